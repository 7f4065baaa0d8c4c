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
use crate::solid::{Cylinder, Meeting, triple_product};

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

    /// The first point, up to `t_max`, where the ray meets a cylinder of the
    /// current prototype.
    #[inline]
    fn first_meeting(&self, cylinder: &Cylinder, t_max: f64) -> Option<Meeting> {
        let LocalRay {
            direction, shift, ..
        } = self.level().ray;
        let from_p0 = self.level().ray.origin_from(cylinder.p0());
        triple_product::first(cylinder, from_p0, direction, shift, self.t_min, t_max)
    }

    /// Whether the ray meets a cylinder of the current prototype.
    #[inline]
    pub fn meets(&self, record: &CylinderRecord) -> bool {
        self.first_meeting(&record.cylinder(), self.t_max).is_some()
    }

    /// Keeps of the points where the ray meets a cylinder of the current
    /// prototype those that are wanted.
    #[inline]
    pub fn visit(&mut self, record: &CylinderRecord, prototype: PrototypeIndex, position: u32) {
        let cylinder = record.cylinder();
        match self.keep {
            Keep::First(_) => {
                if let Some(meeting) = self.first_meeting(&cylinder, self.bound()) {
                    self.offer(meeting, record.primitive(), prototype, position);
                }
            }
            Keep::Next { .. } => {
                let ray = &self.level().ray;
                let (from_p0, shift) = (ray.origin_from(cylinder.p0()), ray.shift);
                let Some(chord) = triple_product::chord(&cylinder, from_p0, ray.direction) else {
                    return;
                };
                for meeting in chord.meetings(cylinder.caps(), shift, self.t_min, self.bound()) {
                    self.offer(meeting, record.primitive(), prototype, position);
                }
            }
        }
    }

    #[inline]
    fn offer(
        &mut self,
        meeting: Meeting,
        primitive: u32,
        prototype: PrototypeIndex,
        position: u32,
    ) {
        self.keep
            .offer(meeting, &self.path, primitive, |meeting, path| Found {
                meeting,
                prototype,
                record: position,
                primitive,
                path: path.clone(),
            });
    }

    /// The `t_far` that leaves room for all hits that would be kept.
    #[inline]
    pub fn t_far(&self) -> f32 {
        self.level().window.t_far(self.bound())
    }
}
