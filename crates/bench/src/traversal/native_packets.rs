//! Packets of rays through what Embree intersects by itself.

use std::ops::Range;

use super::native::Native;
use super::rays::{Kind, Rays};
use super::representation::{Met, Representative};
use cyltrace::embree::{Coherence, GREATEST_PACKET, NativeHit, PacketWidth, Ray32, RaySet, Rays32};

/// A scene of Embree's own geometry, traced by packets of the widest kind.
struct NativePackets {
    native: Native,
    width: PacketWidth,
}

/// The same scene traced by packets.
///
/// # Errors
/// Why it cannot be.
pub fn by_packets(native: Native) -> Result<Box<dyn Representative>, String> {
    match native.packet_width() {
        Some(width) => Ok(Box::new(NativePackets { native, width })),
        None => Err(String::from("the installed Embree does not trace packets")),
    }
}

impl NativePackets {
    /// The hint that suits the rays best: coherent rays and shadow rays are up to 1.4 times
    /// as fast with Embree's hint that they are coherent, incoherent rays up to 1.6 times
    /// without it.
    ///
    /// Through instances no packet has the hint: Embree 3.13.5 on AVX-512 may never return
    /// from `rtcOccluded16` with it, if packets without it went through curves before. There it
    /// makes no difference in time that shows.
    fn coherence(&self, kind: Kind) -> Coherence {
        match kind {
            Kind::Coherent | Kind::Shadow if !self.native.has_instances() => Coherence::Coherent,
            _ => Coherence::Incoherent,
        }
    }

    /// Traces rays for their first hits, a packet after the other.
    #[inline]
    fn each_hit(&self, kind: Kind, rays: &[Ray32], mut tell: impl FnMut(usize, NativeHit)) {
        for (number, packet) in rays.chunks(GREATEST_PACKET).enumerate() {
            let (all, first) = (RaySet::first(packet.len()), number * GREATEST_PACKET);
            let scene = self.native.scene();
            scene.closest_native_packet(
                &side_by_side(packet),
                all,
                self.width,
                self.coherence(kind),
                &mut (),
                |ray, hit| {
                    tell(first + ray, hit);
                },
            );
        }
    }

    /// The rays of each packet that are blocked.
    #[inline]
    fn each_blocked(&self, kind: Kind, rays: &[Ray32]) -> impl Iterator<Item = (usize, RaySet)> {
        let coherence = self.coherence(kind);
        rays.chunks(GREATEST_PACKET).map(move |packet| {
            let rays = side_by_side(packet);
            let all = RaySet::first(packet.len());
            let scene = self.native.scene();
            let blocked = scene.any_packet(&rays, all, self.width, coherence, &mut ());
            (packet.len(), blocked)
        })
    }
}

/// The rays by component.
fn side_by_side(rays: &[Ray32]) -> Rays32 {
    let mut packet = Rays32 {
        origin: [[0.0; GREATEST_PACKET]; 3],
        direction: [[0.0; GREATEST_PACKET]; 3],
        t_far: [0.0; GREATEST_PACKET],
    };
    for (number, ray) in rays.iter().enumerate() {
        for axis in 0..3 {
            packet.origin[axis][number] = ray.origin[axis];
            packet.direction[axis][number] = ray.direction[axis];
        }
        packet.t_far[number] = ray.t_far;
    }
    packet
}

impl Representative for NativePackets {
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>> {
        let narrow = &rays.narrow[range];
        let mut met = vec![None; narrow.len()];
        self.each_hit(rays.kind, narrow, |ray, hit| {
            met[ray] = Some(self.native.met(&hit))
        });
        met
    }

    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool> {
        let packets = self.each_blocked(rays.kind, &rays.narrow[range]);
        packets
            .flat_map(|(count, blocked)| (0..count).map(move |ray| blocked.contains(ray)))
            .collect()
    }

    fn run(&self, rays: &Rays, range: Range<usize>) -> u64 {
        let asked = &rays.narrow[range];
        match rays.kind {
            Kind::Shadow => {
                let packets = self.each_blocked(rays.kind, asked);
                packets.map(|(_, blocked)| blocked.len() as u64).sum()
            }
            Kind::Coherent | Kind::Incoherent => {
                let mut sum = 0;
                self.each_hit(rays.kind, asked, |_, hit| sum += u64::from(hit.t.to_bits()));
                sum
            }
        }
    }

    fn bytes(&self) -> usize {
        self.native.bytes()
    }
}
