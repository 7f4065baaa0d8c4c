//! The circular cylinder as users define it.

mod convex;

use glam::DVec3;

use super::Caps;
use crate::math::{Bounds, UNIT_ROUNDOFF, power_of_two};

/// The surface of a circular cylinder: two endpoints, a radius and its caps, all taken as exact
/// numbers.
///
/// The solid is `{x : dist(x, line p0 p1) <= radius, 0 <= (x - p0)·(p1 - p0) <= |p1 - p0|²}`.
/// The surface consists of its wall and those of its disks that `caps` names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    p0: DVec3,
    p1: DVec3,
    radius: f64,
    caps: Caps,
}

/// Why numbers do not define a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CylinderError {
    /// A coordinate of an endpoint is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("{which} is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", point.x, point.y, point.z, Cylinder::GREATEST)]
    Endpoint {
        /// `"p0"` or `"p1"`.
        which: &'static str,
        /// The endpoint as given.
        point: DVec3,
    },
    /// The radius is not in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "radius is {radius:?}: it must be a positive number between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Radius {
        /// The radius as given.
        radius: f64,
    },
    /// The endpoints are the same, or nearer than [`Cylinder::LEAST`].
    #[error(
        "p0 and p1 are {length:?} apart: a cylinder needs a length of at least {:.1e}",
        Cylinder::LEAST
    )]
    Length {
        /// The distance between the endpoints.
        length: f64,
    },
}

impl Cylinder {
    /// The least radius and length: 2^-150, about 7.0e-46, below the least number of f32. Below
    /// it, products of four lengths and two directions would lose bits to underflow.
    pub const LEAST: f64 = power_of_two(-150);
    /// The greatest radius and size of a coordinate: 2^150, about 1.4e45, above the greatest
    /// number of f32. Above it, the same products overflow.
    pub const GREATEST: f64 = power_of_two(150);

    /// The cylinder from `p0` to `p1`.
    ///
    /// # Errors
    /// When a number is not finite or out of range, or the ends coincide.
    pub fn new(p0: DVec3, p1: DVec3, radius: f64, caps: Caps) -> Result<Self, CylinderError> {
        for (which, point) in [("p0", p0), ("p1", p1)] {
            if !Self::is_in_range(point) {
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

    /// Whether every coordinate is at most [`Cylinder::GREATEST`] in size, and not NaN.
    pub(crate) fn is_in_range(point: DVec3) -> bool {
        point.is_finite() && point.abs().max_element() <= Self::GREATEST
    }

    /// The cylinder of numbers that [`Cylinder::new`] accepts, without the check. The results
    /// for a cylinder of other numbers have no meaning.
    #[inline]
    #[must_use]
    pub fn from_valid(p0: DVec3, p1: DVec3, radius: f64, caps: Caps) -> Self {
        Self {
            p0,
            p1,
            radius,
            caps,
        }
    }

    /// The same cylinder with other caps.
    #[inline]
    #[must_use]
    pub fn with_caps(self, caps: Caps) -> Self {
        Self { caps, ..self }
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

    /// The least box that contains the solid, rounded outward by a few ulps.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let reach = disk_reach(self.p1 - self.p0, self.radius);
        Bounds {
            lower: self.p0.min(self.p1) - reach,
            upper: self.p0.max(self.p1) + reach,
        }
        .rounded_outward()
    }
}

/// The middle between two points. Halves are exact, so only their sum is rounded.
pub(super) fn middle(p0: DVec3, p1: DVec3) -> DVec3 {
    p0 * 0.5 + p1 * 0.5
}

/// The extent of a disk across the axis `a` from its center, along each coordinate axis,
/// rounded up.
///
/// Along axis `i` that is `radius √(1 - aᵢ²/|a|²)`. Written as `radius √((aⱼ² + aₖ²)/|a|²)`
/// nothing cancels, and the relative error is below 8 roundings, which the factor on the radius
/// covers.
pub(super) fn disk_reach(a: DVec3, radius: f64) -> DVec3 {
    let squared = a * a;
    let others = DVec3::new(
        squared.y + squared.z,
        squared.z + squared.x,
        squared.x + squared.y,
    );
    let sine = (others / a.length_squared()).map(f64::sqrt).min(DVec3::ONE);
    sine * (radius * (1.0 + 10.0 * UNIT_ROUNDOFF))
}
