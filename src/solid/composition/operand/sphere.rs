//! The surface of a ball. Its exact normal is the offset from the center.

use glam::DVec3;

use super::{OperandSurface, Vector};
use crate::solid::composition::bend::Bend;
use crate::solid::composition::piece::{Piece, Pieces, Viewed};
use crate::solid::exact::difference;
use crate::solid::{Part, Sphere};

impl OperandSurface for Sphere {
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces) {
        pieces.push(ball(view, Part::Side, DVec3::ZERO, self.radius()));
    }

    fn exact_normal(&self, _: Part, point: DVec3) -> Option<Vector> {
        Some(difference(point, self.center()))
    }
}

/// The piece of a ball whose center is relative to the anchor.
pub(super) fn ball(view: &Viewed, part: Part, center: DVec3, radius: f64) -> Piece {
    let normal = (view.from_anchor - center).normalize();
    let (around, along) = normal.any_orthonormal_pair();
    let curvature = 1.0 / radius;
    Piece {
        bend: Bend::new(around, along, curvature, [curvature; 2]),
        ..view.flat(part, normal, view.displacement / radius)
    }
}
