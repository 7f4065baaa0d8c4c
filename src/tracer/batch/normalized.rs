//! The normalized rays of a packet.

use crate::embree::{GREATEST_PACKET, Instructions, RaySet};
use crate::math::{LANES, Lanes, Ray};
use crate::tracer::Tracer;
use crate::tracer::decisions::Decisions;
use crate::tracer::frame::{LocalRay, PacketRays, ROWS};
use crate::tracer::query::Packet;

/// The rays of a packet, with normalized directions.
pub(super) struct NormalizedRays {
    pub all: RaySet,
    pub packet: Packet,
    pub local: PacketRays,
    /// The factor from the `t` of each ray to the caller's.
    pub factors: [f64; GREATEST_PACKET],
}

impl NormalizedRays {
    /// An empty packet, to be computed with these instructions.
    pub fn new(instructions: Instructions, decisions: Decisions) -> Self {
        Self {
            all: RaySet::EMPTY,
            packet: Packet::new(instructions, decisions),
            local: PacketRays::NOWHERE,
            factors: [1.0; GREATEST_PACKET],
        }
    }

    /// Replaces the rays. They are traced as a packet if `is_together`, otherwise one by one.
    /// Returns false if a ray is not valid, that is a miss in any scene.
    pub fn fill(&mut self, tracer: &Tracer, rays: &[Ray], is_together: bool) -> bool {
        let (mut t_min, mut t_max) = ([Lanes::splat(0.0); ROWS], [Lanes::splat(0.0); ROWS]);
        for (number, ray) in rays.iter().enumerate() {
            let (row, lane) = (number / LANES, number % LANES);
            let Some((ray, factor)) = tracer.normalized(ray) else {
                return false;
            };
            self.local.set(row, lane, &LocalRay::new(&ray));
            t_min[row].0[lane] = ray.t_min;
            t_max[row].0[lane] = ray.t_max;
            self.factors[number] = factor;
        }
        self.all = RaySet::first(rays.len());
        self.packet.begin(t_min, t_max, is_together);
        true
    }
}
