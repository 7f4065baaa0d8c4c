//! What can be in a picture: the part of space that the camera's rays go
//! through.

use glam::DVec3;

use crate::math::{Bounds, power_of_two};

/// By how much a box has to be outside, relative to the size of what is
/// subtracted to find it out: some hundred times the roundings of that, and
/// of rays through the picture's edge.
const SLACK: f64 = power_of_two(-40);

/// The space between four planes through the edges of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewVolume {
    eye: DVec3,
    /// Normals of the planes through the eye or beside it, which point inward,
    /// and how far from the eye the planes are along them.
    sides: [(DVec3, f64); 4],
}

impl ViewVolume {
    /// The points with `normal · (point - eye) + distance >= 0` for all sides.
    pub(super) fn new(eye: DVec3, sides: [(DVec3, f64); 4]) -> Self {
        Self { eye, sides }
    }

    /// Whether any ray of the camera may reach a box; only false where none
    /// does.
    #[must_use]
    pub fn may_reach(&self, bounds: &Bounds) -> bool {
        let (center, half) = (bounds.center() - self.eye, bounds.extent() * 0.5);
        let size = bounds.lower.abs().max(bounds.upper.abs()) + self.eye.abs();
        self.sides.iter().all(|(normal, distance)| {
            let farthest = normal.dot(center) + normal.abs().dot(half) + distance;
            let slack = SLACK * (normal.abs().dot(size) + distance.abs());
            // Written so that NaN may be reached.
            !(farthest < -slack)
        })
    }
}
