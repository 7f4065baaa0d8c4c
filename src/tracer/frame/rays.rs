//! Rays in prototypes.

use glam::DVec3;

use crate::math::{ChildFromParent, Ray, UNIT_ROUNDOFF};
use crate::solid::RayOrigin;

/// A ray in a prototype's own space.
///
/// Its points are `base + origin + (t - shift) * direction` for the `t` of the query's ray.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LocalRay {
    pub origin: DVec3,
    pub direction: DVec3,
    /// Zero, or the center of the prototype for a ray that was moved.
    pub base: DVec3,
    pub shift: f64,
}

impl LocalRay {
    pub fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            base: DVec3::ZERO,
            shift: 0.0,
        }
    }

    /// The ray's origin relative to a point of the prototype's space.
    #[inline(always)]
    pub fn origin_from(&self, point: DVec3) -> DVec3 {
        self.origin - (point - self.base)
    }

    /// The ray's exact origin.
    pub fn start(&self) -> RayOrigin {
        RayOrigin {
            base: self.base,
            offset: self.origin,
        }
    }

    /// The ray in the space of a placed prototype. The direction keeps its
    /// length, so that `t` keeps its meaning.
    #[inline(always)]
    pub fn in_child(&self, child_from_parent: &ChildFromParent) -> Self {
        Self {
            origin: child_from_parent.vector(self.origin_from(child_from_parent.translation())),
            direction: child_from_parent.vector(self.direction),
            base: DVec3::ZERO,
            shift: self.shift,
        }
    }
}

/// The map from the `t` of a query to the `t_far` of the f32 ray in the frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Window {
    /// The query's `t` at the point nearest to the center is `shift + nearest`.
    pub(super) shift: f64,
    pub(super) nearest: f64,
    /// The start of the f32 ray, relative to the nearest point.
    pub(super) start: f64,
    /// The number of units of the f32 ray's parameter in a unit of `t`.
    pub(super) rate: f64,
}

impl Window {
    /// `t` relative to the nearest point, moved by `outward` times the rounding of the
    /// differences.
    #[inline(always)]
    pub(super) fn past_nearest(&self, t: f64, outward: f64) -> f64 {
        let slack = 4.0 * UNIT_ROUNDOFF * (t.abs() + self.shift.abs() + self.nearest.abs());
        let difference = (t - self.shift) - self.nearest;
        if difference.is_finite() {
            difference + outward * slack
        } else {
            difference
        }
    }

    /// The end of the f32 ray for hits up to `t`; never too small.
    #[inline(always)]
    pub fn t_far(&self, t: f64) -> f32 {
        self.length_to(self.past_nearest(t, 1.0))
    }

    /// The length of the f32 ray up to `end`, relative to the nearest point. The 2^-30 covers
    /// the roundings, which are below 2^-48 in the frame; the factor covers rounding to f32,
    /// which subtracts at most 2^-24.
    #[inline(always)]
    pub(super) fn length_to(&self, end: f64) -> f32 {
        const OUTWARD: f64 = 1.0 + 1.0 / (1 << 23) as f64;
        (((end - self.start) * self.rate + 1.0 / (1 << 30) as f64) * OUTWARD) as f32
    }
}

/// A ray in one prototype.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Level {
    pub ray: LocalRay,
    pub window: Window,
}
