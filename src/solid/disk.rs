//! The flat disk as users state it.

use glam::DVec3;

use super::Cylinder;

/// A flat disk: its centre, a normal of any length and its radius, taken as
/// exact numbers.
///
/// It is the closed set `{x : normal · (x - centre) = 0, |x - centre| <= radius}`,
/// a solid without an inside: a ray that passes through it meets it in one
/// point, an entry and an exit at the same `t`. All of it is
/// [`Part::Side`](super::Part::Side).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    centre: DVec3,
    normal: DVec3,
    radius: f64,
}

/// Why numbers are not a disk.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DiskError {
    /// A coordinate of the centre is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the centre is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", centre.x, centre.y, centre.z, Cylinder::GREATEST)]
    Centre {
        /// The centre as given.
        centre: DVec3,
    },
    /// The normal is zero or not finite, or its greatest coordinate is out of
    /// [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "the normal is ({:?}, {:?}, {:?}): its greatest coordinate must be between {:.1e} and {:.1e} in size", normal.x, normal.y, normal.z,
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Normal {
        /// The normal as given.
        normal: DVec3,
    },
    /// The radius is not a number in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "radius is {radius:?}: it must be a positive number between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Radius {
        /// The radius as given.
        radius: f64,
    },
}

impl Disk {
    /// The disk around `centre` across `normal`.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(centre: DVec3, normal: DVec3, radius: f64) -> Result<Self, DiskError> {
        let range = Cylinder::LEAST..=Cylinder::GREATEST;
        if !Cylinder::is_in_range(centre) {
            return Err(DiskError::Centre { centre });
        }
        if !normal.is_finite() || !range.contains(&normal.abs().max_element()) {
            return Err(DiskError::Normal { normal });
        }
        if !range.contains(&radius) {
            return Err(DiskError::Radius { radius });
        }
        Ok(Self::from_valid(centre, normal, radius))
    }

    /// The disk of numbers that [`Disk::new`] accepted before.
    #[inline]
    pub(crate) fn from_valid(centre: DVec3, normal: DVec3, radius: f64) -> Self {
        Self {
            centre,
            normal,
            radius,
        }
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// The normal as stated, of any length.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}
