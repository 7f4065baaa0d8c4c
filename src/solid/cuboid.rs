//! The cuboid as users state it.

use glam::DVec3;

use super::Cylinder;
use crate::math::Orientation;

/// A box that may be turned: its centre, half of its width along each of its own
/// axes, and its orientation, all taken as exact numbers.
///
/// With `f` the columns of [`Orientation::world_from_object`], the solid is
/// `{x : |f_i · (x - centre)| <= half_widths_i}` and the surface its boundary, six
/// faces named by their own axis and side. The columns of a turned cuboid are
/// orthonormal to within roundings, and taken as they are.
///
/// A point on an edge or a corner belongs to the face that is first of x, y, z,
/// whichever way a ray passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    centre: DVec3,
    half_widths: DVec3,
    orientation: Orientation,
}

/// Why numbers are not a cuboid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CuboidError {
    /// A coordinate of the centre is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the centre is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", centre.x, centre.y, centre.z, Cylinder::GREATEST)]
    Centre {
        /// The centre as given.
        centre: DVec3,
    },
    /// A half width is not a number in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "the half width along {axis} is {half_width:?}: it must be a positive number between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    HalfWidth {
        /// `"x"`, `"y"` or `"z"`, an axis of the cuboid.
        axis: &'static str,
        /// The half width as given.
        half_width: f64,
    },
}

impl Cuboid {
    /// The cuboid around `centre` that reaches `half_widths` along its own axes.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(
        centre: DVec3,
        half_widths: DVec3,
        orientation: Orientation,
    ) -> Result<Self, CuboidError> {
        if !Cylinder::is_in_range(centre) {
            return Err(CuboidError::Centre { centre });
        }
        for (axis, half_width) in ["x", "y", "z"].into_iter().zip(half_widths.to_array()) {
            if !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&half_width) {
                return Err(CuboidError::HalfWidth { axis, half_width });
            }
        }
        Ok(Self::from_valid(centre, half_widths, orientation))
    }

    /// The cuboid of numbers that [`Cuboid::new`] accepted before.
    #[inline]
    pub(crate) fn from_valid(centre: DVec3, half_widths: DVec3, orientation: Orientation) -> Self {
        Self {
            centre,
            half_widths,
            orientation,
        }
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Half of the width along each of its own axes, positive.
    #[must_use]
    pub fn half_widths(&self) -> DVec3 {
        self.half_widths
    }

    /// Which way it is turned.
    #[must_use]
    pub fn orientation(&self) -> Orientation {
        self.orientation
    }
}
