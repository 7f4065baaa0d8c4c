//! The part of space that the camera's rays cover, and so the picture can show.

use glam::DVec3;

use crate::math::{Bounds, power_of_two};

/// How far a box has to be outside, relative to the size of the numbers subtracted
/// in the test: about a hundred times the rounding errors of the test and of rays
/// through the picture's edge.
const SLACK: f64 = power_of_two(-40);

/// The space between four planes through the edges of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewVolume {
    eye: DVec3,
    /// The inward normals of the planes, and the distances of the planes from the eye
    /// along them.
    sides: [(DVec3, f64); 4],
}

impl ViewVolume {
    /// The points with `normal · (point - eye) + distance >= 0` for all sides.
    pub(super) fn new(eye: DVec3, sides: [(DVec3, f64); 4]) -> Self {
        Self { eye, sides }
    }

    /// Whether any ray of the camera may reach a box; false only if none does.
    #[must_use]
    pub fn may_reach(&self, bounds: &Bounds) -> bool {
        let (center, half) = (bounds.center() - self.eye, bounds.extent() * 0.5);
        let size = bounds.lower.abs().max(bounds.upper.abs()) + self.eye.abs();
        self.sides.iter().all(|(normal, distance)| {
            let farthest = normal.dot(center) + normal.abs().dot(half) + distance;
            let slack = SLACK * (normal.abs().dot(size) + distance.abs());
            // Written so that NaN counts as reachable.
            !(farthest < -slack)
        })
    }
}
