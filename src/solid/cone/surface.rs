//! The point, normal and parameters of a hit on a cone, with error bounds.
//!
//! As for the cylinder (`solid/surface.rs`, whose numbering this keeps), the reported point is
//! the point of the surface nearest to `o + t d`. In the half-plane of the axis and the point,
//! the wall is the segment from `(0, r0)` to `(|a|, r1)`. With the height `y = x·a` and the
//! distance `ρ` from the axis, the nearest point is at the share
//!
//! ```text
//! v = (y + Δ (ρ - r0)) / (|a|² + Δ²),   q = p0 + v a + (r0 + v Δ) outward
//! ```
//!
//! of it, if that is in \[0, 1\]. The error of `v` does not matter: it only selects another
//! point of the wall. Let R be the greater radius. Steps 1, 2 and 4 are those of the cylinder,
//! and `r0 + v Δ` rounds by 3 u R more; by step 3 `outward` extends past the plane across the
//! axis by `6 u R`, which a slanted wall turns into at most as much. The sum is
//! `u (|q| + 3 |a| + 21 R)`; counting 4 and 26 covers second-order terms. A disk is a
//! cylinder's.

use glam::DVec3;

use super::Cone;
use crate::math::UNIT_ROUNDOFF;
use crate::solid::surface::Around;
use crate::solid::{Cylinder, Part, SurfacePoint, surface_point as surface_point_of_cylinder};

/// The point of `part` nearest to `p0 + from_p0`, with `u` and `v` as for a cylinder.
pub(super) fn surface_point(cone: &Cone, part: Part, from_p0: DVec3) -> SurfacePoint {
    let (r0, r1) = (cone.ends.radius0, cone.ends.radius1);
    let disk = |radius| {
        let cylinder = Cylinder::from_valid(cone.ends.p0, cone.ends.p1, radius, cone.caps);
        surface_point_of_cylinder(&cylinder, part, from_p0)
    };
    match part {
        Part::Cap0 => return disk(r0),
        Part::Cap1 => return disk(r1),
        // The same bits as the equal cylinder.
        Part::Side if r0 == r1 => return disk(r0),
        Part::Side => {}
        part => unreachable!("a cone has no part {}", part.name()),
    }
    let a = cone.ends.axis();
    let around = Around::new(a, from_p0);
    let (aa, delta) = (a.length_squared(), r1 - r0);
    let along = from_p0.dot(a) + delta * (around.distance - r0);
    let v = (along / (aa + delta * delta)).clamp(0.0, 1.0);
    let point = cone.ends.p0 + (a * v + around.outward * (r0 + delta * v));
    let normal = around.outward * aa.sqrt() - around.axis * delta;
    SurfacePoint {
        point,
        error: UNIT_ROUNDOFF * (point.length() + 4.0 * aa.sqrt() + 26.0 * r0.max(r1)),
        normal: normal.normalize(),
        v,
        first: around.angle(),
    }
}
