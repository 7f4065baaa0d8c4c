//! Cylinders that contain solids of other kinds.
//!
//! They are in the filter of cylinders: seven bytes a solid say no more of most kinds. What a
//! filter leaves to be solved in vain goes with the shadow that a copy throws beside that of
//! the solid, in the mean over all directions a quarter of their areas (Cauchy):
//!
//! - A cone or rounded cone is in the cylinder of its greater radius, which has 17 % more
//!   where radii vary by a factor of three, twice as much where one of them is zero.
//! - A disk is one of no length. Its half axis is long enough to say the normal to within
//!   what the radius gains by that: 25 % more in a thicket.
//! - A cuboid is in the cylinder about one of its axes, 26 % more for a cube; a box along the
//!   axes of the cell has twice as much for one that is turned, a ball 57 %.
//!
//! Corners of such a cylinder may be outside the solid's box, and so outside the
//! cell. `super` uses only that a point *of the solid* is in the cell, and `cylinders`
//! that `c` and `b` fit into it, which they do: the ends of the axis are points of the solid.

use glam::DVec3;

use crate::math::{UNIT_ROUNDOFF, power_of_two};
use crate::solid::{Cone, ConvexSolid, Cuboid, Cylinder, Disk, RoundedCone};

/// A cylinder, about the points `anchor + h axis` for the heights `h`, relative to the
/// anchor so that nothing of its size is lost far from the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheath {
    pub anchor: DVec3,
    /// A direction of length 1.
    pub axis: DVec3,
    pub heights: [f64; 2],
    pub radius: f64,
}

/// Points that are no further apart have any direction from each other. It is nothing
/// beside the slack of a frame, for no solid is smaller than [`Cylinder::LEAST`], and its
/// square does not underflow.
const COINCIDENT: f64 = power_of_two(-400);

/// A kind of solid that is within a cylinder.
pub(crate) trait Sheathed: ConvexSolid {
    /// That cylinder. Roundings of it are far below the slack of a frame.
    fn sheath(&self) -> Sheath;
}

impl Sheath {
    /// About the line from a point to another; `heights` are of the distance between them.
    fn between(p0: DVec3, p1: DVec3, heights: impl Fn(f64) -> [f64; 2], radius: f64) -> Self {
        let way = p1 - p0;
        let length = way.length();
        Self {
            anchor: p0,
            axis: if length > COINCIDENT {
                way / length
            } else {
                DVec3::X
            },
            heights: heights(length),
            radius,
        }
    }
}

impl Sheathed for Cylinder {
    fn sheath(&self) -> Sheath {
        Sheath::between(self.p0(), self.p1(), |length| [0.0, length], self.radius())
    }
}

impl Sheathed for Cone {
    fn sheath(&self) -> Sheath {
        let radius = self.radius0().max(self.radius1());
        Sheath::between(self.p0(), self.p1(), |length| [0.0, length], radius)
    }
}

impl Sheathed for RoundedCone {
    fn sheath(&self) -> Sheath {
        let (r0, r1) = (self.radius0(), self.radius1());
        // One ball may be within the other.
        let heights = |length: f64| [(-r0).min(length - r1), r0.max(length + r1)];
        Sheath::between(self.p0(), self.p1(), heights, r0.max(r1))
    }
}

impl Sheathed for Disk {
    fn sheath(&self) -> Sheath {
        Sheath {
            anchor: self.center(),
            axis: self.normal().normalize(),
            heights: [0.0; 2],
            radius: self.radius(),
        }
    }
}

impl Sheathed for Cuboid {
    /// Of the cylinders about its axes the one with the least area.
    fn sheath(&self) -> Sheath {
        let half_widths = self.half_widths();
        // As its bounds: its axes are orthonormal to within roundings.
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
