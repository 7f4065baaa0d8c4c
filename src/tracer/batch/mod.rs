//! Many rays at a time.
//!
//! Coherent rays are traced sixteen together, as a packet: Embree walks its tree
//! once for all of them, and the solver takes eight to a row. Others enter the root
//! together, in the same rows, but are then traced one by one, for a packet visits
//! whatever any of its rays has to. Rays that start at many places are first put in an
//! order in which neighbours have most in common. Answers depend on none of this.

mod normalized;
mod order;
mod packet_heuristic;

use arrayvec::ArrayVec;

use super::prototype::Prototype;
use super::{FirstHit, Hit, HitFields, PartialHit, Tracer};
use crate::embree::GREATEST_PACKET;
use crate::math::Ray;
use normalized::NormalizedRays;
use order::{Group, order, split};
use packet_heuristic::PacketHeuristic;

/// Rays are alike if the cosine between each direction and the first one is at
/// least this, which is an angle of 8 degrees: a pixel's neighbours in most
/// pictures, or all rays to a sun.
const LEAST_COSINE: f64 = 0.99;

/// Fewer rays than this are traced one by one, and enter one by one.
const LEAST_RAYS: usize = 4;

/// A description of this many bytes, which has about as many in Embree's tree, is
/// thought to stay in the caches of a core, of which recent ones have 1 to 2 MB.
const GREATEST_CACHED: usize = 1 << 21;

impl Tracer {
    /// The first hits of many rays, in their order, as [`Tracer::first_hit`]
    /// finds them. The more rays there are the more have something in common;
    /// rays of one point that are neighbours in the slice are traced together.
    pub fn first_hits(&self, rays: &[Ray], hits: &mut Vec<Option<FirstHit>>) {
        hits.clear();
        hits.reserve(rays.len());
        let alone = |ray: &Ray| self.first_hit_and_callbacks(ray);
        self.answer_all(rays, hits, alone, |root, normalized, hits| {
            root.search_packet(normalized.all, &normalized.local, &mut normalized.packet);
            for ray in normalized.all {
                let nearest = normalized.packet.take_nearest(ray);
                hits.push(nearest.map(|nearest| FirstHit::new(nearest, normalized.factors[ray])));
            }
        });
    }

    /// The hits of many rays, in their order, as [`Tracer::closest`] finds
    /// them.
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        self.resolve_batch(rays, hits, |ray, first| self.hit(ray, first));
    }

    /// As [`Tracer::closest_batch`], with only those fields worked out that are in `fields`.
    pub fn closest_batch_with(
        &self,
        rays: &[Ray],
        fields: HitFields,
        hits: &mut Vec<Option<PartialHit>>,
    ) {
        self.resolve_batch(rays, hits, |ray, first| self.hit_with(ray, first, fields));
    }

    /// The hits of many rays, worked out by `hit`.
    fn resolve_batch<T>(
        &self,
        rays: &[Ray],
        hits: &mut Vec<Option<T>>,
        hit: impl Fn(&Ray, &FirstHit) -> T,
    ) {
        let mut first = Vec::new();
        self.first_hits(rays, &mut first);
        let pairs = rays.iter().zip(first);
        hits.clear();
        hits.extend(pairs.map(|(ray, first)| Some(hit(ray, &first?))));
    }

    /// Whether each of many rays meets any surface, in their order, as
    /// [`Tracer::occluded`] says.
    pub fn occluded_batch(&self, rays: &[Ray], blocked: &mut Vec<bool>) {
        blocked.clear();
        blocked.reserve(rays.len());
        let alone = |ray: &Ray| self.occluded_and_callbacks(ray);
        self.answer_all(rays, blocked, alone, |root, normalized, blocked| {
            let hit =
                root.occluded_packet(normalized.all, &normalized.local, &mut normalized.packet);
            blocked.extend(normalized.all.into_iter().map(|ray| hit.contains(ray)));
        });
    }

    /// Adds the answer of each ray to `answers`: of usual rays by `together`, of few or
    /// others by `alone`, which also says how often Embree called back.
    fn answer_all<T: Default>(
        &self,
        rays: &[Ray],
        answers: &mut Vec<T>,
        alone: impl Fn(&Ray) -> (T, u32),
        together: impl Fn(&Prototype, &mut NormalizedRays, &mut Vec<T>),
    ) {
        let mut packet_heuristic = PacketHeuristic::default();
        let mut normalized = NormalizedRays::new(self.device.instructions(), self.decisions());
        let mut answer = |rays: &[Ray], is_alike, answers: &mut Vec<T>| match &self.root {
            Some(root)
                if rays.len() >= LEAST_RAYS
                    && normalized.fill(
                        self,
                        rays,
                        self.are_packet(rays, is_alike, &mut packet_heuristic),
                    ) =>
            {
                together(root, &mut normalized, answers);
                packet_heuristic.traced(&normalized);
            }
            _ => answers.extend(rays.iter().map(|ray| {
                let (answer, callbacks) = alone(ray);
                packet_heuristic.traced_alone(1, callbacks);
                answer
            })),
        };
        let mut few = Vec::with_capacity(GREATEST_PACKET);
        let mut rest = rays;
        while !rest.is_empty() {
            let group;
            (group, rest) = split(rest);
            let Group { rays, is_alike } = group;
            let Some(order) = order(group, self.fits_caches()) else {
                for rays in rays.chunks(GREATEST_PACKET) {
                    answer(rays, is_alike, answers);
                }
                continue;
            };
            let first = answers.len();
            answers.resize_with(first + rays.len(), T::default);
            for numbers in order.chunks(GREATEST_PACKET) {
                let in_order: ArrayVec<Ray, GREATEST_PACKET> = numbers
                    .iter()
                    .map(|&number| rays[number as usize])
                    .collect();
                answer(&in_order, is_alike, &mut few);
                for (&number, answer) in numbers.iter().zip(few.drain(..)) {
                    answers[first + number as usize] = answer;
                }
            }
        }
    }

    /// The positions of a batch's rays in the order in which the batch traces them.
    #[must_use]
    pub fn batch_order(&self, rays: &[Ray]) -> Vec<u32> {
        let mut positions = Vec::with_capacity(rays.len());
        let mut rest = rays;
        while !rest.is_empty() {
            let first = positions.len() as u32;
            let group;
            (group, rest) = split(rest);
            match order(group, self.fits_caches()) {
                Some(order) => positions.extend(order.into_iter().map(|position| first + position)),
                None => positions.extend(first..first + group.rays.len() as u32),
            }
        }
        positions
    }

    /// Whether all that rays visit stays in a core's own caches, however rays come.
    fn fits_caches(&self) -> bool {
        self.counted.described_bytes <= GREATEST_CACHED
    }

    /// Whether the rays should be a packet. Those of a group that is alike are within twice
    /// the angle of each other.
    fn are_packet(
        &self,
        rays: &[Ray],
        is_alike: bool,
        packet_heuristic: &mut PacketHeuristic,
    ) -> bool {
        self.traces_packets && (is_alike || are_alike(rays)) && packet_heuristic.wants_packet()
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
