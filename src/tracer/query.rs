//! The state of one query: the f64 ray and the hits so far.
//!
//! It travels through Embree in the query context. Embree's own f32 ray only
//! finds candidates; what is a hit, and which is nearer, is decided here on
//! f64 alone.

use super::found::{Found, InstancePath, Keep};
use super::frame::{Frame, Level, LocalRay};
use crate::embree::Ray32;
use crate::math::Ray;
use crate::scene::{CylinderRecord, PrototypeIndex};
use crate::solid::{Chord, Cylinder, triple_product};

/// A query on its way.
#[derive(Debug)]
pub(crate) struct Query {
    t_min: f64,
    t_max: f64,
    /// The ray in the prototype that is being traced.
    pub level: Option<Level>,
    pub path: InstancePath,
    pub keep: Keep,
}

impl Query {
    /// A query for the first hit, or whether there is any.
    pub fn first(ray: &Ray) -> Self {
        Self::new(ray, Keep::First(None))
    }

    /// A query for the next hits after one, at most `most`.
    pub fn next(ray: &Ray, after: Option<Found>, most: usize) -> Self {
        let t_min = after.as_ref().map_or(ray.t_min, |after| after.meeting.t);
        let hits = Vec::new();
        let keep = Keep::Next { after, most, hits };
        Self {
            t_min,
            ..Self::new(ray, keep)
        }
    }

    fn new(ray: &Ray, keep: Keep) -> Self {
        Self {
            t_min: ray.t_min,
            t_max: ray.t_max,
            level: None,
            path: InstancePath::new(),
            keep,
        }
    }

    /// The greatest `t` that can still be part of the answer.
    #[inline]
    pub fn bound(&self) -> f64 {
        self.keep.bound(self.t_max)
    }

    /// The ray in a prototype, if anything there could be part of the answer.
    #[inline]
    pub fn enter(&self, frame: &Frame, ray: &LocalRay) -> Option<(Level, Ray32)> {
        frame.enter(ray, self.t_min, self.bound())
    }

    /// The level that callbacks run in.
    #[inline]
    pub fn level(&self) -> &Level {
        self.level
            .as_ref()
            .expect("callbacks run within a prototype")
    }

    /// The stretch of the ray inside a cylinder of the current prototype.
    #[inline]
    fn chord(&self, cylinder: &Cylinder) -> Option<Chord> {
        let ray = &self.level().ray;
        triple_product::chord(cylinder, ray.origin_from(cylinder.p0()), ray.direction)
    }

    /// Whether the ray meets a cylinder of the current prototype.
    #[inline]
    pub fn meets(&self, record: &CylinderRecord) -> bool {
        let (cylinder, shift) = (record.cylinder(), self.level().ray.shift);
        self.chord(&cylinder)
            .and_then(|chord| chord.first(cylinder.caps(), shift, self.t_min, self.t_max))
            .is_some()
    }

    /// Keeps of the points where the ray meets a cylinder of the current
    /// prototype those that are wanted.
    #[inline]
    pub fn visit(&mut self, record: &CylinderRecord, prototype: PrototypeIndex, position: u32) {
        let (cylinder, shift) = (record.cylinder(), self.level().ray.shift);
        let Some(chord) = self.chord(&cylinder) else {
            return;
        };
        let primitive = record.primitive();
        let meetings = chord.meetings(cylinder.caps(), shift, self.t_min, self.bound());
        let wanted = match self.keep {
            Keep::First(_) => 1,
            Keep::Next { .. } => 2,
        };
        for meeting in meetings.take(wanted) {
            self.keep
                .offer(meeting, &self.path, primitive, |meeting, path| Found {
                    meeting,
                    prototype,
                    record: position,
                    primitive,
                    path: path.clone(),
                });
        }
    }

    /// The `t_far` that leaves room for all hits that would be kept.
    #[inline]
    pub fn t_far(&self) -> f32 {
        self.level().window.t_far(self.bound())
    }
}
