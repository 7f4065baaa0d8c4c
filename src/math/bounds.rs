//! Axis-aligned boxes in f64 that are rounded outward.

use glam::DVec3;

/// The closed box `lower <= x <= upper`, axis by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub lower: DVec3,
    /// Greatest coordinates.
    pub upper: DVec3,
}

impl Bounds {
    /// The box that holds nothing; the neutral element of [`Bounds::union`].
    pub const EMPTY: Self = Self {
        lower: DVec3::INFINITY,
        upper: DVec3::NEG_INFINITY,
    };

    /// Whether no point lies in the box.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.lower.cmple(self.upper).all()
    }

    /// The least box that holds both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            lower: self.lower.min(other.lower),
            upper: self.upper.max(other.upper),
        }
    }

    /// The middle of a box that is not empty, rounded.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.lower * 0.5 + self.upper * 0.5
    }

    /// The edge lengths of a box that is not empty, rounded.
    #[must_use]
    pub fn extent(&self) -> DVec3 {
        self.upper - self.lower
    }
}
