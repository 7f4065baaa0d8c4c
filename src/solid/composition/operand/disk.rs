//! A disk has no inside, so it cannot be an operand: it has no pieces.

use glam::DVec3;

use super::{OperandSurface, Vector};
use crate::solid::composition::piece::{Pieces, Viewed};
use crate::solid::{Disk, Part};

impl OperandSurface for Disk {
    fn add_pieces(&self, _: &Viewed, _: &mut Pieces) {}

    fn exact_normal(&self, _: Part, _: DVec3) -> Option<Vector> {
        None
    }
}
