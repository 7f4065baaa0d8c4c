//! The point, normal and parameters of a hit on a rounded cone, with error bounds.
//!
//! A ball sweeps the hull if its center moves from `p0` to `p1` and its radius changes
//! linearly. The point nearest to `o + t d` is one of the sphere around some center `p0 + v a`;
//! for the spheres at the ends v is 0 or 1. On the wall the normal is
//! `n = (outward √β - axis Δ) / |a|` with `β = |a|² - Δ²`. Going back along it from a point at
//! height `y = x·a` and distance `ρ` from the axis, one reaches the axis at
//!
//! ```text
//! v = (y + ρ Δ |a| / √β) / |a|²,   q = p0 + v a + (r0 + v Δ) n
//! ```
//!
//! Error (u = 2^-53, R the greater radius): as for the cylinder, the center is off by `2 u |a|`
//! and the sums round by `u (|q| + |a| + R)`. `r0 + v Δ` rounds by 3 u R; `n` is unit to 8 u.
//! `outward` is off the perpendicular by 6 u, and `√β / |a|` is off by up to `u |a| / √β`,
//! since `a` is rounded: both turn `n` by an angle δ, which moves q along the sphere that the
//! hull contains, so off the surface by at most δ² R/2. If `√β < √u |a|`, the turn is below 2
//! √u, otherwise below `√u`. So δ² / 2 is below 4 u. The sum is `u (|q| + 4 |a| + 16 R)`; 5 and
//! 20 are counted. On a sphere the error is `u (|q| + 6 R)`.
//!
//! **Centers next to each other.** The square of an `a` below 2^-484 loses bits to underflow,
//! and below 2^-537 all of them. Radii that differ do so by at least 2^-202, the spacing of the
//! numbers at `Cylinder::LEAST`. So an `a` below [`SHORT`] has a wall only if the radii are
//! equal. The hull is then one ball up to `|a|`, which is less than 2^-249 R, and the hit is
//! computed on the ball. Its angle and its height are those of `a` and `x` times [`LONGER`],
//! which is exact: the multiple of `a` is below 2^201 and, unless zero, at least 2^-474, with a
//! square that is a normal number.

use glam::DVec3;

use super::RoundedCone;
use crate::math::{UNIT_ROUNDOFF, power_of_two};
use crate::solid::surface::Around;
use crate::solid::{Part, SurfacePoint};

/// The bound of every coordinate of a short `a`; any number between 2^-484 and 2^-203 would
/// serve.
const SHORT: f64 = power_of_two(-400);

/// The factor for a short `a`.
const LONGER: f64 = power_of_two(600);

/// The point of `part` nearest to `p0 + from_p0`. `v` is the position, from `p0` to `p1`, of
/// the center of the ball that touches the surface there; `u` is as for a cylinder. If the
/// centers coincide, the axis is along z.
pub(super) fn surface_point(solid: &RoundedCone, part: Part, from_p0: DVec3) -> SurfacePoint {
    let (r0, r1) = (solid.ends.radius0, solid.ends.radius1);
    let a = solid.ends.axis();
    let is_short = a.abs().max_element() < SHORT;
    let axis = if a == DVec3::ZERO {
        DVec3::Z
    } else if is_short {
        a * LONGER
    } else {
        a
    };
    let around = Around::new(axis, from_p0);
    let sphere = |center: DVec3, radius: f64, from_center: DVec3, v| {
        let distance = from_center.length();
        // The center has no nearest point; any point serves.
        let normal = if distance > 0.0 {
            from_center / distance
        } else {
            around.outward
        };
        let point = center + normal * radius;
        SurfacePoint {
            point,
            error: UNIT_ROUNDOFF * (point.length() + 6.0 * radius),
            normal,
            v,
            first: around.angle(),
        }
    };
    match (part, solid.taper()) {
        (Part::Cap0, _) => sphere(solid.ends.p0, r0, from_p0, 0.0),
        (Part::Cap1, _) => sphere(solid.ends.p1, r1, from_p0 - a, 1.0),
        (Part::Side, Some(_)) if is_short => {
            let v = (from_p0 * LONGER).dot(axis) / axis.length_squared();
            sphere(solid.ends.p0, r0, from_p0, v.clamp(0.0, 1.0))
        }
        (Part::Side, Some(taper)) => {
            let (aa, delta) = (a.length_squared(), r1 - r0);
            let (length, root) = (aa.sqrt(), taper.beta().sqrt());
            let along = from_p0.dot(a) + around.distance * delta * length / root;
            let v = (along / aa).clamp(0.0, 1.0);
            let normal = (around.outward * root - around.axis * delta) / length;
            let point = solid.ends.p0 + (a * v + normal * (r0 + delta * v));
            SurfacePoint {
                point,
                error: UNIT_ROUNDOFF * (point.length() + 5.0 * length + 20.0 * r0.max(r1)),
                normal,
                v,
                first: around.angle(),
            }
        }
        (part, _) => unreachable!("{solid:?} has no part {}", part.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    /// The angle depends on the direction of the centers alone, however near they are.
    #[test]
    fn centers_next_to_each_other_have_the_angles_and_heights_of_distant_ones() {
        for index in 0..1000 {
            let mut random = Random::new(31, index);
            let axis = random.direction();
            let across = axis.any_orthonormal_vector() * random.log_uniform(0.1, 10.0);
            let solid = |p1| RoundedCone::new(DVec3::ZERO, p1, 1.0, 1.0).unwrap();
            let distant = surface_point(&solid(axis), Part::Cap0, across);
            for exponent in [-400, -450, -520, -530, -536, -600, -1000] {
                let near = solid(axis * power_of_two(exponent));
                for part in [Part::Cap0, Part::Cap1] {
                    let found = surface_point(&near, part, across);
                    let turn = (found.u() - distant.u()).abs();
                    assert!(
                        turn.min(1.0 - turn) < 1e-15,
                        "{index}, {exponent}: {found:?}"
                    );
                    assert!((found.point - distant.point).length() < found.error);
                }
            }
        }
        // On a coordinate plane the height is a number as small as the centers' distance.
        for exponent in [-400, -450, -520, -530, -536] {
            let length = 1.3 * power_of_two(exponent);
            let near = RoundedCone::new(DVec3::ZERO, DVec3::Z * length, 2.0, 2.0).unwrap();
            for share in [0.25, 0.5, 0.75] {
                let from_p0 = DVec3::new(0.0, 2.5, share * length);
                let found = surface_point(&near, Part::Side, from_p0);
                assert_eq!((found.u(), found.v), (0.25, share), "{exponent}");
                assert_eq!((found.point.y, found.normal.y), (2.0, 1.0), "{exponent}");
            }
        }
    }
}
