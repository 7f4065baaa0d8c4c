//! The ray of every query: a point, a direction of any length and a range.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::{Real, RealVector, power_of_two};

/// The greatest size of a component of a ray's origin: 2^200, about 1.6e60, which is
/// 2^50 times farther than a solid may lie.
pub const GREATEST_ORIGIN: f64 = power_of_two(200);

/// The sizes that the largest component of a ray's direction may have: 2^-500 to
/// 2^500, about 3.1e-151 to 3.3e150.
///
/// A placed solid reaches up to 2^150 (the greatest coordinate) times 2^64 (the greatest
/// stretch of placements), which is farther than the farthest origin. So the `t` of a hit
/// is at most 2^216 / 2^-500, which is a finite f64. Its square need not be finite: the
/// tracer scales directions before it solves.
pub const DIRECTION_SIZES: RangeInclusive<f64> = power_of_two(-500)..=power_of_two(500);

/// A ray cannot be traced because one of its numbers is too large or too small.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RaySizeError {
    /// The origin is too far away.
    #[error(
        "the origin has the component {component:e}: it must be a number of at most {GREATEST_ORIGIN:.1e} in size"
    )]
    Origin {
        /// The component that is too large or NaN.
        component: f64,
    },
    /// The direction is too long or too short.
    #[error(
        "the largest component of the direction is {component:e}: its size must be between {:.1e} and {:.1e}",
        DIRECTION_SIZES.start(),
        DIRECTION_SIZES.end()
    )]
    Direction {
        /// The largest component, or one that is NaN.
        component: f64,
    },
}

/// The set of points `origin + t * direction` with `t_min <= t <= t_max`.
///
/// The direction need not have unit length. `t` is in units of the length of
/// `direction`, and keeps that meaning through placements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at `t = 0`.
    pub origin: DVec3,
    /// Any vector whose largest component is within [`DIRECTION_SIZES`].
    pub direction: DVec3,
    /// The least `t` of a hit; may be negative or minus infinity.
    pub t_min: f64,
    /// The greatest `t` of a hit; may be infinite.
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

    /// Whether the ray can hit anything: origin and direction have the sizes of
    /// [`Ray::has_supported_sizes`], and the range is not empty (NaN makes it empty).
    /// Any other ray misses.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.has_supported_sizes() && self.t_min <= self.t_max
    }

    /// Whether no component of the origin exceeds [`GREATEST_ORIGIN`] in size, and the
    /// largest component of the direction is within [`DIRECTION_SIZES`]. The other
    /// components of the direction may be arbitrarily small, and the limits of `t` may be
    /// any numbers.
    #[inline]
    #[must_use]
    pub fn has_supported_sizes(&self) -> bool {
        // The sums are NaN where a component is; `max_element` may ignore NaN.
        let (origin, direction) = (self.origin.abs(), self.direction.abs());
        origin.max_element() <= GREATEST_ORIGIN
            && DIRECTION_SIZES.contains(&direction.max_element())
            && !(self.origin + self.direction).is_nan()
    }

    /// As [`Ray::has_supported_sizes`], but reports the component at fault.
    ///
    /// # Errors
    /// If a component is NaN, or its size is not supported.
    pub fn check_sizes(&self) -> Result<(), RaySizeError> {
        if self.has_supported_sizes() {
            return Ok(());
        }
        let component = worst(self.origin);
        if !(component.abs() <= GREATEST_ORIGIN) {
            return Err(RaySizeError::Origin { component });
        }
        let component = worst(self.direction);
        Err(RaySizeError::Direction { component })
    }
}

/// The NaN component if one exists, else the largest.
fn worst(vector: DVec3) -> f64 {
    let components = vector.to_array().into_iter();
    components
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
        .expect("a vector has three components")
}

/// A [`Ray`] in any precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOf<S: Real> {
    /// The point at `t = 0`.
    pub origin: S::Vector,
    /// Any direction of any length.
    pub direction: S::Vector,
    /// The least `t` of a hit.
    pub t_min: S,
    /// The greatest `t` of a hit.
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
