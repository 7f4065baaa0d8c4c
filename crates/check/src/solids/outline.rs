//! A shape about an axis: all that is needed to aim rays at walls, rims and axes.

use glam::DVec3;

/// The extent of a shape about an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline {
    /// The start of the axis.
    pub bottom: DVec3,
    /// A unit vector.
    pub axis: DVec3,
    /// Unit vectors across it.
    pub across: [DVec3; 2],
    /// The length of the axis, from bottom to top.
    pub length: f64,
    /// The greatest radius.
    pub radius: f64,
}

impl Outline {
    pub fn about(bottom: DVec3, axis: DVec3, length: f64, radii: [f64; 2]) -> Self {
        let (one, other) = axis.any_orthonormal_pair();
        Self {
            bottom,
            axis,
            across: [one, other],
            length,
            radius: radii[0].max(radii[1]),
        }
    }

    /// The point at a height, off the axis.
    pub fn point(&self, height: f64, off: DVec3) -> DVec3 {
        self.bottom + self.axis * height + off
    }
}
