//! The points of a cuboid on a ray, exactly.
//!
//! Every plane of a face is intersected on its own, and its point is checked against the
//! definition of the solid, all three axes of it: those that pass are points of
//! the surface, and the first and the last of them are the ends of the chord. A line
//! within a face meets the planes of the others. A point on several faces is of the
//! first axis.

use std::cmp::Ordering;

use glam::DVec3;

use super::any::TrueSolid;
use super::change::least_change;
use super::chord::{TrueChord, TrueEnd};
use super::composed::{Leaf, Sheet, TrueOperand};
use super::cylinder::TrueHit;
use super::normal::unit;
use super::number::{Exact, ExactVector, Surd, exact, sign, vector_of, zero};
use super::ray::ExactRay;
use cyltrace::math::Ray;
use cyltrace::solid::{Cuboid, Part};

const LOWER: [Part; 3] = [Part::XMin, Part::YMin, Part::ZMin];
const UPPER: [Part; 3] = [Part::XMax, Part::YMax, Part::ZMax];

/// A cuboid's own coordinates of a line: `start + t slope` each.
struct OwnLine {
    start: [Exact; 3],
    slope: [Exact; 3],
    half_widths: [Exact; 3],
}

/// Where the ray's line is within the closed cuboid, if it is.
#[must_use]
pub fn cuboid_chord(cuboid: &Cuboid, ray: &ExactRay) -> Option<TrueChord> {
    let line = OwnLine {
        start: along_axes(cuboid, &ray.origin_from(cuboid.center())),
        slope: along_axes(cuboid, &ray.direction),
        half_widths: cuboid.half_widths().to_array().map(|one| ray.length(one)),
    };
    let mut ends: Vec<TrueEnd> = Vec::new();
    for axis in 0..3 {
        if sign(&line.slope[axis]) == Ordering::Equal {
            continue;
        }
        for height in [-&line.half_widths[axis], line.half_widths[axis].clone()] {
            let t = Surd::quotient(height - &line.start[axis], line.slope[axis].clone());
            ends.extend(line.part_at(&t).map(|part| TrueEnd { t, part }));
        }
    }
    ends.sort_by(|one, other| one.t.cmp_exact(&other.t));
    let (enter, leave) = (ends.first()?.clone(), ends.last()?.clone());
    Some(TrueChord {
        enter,
        leave,
        lies_on: line.face(),
    })
}

fn along_axes(cuboid: &Cuboid, vector: &ExactVector) -> [Exact; 3] {
    let frame = cuboid.orientation().world_from_object();
    std::array::from_fn(|axis| ExactVector::new(frame.col(axis)).dot(vector))
}

impl OwnLine {
    /// The part of the surface at a parameter at which the line is on some plane.
    fn part_at(&self, t: &Surd) -> Option<Part> {
        let mut found = None;
        for axis in (0..3).rev() {
            let (start, slope, half_width) = (
                &self.start[axis],
                &self.slope[axis],
                &self.half_widths[axis],
            );
            match t.sign_of_line(&(start + half_width), slope) {
                Ordering::Less => return None,
                Ordering::Equal => found = Some(LOWER[axis]),
                Ordering::Greater => {}
            }
            match t.sign_of_line(&(start - half_width), slope) {
                Ordering::Less => {}
                Ordering::Equal => found = Some(UPPER[axis]),
                Ordering::Greater => return None,
            }
        }
        found
    }

    /// The face in whose plane the line runs, the first of several.
    fn face(&self) -> Option<Part> {
        (0..3).find_map(|axis| {
            let (start, half_width) = (&self.start[axis], &self.half_widths[axis]);
            if self.slope[axis] != zero() {
                None
            } else if *start == -half_width {
                Some(LOWER[axis])
            } else {
                (start == half_width).then_some(UPPER[axis])
            }
        })
    }
}

impl TrueSolid for Cuboid {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        cuboid_chord(self, ray).map_or(Vec::new(), |chord| chord.hits(ray))
    }

    fn gap(&self, ray: &Ray) -> f64 {
        // What makes the line go through an edge's line or brings the origin to a face's plane.
        assert!(
            ray.is_valid(),
            "a gap is of a valid ray, and this is {ray:?}"
        );
        let vectors = [self.half_widths(), self.center(), ray.origin, ray.direction];
        let numbers = vectors.map(|vector| vector.to_array().map(exact)).concat();
        let is_along =
            along_axes(self, &ExactVector::new(ray.direction)).map(|slope| slope == zero());
        least_change(numbers, |numbers: &[Exact]| {
            let [half_widths, center, origin, d] =
                [0, 3, 6, 9].map(|first| vector_of(&numbers[first..]));
            let start = along_axes(self, &(&origin - &center));
            let slope = along_axes(self, &d);
            let planes: [[Exact; 2]; 3] = std::array::from_fn(|axis| {
                let (start, half_width) = (&start[axis], &half_widths.0[axis]);
                [start + half_width, start - half_width]
            });
            let mut conditions = planes.concat();
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                // A line along both of the planes keeps its distance to their edges.
                if is_along[i] && is_along[j] {
                    continue;
                }
                for one in &planes[i] {
                    for other in &planes[j] {
                        conditions.push(one * &slope[j] - other * &slope[i]);
                    }
                }
            }
            conditions
        })
    }

    fn outward_normal(&self, _: &Ray, hit: &TrueHit) -> Option<DVec3> {
        let axes = self.orientation().world_from_object();
        let (axis, side) = match hit.part {
            Part::XMin => (0, -1.0),
            Part::XMax => (0, 1.0),
            Part::YMin => (1, -1.0),
            Part::YMax => (1, 1.0),
            Part::ZMin => (2, -1.0),
            _ => (2, 1.0),
        };
        unit(&ExactVector::new(axes.col(axis) * side))
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        let half_widths = self.half_widths().to_array().map(exact);
        let from_center = &ExactVector::new(point) - &ExactVector::new(self.center());
        along_axes(self, &from_center)
            .iter()
            .zip(half_widths)
            .all(|(own, half_width)| -&half_width <= *own && *own <= half_width)
    }
}

impl TrueOperand for Cuboid {
    fn leaf(&self) -> Leaf {
        let center = ExactVector::new(self.center());
        let axes = self.orientation().world_from_object();
        let parts = [
            [Part::XMin, Part::XMax],
            [Part::YMin, Part::YMax],
            [Part::ZMin, Part::ZMax],
        ];
        let mut sheets = Vec::new();
        for (axis, parts) in parts.into_iter().enumerate() {
            let half_width = exact(self.half_widths()[axis]);
            for (part, side) in parts.into_iter().zip([-1.0, 1.0]) {
                let normal = ExactVector::new(axes.col(axis) * side);
                let offset = normal.dot(&center) + &half_width;
                sheets.push(Sheet::plane(&normal, &offset, Some(part)));
            }
        }
        Leaf::within(sheets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Orientation;

    /// Both ends, and the face that the line lies in.
    type Answer = ([(f64, Part); 2], Option<Part>);

    fn answer(origin: [f64; 3], direction: [f64; 3]) -> Option<Answer> {
        // Its own y and z are the world's z and -y.
        let turned = Orientation::IDENTITY.rotated_x(90.0);
        let cuboid = Cuboid::new(DVec3::X, DVec3::new(1.0, 2.0, 3.0), turned).unwrap();
        let ray = Ray::new(DVec3::from(origin), DVec3::from(direction));
        cuboid_chord(&cuboid, &ExactRay::new(&ray)).map(|chord| {
            (
                chord.ends().map(|hit| (hit.t_f64(), hit.part)),
                chord.lies_on,
            )
        })
    }

    #[test]
    fn textbook_cases_have_their_known_answers() {
        use Part::{XMax, XMin, YMax, YMin, ZMax, ZMin};
        // Through two faces, of either axis.
        assert_eq!(
            answer([-3.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
            Some(([(3.0, XMin), (5.0, XMax)], None))
        );
        assert_eq!(
            answer([1.0, 5.0, 1.0], [0.0, -2.0, 0.0]),
            Some(([(1.0, ZMin), (4.0, ZMax)], None))
        );
        assert_eq!(
            answer([1.0, 0.0, -9.0], [0.0, 0.0, 1.0]),
            Some(([(7.0, YMin), (11.0, YMax)], None))
        );
        // Beside it; touching an edge, and from corner to corner.
        assert_eq!(answer([3.0, 0.0, 1.0], [0.0, 1.0, 0.0]), None);
        assert_eq!(
            answer([1.0, 0.0, 3.0], [1.0, 0.0, -1.0]),
            Some(([(1.0, XMax), (1.0, XMax)], None))
        );
        assert_eq!(
            answer([-1.0, 6.0, 4.0], [1.0, -3.0, -2.0]),
            Some(([(1.0, XMin), (3.0, XMax)], None))
        );
        // Within a face, and along an edge.
        assert_eq!(
            answer([-1.0, 3.0, 0.0], [1.0, 0.0, 0.0]),
            Some(([(1.0, XMin), (3.0, XMax)], Some(ZMin)))
        );
        assert_eq!(
            answer([2.0, 0.0, 2.0], [0.0, 1.0, 0.0]),
            Some(([(-3.0, XMax), (3.0, XMax)], Some(XMax)))
        );
    }

    #[test]
    fn gap_at_an_edge_is_the_distance_to_it() {
        let cuboid = Cuboid::new(DVec3::ONE, DVec3::splat(0.5), Orientation::IDENTITY).unwrap();
        let gap = |x: f64| {
            let ray = Ray::new(DVec3::new(x, 1.25, -7.0), DVec3::new(0.0, 0.0, 1.0));
            TrueSolid::gap(&cuboid, &ray)
        };
        assert_eq!(gap(1.5), 0.0);
        let near = gap(1.5 + 1e-9);
        assert!(2e-10 < near && near < 1e-9, "{near:e}");
        assert!(gap(1.1) > 0.02);
    }
}
