//! The ends of a cone or a rounded cone: two points with a radius each.

use glam::DVec3;

use super::taper::{Fit, Taper};
use crate::solid::Cylinder;
use crate::solid::offset::{Between, ExactOffset};

/// Two points and the radius at either, all taken as exact numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) struct Ends {
    pub p0: DVec3,
    pub p1: DVec3,
    pub radius0: f64,
    pub radius1: f64,
}

/// Why numbers do not define a cone.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ConeError {
    /// A coordinate of an endpoint is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("{which} is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", point.x, point.y, point.z, Cylinder::GREATEST)]
    Endpoint {
        /// `"p0"` or `"p1"`.
        which: &'static str,
        /// The endpoint as given.
        point: DVec3,
    },
    /// A radius is neither zero nor in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "{which} is {radius:?}: it must be zero or between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Radius {
        /// `"radius0"` or `"radius1"`.
        which: &'static str,
        /// The radius as given.
        radius: f64,
    },
    /// Both radii are zero.
    #[error("radius0 and radius1 are both zero: one of them must be positive")]
    NoRadius,
    /// The endpoints are the same, or nearer than [`Cylinder::LEAST`].
    #[error(
        "p0 and p1 are {length:?} apart: a cone needs a length of at least {:.1e}",
        Cylinder::LEAST
    )]
    Length {
        /// The distance between the endpoints.
        length: f64,
    },
}

impl Ends {
    /// The ends of a solid.
    ///
    /// # Errors
    /// When one of the numbers is out of range, or both radii are zero. The points may
    /// coincide.
    pub fn new(p0: DVec3, p1: DVec3, radius0: f64, radius1: f64) -> Result<Self, ConeError> {
        for (which, point) in [("p0", p0), ("p1", p1)] {
            if !Cylinder::is_in_range(point) {
                return Err(ConeError::Endpoint { which, point });
            }
        }
        for (which, radius) in [("radius0", radius0), ("radius1", radius1)] {
            if radius != 0.0 && !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&radius) {
                return Err(ConeError::Radius { which, radius });
            }
        }
        if radius0 == 0.0 && radius1 == 0.0 {
            return Err(ConeError::NoRadius);
        }
        Ok(Self {
            p0,
            p1,
            // Turns -0 into 0.
            radius0: radius0.abs(),
            radius1: radius1.abs(),
        })
    }

    /// The offset from the first point to the second, rounded.
    #[inline(always)]
    pub fn axis(&self) -> DVec3 {
        self.p1 - self.p0
    }

    /// The distance between the points.
    pub fn length(&self) -> f64 {
        self.axis().length()
    }

    /// The sum of the length and the greater diameter.
    pub fn size(&self) -> f64 {
        self.length() + 2.0 * self.radius0.max(self.radius1)
    }

    /// As [`Ends::taper`], with the exact axis.
    pub fn exact_taper(&self, fit: Fit) -> Taper<ExactOffset> {
        let axis = Between {
            from: self.p0,
            to: self.p1,
        };
        Taper {
            a: axis.exact(),
            radius0: self.radius0,
            radius1: self.radius1,
            fit,
        }
    }

    /// The cone's wall with these ends.
    #[inline(always)]
    pub fn taper(&self, fit: Fit) -> Taper {
        Taper {
            a: self.axis(),
            radius0: self.radius0,
            radius1: self.radius1,
            fit,
        }
    }
}
