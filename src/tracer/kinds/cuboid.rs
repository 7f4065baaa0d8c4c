//! A cuboid is represented by the cylinder about one of its axes. Its shadow is 26 % larger
//! than that of a cube. An axis-aligned box in the cell has twice the shadow of a turned cube,
//! a ball 57 % more.

use super::TracedKind;
use crate::math::UNIT_ROUNDOFF;
use crate::solid::Cuboid;
use crate::tracer::filter::{Sheath, Sheathed};

impl TracedKind for Cuboid {}

impl Sheathed for Cuboid {
    /// The cylinder of least area about one of its axes.
    fn sheath(&self) -> Sheath {
        let half_widths = self.half_widths();
        // As in its bounds: its axes are orthonormal to within roundings.
        let off = 16.0 * UNIT_ROUNDOFF * half_widths.element_sum();
        let about = |axis: usize| {
            let height = half_widths[axis] + off;
            let across = [half_widths[(axis + 1) % 3], half_widths[(axis + 2) % 3]];
            Sheath {
                anchor: self.center(),
                axis: self.orientation().world_from_object().col(axis),
                heights: [-height, height],
                radius: libm::hypot(across[0], across[1]) + off,
            }
        };
        let area = |one: &Sheath| one.radius * (one.radius + 2.0 * one.heights[1]);
        let others = [about(1), about(2)];
        others.into_iter().fold(about(0), |least, one| {
            if area(&one) < area(&least) {
                one
            } else {
                least
            }
        })
    }
}
