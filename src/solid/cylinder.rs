//! The circular cylinder as users state it.

use glam::DVec3;

/// Which ends of a cylinder are closed by a disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Caps {
    /// A tube, open at both ends.
    None,
    /// A disc at `p0` only.
    P0,
    /// A disc at `p1` only.
    P1,
    /// Discs at both ends.
    #[default]
    Both,
}

impl Caps {
    /// Whether there is a disc at `p0`.
    #[must_use]
    pub fn at_p0(self) -> bool {
        matches!(self, Self::P0 | Self::Both)
    }

    /// Whether there is a disc at `p1`.
    #[must_use]
    pub fn at_p1(self) -> bool {
        matches!(self, Self::P1 | Self::Both)
    }
}

/// The surface of a circular cylinder: two endpoints, a radius and its caps,
/// all taken as exact numbers.
///
/// The solid is `{x : dist(x, line p0 p1) <= radius, 0 <= (x - p0)·(p1 - p0) <= |p1 - p0|²}`;
/// the surface is its wall and those of its discs that `caps` names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    p0: DVec3,
    p1: DVec3,
    radius: f64,
    caps: Caps,
}

/// Why numbers are not a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CylinderError {
    /// A coordinate of an endpoint is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("{which} is ({}, {}, {}): every coordinate must be finite and at most {:e} in size", point.x, point.y, point.z, Cylinder::GREATEST)]
    Endpoint {
        /// `"p0"` or `"p1"`.
        which: &'static str,
        /// The endpoint as given.
        point: DVec3,
    },
    /// The radius is not a number in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "radius is {radius}: it must be a positive number between {:e} and {:e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Radius {
        /// The radius as given.
        radius: f64,
    },
    /// The endpoints are the same, or nearer than [`Cylinder::LEAST`].
    #[error(
        "p0 and p1 are {length:e} apart: a cylinder needs a length of at least {:e}",
        Cylinder::LEAST
    )]
    Length {
        /// The distance between the endpoints.
        length: f64,
    },
}

impl Cylinder {
    /// The least radius and length: about 6.2e-61. Below it, products of four
    /// lengths would lose bits to f64 underflow.
    pub const LEAST: f64 = 1.0 / Self::GREATEST;
    /// The greatest radius and coordinate: 2^200, about 1.6e60. Above it,
    /// products of four lengths would overflow f64.
    pub const GREATEST: f64 = (1_u128 << 100) as f64 * (1_u128 << 100) as f64;

    /// The cylinder from `p0` to `p1`.
    ///
    /// # Errors
    /// When a number is not finite or out of range, or the ends coincide.
    pub fn new(p0: DVec3, p1: DVec3, radius: f64, caps: Caps) -> Result<Self, CylinderError> {
        for (which, point) in [("p0", p0), ("p1", p1)] {
            if !(point.abs().max_element() <= Self::GREATEST) || !point.is_finite() {
                return Err(CylinderError::Endpoint { which, point });
            }
        }
        if !(Self::LEAST..=Self::GREATEST).contains(&radius) {
            return Err(CylinderError::Radius { radius });
        }
        let length = (p1 - p0).length();
        if length < Self::LEAST {
            return Err(CylinderError::Length { length });
        }
        Ok(Self {
            p0,
            p1,
            radius,
            caps,
        })
    }

    /// The first endpoint.
    #[must_use]
    pub fn p0(&self) -> DVec3 {
        self.p0
    }

    /// The second endpoint.
    #[must_use]
    pub fn p1(&self) -> DVec3 {
        self.p1
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The closed ends.
    #[must_use]
    pub fn caps(&self) -> Caps {
        self.caps
    }
}
