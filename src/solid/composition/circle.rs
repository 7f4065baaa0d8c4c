//! A piece as a circle on the sphere of directions.

use glam::DVec3;

use super::piece::Piece;

/// The circle of a group, as `n k + √(1 - k²) (cos φ x + sin φ y)`.
pub(super) struct Circle {
    pub middle: DVec3,
    pub x: DVec3,
    pub y: DVec3,
}

impl Circle {
    pub fn new(piece: &Piece) -> Self {
        let (x, y) = piece.normal.any_orthonormal_pair();
        let radius = (1.0 - piece.cosine * piece.cosine).sqrt();
        Self {
            middle: piece.normal * piece.cosine,
            x: x * radius,
            y: y * radius,
        }
    }

    /// The direction at an angle.
    pub fn at(&self, angle: f64) -> DVec3 {
        self.middle + self.x * libm::cos(angle) + self.y * libm::sin(angle)
    }
}
