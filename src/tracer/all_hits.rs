//! All hits of a ray, a batch at a time.
//!
//! A traversal keeps the first so many hits after the last one that is known.
//! Hits have a total order, so that the next traversal goes on exactly there:
//! none is missed or doubled, also among many at the same `t`.

use super::frame::LocalRay;
use super::query::{Found, Keep, Query};
use super::resolve::Which;
use super::{Hit, Tracer};
use crate::math::Ray;

/// A batch that suits most rays: a second traversal is needed for few, and
/// keeping that many in order costs little.
pub const DEFAULT_BATCH: usize = 32;

/// The hits of [`Tracer::all_hits`].
pub struct AllHits<'a> {
    tracer: &'a Tracer,
    /// The ray in use, and the factor that turns its `t` back.
    ray: Option<(Ray, f64)>,
    batch: usize,
    /// Those of the last traversal that have not been handed out.
    known: std::vec::IntoIter<Found>,
    /// The last one of that traversal, after which the next goes on.
    last: Option<Found>,
    is_complete: bool,
}

impl<'a> AllHits<'a> {
    pub(super) fn new(tracer: &'a Tracer, ray: &Ray, batch: usize) -> Self {
        Self {
            tracer,
            ray: tracer.in_use(ray),
            batch: batch.max(1),
            known: Vec::new().into_iter(),
            last: None,
            is_complete: false,
        }
    }

    /// Finds the next hits, if there can be any.
    fn search(&mut self) -> Option<()> {
        let (ray, _) = self.ray?;
        let root = self.tracer.root.as_ref()?;
        let mut query = Query::next(&ray, self.last.take(), self.batch);
        root.search(&LocalRay::new(&ray), &mut query);
        let Keep::Next(next) = query.keep else {
            unreachable!("the query keeps what it was told to keep");
        };
        let hits = next.hits;
        self.is_complete = hits.len() < self.batch;
        self.last = hits.last().cloned();
        self.known = hits.into_iter();
        Some(())
    }
}

impl Iterator for AllHits<'_> {
    type Item = Hit;

    fn next(&mut self) -> Option<Hit> {
        if self.known.as_slice().is_empty() && !self.is_complete {
            self.search()?;
        }
        let found = self.known.next()?;
        let (ray, factor) = self.ray?;
        let root = self.tracer.root.as_ref()?;
        let which = Which::This(found.met);
        Some(
            self.tracer
                .resolved(root, &ray, factor, &found.place, which),
        )
    }
}
