//! The points of a sphere on a ray, exactly, by the quadratic of the textbook.

use glam::DVec3;

use super::any::{TrueSolid, from_point};
use super::change::least_change;
use super::chord::{TrueChord, TrueEnd, in_ball};
use super::composed::{Leaf, Sheet, TrueOperand};
use super::cylinder::TrueHit;
use super::normal::unit;
use super::number::{Exact, ExactVector, exact, vector_of};
use super::ray::ExactRay;
use cyltrace::math::Ray;
use cyltrace::solid::{Part, Sphere};

/// Where the ray's line is within the closed ball, if it is.
#[must_use]
pub fn sphere_chord(sphere: &Sphere, ray: &ExactRay) -> Option<TrueChord> {
    let (x, radius) = (
        ray.origin_from(sphere.center()),
        ray.length(sphere.radius()),
    );
    let [enter, leave] = in_ball(&x, &ray.direction, &radius)?.map(|t| TrueEnd {
        t,
        part: Part::Side,
    });
    Some(TrueChord {
        enter,
        leave,
        lies_on: None,
    })
}

impl TrueSolid for Sphere {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        sphere_chord(self, ray).map_or(Vec::new(), |chord| chord.hits(ray))
    }

    fn gap(&self, ray: &Ray) -> f64 {
        // What makes the line touch the sphere or brings the origin to it.
        assert!(
            ray.is_valid(),
            "a gap is of a valid ray, and this is {ray:?}"
        );
        let mut numbers = vec![exact(self.radius())];
        for vector in [self.center(), ray.origin, ray.direction] {
            numbers.extend(vector.to_array().map(exact));
        }
        least_change(numbers, |numbers: &[Exact]| {
            let [center, origin, d] = [1, 4, 7].map(|first| vector_of(&numbers[first..]));
            let (x, rr) = (&origin - &center, &numbers[0] * &numbers[0]);
            let (dd, xd) = (d.dot(&d), x.dot(&d));
            let height = x.dot(&x) - rr;
            vec![&xd * &xd - &dd * &height, height]
        })
    }

    fn outward_normal(&self, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
        unit(&from_point(self.center(), ray, hit))
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        let x = &ExactVector::new(point) - &ExactVector::new(self.center());
        let radius = exact(self.radius());
        x.dot(&x) <= &radius * &radius
    }
}

impl TrueOperand for Sphere {
    fn leaf(&self) -> Leaf {
        let (center, radius) = (ExactVector::new(self.center()), exact(self.radius()));
        Leaf::within(vec![Sheet::sphere(&center, &radius, Part::Side)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textbook_cases_have_their_known_answers() {
        let sphere = Sphere::new(DVec3::X * 10.0, 5.0).unwrap();
        let ends = |y: f64| {
            let ray = Ray::new(DVec3::Y * y, DVec3::X * 2.0);
            sphere_chord(&sphere, &ExactRay::new(&ray))
                .map(|chord| chord.ends().map(|hit| hit.t_f64()))
        };
        assert_eq!(ends(3.0), Some([3.0, 7.0]));
        assert_eq!(ends(5.0), Some([5.0, 5.0]));
        assert_eq!(ends(5.0_f64.next_up()), None);
        let gap = |y| TrueSolid::gap(&sphere, &Ray::new(DVec3::new(-1.0, y, 0.0), DVec3::X));
        assert_eq!(gap(5.0), 0.0);
        let near = gap(5.0 * (1.0 + 1e-9));
        assert!(2e-10 < near && near < 1e-9, "{near:e}");
        assert!(gap(3.0) > 0.02);
        assert!(TrueSolid::truly_contains(
            &sphere,
            DVec3::new(13.0, 4.0, 0.0)
        ));
        assert!(!TrueSolid::truly_contains(
            &sphere,
            DVec3::new(13.0, 4.0, 1e-300)
        ));
    }
}
