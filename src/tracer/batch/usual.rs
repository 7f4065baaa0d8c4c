//! The rays of a packet as they are traced.

use crate::embree::{GREATEST_PACKET, RaySet};
use crate::math::{LANES, Lanes, Ray};
use crate::tracer::frame::{LocalRay, PacketRays, ROWS};
use crate::tracer::query::Packet;
use crate::tracer::with_usual_length;

/// Rays of a packet with directions of usual length.
pub(super) struct Usual {
    pub all: RaySet,
    pub packet: Packet,
    pub local: PacketRays,
    /// What turns the `t` of each ray back.
    pub factors: [[f64; 2]; GREATEST_PACKET],
}

impl Usual {
    /// No rays yet.
    pub fn new() -> Self {
        Self {
            all: RaySet::EMPTY,
            packet: Packet::new(),
            local: PacketRays::NOWHERE,
            factors: [[1.0; 2]; GREATEST_PACKET],
        }
    }

    /// Replaces the rays; false if one is not valid.
    pub fn fill(&mut self, rays: &[Ray]) -> bool {
        let (mut t_min, mut t_max) = ([Lanes::splat(0.0); ROWS], [Lanes::splat(0.0); ROWS]);
        for (number, ray) in rays.iter().enumerate() {
            let (row, lane) = (number / LANES, number % LANES);
            let Some((ray, factors)) = with_usual_length(ray) else {
                return false;
            };
            self.local.set(row, lane, &LocalRay::new(&ray));
            t_min[row].0[lane] = ray.t_min;
            t_max[row].0[lane] = ray.t_max;
            self.factors[number] = factors;
        }
        self.all = RaySet::first(rays.len());
        self.packet.begin(t_min, t_max);
        true
    }
}
