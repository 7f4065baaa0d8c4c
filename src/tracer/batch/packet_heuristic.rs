//! Whether packets pay.

use super::normalized::NormalizedRays;

/// A packet's callback takes about as long as this many of a single ray: it solves
/// two rows of eight lanes, and Embree moves sixteen lanes about. Measured
/// on sticks and trees; `docs/performance.md`.
const PACKET_CALLBACK: u32 = 1;

/// After a packet that did not pay, this many times as many rays are traced one by
/// one before the next is tried.
const PAUSE: u32 = 7;

/// Whether packets paid so far. Rays may go the same way and still have little
/// in common: where what is between them is small, each meets other things. The
/// callbacks tell, of the last packet and of the single rays.
#[derive(Debug, Default)]
pub(super) struct PacketHeuristic {
    /// Callbacks of single rays, and how many rays.
    callbacks: u32,
    rays: u32,
    /// How many packets are not to be tried.
    pause: u32,
}

impl PacketHeuristic {
    pub fn wants_packet(&mut self) -> bool {
        self.pause = self.pause.saturating_sub(1);
        self.pause == 0
    }

    /// Counts `rays` that were traced one by one.
    pub fn traced_alone(&mut self, rays: usize, callbacks: u32) {
        // The newest count for more: what was long ago was elsewhere.
        if self.rays >= 256 {
            (self.callbacks, self.rays) = (self.callbacks / 2, self.rays / 2);
        }
        self.callbacks += callbacks;
        self.rays += rays as u32;
    }

    pub fn traced(&mut self, normalized: &NormalizedRays) {
        if normalized.packet.is_together {
            self.traced_packet(normalized);
        } else {
            self.traced_alone(normalized.all.len(), normalized.packet.callbacks);
        }
    }

    fn traced_packet(&mut self, normalized: &NormalizedRays) {
        let rays = normalized.all.len() as u64;
        let cost = u64::from(PACKET_CALLBACK) * u64::from(normalized.packet.callbacks);
        // Until single rays were traced, four callbacks each are supposed.
        let (callbacks, of_rays) = match self.rays {
            0 => (4, 1),
            of_rays => (u64::from(self.callbacks), u64::from(of_rays)),
        };
        if cost * of_rays > callbacks * rays {
            self.pause = PAUSE + 1;
        }
    }
}
