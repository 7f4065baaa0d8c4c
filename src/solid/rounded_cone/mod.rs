//! The rounded cone as users define it.

mod quick;
mod solver;
mod surface;

use glam::DVec3;

use super::cone::Ends;
use super::cone::taper::{Fit, Measures, Taper};
use super::cylinder::middle;
use super::exact::{self, Expression, Number, difference, dot};
use super::offset::{Between, Offset};
use super::quick::{Quick, Range};
use super::reject::Line;
use super::{
    Chord, ConeError, ConvexSolid, Location, Part, RayOrigin, SolidKind, SurfacePoint, ball,
};
use crate::math::Bounds;

/// The surface of the convex hull of two balls: two centers and a radius each, all taken as
/// exact numbers.
///
/// A ball sweeps this solid if its radius changes linearly from `p0` to `p1`: two spheres and
/// the cone that touches both, with no edge between them. If one ball contains the other, the
/// solid is that ball. A radius may be zero, and the centers may coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCone {
    ends: Ends,
}

/// Why numbers do not define a rounded cone: one of them is out of the range of a
/// [`Cone`](super::Cone)'s, or both radii are zero.
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
        Ok(Self {
            ends: Ends::new(p0, p1, radius0, radius1)?,
        })
    }

    /// The first center.
    #[must_use]
    pub fn p0(&self) -> DVec3 {
        self.ends.p0
    }

    /// The second center.
    #[must_use]
    pub fn p1(&self) -> DVec3 {
        self.ends.p1
    }

    /// The radius of the ball around `p0`, not negative.
    #[must_use]
    pub fn radius0(&self) -> f64 {
        self.ends.radius0
    }

    /// The radius of the ball around `p1`, not negative.
    #[must_use]
    pub fn radius1(&self) -> f64 {
        self.ends.radius1
    }

    /// The chord of a line, with the origin relative to both ends. Whether one ball contains
    /// the other is decided by the rounded axis first, since that decides whether the surface
    /// has a wall.
    fn chord_of<A: Offset>(
        &self,
        taper: &Taper<A>,
        from_p0: impl Offset,
        from_p1: impl Offset,
        direction: DVec3,
    ) -> Option<Chord> {
        if self.rejects_from_ends([from_p0.rounded(), from_p1.rounded()], direction) {
            return None;
        }
        if self.taper().is_some() && taper.beta() > 0.0 {
            return solver::chord(taper, from_p0, from_p1, direction);
        }
        let (radius0, radius1) = (self.ends.radius0, self.ends.radius1);
        if radius0 >= radius1 {
            ball::chord(from_p0, direction, radius0, Part::Cap0)
        } else {
            ball::chord(from_p1, direction, radius1, Part::Cap1)
        }
    }

    /// Whether a line certainly misses, with the origin relative to both ends. The offset from
    /// the second end may be the difference of rounded ones: either the hull is within the
    /// infinite wall, whose test has bounds for it, or one ball contains it, with a radius of
    /// at least the length of the axis.
    #[inline(always)]
    fn rejects_from_ends(&self, [from_p0, from_p1]: [DVec3; 2], direction: DVec3) -> bool {
        let Ends {
            radius0, radius1, ..
        } = self.ends;
        let [from_p0, from_p1] = [from_p0, from_p1].map(|x| Line::new(x, direction));
        from_p0.misses_ball(radius0)
            & from_p1.misses_ball(radius1)
            & from_p0.misses_wall(&self.ends.taper(Fit::Balls))
    }
}

impl ConvexSolid for RoundedCone {
    const KIND: SolidKind = SolidKind::RoundedCone;

    /// In lanes, the offset from the second ball is a difference of rounded offsets.
    const QUICK_IS_EXACT: bool = false;

    fn bounds(&self) -> Bounds {
        let Ends {
            p0,
            p1,
            radius0,
            radius1,
        } = self.ends;
        Bounds {
            lower: (p0 - radius0).min(p1 - radius1),
            upper: (p0 + radius0).max(p1 + radius1),
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

    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        let taper = self.ends.taper(Fit::Balls);
        let from_p1 = Between {
            from: taper.a,
            to: from_anchor,
        };
        self.chord_of(&taper, from_anchor, from_p1, direction)
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        let taper = self.ends.exact_taper(Fit::Balls);
        let [from_p0, from_p1] = [self.p0(), self.p1()].map(|end| origin.offset_from(end));
        self.chord_of(&taper, from_p0, from_p1, direction)
    }

    #[inline(always)]
    fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        let from_p1 = from_anchor - self.ends.axis();
        self.rejects_from_ends([from_anchor, from_p1], direction)
    }

    #[inline(always)]
    fn quick_first(&self, from_anchor: DVec3, direction: DVec3, range: &Range) -> Quick {
        quick::first(self, from_anchor, direction, range)
    }

    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        surface::surface_point(self, part, from_anchor)
    }

    fn locate(&self, point: DVec3) -> Location {
        let within = |limit| {
            let solid = self;
            Location::of_sign(exact::sign(&Beyond {
                solid,
                point,
                limit,
            }))
        };
        let Ends {
            p0,
            p1,
            radius0,
            radius1,
        } = self.ends;
        let balls = ball::locate(p0, radius0, point).max(ball::locate(p1, radius1, point));
        // The disks at the seams are inside of the balls except for their rims, so the first
        // need not be tested. If one ball contains the other, no height is beyond the one seam
        // and not beyond the other.
        if balls == Location::Inside
            || !point.is_finite()
            || within(Limit::Seam0) != Location::Inside
        {
            return balls;
        }
        let between = within(Limit::Seam1);
        match between {
            Location::Outside => balls,
            _ => balls.max(between.min(within(Limit::Wall))),
        }
    }

    /// A seam is on the surface of its sphere and on that of the wall. Neither ball contains
    /// the other.
    fn is_on(&self, part: Part, point: DVec3) -> bool {
        let beyond = |limit| {
            let solid = self;
            exact::sign(&Beyond {
                solid,
                point,
                limit,
            })
        };
        match part {
            Part::Cap0 => beyond(Limit::Seam0).is_ge(),
            Part::Cap1 => beyond(Limit::Seam1).is_ge(),
            _ => beyond(Limit::Seam0).is_le() && beyond(Limit::Seam1).is_le(),
        }
    }

    fn size(&self) -> f64 {
        self.ends.size()
    }
}

#[derive(Clone, Copy, Debug)]
enum Limit {
    Seam0,
    Seam1,
    Wall,
}

/// Positive if the point is beyond a limit of the wall's part of the solid.
struct Beyond<'a> {
    solid: &'a RoundedCone,
    point: DVec3,
    limit: Limit,
}

impl Expression for Beyond<'_> {
    fn value<N: Number>(&self) -> N {
        let solid = self.solid;
        let (a, x) = (
            difference::<N>(solid.ends.p1, solid.ends.p0),
            difference(self.point, solid.ends.p0),
        );
        let (r0, r1) = (solid.ends.radius0, solid.ends.radius1);
        let measures = Measures::new(&a, r0, r1, Fit::Balls);
        let z = || dot(&x, &a).plus(&N::of(r0).times(&measures.delta));
        match self.limit {
            Limit::Seam0 => N::of(0.0).minus(&z()),
            Limit::Seam1 => z().minus(&measures.beta),
            Limit::Wall => measures.outside(&a, &x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn ball_that_holds_the_other_is_the_rounded_cone() {
        let (p0, p1) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, 5.0));
        for (p1, radius1, part) in [
            (p1, 1.0, Part::Cap0),
            (p1, 5.0, Part::Cap1),
            (p0, 3.0, Part::Cap0),
        ] {
            let solid = RoundedCone::new(p0, p1, 3.0, radius1).unwrap();
            let chord = solid.chord(DVec3::new(-10.0, 0.0, 0.0), DVec3::X).unwrap();
            assert_eq!((chord.enter.part, chord.leave.part), (part, part));
            let outer = RoundedCone::new(
                if part == Part::Cap0 { p0 } else { p1 },
                if part == Part::Cap0 { p0 } else { p1 },
                if part == Part::Cap0 { 3.0 } else { 5.0 },
                0.0,
            );
            let outer = outer.unwrap();
            for index in 0..1000 {
                let mut random = Random::new(23, index);
                let point = p0 + random.direction() * random.uniform(2.5, 7.5);
                assert_eq!(solid.contains(point), outer.contains(point));
            }
        }
    }

    #[test]
    fn ends_may_coincide_but_one_radius_is_positive() {
        let rounded = |r0, r1| RoundedCone::new(DVec3::ZERO, DVec3::ZERO, r0, r1);
        assert!(rounded(1.0, 2.0).is_ok());
        assert!(rounded(0.0, 0.0).is_err());
    }
}
