//! The state of one query: the f64 ray and the best hit so far.
//!
//! It travels through Embree in the query context. Embree's own f32 ray only
//! finds candidates; what is a hit, and which is nearer, is decided here on
//! f64 alone.

use arrayvec::ArrayVec;

use super::frame::{Frame, Level, LocalRay};
use crate::embree::Ray32;
use crate::math::Ray;
use crate::scene::{CylinderRecord, GREATEST_DEPTH, PrototypeIndex};
use crate::solid::{Meeting, triple_product};

/// The placements on the way from the root to a prototype, outermost first.
pub(crate) type InstancePath = ArrayVec<u32, GREATEST_DEPTH>;

/// A hit as the query keeps it: what is needed to work it out afterwards.
#[derive(Clone, Debug)]
pub(crate) struct Best {
    /// The parameter of the ray that was asked for.
    pub t: f64,
    /// The meeting, whose `t` counts from the local ray's origin.
    pub meeting: Meeting,
    pub prototype: PrototypeIndex,
    /// The position in the prototype's list of cylinders.
    pub record: u32,
    /// The number that the user knows it by.
    pub primitive: u32,
    pub path: InstancePath,
}

/// A closest-hit or any-hit query on its way.
#[derive(Debug)]
pub(crate) struct Query {
    t_min: f64,
    t_max: f64,
    /// The ray in the prototype that is being traced.
    pub level: Option<Level>,
    pub path: InstancePath,
    pub best: Option<Best>,
}

impl Query {
    pub fn new(ray: &Ray) -> Self {
        Self {
            t_min: ray.t_min,
            t_max: ray.t_max,
            level: None,
            path: InstancePath::new(),
            best: None,
        }
    }

    /// The greatest `t` that can still become the answer.
    #[inline]
    fn bound(&self) -> f64 {
        self.best.as_ref().map_or(self.t_max, |best| best.t)
    }

    /// The ray in a prototype, if anything there could become the answer.
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

    /// The first point in range where the ray meets a cylinder of the current
    /// prototype.
    #[inline]
    pub fn meet(&self, record: &CylinderRecord) -> Option<Meeting> {
        let (cylinder, ray) = (record.cylinder(), &self.level().ray);
        triple_product::chord(&cylinder, ray.origin_from(cylinder.p0()), ray.direction)?.first(
            cylinder.caps(),
            ray.shift,
            self.t_min,
            self.bound(),
        )
    }

    /// Takes a meeting as the best hit if it comes before the best so far:
    /// less `t`, or the same and a lesser (path, primitive).
    #[inline]
    pub fn offer(
        &mut self,
        meeting: Meeting,
        prototype: PrototypeIndex,
        record: u32,
        primitive: u32,
    ) -> bool {
        let t = meeting.t + self.level().ray.shift;
        if let Some(best) = &self.best
            && (t > best.t
                || (t == best.t && (&self.path, primitive) >= (&best.path, best.primitive)))
        {
            return false;
        }
        let path = self.path.clone();
        self.best = Some(Best {
            t,
            meeting,
            prototype,
            record,
            primitive,
            path,
        });
        true
    }

    /// The `t_far` that leaves room for hits as near as the best one.
    #[inline]
    pub fn t_far(&self) -> f32 {
        self.level().window.t_far(self.bound())
    }
}
