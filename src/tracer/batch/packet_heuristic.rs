//! Decides whether packets pay.

use super::normalized::NormalizedRays;

/// After a packet that did not pay, the rays of this number of packets are traced one by one.
const PAUSE: u32 = 7;

/// Whether packets paid so far. Rays may be coherent and still have little in common: if the
/// solids between them are small, each ray visits others. The heuristic compares the callbacks
/// of the last packet with those of single rays.
#[derive(Debug, Default)]
pub(super) struct PacketHeuristic {
    /// The callbacks of single rays, and the number of these rays.
    callbacks: u32,
    rays: u32,
    /// The remaining number of packets to skip, plus one.
    pause: u32,
}

impl PacketHeuristic {
    pub fn wants_packet(&mut self) -> bool {
        self.pause = self.pause.saturating_sub(1);
        self.pause == 0
    }

    /// Counts `rays` that were traced one by one.
    pub fn traced_alone(&mut self, rays: usize, callbacks: u32) {
        // Halves old counts, so that new ones weigh more: old rays were elsewhere.
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
        let cost = u64::from(normalized.packet.callbacks);
        // Assumes four callbacks per ray until single rays were traced.
        let (callbacks, of_rays) = match self.rays {
            0 => (4, 1),
            of_rays => (u64::from(self.callbacks), u64::from(of_rays)),
        };
        if cost * of_rays > callbacks * rays {
            self.pause = PAUSE + 1;
        }
    }
}
