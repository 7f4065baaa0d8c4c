//! Batches of rays.
//!
//! Coherent rays are traced in packets of sixteen: Embree walks its tree once for all of them,
//! and the solver computes rows of eight. Other rays enter the root together, in the same rows,
//! but are then traced one by one, because a packet visits everything that any of its rays
//! visits. Rays with many different origins are first sorted so that neighbours have most in
//! common. Results depend on none of this.

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

/// Rays are coherent if the cosine between each direction and the first one is at least this,
/// an angle of 8 degrees: a pixel's neighbours in most pictures, or all rays to a sun.
const LEAST_COSINE: f64 = 0.99;

/// Fewer rays than this are traced one by one, and enter the root one by one.
const LEAST_RAYS: usize = 4;

/// A description up to this number of bytes, with a tree of about the same size, is assumed to
/// stay in the caches of a core; those of recent ones have 1 to 2 MB.
const GREATEST_CACHED: usize = 1 << 21;

impl Tracer {
    /// The first hits of many rays, in their order, as by [`Tracer::first_hit`]. More rays have
    /// more in common; rays from one point that are neighbours in the slice are traced
    /// together.
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

    /// The hits of many rays, in their order, as by [`Tracer::closest`].
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut Vec<Option<Hit>>) {
        self.resolve_batch(rays, hits, |ray, first| self.hit(ray, first));
    }

    /// As [`Tracer::closest_batch`], with only the given fields computed.
    pub fn closest_batch_with(
        &self,
        rays: &[Ray],
        fields: HitFields,
        hits: &mut Vec<Option<PartialHit>>,
    ) {
        self.resolve_batch(rays, hits, |ray, first| self.hit_with(ray, first, fields));
    }

    /// The hits of many rays, computed by `hit`.
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

    /// Whether each of many rays hits any surface, in their order, as by [`Tracer::occluded`].
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

    /// Adds the result of each ray to `answers`: by `together`, or by `alone` for few rays and
    /// for rays that are not valid. `alone` also returns the number of callbacks.
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

    /// Whether everything that rays visit stays in a core's caches, in any order of rays.
    fn fits_caches(&self) -> bool {
        self.counted.described_bytes <= GREATEST_CACHED
    }

    /// Whether the rays should be a packet. Rays of a coherent group are within twice the angle
    /// of each other.
    fn are_packet(
        &self,
        rays: &[Ray],
        is_alike: bool,
        packet_heuristic: &mut PacketHeuristic,
    ) -> bool {
        self.traces_packets && (is_alike || are_alike(rays)) && packet_heuristic.wants_packet()
    }
}

/// Whether all rays have similar directions. Their origins matter less: those of a picture's
/// rays are near each other, and rays from elsewhere with the same directions still intersect
/// boxes in the same order.
fn are_alike(rays: &[Ray]) -> bool {
    let first = rays[0].direction;
    rays.iter().all(|ray| {
        let product = ray.direction.dot(first);
        let squares = ray.direction.length_squared() * first.length_squared();
        product > 0.0 && product * product >= LEAST_COSINE * LEAST_COSINE * squares
    })
}
