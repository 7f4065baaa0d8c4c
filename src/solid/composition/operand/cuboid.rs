//! The faces of a cuboid.
//!
//! The exact normal of a face is the stated axis, or its opposite.

use glam::DVec3;

use super::{OperandSurface, Vector};
use crate::solid::composition::piece::{Pieces, Viewed};
use crate::solid::cuboid::FACES;
use crate::solid::exact::vector;
use crate::solid::spawn::SOLVER_DISPLACEMENT;
use crate::solid::{Cuboid, Part};

impl OperandSurface for Cuboid {
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces) {
        let frame = self.orientation().world_from_object();
        for (axis, faces) in FACES.into_iter().enumerate() {
            let (normal, half_width) = (frame.col(axis), self.half_widths()[axis]);
            let height = view.from_anchor.dot(normal);
            for (part, side) in faces.into_iter().zip([-1.0, 1.0]) {
                if view.passes(part, (side * height - half_width).abs()) {
                    pieces.push(view.flat(part, normal * side, SOLVER_DISPLACEMENT));
                }
            }
        }
    }

    fn exact_normal(&self, part: Part, _: DVec3) -> Option<Vector> {
        let frame = self.orientation().world_from_object();
        let axis = FACES.iter().position(|faces| faces.contains(&part))?;
        let normal = frame.col(axis);
        Some(vector(if part == FACES[axis][0] {
            -normal
        } else {
            normal
        }))
    }
}
