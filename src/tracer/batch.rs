//! Many rays at a time.
//!
//! Rays that go the same way are traced sixteen together, as a packet: Embree
//! walks its tree once for all of them, and the solver takes eight to a row.
//! Others are traced one by one, for a packet visits whatever any of its rays
//! has to. Answers do not depend on which it is.

use super::frame::{LocalRay, PacketRays, ROWS};
use super::prototype::Prototype;
use super::query::Packet;
use super::{FirstHit, Hit, Tracer, with_usual_length};
use crate::embree::{GREATEST_PACKET, RaySet};
use crate::math::{LANES, Lanes, Ray};

/// Rays are alike if the cosine between each direction and the first one is at
/// least this, which is an angle of 8 degrees: a pixel's neighbours in most
/// pictures, or all rays to a sun.
const LEAST_COSINE: f64 = 0.99;

/// Fewer rays than this are traced one by one.
const LEAST_RAYS: usize = 4;

/// A packet's callback takes about as long as so many of a single ray: it solves
/// two rows of eight lanes, and Embree moves sixteen lanes about. Measured
/// on sticks and trees; `docs/performance.md`.
const PACKET_CALLBACK: u32 = 2;

/// After a packet that did not pay, so many times as many rays are traced one by
/// one before the next is tried.
const PAUSE: u32 = 7;

impl Tracer {
    /// The first hits of many rays, in their order, as [`Tracer::first_hit`]
    /// finds them. Rays that are neighbours in the slice and go the same way are
    /// traced together.
    pub fn first_hits(&self, rays: &[Ray], hits: &mut Vec<Option<FirstHit>>) {
        hits.clear();
        hits.reserve(rays.len());
        let alone = |ray: &Ray| self.first_hit_and_callbacks(ray);
        self.answer_all(rays, hits, alone, |root, usual, hits| {
            root.search_packet(usual.all, &usual.local, &mut usual.packet);
            for ray in usual.all {
                let nearest = usual.packet.take_nearest(ray);
                hits.push(nearest.map(|nearest| FirstHit::new(nearest, usual.factors[ray])));
            }
        });
    }

    /// The hits of many rays, in their order, as [`Tracer::closest`] finds
    /// them.
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        let mut first = Vec::new();
        self.first_hits(rays, &mut first);
        let pairs = rays.iter().zip(first);
        hits.clear();
        hits.extend(pairs.map(|(ray, first)| Some(self.hit(ray, &first?))));
    }

    /// Whether each of many rays meets any surface, in their order, as
    /// [`Tracer::occluded`] says.
    pub fn occluded_batch(&self, rays: &[Ray], blocked: &mut Vec<bool>) {
        blocked.clear();
        blocked.reserve(rays.len());
        let alone = |ray: &Ray| self.occluded_and_callbacks(ray);
        self.answer_all(rays, blocked, alone, |root, usual, blocked| {
            let hit = root.occluded_packet(usual.all, &usual.local, &mut usual.packet);
            blocked.extend(usual.all.into_iter().map(|ray| hit.contains(ray)));
        });
    }

    /// Adds the answer of each ray to `answers`: of rays that should be a packet
    /// by `together`, of others by `alone`, which also says how often Embree
    /// called back.
    fn answer_all<T>(
        &self,
        rays: &[Ray],
        answers: &mut Vec<T>,
        alone: impl Fn(&Ray) -> (T, u32),
        together: impl Fn(&Prototype, &mut Usual, &mut Vec<T>),
    ) {
        let (mut habit, mut usual) = (Habit::default(), Usual::new());
        for rays in rays.chunks(GREATEST_PACKET) {
            match &self.root {
                Some(root) if self.are_packet(rays, &mut habit) && usual.fill(rays) => {
                    together(root, &mut usual, answers);
                    habit.traced_packet(&usual);
                }
                _ => answers.extend(rays.iter().map(|ray| {
                    let (answer, callbacks) = alone(ray);
                    habit.traced_one(callbacks);
                    answer
                })),
            }
        }
    }

    /// Whether the rays should be a packet.
    fn are_packet(&self, rays: &[Ray], habit: &mut Habit) -> bool {
        rays.len() >= LEAST_RAYS && self.traces_packets && are_alike(rays) && habit.wants_packet()
    }
}

/// Whether packets paid so far. Rays may go the same way and still have little
/// in common: where what is between them is small, each meets other things. The
/// callbacks tell, of the last packet and of the single rays.
#[derive(Debug, Default)]
struct Habit {
    /// Callbacks of single rays, and how many rays.
    callbacks: u32,
    rays: u32,
    /// How many packets are not to be tried.
    pause: u32,
}

impl Habit {
    fn wants_packet(&mut self) -> bool {
        self.pause = self.pause.saturating_sub(1);
        self.pause == 0
    }

    fn traced_one(&mut self, callbacks: u32) {
        // The newest count for more: what was long ago was elsewhere.
        if self.rays == 256 {
            (self.callbacks, self.rays) = (self.callbacks / 2, 128);
        }
        self.callbacks += callbacks;
        self.rays += 1;
    }

    fn traced_packet(&mut self, usual: &Usual) {
        let rays = usual.all.len() as u64;
        let cost = u64::from(PACKET_CALLBACK) * u64::from(usual.packet.callbacks);
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

/// Rays of a packet with directions of usual length.
struct Usual {
    all: RaySet,
    packet: Packet,
    local: PacketRays,
    /// What turns the `t` of each ray back.
    factors: [[f64; 2]; GREATEST_PACKET],
}

impl Usual {
    /// No rays yet.
    fn new() -> Self {
        Self {
            all: RaySet::EMPTY,
            packet: Packet::new(),
            local: PacketRays::NOWHERE,
            factors: [[1.0; 2]; GREATEST_PACKET],
        }
    }

    /// Replaces the rays; false if one is not valid.
    fn fill(&mut self, rays: &[Ray]) -> bool {
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

/// Whether all rays go about the same way. Where they start does not matter as
/// much: it is near together for rays of a picture, and where it is not the
/// directions still say that the boxes they meet are met in the same order.
fn are_alike(rays: &[Ray]) -> bool {
    let first = rays[0].direction;
    rays.iter().all(|ray| {
        let product = ray.direction.dot(first);
        let squares = ray.direction.length_squared() * first.length_squared();
        product > 0.0 && product * product >= LEAST_COSINE * LEAST_COSINE * squares
    })
}
