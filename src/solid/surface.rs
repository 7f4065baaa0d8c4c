//! The point, normal and parameters of a hit on a cylinder, with error bounds.
//!
//! A hit's `t` has an error along the ray that can be large relative to the radius (far
//! origins, grazing rays). The reported point is therefore not `o + t d` but the point of the
//! surface nearest to it, computed as `q = base + ρ`: `base` is on the axis (at `p0`, `p1` or
//! between), `ρ` is perpendicular to the axis, of length `radius` on the wall and of at most
//! `radius` on a disk.
//!
//! The distance of `q` from the true surface (u = 2^-53, Euclidean norms; every component of a
//! vector operation has relative error u, hence so has its norm):
//!
//! 1. `a = p1 - p0` is rounded, `u |a|`, and so is `y a` with y in \[0, 1\]:
//!    the axis point is displaced by at most `2 u |a|`;
//! 2. `|ρ|` has relative error 5 u (dot product, root, quotient, product);
//! 3. `ρ` is made perpendicular twice; after the second time its component along the computed
//!    axis is below `5 u |ρ|`, and the computed axis is off the true one by u: at an end, `ρ`
//!    extends past the disk's plane by at most `6 u |ρ|`; on the wall this does not matter;
//! 4. the sums `y a + ρ` and `p0 + ...` round by `u (|a| + radius)` and `u |q|`.
//!
//! The sum is `u (|q| + 3 |a| + 12 radius)`. Counting 4 and 16 instead of 3 and 12 covers
//! second-order terms and the rounding of the bound itself.
//!
//! The angle `u` takes an arc tangent, which costs as much as everything else here, and most
//! callers do not use it. A surface point therefore contains the inputs of `u`, and
//! [`SurfacePoint::u`] computes it.

use glam::DVec3;

use super::{Cylinder, Part};
use crate::math::UNIT_ROUNDOFF;

/// A point of a surface in the solid's own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: DVec3,
    /// Bounds the distance of `point` from the true surface.
    pub error: f64,
    /// Outward unit normal, within 16 units of 2^-53 of the normal at `point`.
    pub normal: DVec3,
    /// Axial position from `p0` to `p1`, in [0, 1].
    pub v: f64,
    /// The inputs of [`SurfacePoint::u`].
    pub(super) first: FirstParameter,
}

impl SurfacePoint {
    /// Angle around the axis divided by 2π, in [0, 1).
    #[must_use]
    pub fn u(&self) -> f64 {
        match self.first {
            FirstParameter::Angle { axis, outward } => {
                let (reference, across) = angle_frame(axis);
                turn(outward, reference, across)
            }
            FirstParameter::Share(share) => share,
        }
    }
}

/// The parameter `u` of a surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FirstParameter {
    /// The angle of a unit vector around an axis, also a unit vector.
    Angle { axis: DVec3, outward: DVec3 },
    /// The number itself.
    Share(f64),
}

/// The point of `part` nearest to `p0 + from_p0`.
///
/// `u` counts from the direction of the coordinate axis that is most perpendicular to the
/// cylinder's axis (the first of equals), and grows right-handed about the direction from `p0`
/// to `p1`. On the axis itself, at the center of a disk, it is 0.
#[must_use]
#[inline]
pub fn surface_point(cylinder: &Cylinder, part: Part, from_p0: DVec3) -> SurfacePoint {
    let (p0, p1, radius) = (cylinder.p0(), cylinder.p1(), cylinder.radius());
    let a = p1 - p0;
    let around = Around::new(a, from_p0);
    let Around {
        axis,
        outward,
        distance,
    } = around;

    let v = match part {
        Part::Side => (from_p0.dot(a) / a.length_squared()).clamp(0.0, 1.0),
        Part::Cap0 => 0.0,
        Part::Cap1 => 1.0,
        part => part.not_of_a_cylinder(),
    };
    let (point, normal) = match part {
        Part::Side => (p0 + (a * v + outward * radius), outward),
        Part::Cap0 => (p0 + outward * distance.min(radius), -axis),
        Part::Cap1 => (p1 + outward * distance.min(radius), axis),
        part => part.not_of_a_cylinder(),
    };
    let along = if part == Part::Side {
        4.0 * a.length()
    } else {
        0.0
    };
    let error = UNIT_ROUNDOFF * (point.length() + along + 16.0 * radius);
    SurfacePoint {
        point,
        error,
        normal,
        v,
        first: around.angle(),
    }
}

/// The position of a point relative to an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    /// Unit vector along the axis.
    pub axis: DVec3,
    /// Unit vector from the axis to the point.
    pub outward: DVec3,
    /// The distance from the axis.
    pub distance: f64,
}

impl Around {
    /// For the point `from_p0` and the axis `a`, which starts at `p0`.
    #[inline(always)]
    pub fn new(a: DVec3, from_p0: DVec3) -> Self {
        let axis = a.normalize();
        let from_axis = from_p0 - a * (from_p0.dot(a) / a.length_squared());
        let radial = from_axis - axis * from_axis.dot(axis);
        let distance = radial.length();
        // A point on the axis has no nearest point of the wall; any direction serves.
        let outward = if distance > 0.0 {
            radial / distance
        } else {
            angle_frame(axis).0
        };
        Self {
            axis,
            outward,
            distance,
        }
    }

    /// The angle of the point, which is 0 on the axis.
    pub fn angle(&self) -> FirstParameter {
        FirstParameter::Angle {
            axis: self.axis,
            outward: self.outward,
        }
    }
}

/// The angle of `outward` from `reference` towards `across`, in turns, in [0, 1).
fn turn(outward: DVec3, reference: DVec3, across: DVec3) -> f64 {
    // Turns -0 into 0, the same direction.
    let (y, x) = (outward.dot(across) + 0.0, outward.dot(reference) + 0.0);
    let turn = libm::atan2(y, x) / std::f64::consts::TAU;
    let turn = if turn < 0.0 { turn + 1.0 } else { turn };
    if turn >= 1.0 { 0.0 } else { turn }
}

/// The two unit vectors perpendicular to `axis` that define angles: direction 0, and the
/// direction a quarter turn on.
pub fn angle_frame(axis: DVec3) -> (DVec3, DVec3) {
    let size = axis.abs();
    let coordinate_axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let reference = (coordinate_axis - axis * coordinate_axis.dot(axis)).normalize();
    (reference, axis.cross(reference))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Caps;

    fn unit_cylinder() -> Cylinder {
        Cylinder::new(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), 0.5, Caps::Both).unwrap()
    }

    #[test]
    fn wall_point_has_its_angle_and_height() {
        let cylinder = unit_cylinder();
        for (from, u) in [
            (DVec3::new(0.6, 0.0, 0.5), 0.0),
            (DVec3::new(0.0, 0.6, 0.5), 0.25),
            (DVec3::new(-0.6, 0.0, 0.5), 0.5),
            (DVec3::new(0.0, -0.6, 0.5), 0.75),
        ] {
            let found = surface_point(&cylinder, Part::Side, from);
            assert_eq!((found.u(), found.v), (u, 0.25), "{from:?}");
            assert!((found.point - DVec3::new(from.x, from.y, 0.6) / 1.2).length() < 1e-15);
            assert_eq!(found.normal, DVec3::new(from.x, from.y, 0.0) / 0.6);
        }
    }

    #[test]
    fn angle_just_below_zero_stays_below_one() {
        let from = DVec3::new(0.5, -1e-30, 1.0);
        let u = surface_point(&unit_cylinder(), Part::Side, from).u();
        assert!((0.0..1.0).contains(&u), "{u}");
    }

    #[test]
    fn cap_point_stays_on_its_disk() {
        let cylinder = unit_cylinder();
        let found = surface_point(&cylinder, Part::Cap1, DVec3::new(0.7, 0.0, 2.1));
        assert_eq!(
            (found.point, found.normal),
            (DVec3::new(0.5, 0.0, 2.0), DVec3::Z)
        );
        assert_eq!(found.v, 1.0);
        let middle = surface_point(&cylinder, Part::Cap0, DVec3::ZERO);
        assert_eq!(
            (middle.point, middle.normal, middle.u()),
            (DVec3::ZERO, -DVec3::Z, 0.0)
        );
    }
}
