//! A box along three axes. Its faces are their own supporting planes.

use glam::DVec3;

use super::between::{Between, PartNormals, Parts};
use super::outline::Outline;
use super::taper::UNIT;
use super::{ConvexShape, Scaled, Shape};
use cyltrace::solid::Part;
use cyltrace_oracle::{ExactVector, exact};

/// The faces by axis and side.
const FACES: [[Part; 2]; 3] = [
    [Part::XMin, Part::XMax],
    [Part::YMin, Part::YMax],
    [Part::ZMin, Part::ZMax],
];

/// All points within a half width of a point along each of three axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    pub center: DVec3,
    /// Unit vectors, rounded.
    pub axes: [DVec3; 3],
    pub half_widths: DVec3,
}

impl Block {
    /// The face whose outward normal is nearest to a vector: its axis and side.
    fn face(&self, hint: DVec3) -> (usize, f64) {
        let along = self.axes.map(|axis| axis.dot(hint));
        let axis = (0..3)
            .max_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs()))
            .unwrap_or(0);
        (axis, along[axis].signum())
    }

    fn along(&self, vector: DVec3) -> DVec3 {
        DVec3::from_array(self.axes.map(|axis| axis.dot(vector)))
    }
}

impl ConvexShape for Block {
    fn end_points(&self) -> [DVec3; 2] {
        [self.center; 2]
    }

    fn axis(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn at_origin(&self) -> Shape {
        Shape::Block(Self {
            center: DVec3::ZERO,
            ..*self
        })
    }

    fn displaced(&self, outward: f64) -> Option<Shape> {
        Some(Shape::Block(Self {
            half_widths: self.half_widths + outward,
            ..*self
        }))
    }

    fn half_width(&self) -> f64 {
        self.half_widths.min_element()
    }

    fn surely_contains(&self, y: DVec3, error: f64) -> bool {
        let reach = self.half_widths * (1.0 - 8.0 * UNIT);
        (self.along(y).abs() + error).cmple(reach).all()
    }

    fn is_surely_beyond(&self, y: DVec3, error: f64, m: DVec3) -> bool {
        let (axis, side) = self.face(m);
        let half_width = self.half_widths[axis];
        let error = 2.0 * error + 8.0 * UNIT * (y.length() + half_width);
        side * self.axes[axis].dot(y) - half_width > error
    }

    fn contains(&self, Scaled { x, scale }: &Scaled) -> bool {
        (0..3).all(|axis| {
            let along = ExactVector::new(self.axes[axis]).dot(x);
            let reach = exact(self.half_widths[axis]) * scale;
            -&reach <= along && along <= reach
        })
    }

    fn is_beyond(&self, Scaled { x, scale }: &Scaled, m: DVec3) -> bool {
        let (axis, side) = self.face(m);
        let along = ExactVector::new(self.axes[axis] * side).dot(x);
        along > exact(self.half_widths[axis]) * scale
    }

    fn depth(&self, point: DVec3) -> f64 {
        let beyond = self.along(point - self.center).abs() - self.half_widths;
        if beyond.max_element() <= 0.0 {
            return -beyond.max_element();
        }
        -beyond.max(DVec3::ZERO).length()
    }

    fn add_parts(&self, between: &Between, parts: &mut Parts) {
        for (axis, faces) in FACES.into_iter().enumerate() {
            for (face, side) in faces.into_iter().zip([-1.0, 1.0]) {
                let normal = self.axes[axis] * side;
                if between.reaches(normal, self.half_widths[axis]) {
                    parts.push((face, PartNormals::flat(normal)));
                }
            }
        }
    }

    fn outline(&self) -> Outline {
        let [x, y, z] = self.axes;
        let half = self.half_widths;
        Outline {
            bottom: self.center - z * half.z,
            axis: z,
            across: [x, y],
            length: 2.0 * half.z,
            radius: half.x.max(half.y),
        }
    }

    fn wall(&self, outline: &Outline, _: f64, outward: DVec3) -> (f64, DVec3) {
        let along = outline.across.map(|axis| outward.dot(axis));
        let reach = [0, 1].map(|i| self.half_widths[i] / along[i].abs());
        let first = usize::from(reach[1] < reach[0]);
        (reach[first], outline.across[first] * along[first].signum())
    }
}
