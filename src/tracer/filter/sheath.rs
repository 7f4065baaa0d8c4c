//! Cylinders that contain solids of other kinds.
//!
//! They are stored in the filter of cylinders: seven bytes describe most kinds of solids no
//! better. The number of solids that a filter passes in vain grows with the shadow of a copy
//! compared with that of the solid: averaged over all directions, a quarter of their areas
//! (Cauchy). `kinds` has the ratio for each kind.
//!
//! Corners of such a cylinder may be outside the solid's box, and so outside the cell. `super`
//! requires only that a point *of the solid* is in the cell, and `cylinders` that `c` and `b`
//! fit into it. They do: the ends of the axis are points of the solid.

use glam::DVec3;

use crate::math::power_of_two;
use crate::scene::Listed;
use crate::solid::ConvexSolid;

/// A cylinder with the axis points `anchor + h axis` for the heights `h`, relative to the
/// anchor so that precision is kept far from the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheath {
    pub anchor: DVec3,
    /// A direction of length 1.
    pub axis: DVec3,
    pub heights: [f64; 2],
    pub radius: f64,
}

/// Points that are no farther apart get an arbitrary axis. Such a distance is negligible beside
/// the slack of a frame, because no solid is smaller than [`Cylinder::LEAST`], and its square
/// does not underflow.
const COINCIDENT: f64 = power_of_two(-400);

/// A kind of solid with a bounding cylinder.
pub(crate) trait Sheathed: ConvexSolid + Listed {
    /// The bounding cylinder. Its roundings are far below the slack of a frame.
    fn sheath(&self) -> Sheath;
}

impl Sheath {
    /// About the line from one point to another; `heights` is a function of their distance.
    pub fn between(p0: DVec3, p1: DVec3, heights: impl Fn(f64) -> [f64; 2], radius: f64) -> Self {
        let axis = p1 - p0;
        let length = axis.length();
        Self {
            anchor: p0,
            axis: if length > COINCIDENT {
                axis / length
            } else {
                DVec3::X
            },
            heights: heights(length),
            radius,
        }
    }
}
