//! The ray of every query: a point, a direction of any length and a range.

use glam::DVec3;

use super::{Real, RealVector};

/// The set of points `origin + t * direction` with `t_min <= t <= t_max`.
///
/// The direction need not have unit length; `t` counts in lengths of
/// `direction`, and keeps that meaning through placements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at `t = 0`.
    pub origin: DVec3,
    /// Any finite vector that is not zero.
    pub direction: DVec3,
    /// Least `t` that counts; may be negative or minus infinity.
    pub t_min: f64,
    /// Greatest `t` that counts; may be infinite.
    pub t_max: f64,
}

impl Ray {
    /// The half line that starts at `origin`: `t` in `[0, inf]`.
    #[must_use]
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            t_min: 0.0,
            t_max: f64::INFINITY,
        }
    }

    /// The point at parameter `t`, rounded to f64.
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Whether the ray can hit anything: origin and direction are finite, the
    /// direction is not zero, and the range is not empty (NaN makes it empty).
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.origin.is_finite()
            && self.direction.is_finite()
            && self.direction != DVec3::ZERO
            && self.t_min <= self.t_max
    }
}

/// A [`Ray`] in any precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOf<S: Real> {
    /// The point at `t = 0`.
    pub origin: S::Vector,
    /// Any direction of any length.
    pub direction: S::Vector,
    /// Least `t` that counts.
    pub t_min: S,
    /// Greatest `t` that counts.
    pub t_max: S,
}

impl<S: Real> RayOf<S> {
    /// The ray with every number rounded to nearest.
    #[must_use]
    pub fn rounded(ray: &Ray) -> Self {
        Self {
            origin: S::Vector::from_f64(ray.origin),
            direction: S::Vector::from_f64(ray.direction),
            t_min: S::from_f64(ray.t_min),
            t_max: S::from_f64(ray.t_max),
        }
    }

    /// The same ray in f64.
    #[inline]
    #[must_use]
    pub fn to_f64(&self) -> Ray {
        Ray {
            origin: self.origin.to_f64(),
            direction: self.direction.to_f64(),
            t_min: self.t_min.to_f64(),
            t_max: self.t_max.to_f64(),
        }
    }

    /// The point at parameter `t`, rounded.
    #[inline]
    #[must_use]
    pub fn at(&self, t: S) -> S::Vector {
        self.origin + self.direction * t
    }
}
