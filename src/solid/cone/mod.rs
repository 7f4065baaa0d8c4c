//! The truncated cone as users define it.

mod ends;
pub(super) mod heights;
pub(super) mod quick;
mod roots;
mod rounded;
pub(super) mod solver;
mod surface;
pub(super) mod taper;
pub(super) mod wall;

use glam::DVec3;

use super::cylinder::{disk_reach, middle};
use super::exact::{self, Expression, Number, difference, dot};
use super::offset::Offset;
use super::quick::{Quick, Range};
use super::reject::Line;
use super::{
    Caps, Chord, ConvexSolid, Cylinder, Location, Part, RayOrigin, SolidKind, SurfacePoint,
    triple_product,
};
use crate::math::Bounds;
pub use ends::ConeError;
pub(super) use ends::Ends;
use taper::{Fit, Measures};

/// The surface of a part of a circular cone: two endpoints, the radius at each and its caps,
/// all taken as exact numbers.
///
/// With `a = p1 - p0`, the solid is the set of points `x` whose axial position
/// `h = (x - p0)·a / |a|²` is in `[0, 1]` and whose distance from the line `p0 p1` is at most
/// `radius0 + h (radius1 - radius0)`. The surface consists of its wall and those of its disks
/// that `caps` names. One radius may be zero: the disk there is a point, the apex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    ends: Ends,
    caps: Caps,
}

impl Cone {
    /// The cone from `p0` to `p1`.
    ///
    /// # Errors
    /// When a number is not finite or out of range, the ends coincide, a radius
    /// is negative or both are zero.
    pub fn new(
        p0: DVec3,
        p1: DVec3,
        radius0: f64,
        radius1: f64,
        caps: Caps,
    ) -> Result<Self, ConeError> {
        let ends = Ends::new(p0, p1, radius0, radius1)?;
        let length = ends.length();
        if length < Cylinder::LEAST {
            return Err(ConeError::Length { length });
        }
        Ok(Self { ends, caps })
    }

    /// The cone of numbers that [`Cone::new`] has accepted before.
    #[inline]
    pub(crate) fn from_valid(p0: DVec3, p1: DVec3, radius0: f64, radius1: f64, caps: Caps) -> Self {
        let ends = Ends {
            p0,
            p1,
            radius0,
            radius1,
        };
        Self { ends, caps }
    }

    /// The same cone with other caps.
    #[must_use]
    pub fn with_caps(self, caps: Caps) -> Self {
        Self { caps, ..self }
    }

    /// The first endpoint.
    #[must_use]
    pub fn p0(&self) -> DVec3 {
        self.ends.p0
    }

    /// The second endpoint.
    #[must_use]
    pub fn p1(&self) -> DVec3 {
        self.ends.p1
    }

    /// The radius at `p0`, not negative.
    #[must_use]
    pub fn radius0(&self) -> f64 {
        self.ends.radius0
    }

    /// The radius at `p1`, not negative.
    #[must_use]
    pub fn radius1(&self) -> f64 {
        self.ends.radius1
    }

    /// The closed ends.
    #[must_use]
    pub fn caps(&self) -> Caps {
        self.caps
    }

    /// The same solid as a cylinder, if the radii are equal.
    fn as_cylinder(&self) -> Option<Cylinder> {
        let Ends {
            p0,
            p1,
            radius0,
            radius1,
        } = self.ends;
        (radius0 == radius1).then(|| Cylinder::from_valid(p0, p1, radius0, Caps::Both))
    }
}

impl Cylinder {
    /// The cone with equal radii that is the same set.
    pub(super) fn as_cone(&self) -> Cone {
        let (radius, caps) = (self.radius(), self.caps());
        Cone::from_valid(self.p0(), self.p1(), radius, radius, caps)
    }
}

impl ConvexSolid for Cone {
    const KIND: SolidKind = SolidKind::Cone;

    fn bounds(&self) -> Bounds {
        let Ends {
            p0,
            p1,
            radius0,
            radius1,
        } = self.ends;
        let (reach0, reach1) = (disk_reach(p1 - p0, radius0), disk_reach(p1 - p0, radius1));
        Bounds {
            lower: (p0 - reach0).min(p1 - reach1),
            upper: (p0 + reach0).max(p1 + reach1),
        }
        .rounded_outward()
    }

    fn anchor(&self) -> DVec3 {
        self.ends.p0
    }

    fn center(&self) -> DVec3 {
        middle(self.p0(), self.p1())
    }

    fn radius(&self) -> f64 {
        self.radius0().max(self.radius1())
    }

    fn caps(&self) -> Caps {
        self.caps
    }

    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        if self.rejects(from_anchor, direction) {
            return None;
        }
        match self.as_cylinder() {
            Some(cylinder) => triple_product::chord(&cylinder, from_anchor, direction),
            None => solver::chord(&self.ends.taper(Fit::Disks), from_anchor, direction),
        }
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        let from_p0 = origin.offset_from(self.ends.p0);
        if self.rejects(from_p0.rounded(), direction) {
            return None;
        }
        match self.as_cylinder() {
            Some(cylinder) => cylinder.exact_chord(origin, direction),
            None => solver::chord(&self.ends.exact_taper(Fit::Disks), from_p0, direction),
        }
    }

    #[inline(always)]
    fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        Line::new(from_anchor, direction).misses_wall(&self.ends.taper(Fit::Disks))
    }

    #[inline(always)]
    fn quick_first(&self, from_anchor: DVec3, direction: DVec3, range: &Range) -> Quick {
        quick::first(self, from_anchor, direction, range)
    }

    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        surface::surface_point(self, part, from_anchor)
    }

    fn locate(&self, point: DVec3) -> Location {
        if !point.is_finite() {
            return Location::Outside;
        }
        let cone = self;
        let within = |limit| Location::of_sign(exact::sign(&Beyond { cone, point, limit }));
        // The other nappe is outside of the slab.
        let along = within(Limit::Disk0).min(within(Limit::Disk1));
        match along {
            Location::Outside => along,
            _ => along.min(within(Limit::Wall)),
        }
    }

    fn is_on(&self, part: Part, point: DVec3) -> bool {
        let limit = match part {
            Part::Cap0 => Limit::Disk0,
            Part::Cap1 => Limit::Disk1,
            _ => Limit::Wall,
        };
        let cone = self;
        exact::sign(&Beyond { cone, point, limit }).is_eq()
    }

    fn size(&self) -> f64 {
        self.ends.size()
    }
}

#[derive(Clone, Copy, Debug)]
enum Limit {
    Disk0,
    Disk1,
    Wall,
}

/// Positive if the point is beyond a limit of the solid.
struct Beyond<'a> {
    cone: &'a Cone,
    point: DVec3,
    limit: Limit,
}

impl Expression for Beyond<'_> {
    fn value<N: Number>(&self) -> N {
        let cone = self.cone;
        let (a, x) = (
            difference::<N>(cone.ends.p1, cone.ends.p0),
            difference(self.point, cone.ends.p0),
        );
        match self.limit {
            Limit::Disk0 => N::of(0.0).minus(&dot(&x, &a)),
            Limit::Disk1 => dot(&x, &a).minus(&dot(&a, &a)),
            Limit::Wall => {
                Measures::new(&a, cone.ends.radius0, cone.ends.radius1, Fit::Disks).outside(&a, &x)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_no_cone_are_refused() {
        let new = |p1, r0, r1| Cone::new(DVec3::ZERO, p1, r0, r1, Caps::Both);
        assert!(matches!(new(DVec3::Z, 0.0, 0.0), Err(ConeError::NoRadius)));
        assert!(matches!(
            new(DVec3::ZERO, 1.0, 0.0),
            Err(ConeError::Length { .. })
        ));
        assert!(matches!(
            new(DVec3::Z, -1.0, 1.0),
            Err(ConeError::Radius {
                which: "radius0",
                ..
            })
        ));
        assert!(matches!(
            new(DVec3::Z, 1.0, f64::NAN),
            Err(ConeError::Radius {
                which: "radius1",
                ..
            })
        ));
        assert!(matches!(
            new(DVec3::INFINITY, 1.0, 1.0),
            Err(ConeError::Endpoint { which: "p1", .. })
        ));
        assert!(
            new(DVec3::Z, 1.0, -0.0)
                .unwrap()
                .radius1()
                .is_sign_positive()
        );
    }
}
