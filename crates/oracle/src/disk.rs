//! The points of a disk on a ray, exactly.
//!
//! A line that is not parallel to the plane meets it in one point, which is
//! compared with the radius as it is; within the plane the disk is the ball around
//! its center.

use std::cmp::Ordering;

use glam::DVec3;

use super::any::TrueSolid;
use super::change::least_change;
use super::chord::{TrueChord, TrueEnd, in_ball};
use super::composed::{Leaf, TrueOperand};
use super::cylinder::TrueHit;
use super::normal::unit;
use super::number::{Exact, ExactVector, Surd, exact, sign, vector_of, zero};
use super::ray::ExactRay;
use cyltrace::math::Ray;
use cyltrace::solid::{Disk, Part};

/// Where the ray's line is within the closed disk, if it is: in one point, or along a
/// line within its plane.
#[must_use]
pub fn disk_chord(disk: &Disk, ray: &ExactRay) -> Option<TrueChord> {
    let (x, d) = (ray.origin_from(disk.center()), &ray.direction);
    let (n, radius) = (ExactVector::new(disk.normal()), ray.length(disk.radius()));
    let (height, slope) = (n.dot(&x), n.dot(d));
    let is_along = sign(&slope) == Ordering::Equal;
    let [enter, leave] = if is_along {
        if sign(&height) != Ordering::Equal {
            return None;
        }
        in_ball(&x, d, &radius)?
    } else {
        // The point times the slope, so that nothing is divided.
        let point = &x.times(&slope) - &d.times(&height);
        let reach = &radius * &slope;
        if point.dot(&point) > &reach * &reach {
            return None;
        }
        let t = Surd::quotient(-height, slope);
        [t.clone(), t]
    }
    .map(|t| TrueEnd {
        t,
        part: Part::Side,
    });
    Some(TrueChord {
        enter,
        leave,
        lies_on: is_along.then_some(Part::Side),
    })
}

impl TrueSolid for Disk {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        disk_chord(self, ray).map_or(Vec::new(), |chord| chord.hits(ray))
    }

    fn gap(&self, ray: &Ray) -> f64 {
        // What makes the line go through the rim or brings the origin to the plane.
        assert!(
            ray.is_valid(),
            "a gap is of a valid ray, and this is {ray:?}"
        );
        let mut numbers = vec![exact(self.radius())];
        for vector in [self.center(), self.normal(), ray.origin, ray.direction] {
            numbers.extend(vector.to_array().map(exact));
        }
        least_change(numbers, |numbers: &[Exact]| {
            let [center, n, origin, d] = [1, 4, 7, 10].map(|first| vector_of(&numbers[first..]));
            let x = &origin - &center;
            let (height, slope) = (n.dot(&x), n.dot(&d));
            let point = &x.times(&slope) - &d.times(&height);
            let reach = &numbers[0] * slope;
            vec![point.dot(&point) - &reach * &reach, height]
        })
    }

    fn outward_normal(&self, _: &Ray, _: &TrueHit) -> Option<DVec3> {
        unit(&ExactVector::new(self.normal()))
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        let x = &ExactVector::new(point) - &ExactVector::new(self.center());
        let radius = exact(self.radius());
        ExactVector::new(self.normal()).dot(&x) == zero() && x.dot(&x) <= &radius * &radius
    }
}

impl TrueOperand for Disk {
    fn leaf(&self) -> Leaf {
        panic!("a disk has no inside and composes nothing")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textbook_cases_have_their_known_answers() {
        let disk = Disk::new(DVec3::Z, DVec3::Z * 7.0, 5.0).unwrap();
        let ends = |origin, direction| {
            disk_chord(&disk, &ExactRay::new(&Ray::new(origin, direction)))
                .map(|chord| chord.ends().map(|hit| hit.t_f64()))
        };
        let rim = DVec3::new(3.0, 4.0, 1.0);
        let slope = DVec3::new(1.0, 2.0, -2.0);
        assert_eq!(ends(rim - slope * 3.0, slope), Some([3.0, 3.0]));
        assert_eq!(ends(rim + DVec3::X * 1e-15, slope), None);
        assert_eq!(ends(rim - DVec3::X * 13.0, DVec3::X), Some([7.0, 13.0]));
        assert_eq!(ends(rim + DVec3::Z * 1e-15, DVec3::X), None);
        let gap = |y| {
            let ray = Ray::new(DVec3::new(0.5, y, -3.0), DVec3::Z);
            TrueSolid::gap(&Disk::new(DVec3::Z, DVec3::Z, 5.0).unwrap(), &ray)
        };
        assert!(gap(0.5 * 99.0_f64.sqrt()) < 1e-15);
        let near = gap(0.5 * 99.0_f64.sqrt() + 1e-8);
        assert!(2e-10 < near && near < 2e-9, "{near:e}");
        assert!(gap(3.0) > 0.02);
        assert!(TrueSolid::truly_contains(&disk, rim));
        assert!(!TrueSolid::truly_contains(&disk, rim + DVec3::Z * 1e-15));
        assert!(!TrueSolid::truly_contains(
            &disk,
            rim.with_x(3.0_f64.next_up())
        ));
    }
}
