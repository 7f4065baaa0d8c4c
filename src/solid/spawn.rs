//! The start of a ray that leaves a surface.
//!
//! A new ray from near the surface must not hit it there again. Put the start at distance δ
//! outside the tangent plane of the true surface. The next query computes the exact result for
//! a start and a direction that are slightly displaced. The solid is convex and the direction
//! does not point into it, so there is no such hit if δ exceeds the sum of all displacements:
//!
//! - the point's own error, and the rounding of the start, `u |p|`;
//! - for the solver, [`SOLVER_DISPLACEMENT`] times the sizes that it uses;
//! - for the normal, which is within `16 u` of the true one, that angle times the solid's size;
//! - for a placed solid, the displacements of the placements (`tracer::resolve`).
//!
//! The offset is twice the sum, to cover the terms of second order.
//!
//! **Other solids than cylinders.** The displacements, in units of u times
//! `|o| + |anchor| + size`: the origin relative to the anchor, 2; an axis, 1; a difference of
//! radii, 1; the sign of `x·d`, which distinguishes the roots, 3. All else is decided exactly
//! on these numbers: whether the line intersects the solid, and the sign of each `t`, which has
//! a relative error. The sum, 7, is within the cylinder's bound. The normal of a rounded cone's
//! wall may be turned by more than 16 u, by `θ = u |a| / √β` (`rounded_cone/surface.rs`). But
//! that wall is only `√β` long, and the balls beyond it curve away: a line in the turned plane
//! reaches a depth of at most `θ √β + θ² R / 2`, at most `2 u (|a| + R)`, which adds 2.

use glam::DVec3;

use crate::math::{Ray, UNIT_ROUNDOFF};

/// The results of the solvers are exact for a ray displaced by at most this times
/// `|o| + |p0| + |p1| + 2 radius`; `docs/derivations.md`, section 5, adds up the roundings of
/// the triple-product solver to 22 u.
pub(super) const SOLVER_DISPLACEMENT: f64 = 32.0 * UNIT_ROUNDOFF;

/// The displacement of a query that starts near a hit, apart from the error of the hit's point.
/// Lengths are in the units of the current space.
#[derive(Clone, Copy, Debug)]
pub struct SpawnMargin {
    /// The sum of all displacements of the start.
    pub displacement: f64,
    /// Bounds the angle between the normal and the true one.
    pub normal_error: f64,
    /// Bounds the distance between any two points of the solid.
    pub size: f64,
}

impl SpawnMargin {
    /// The margin in the space of a solid. `seen` is the sum of the sizes that the solver uses,
    /// and `size` bounds the distance between any two points of the solid.
    #[must_use]
    pub fn new(seen: f64, size: f64) -> Self {
        Self {
            displacement: SOLVER_DISPLACEMENT * seen,
            normal_error: 16.0 * UNIT_ROUNDOFF,
            size,
        }
    }

    /// The distance from `point`, which is within `error` of the true surface, at which a ray
    /// has to start along the normal.
    #[must_use]
    pub fn offset(&self, point: DVec3, error: f64) -> f64 {
        let rounding = 2.0 * UNIT_ROUNDOFF * point.length();
        2.0 * (error + self.displacement + rounding + self.normal_error * self.size)
    }
}

/// The ray that starts at the distance `offset` from `point`, on the side of the surface that
/// `direction` points to; `normal` is the outward unit normal.
#[must_use]
pub fn spawned_ray(point: DVec3, normal: DVec3, offset: f64, direction: DVec3) -> Ray {
    let side = if direction.dot(normal) < 0.0 {
        -1.0
    } else {
        1.0
    };
    Ray::new(point + normal * (side * offset), direction)
}
