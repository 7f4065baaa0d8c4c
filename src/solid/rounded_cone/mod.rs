//! The rounded cone as users state it.

use glam::DVec3;

use super::ConeError;
use super::cone::check_ends;

/// The surface of the convex hull of two balls: two centres and a radius each,
/// all taken as exact numbers.
///
/// It is what a ball sweeps whose radius changes evenly on its way from `p0` to
/// `p1`: two spheres and the cone that touches both, with no edge between them.
/// Where one ball holds the other, it is that ball. A radius may be zero, and the
/// centres may coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCone {
    p0: DVec3,
    p1: DVec3,
    radius0: f64,
    radius1: f64,
}

/// Why numbers are not a rounded cone: one of them is out of the range that a
/// [`Cone`](super::Cone)'s have, or both radii are zero.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(transparent)]
pub struct RoundedConeError(#[from] pub ConeError);

impl RoundedCone {
    /// The hull of the balls around `p0` and `p1`.
    ///
    /// # Errors
    /// When a number is not finite or out of range, a radius is negative or both
    /// are zero.
    pub fn new(p0: DVec3, p1: DVec3, radius0: f64, radius1: f64) -> Result<Self, RoundedConeError> {
        check_ends(p0, p1, radius0, radius1)?;
        // A radius of -0 is one of 0.
        Ok(Self::from_valid(p0, p1, radius0.abs(), radius1.abs()))
    }

    /// The rounded cone of numbers that [`RoundedCone::new`] accepted before.
    #[inline]
    pub(crate) fn from_valid(p0: DVec3, p1: DVec3, radius0: f64, radius1: f64) -> Self {
        Self {
            p0,
            p1,
            radius0,
            radius1,
        }
    }

    /// The first centre.
    #[must_use]
    pub fn p0(&self) -> DVec3 {
        self.p0
    }

    /// The second centre.
    #[must_use]
    pub fn p1(&self) -> DVec3 {
        self.p1
    }

    /// The radius of the ball around `p0`, not negative.
    #[must_use]
    pub fn radius0(&self) -> f64 {
        self.radius0
    }

    /// The radius of the ball around `p1`, not negative.
    #[must_use]
    pub fn radius1(&self) -> f64 {
        self.radius1
    }
}
