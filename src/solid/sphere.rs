//! The sphere as users state it.

use glam::DVec3;

use super::Cylinder;

/// A sphere: its centre and radius, taken as exact numbers. The solid is
/// `{x : |x - centre| <= radius}`, the surface its boundary, all of it
/// [`Part::Side`](super::Part::Side).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: DVec3,
    radius: f64,
}

/// Why numbers are not a sphere.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// A coordinate of the centre is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the centre is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", centre.x, centre.y, centre.z, Cylinder::GREATEST)]
    Centre {
        /// The centre as given.
        centre: DVec3,
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

impl Sphere {
    /// The sphere around `centre`.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, SphereError> {
        if !Cylinder::is_in_range(centre) {
            return Err(SphereError::Centre { centre });
        }
        if !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&radius) {
            return Err(SphereError::Radius { radius });
        }
        Ok(Self::from_valid(centre, radius))
    }

    /// The sphere of numbers that [`Sphere::new`] accepted before.
    #[inline]
    pub(crate) fn from_valid(centre: DVec3, radius: f64) -> Self {
        Self { centre, radius }
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}
