//! How far a point is from a part of a cylinder's surface.

use std::cmp::Ordering;

use super::affine::ExactAffine;
use super::number::{Exact, ExactVector, exact, long, sign};
use crate::solid::{Cylinder, Part};

/// A bound of the distance from `point` to `part` of a cylinder placed in the
/// point's space, itself exact to f64.
///
/// The point is taken to the cylinder's space, moved to the nearest point of
/// the part there, and that one is taken back. Without a placement, or with
/// one that keeps angles, this is the distance; else it may be more.
///
/// # Panics
/// When the point is not finite, or the placement is singular.
#[must_use]
pub fn distance_to_part(
    cylinder: &Cylinder,
    part: Part,
    world_from_object: &ExactAffine,
    point: glam::DVec3,
) -> f64 {
    let (adjugate, determinant) = world_from_object.adjugate();
    let world = ExactVector::new(point);
    let local = adjugate.times(&(&world - world_from_object.translation()));
    let local = divided(&local, &determinant);

    let (p0, p1) = (
        ExactVector::new(cylinder.p0()),
        ExactVector::new(cylinder.p1()),
    );
    let axis = &p1 - &p0;
    let from_p0 = &local - &p0;
    let along = long(&axis.dot(&from_p0)) / long(&axis.dot(&axis));
    let foot = &p0 + &axis.times(&along);
    let radial = &local - &foot;
    let distance = long(&radial.dot(&radial)).sqrt();
    let radius = exact(cylinder.radius());
    // On the axis every direction is as near; the bound is then off by at most
    // the radius, which no caller relies on.
    let outward = if sign(&distance) == Ordering::Equal {
        radial
    } else {
        divided(&radial, &distance)
    };
    let nearest = match part {
        Part::Side => {
            let along = along.max(exact(0.0)).min(exact(1.0));
            &(&p0 + &axis.times(&along)) + &outward.times(&radius)
        }
        Part::Cap0 => &p0 + &outward.times(&distance.min(radius)),
        Part::Cap1 => &p1 + &outward.times(&distance.min(radius)),
    };
    (&world_from_object.point(&nearest) - &world).length()
}

fn divided(vector: &ExactVector, divisor: &Exact) -> ExactVector {
    ExactVector(vector.0.clone().map(|x| long(&x) / long(divisor)))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::solid::Caps;

    #[test]
    fn distances_to_the_parts_of_a_unit_cylinder() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * 2.0, 1.0, Caps::Both).unwrap();
        let distance = |part, x, z| {
            let point = DVec3::new(x, 0.0, z);
            distance_to_part(&cylinder, part, &ExactAffine::identity(), point)
        };
        assert_eq!(distance(Part::Side, 1.5, 1.0), 0.5);
        assert_eq!(distance(Part::Side, 0.75, 1.0), 0.25);
        assert_eq!(distance(Part::Side, 1.0, 3.0), 1.0);
        assert_eq!(distance(Part::Cap0, 0.5, -0.25), 0.25);
        assert_eq!(distance(Part::Cap1, 4.0, 6.0), 5.0);
        assert_eq!(distance(Part::Cap1, 0.0, 2.0), 0.0);
    }
}
