//! The sphere as users define it. `ball` has its solver.

use glam::DVec3;

use super::quick::{Quick, Range};
use super::reject::Line;
use super::surface::FirstParameter;
use super::{
    Chord, ConvexSolid, Cylinder, Location, Part, RayOrigin, SolidKind, SurfacePoint, ball,
};
use crate::math::{Bounds, UNIT_ROUNDOFF, unit};

/// A sphere: its center and radius, taken as exact numbers. The solid is
/// `{x : |x - center| <= radius}`, the surface its boundary, all of it
/// [`Part::Side`](super::Part::Side).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

/// Why numbers do not define a sphere.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// A coordinate of the center is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the center is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", center.x, center.y, center.z, Cylinder::GREATEST)]
    Center {
        /// The center as given.
        center: DVec3,
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
}

impl Sphere {
    /// The sphere around `center`.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(center: DVec3, radius: f64) -> Result<Self, SphereError> {
        if !Cylinder::is_in_range(center) {
            return Err(SphereError::Center { center });
        }
        if !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&radius) {
            return Err(SphereError::Radius { radius });
        }
        Ok(Self::from_valid(center, radius))
    }

    /// The sphere of numbers that [`Sphere::new`] has accepted before.
    #[inline]
    pub(crate) fn from_valid(center: DVec3, radius: f64) -> Self {
        Self { center, radius }
    }

    /// The center.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl ConvexSolid for Sphere {
    const KIND: SolidKind = SolidKind::Sphere;

    fn bounds(&self) -> Bounds {
        Bounds {
            lower: self.center - self.radius,
            upper: self.center + self.radius,
        }
        .rounded_outward()
    }

    fn anchor(&self) -> DVec3 {
        self.center
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    #[inline]
    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        ball::chord(from_anchor, direction, self.radius, Part::Side)
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        let x = origin.offset_from(self.center);
        ball::chord(x, direction, self.radius, Part::Side)
    }

    #[inline(always)]
    fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        Line::new(from_anchor, direction).misses_ball(self.radius)
    }

    #[inline(always)]
    fn quick_first(&self, from_anchor: DVec3, direction: DVec3, range: &Range) -> Quick {
        ball::quick_first(from_anchor, direction, self.radius, range)
    }

    /// `u` is the angle about z, from x towards y, in turns, and 0 at the poles. `v` is the
    /// share of the height, 0 at the least z.
    ///
    /// The outward unit vector is `q / |q|`, with `q` first divided by its greatest component:
    /// its length is off by less than 6 u, the product with the radius and the sum with the
    /// center by u of theirs. At the center itself, which has no nearest point, it is z.
    fn surface_point(&self, _: Part, from_anchor: DVec3) -> SurfacePoint {
        let normal = unit(from_anchor).unwrap_or(DVec3::Z);
        let point = self.center + normal * self.radius;
        SurfacePoint {
            point,
            error: UNIT_ROUNDOFF * (point.length() + 8.0 * self.radius),
            normal,
            v: (0.5 + 0.5 * normal.z).clamp(0.0, 1.0),
            // About z, angles count from x.
            first: FirstParameter::Angle {
                axis: DVec3::Z,
                outward: normal,
            },
        }
    }

    fn locate(&self, point: DVec3) -> Location {
        ball::locate(self.center, self.radius, point)
    }

    fn is_on(&self, part: Part, _: DVec3) -> bool {
        part == Part::Side
    }

    fn size(&self) -> f64 {
        2.0 * self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_their_angle_and_height() {
        let sphere = Sphere::new(DVec3::new(1.0, 2.0, 3.0), 2.0).unwrap();
        for (from, u, v) in [
            (DVec3::X, 0.0, 0.5),
            (DVec3::Y * 1e-200, 0.25, 0.5),
            (DVec3::NEG_X, 0.5, 0.5),
            (DVec3::NEG_Y * 1e200, 0.75, 0.5),
            (DVec3::Z, 0.0, 1.0),
            (DVec3::NEG_Z, 0.0, 0.0),
            (-DVec3::ZERO, 0.0, 1.0),
        ] {
            let found = sphere.surface_point(Part::Side, from);
            assert_eq!((found.u(), found.v), (u, v), "{from}");
            assert_eq!(found.point, sphere.center + found.normal * 2.0, "{from}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let least = Cylinder::LEAST;
        assert!(Sphere::new(DVec3::ZERO, least).is_ok());
        for radius in [least.next_down(), 0.0, -1.0, f64::NAN, f64::INFINITY] {
            let refused = Sphere::new(DVec3::ZERO, radius);
            assert!(matches!(refused, Err(SphereError::Radius { .. })));
        }
        for x in [1e46, f64::NAN, f64::NEG_INFINITY] {
            let refused = Sphere::new(DVec3::X * x, 1.0);
            assert!(matches!(refused, Err(SphereError::Center { .. })));
        }
    }
}
