//! A ray in exact numbers, in the space of its solid.
//!
//! A placement `x -> L x + T` puts the solid into the ray's space. Its inverse is
//! the adjugate of L over the determinant, so that with `s = ±det L > 0` the point
//! at `t` is, in the solid's own space,
//!
//! ```text
//! (±adj L (o - T) + t (±adj L d)) / s
//! ```
//!
//! Nothing is divided: the numerators are the ray, and `s` is how many of its units
//! make one of the solid's, whose numbers are multiplied by it. `t` is kept. The sign
//! is that of the determinant, so that radii stay positive also in a mirror.

use std::cmp::Ordering;

use glam::DVec3;

use super::affine::ExactAffine;
use super::number::{Exact, ExactVector, exact, sign};
use cyltrace::math::Ray;

/// The points `origin + t direction` with `t_min <= t <= t_max`, counted in a unit of
/// which the solid's own is a known multiple.
#[derive(Clone, Debug)]
pub struct ExactRay {
    pub(super) origin: ExactVector,
    pub(super) direction: ExactVector,
    pub(super) t_min: f64,
    pub(super) t_max: f64,
    /// The solid's unit of length in those of the ray; positive.
    unit: Exact,
}

impl ExactRay {
    /// The ray as it is, for a solid in the same space.
    ///
    /// # Panics
    /// When the ray is not valid ([`Ray::is_valid`]).
    #[must_use]
    pub fn new(ray: &Ray) -> Self {
        assert!(
            ray.is_valid(),
            "the oracle takes valid rays, and this is {ray:?}"
        );
        Self {
            origin: ExactVector::new(ray.origin),
            direction: ExactVector::new(ray.direction),
            t_min: ray.t_min,
            t_max: ray.t_max,
            unit: exact(1.0),
        }
    }

    /// The ray as a solid sees it that is placed in the ray's space; `t` is the same.
    ///
    /// # Panics
    /// When the ray is not valid, or the placement's matrix is singular.
    #[must_use]
    pub fn through(world_from_object: &ExactAffine, ray: &Ray) -> Self {
        let Self {
            origin, direction, ..
        } = Self::new(ray);
        let (adjugate, determinant) = world_from_object.adjugate();
        let side = match sign(&determinant) {
            Ordering::Less => exact(-1.0),
            Ordering::Equal => panic!("the placement is singular: {world_from_object:?}"),
            Ordering::Greater => exact(1.0),
        };
        let taken = |vector: &ExactVector| adjugate.times(vector).times(&side);
        Self {
            origin: taken(&(&origin - world_from_object.translation())),
            direction: taken(&direction),
            t_min: ray.t_min,
            t_max: ray.t_max,
            unit: determinant * side,
        }
    }

    /// A length of the solid in the ray's unit.
    pub(super) fn length(&self, length: f64) -> Exact {
        exact(length) * &self.unit
    }

    /// A point of the solid's space in the ray's unit.
    pub(super) fn point(&self, point: DVec3) -> ExactVector {
        ExactVector::new(point).times(&self.unit)
    }

    /// The way from a point of the solid's space to the ray's origin.
    pub(super) fn origin_from(&self, point: DVec3) -> ExactVector {
        &self.origin - &self.point(point)
    }
}
