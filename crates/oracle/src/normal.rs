//! The true outward normal at a hit.
//!
//! On the wall it is the part of `x + t d` across the axis,
//! `(a·a) q - (a·q) a` with `q = x + t d`; on a disk it is the axis. Both are
//! computed from the parameter as [`first_hit`](super::first_hit) gives it and
//! rounded only when they are divided by their length.

use glam::DVec3;

use super::cylinder::{TrueHit, not_of_a_cylinder};
use super::number::{ExactVector, exact, to_f64, zero};
use cyltrace::math::Ray;
use cyltrace::solid::{Cylinder, Part};

/// The unit vector out of the solid at a hit of `ray`, each component within
/// 2 units of 2^-53.
#[must_use]
pub fn outward_normal(cylinder: &Cylinder, ray: &Ray, hit: &TrueHit) -> DVec3 {
    let p0 = ExactVector::new(cylinder.p0());
    let a = &ExactVector::new(cylinder.p1()) - &p0;
    let outward = match hit.part {
        Part::Cap0 => a.times(&exact(-1.0)),
        Part::Cap1 => a,
        Part::Side => {
            let x = &ExactVector::new(ray.origin) - &p0;
            let q = &x + &ExactVector::new(ray.direction).times(&hit.t);
            &q.times(&a.dot(&a)) - &a.times(&a.dot(&q))
        }
        part => not_of_a_cylinder(part),
    };
    unit(&outward).expect("a cylinder has a normal everywhere")
}

/// The unit vector along another that is not zero.
pub(super) fn unit(outward: &ExactVector) -> Option<DVec3> {
    // Divided by the largest component first, so that squares stay in range.
    let largest = outward.0.iter().fold(zero(), |largest, x| {
        let size = if *x < zero() { -x } else { x.clone() };
        if size > largest { size } else { largest }
    });
    if largest == zero() {
        return None;
    }
    let scale = largest.with_precision(64).value();
    let divided = std::array::from_fn(|i| {
        let x = outward.0[i].clone().with_precision(64).value();
        to_f64(&(x / &scale))
    });
    Some(DVec3::from_array(divided).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_hit;
    use cyltrace::solid::Caps;

    #[test]
    fn normal_of_each_part_points_outward() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * 2.0, 5.0, Caps::Both).unwrap();
        for (origin, direction, normal) in [
            (
                DVec3::new(-9.0, 3.0, 1.0),
                DVec3::X,
                DVec3::new(-0.8, 0.6, 0.0),
            ),
            (
                DVec3::new(1.0, 3.0, 1.0),
                DVec3::X,
                DVec3::new(0.8, 0.6, 0.0),
            ),
            (DVec3::new(1.0, 3.0, -1.0), DVec3::Z, DVec3::NEG_Z),
            (DVec3::new(1.0, 3.0, 1.0), DVec3::Z, DVec3::Z),
        ] {
            let ray = Ray::new(origin, direction);
            let hit = first_hit(&cylinder, &ray).hit.expect("a hit");
            let found = outward_normal(&cylinder, &ray, &hit);
            assert!((found - normal).length() < 3e-16, "{found} for {normal}");
        }
    }
}
