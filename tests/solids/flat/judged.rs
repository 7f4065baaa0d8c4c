//! Each kind of solid, with the oracle's truth about it.

use cyltrace::math::Ray;
use cyltrace::solid::{ConvexSolid, Cuboid, Disk, Part, Sphere};
use cyltrace_oracle::{ExactRay, ExactVector, TrueChord, TrueSolid, exact, to_f64};
use glam::DVec3;

/// A solid and what is true of it.
pub trait Judged: ConvexSolid {
    /// The same one around zero.
    fn around_zero(&self) -> Self;
    fn true_chord(&self, ray: &Ray) -> Option<TrueChord>;
    fn truly_holds(&self, point: DVec3) -> bool;
    /// The least relative change after which the answer may be another.
    fn gap(&self, ray: &Ray) -> f64;
    /// How far a point, told to be of `part`, is at least from it.
    fn distance(&self, part: Part, point: DVec3) -> f64;
}

impl Judged for Sphere {
    fn around_zero(&self) -> Self {
        Self::new(DVec3::ZERO, self.radius()).unwrap()
    }

    fn true_chord(&self, ray: &Ray) -> Option<TrueChord> {
        cyltrace_oracle::sphere_chord(self, &ExactRay::new(ray))
    }

    fn truly_holds(&self, point: DVec3) -> bool {
        TrueSolid::truly_contains(self, point)
    }

    fn gap(&self, ray: &Ray) -> f64 {
        TrueSolid::gap(self, ray)
    }

    fn distance(&self, part: Part, point: DVec3) -> f64 {
        assert_eq!(part, Part::Side);
        let (from_center, r) = (between(self.center(), point), exact(self.radius()));
        // The difference of the squares over the sum.
        let off = to_f64(&(from_center.dot(&from_center) - &r * &r)).abs();
        off / (from_center.length() + self.radius())
    }
}

impl Judged for Cuboid {
    fn around_zero(&self) -> Self {
        Self::new(DVec3::ZERO, self.half_widths(), self.orientation()).unwrap()
    }

    fn true_chord(&self, ray: &Ray) -> Option<TrueChord> {
        cyltrace_oracle::cuboid_chord(self, &ExactRay::new(ray))
    }

    fn truly_holds(&self, point: DVec3) -> bool {
        TrueSolid::truly_contains(self, point)
    }

    fn gap(&self, ray: &Ray) -> f64 {
        TrueSolid::gap(self, ray)
    }

    fn distance(&self, part: Part, point: DVec3) -> f64 {
        let (face, side) = match part {
            Part::XMin => (0, -1.0),
            Part::XMax => (0, 1.0),
            Part::YMin => (1, -1.0),
            Part::YMax => (1, 1.0),
            Part::ZMin => (2, -1.0),
            Part::ZMax => (2, 1.0),
            _ => panic!("{part:?} of a cuboid"),
        };
        let frame = self.orientation().world_from_object();
        let offs = [0, 1, 2].map(|axis| {
            let own = ExactVector::new(frame.col(axis)).dot(&between(self.center(), point));
            let half_width = self.half_widths()[axis];
            if axis == face {
                to_f64(&(own - exact(side * half_width))).abs()
            } else {
                let above = to_f64(&(&own - exact(half_width)));
                let below = to_f64(&(-own - exact(half_width)));
                above.max(below).max(0.0)
            }
        });
        DVec3::from_array(offs).max_element()
    }
}

impl Judged for Disk {
    fn around_zero(&self) -> Self {
        Self::new(DVec3::ZERO, self.normal(), self.radius()).unwrap()
    }

    fn true_chord(&self, ray: &Ray) -> Option<TrueChord> {
        cyltrace_oracle::disk_chord(self, &ExactRay::new(ray))
    }

    fn truly_holds(&self, point: DVec3) -> bool {
        TrueSolid::truly_contains(self, point)
    }

    fn gap(&self, ray: &Ray) -> f64 {
        TrueSolid::gap(self, ray)
    }

    fn distance(&self, part: Part, point: DVec3) -> f64 {
        assert_eq!(part, Part::Side);
        let from_center = between(self.center(), point);
        let height = to_f64(&ExactVector::new(self.normal()).dot(&from_center)).abs();
        let over = from_center.length() - self.radius();
        (height / self.normal().length()).max(over)
    }
}

/// The way from one point to another, exactly.
pub fn between(from: DVec3, to: DVec3) -> ExactVector {
    &ExactVector::new(to) - &ExactVector::new(from)
}
