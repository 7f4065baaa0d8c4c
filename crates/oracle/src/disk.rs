//! The points of a disk on a ray, exactly.
//!
//! A line that is not parallel to the plane meets it in one point, which is
//! compared with the radius as it is; within the plane the disk is the ball around
//! its center.

use std::cmp::Ordering;

use super::change::least_change;
use super::chord::{TrueChord, TrueEnd, in_ball};
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

/// Whether the closed disk contains a point.
///
/// # Panics
/// When the point is not finite.
#[must_use]
pub fn disk_holds(disk: &Disk, point: glam::DVec3) -> bool {
    let x = &ExactVector::new(point) - &ExactVector::new(disk.center());
    let radius = exact(disk.radius());
    ExactVector::new(disk.normal()).dot(&x) == zero() && x.dot(&x) <= &radius * &radius
}

/// The least change, the same relative change for every number of the case, after
/// which its answer may be another: to first order, that which makes the line go
/// through the rim or brings the origin to the plane. Events that are out of the ray's range count too, so
/// that it is a lower bound.
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn disk_gap(disk: &Disk, ray: &Ray) -> f64 {
    assert!(
        ray.is_valid(),
        "a gap is of a valid ray, and this is {ray:?}"
    );
    let mut numbers = vec![exact(disk.radius())];
    for vector in [disk.center(), disk.normal(), ray.origin, ray.direction] {
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

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
            disk_gap(&Disk::new(DVec3::Z, DVec3::Z, 5.0).unwrap(), &ray)
        };
        assert!(gap(0.5 * 99.0_f64.sqrt()) < 1e-15);
        let near = gap(0.5 * 99.0_f64.sqrt() + 1e-8);
        assert!(2e-10 < near && near < 2e-9, "{near:e}");
        assert!(gap(3.0) > 0.02);
        assert!(disk_holds(&disk, rim));
        assert!(!disk_holds(&disk, rim + DVec3::Z * 1e-15));
        assert!(!disk_holds(&disk, rim.with_x(3.0_f64.next_up())));
    }
}
