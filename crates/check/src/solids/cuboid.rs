//! The cuboid.

use cyltrace::solid::{AnySolid, Cuboid};

use super::block::Block;
use super::{CheckedSolid, Shape};

impl CheckedSolid for Cuboid {
    fn shape(&self) -> Shape {
        let frame = self.orientation().world_from_object();
        Shape::Block(Block {
            center: self.center(),
            axes: [frame.x_axis, frame.y_axis, frame.z_axis],
            half_widths: self.half_widths(),
        })
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Block(block) = shape else {
            return None;
        };
        let orientation = self.orientation();
        Some(
            Self::new(block.center, block.half_widths, orientation)
                .ok()?
                .into(),
        )
    }
}
