//! Cylinders that contain solids of other kinds.
//!
//! They are in the filter of cylinders: seven bytes a solid say no more of most kinds. What a
//! filter leaves to be solved in vain goes with the shadow that a copy throws beside that of
//! the solid, in the mean over all directions a quarter of their areas (Cauchy). `kinds` says how
//! much that is for each.
//!
//! Corners of such a cylinder may be outside the solid's box, and so outside the
//! cell. `super` uses only that a point *of the solid* is in the cell, and `cylinders`
//! that `c` and `b` fit into it, which they do: the ends of the axis are points of the solid.

use glam::DVec3;

use crate::math::power_of_two;
use crate::solid::ConvexSolid;

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
    pub fn between(p0: DVec3, p1: DVec3, heights: impl Fn(f64) -> [f64; 2], radius: f64) -> Self {
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
