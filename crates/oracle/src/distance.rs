//! How far a point is from a part of a cylinder's surface.

use std::cmp::Ordering;

use super::affine::ExactAffine;
use super::cylinder::not_of_a_cylinder;
use super::number::{Exact, ExactVector, exact, long, sign, zero};
use cyltrace::solid::{Cylinder, Part};

/// A bound of the distance from `point` to `part` of a cylinder placed in the
/// point's space: the distance to some point of the part, exact to f64.
///
/// Two such points are tried: the nearest one as measured in the cylinder's own
/// space, and the one that is reached along the surface's normal in the point's
/// space. Without a placement the first is the nearest; through one that
/// stretches, the second is, to first order in the distance, unless it falls
/// off the end of the part.
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
    let part = PartOf {
        part,
        p0: ExactVector::new(cylinder.p0()),
        axis: &ExactVector::new(cylinder.p1()) - &ExactVector::new(cylinder.p0()),
        radius: exact(cylinder.radius()),
    };
    let local = divided(&local, &determinant);
    let (nearest, normal) = part.nearest(&local);
    // Normals go by the inverse transposed; the way along it, back by the inverse.
    let world_normal = adjugate.times_from_left(&normal);
    let along_normal = divided(&adjugate.times(&world_normal), &determinant);
    let distance_to = |surface: &ExactVector| (&world_from_object.point(surface) - &world).length();
    let first = distance_to(&nearest);
    let second = part.along(&local, &along_normal);
    second.map_or(first, |surface| distance_to(&surface).min(first))
}

/// A part of a cylinder in exact numbers.
struct PartOf {
    part: Part,
    p0: ExactVector,
    axis: ExactVector,
    radius: Exact,
}

impl PartOf {
    /// The height of a point along the axis, 0 at `p0` and 1 at `p1`, and the
    /// vector from the axis to it.
    fn height_and_radial(&self, from_p0: &ExactVector) -> (Exact, ExactVector) {
        let height = long(&self.axis.dot(from_p0)) / long(&self.axis.dot(&self.axis));
        let radial = from_p0 - &self.axis.times(&height);
        (height, radial)
    }

    /// The nearest point of the part and a normal there.
    fn nearest(&self, point: &ExactVector) -> (ExactVector, ExactVector) {
        let (height, radial) = self.height_and_radial(&(point - &self.p0));
        let distance = long(&radial.dot(&radial)).sqrt();
        // On the axis every direction is as near; the bound is then off by at
        // most the radius, which no caller relies on.
        let outward = if sign(&distance) == Ordering::Equal {
            radial
        } else {
            divided(&radial, &distance)
        };
        let within = outward.times(&distance.min(self.radius.clone()));
        match self.part {
            Part::Side => {
                let height = height.max(zero()).min(exact(1.0));
                let foot = &self.p0 + &self.axis.times(&height);
                (&foot + &outward.times(&self.radius), outward)
            }
            Part::Cap0 => (&self.p0 + &within, self.axis.clone()),
            Part::Cap1 => (&(&self.p0 + &self.axis) + &within, self.axis.clone()),
            part => not_of_a_cylinder(part),
        }
    }

    /// Where the line from a point meets the part, nearest to the point.
    fn along(&self, point: &ExactVector, direction: &ExactVector) -> Option<ExactVector> {
        let (height, radial) = self.height_and_radial(&(point - &self.p0));
        let (height_rate, radial_rate) = self.height_and_radial(direction);
        let rr = &self.radius * &self.radius;
        let step = match self.part {
            Part::Side => {
                // |radial + s radial_rate|² = radius², the root next to zero.
                let a = radial_rate.dot(&radial_rate);
                let b = radial.dot(&radial_rate);
                let c = radial.dot(&radial) - rr.clone();
                let root = long(&(&b * &b - &a * &c));
                if sign(&root) == Ordering::Less {
                    return None;
                }
                let root = root.sqrt();
                let q = if sign(&b) == Ordering::Less {
                    &root - &b
                } else {
                    -&root - &b
                };
                if sign(&q) == Ordering::Equal {
                    return None;
                }
                long(&c) / long(&q)
            }
            Part::Cap0 => -long(&height) / long(&height_rate),
            Part::Cap1 => (exact(1.0) - long(&height)) / long(&height_rate),
            part => not_of_a_cylinder(part),
        };
        let reached = point + &direction.times(&step);
        let (height, radial) = self.height_and_radial(&(&reached - &self.p0));
        let is_on_part = match self.part {
            Part::Side => height >= zero() && height <= exact(1.0),
            Part::Cap0 | Part::Cap1 => radial.dot(&radial) <= rr,
            part => not_of_a_cylinder(part),
        };
        is_on_part.then_some(reached)
    }
}

fn divided(vector: &ExactVector, divisor: &Exact) -> ExactVector {
    ExactVector(vector.0.clone().map(|x| long(&x) / long(divisor)))
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::*;
    use cyltrace::solid::Caps;

    fn distance(part: Part, scale: DVec3, x: f64, z: f64) -> f64 {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * 2.0, 1.0, Caps::Both).unwrap();
        let placement = ExactAffine::new(&DAffine3::from_scale(scale));
        distance_to_part(&cylinder, part, &placement, DVec3::new(x, 0.0, z))
    }

    #[test]
    fn distances_to_the_parts_of_a_unit_cylinder() {
        let one = DVec3::ONE;
        assert_eq!(distance(Part::Side, one, 1.5, 1.0), 0.5);
        assert_eq!(distance(Part::Side, one, 0.75, 1.0), 0.25);
        assert_eq!(distance(Part::Side, one, 1.0, 3.0), 1.0);
        assert_eq!(distance(Part::Cap0, one, 0.5, -0.25), 0.25);
        assert_eq!(distance(Part::Cap1, one, 4.0, 6.0), 5.0);
        assert_eq!(distance(Part::Cap1, one, 0.0, 2.0), 0.0);
    }

    #[test]
    fn distances_are_measured_in_the_point_s_space() {
        let flat = DVec3::new(4.0, 1.0, 0.5);
        assert_eq!(distance(Part::Side, flat, 4.25, 0.5), 0.25);
        assert_eq!(distance(Part::Cap1, flat, 2.0, 1.5), 0.5);
    }
}
