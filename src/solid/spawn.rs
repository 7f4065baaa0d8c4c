//! Where a ray may start that leaves a surface.
//!
//! A new ray from near the surface must not meet it there again. Put the start
//! at distance δ outside the tangent plane of the true surface. All that the
//! next query computes is the exact answer for a start and a direction that
//! are a little displaced; as the solid is convex and the direction does not
//! point into it, there is no such intersection if δ is more than all displacements
//! together:
//!
//! - the point's own error, and the rounding of the start, `u |p|`;
//! - for the solver, [`SOLVER_DISPLACEMENT`] times the sizes that it sees;
//! - for the normal, which is within `16 u` of the true one, that angle times
//!   the solid's size;
//! - for a placed solid, what the placements add (`tracer`, on the way up).
//!
//! The sum, taken twice for the terms of second order, is the offset.
//!
//! **Other solids than cylinders.** What is displaced, counted in units of u times
//! `|o| + |anchor| + size`: the origin as seen from the anchor, 2; an axis, 1; a
//! difference of radii, 1; the sign of `x·d`, by which the roots are distinguished, 3. All
//! else is decided on these numbers exactly: whether the line meets the solid, and the
//! sign of each `t`, which has a relative error. Together 7, and so within the
//! cylinder's bound. The wall of a rounded cone has a normal that may be turned by more
//! than 16 u, by `θ = u |a| / √β` (`rounded_cone/surface.rs`). But that wall is only
//! `√β` long, and the balls beyond it curve away: a line in the turned plane comes no
//! deeper than `θ √β + θ² R / 2`, at most `2 u (|a| + R)`, 2 more.

use glam::DVec3;

use super::{ConvexSolid, Cylinder, SurfacePoint};
use crate::math::{Ray, UNIT_ROUNDOFF};

/// The solvers answer exactly for a ray displaced by at most this times
/// `|o| + |p0| + |p1| + 2 radius`; `docs/derivations.md`, section 5, adds up
/// the roundings of the triple-product solver to 22 u.
pub(super) const SOLVER_DISPLACEMENT: f64 = 32.0 * UNIT_ROUNDOFF;

/// What a query that starts near a hit may be displaced by, apart from the
/// error of the hit's point. Lengths in the units of the space it is kept for.
#[derive(Clone, Copy, Debug)]
pub struct SpawnMargin {
    /// The sum of all displacements of the start.
    pub displacement: f64,
    /// Bounds the angle between the normal and the true one.
    pub normal_error: f64,
    /// Bounds the distance of any two points of the solid.
    pub size: f64,
}

impl SpawnMargin {
    /// The margin in the space of a solid of any kind.
    #[must_use]
    pub fn of_solid(solid: &impl ConvexSolid, surface: &SurfacePoint) -> Self {
        let size = solid.size();
        let seen = surface.point.length() + solid.anchor().length() + size;
        Self {
            displacement: SOLVER_DISPLACEMENT * seen,
            normal_error: 16.0 * UNIT_ROUNDOFF,
            size,
        }
    }

    /// The margin in a cylinder's own space.
    #[must_use]
    pub fn new(cylinder: &Cylinder, surface: &SurfacePoint) -> Self {
        let (p0, p1, radius) = (cylinder.p0(), cylinder.p1(), cylinder.radius());
        let seen = surface.point.length() + p0.length() + p1.length() + 2.0 * radius;
        Self {
            displacement: SOLVER_DISPLACEMENT * seen,
            normal_error: 16.0 * UNIT_ROUNDOFF,
            size: (p1 - p0).length() + 2.0 * radius,
        }
    }

    /// How far from `point`, which is within `error` of the true surface, a
    /// ray has to start along the normal.
    #[must_use]
    pub fn offset(&self, point: DVec3, error: f64) -> f64 {
        let rounding = 2.0 * UNIT_ROUNDOFF * point.length();
        2.0 * (error + self.displacement + rounding + self.normal_error * self.size)
    }
}

/// The ray from `offset` beside `point` on the side of the surface that
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
