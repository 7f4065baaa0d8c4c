//! All hits of a ray, in batches.
//!
//! A traversal keeps the first hits after the last known one, at most a batch of them. Hits
//! have a total order, so the next traversal continues exactly there: none is lost or repeated,
//! even among many at the same `t`.
//!
//! **Time.** A full batch ends the ray at its last hit, so for solids in a row the number of
//! visits is about that of the kept hits. If N solids overlap, as coincident and concentric
//! ones do, each traversal visits all of them, and batches of constant size would take N²/batch
//! visits. So the batch size doubles after a traversal that visits more than [`GREATEST_COST`]
//! primitives per hit of its batch. Then
//!
//! - at most log2 N traversals double the batch, with at most N visits each;
//! - the others visit at most [`GREATEST_COST`] primitives per hit.
//!
//! Keeping the least k of the hits in a heap takes log k per hit. The total is N log N.
//!
//! **Memory.** A batch grows only while N > [`GREATEST_COST`] · batch, so it stays below N/8
//! hits, and at its first size if the range prunes.

use super::frame::LocalRay;
use super::query::{Found, Query, QueryMode};
use super::resolve::Which;
use super::{Hit, HitFields, PartialHit, Tracer};
use crate::math::Ray;

/// A batch size that suits most rays: few need a second traversal, and keeping this number of
/// hits in order costs little.
pub const DEFAULT_BATCH: usize = 32;

/// The most primitives that a traversal visits per hit of its batch before the batch grows. A
/// lower limit takes more memory for overlapping solids; a higher one takes proportionally more
/// time for them. Rays through thickets visit some five primitives per hit, and their batches
/// should not grow.
const GREATEST_COST: usize = 16;

/// The hits of [`Tracer::all_hits`].
pub struct AllHits<'a> {
    tracer: &'a Tracer,
    /// The normalized ray, and the factor from its `t` to the caller's.
    ray: Option<(Ray, f64)>,
    /// The batch size of the next traversal.
    batch: usize,
    /// The hits of the last traversal that are not returned yet.
    known: std::vec::IntoIter<Found>,
    /// The last hit of that traversal, after which the next continues.
    last: Option<Found>,
    is_complete: bool,
    /// The primitives visited so far.
    visits: u64,
}

impl<'a> AllHits<'a> {
    pub(super) fn new(tracer: &'a Tracer, ray: &Ray, batch: usize) -> Self {
        Self {
            tracer,
            ray: tracer.normalized(ray),
            batch: batch.max(1),
            known: Vec::new().into_iter(),
            last: None,
            is_complete: false,
            visits: 0,
        }
    }

    /// The same hits, with only the given fields computed.
    pub fn with(mut self, fields: HitFields) -> impl Iterator<Item = PartialHit> + 'a {
        std::iter::from_fn(move || Some(PartialHit::new(self.next_hit(fields)?, fields)))
    }

    /// The next hit, with the given fields computed.
    fn next_hit(&mut self, fields: HitFields) -> Option<Hit> {
        if self.known.as_slice().is_empty() && !self.is_complete {
            self.search()?;
        }
        let found = self.known.next()?;
        let (ray, factor) = self.ray?;
        let root = self.tracer.root.as_ref()?;
        let which = Which::This(found.hit);
        let hit = self
            .tracer
            .resolved(root, (&ray, factor), &found.place, which, fields);
        Some(hit)
    }

    /// Finds the next hits; `None` if there cannot be any.
    fn search(&mut self) -> Option<()> {
        let (ray, _) = self.ray?;
        let root = self.tracer.root.as_ref()?;
        let decisions = self.tracer.decisions();
        let mut query = Query::next(&ray, decisions, self.last.take(), self.batch);
        root.search(&LocalRay::new(&ray), &mut query);
        let QueryMode::Next(next) = query.mode else {
            unreachable!("a query keeps its mode");
        };
        let hits = next.hits.into_sorted_vec();
        self.is_complete = hits.len() < self.batch;
        self.last = hits.last().cloned();
        self.known = hits.into_iter();
        self.visits += u64::from(query.callbacks);
        if query.callbacks as usize > self.batch.saturating_mul(GREATEST_COST) {
            self.batch *= 2;
        }
        Some(())
    }
}

impl Iterator for AllHits<'_> {
    type Item = Hit;

    fn next(&mut self) -> Option<Hit> {
        self.next_hit(HitFields::all())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::scene::{CylinderRecord, MaterialIndex, Prototype, Scene, Solids};
    use crate::solid::{Caps, Cylinder};
    use crate::tracer::Options;

    /// Cylinders across the ray from (-5, 0, 1/2) along x, each with its position on the ray
    /// and its radius.
    fn tracer(cylinders: impl Iterator<Item = (f64, f64)>) -> Tracer {
        let record = |(number, (x, radius)): (usize, (f64, f64))| {
            let (p0, p1) = (DVec3::new(x, 0.0, 0.0), DVec3::new(x, 0.0, 1.0));
            let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).expect("a cylinder");
            CylinderRecord::new(&cylinder, number as u32, MaterialIndex(0))
        };
        let root = Prototype {
            solids: Solids::of_cylinders(cylinders.enumerate().map(record)),
            ..Prototype::default()
        };
        let scene = Arc::new(Scene::new(vec![root]));
        Tracer::new(scene, &Options::default()).expect("a tracer")
    }

    /// The number of hits of that ray, the visits per hit, and the size of the last batch.
    fn cost(tracer: &Tracer) -> (usize, f64, usize) {
        let ray = Ray::new(DVec3::new(-5.0, 0.0, 0.5), DVec3::X);
        let mut hits = tracer.all_hits(&ray, DEFAULT_BATCH);
        let (mut count, mut before) = (0, (f64::NEG_INFINITY, 0));
        for hit in hits.by_ref() {
            let place = (hit.t, hit.primitive);
            assert!(before < place, "{before:?} before {place:?}");
            (count, before) = (count + 1, place);
        }
        (count, hits.visits as f64 / count as f64, hits.batch)
    }

    #[test]
    fn visits_a_hit_grow_with_the_logarithm_where_all_solids_overlap() {
        for count in [1_000_usize, 10_000, 40_000] {
            let share = |number: usize| number as f64 / count as f64;
            let coincident = tracer((0..count).map(|_| (0.0, 1.0)));
            let concentric = tracer((0..count).map(|number| (0.0, 1.0 + share(number))));
            for (name, tracer) in [("coincident", coincident), ("concentric", concentric)] {
                let (hits, visits, batch) = cost(&tracer);
                assert_eq!(hits, 2 * count, "{name}");
                let greatest = GREATEST_COST as f64 + libm::log2(count as f64);
                assert!(visits <= greatest, "{name}, {count}: {visits} visits a hit");
                assert!(batch <= count / 8, "{name}, {count}: batches of {batch}");
            }
        }
    }

    #[test]
    fn batches_stay_small_where_the_range_prunes() {
        for count in [1_000_usize, 40_000] {
            let (hits, visits, batch) = cost(&tracer((0..count).map(|i| (3.0 * i as f64, 1.0))));
            assert_eq!((hits, batch), (2 * count, DEFAULT_BATCH));
            assert!(visits <= 2.0, "{count}: {visits} visits a hit");
        }
    }
}
