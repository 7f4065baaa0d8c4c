//! What every kind of solid implements.
//!
//! Solids are closed convex sets (a disk is one without an inside), so a line is
//! inside one in a single closed interval, its [`Chord`]. Every query of a
//! ray follows from that interval and from which parts of the boundary exist;
//! `chord.rs` has the one step that turns it into hits.

use std::cmp::Ordering;
use std::fmt::Debug;

use glam::DVec3;

use super::lanes::RayLanes;
use super::quick::{self, Quick, QuickLanes, Range};
use super::{Caps, Chord, Intersection, Part, RayOrigin, SolidKind, SpawnMargin, SurfacePoint};
use crate::math::{Bounds, LaneMask};

/// A kind of solid, which is a row of [`for_each_solid!`](crate::for_each_solid).
///
/// Solvers are given a ray's origin as seen from the solid's
/// [anchor](ConvexSolid::anchor): the difference is taken once, relative to
/// wherever the caller's numbers are exact. The direction has a largest component
/// between 2^-100 and 2^100 in size, and with the ranges that constructors enforce
/// nothing overflows.
pub trait ConvexSolid: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// What it is called.
    const KIND: SolidKind;

    /// Whether [`ConvexSolid::quick_first`], where it is not open, has the bits of
    /// [`ConvexSolid::exact_first`] too, for a ray whose origin f64 has.
    const QUICK_IS_EXACT: bool = true;

    /// A box that contains it, rounded outward.
    fn bounds(&self) -> Bounds;

    /// The point that the solver counts from.
    fn anchor(&self) -> DVec3;

    /// Its own center, about which it is turned: the middle of the axis, if it has one,
    /// rounded.
    fn center(&self) -> DVec3;

    /// The radius of its thickest part; of a cuboid half of its least width.
    fn radius(&self) -> f64;

    /// Whether its surface is the boundary of a solid with an inside.
    fn is_closed(&self) -> bool {
        self.caps() == Caps::Both
    }

    /// Which disks the surface has; [`Caps::Both`] for solids without open ends.
    fn caps(&self) -> Caps {
        Caps::Both
    }

    /// The interval of `t` in which the line `anchor + from_anchor + t *
    /// direction` is inside the closed solid, or `None` where it is not. A
    /// non-finite argument is a miss.
    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord>;

    /// The interval in which the line `origin + t * direction` is inside the closed solid,
    /// decided from the numbers as stated: whether there is one, its parts, the order of
    /// its ends and the signs of their `t` are those of exact arithmetic on the solid and
    /// the line. [`ConvexSolid::chord`] decides from the rounded difference that it is
    /// given, and of solids with two ends from the rounded axis.
    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord>;

    /// The first point of that line on the surface, among those with
    /// `t_min <= t + shift <= t_max`, likewise; see [`Chord::first`].
    #[inline]
    fn exact_first(
        &self,
        origin: &RayOrigin,
        direction: DVec3,
        shift: f64,
        [t_min, t_max]: [f64; 2],
    ) -> Option<Intersection> {
        let chord = self.exact_chord(origin, direction)?;
        chord.first(self.caps(), shift, t_min, t_max)
    }

    /// Whether that line certainly misses the closed solid, if a few products tell;
    /// `false` says nothing. It has no branch, so that a row of rays is tested at once.
    #[inline(always)]
    fn rejects(&self, _from_anchor: DVec3, _direction: DVec3) -> bool {
        false
    }

    /// The first point of that line on the surface, among those with
    /// `t_min <= t + shift <= t_max`; see [`Chord::first`].
    #[inline]
    fn first(
        &self,
        from_anchor: DVec3,
        direction: DVec3,
        shift: f64,
        t_min: f64,
        t_max: f64,
    ) -> Option<Intersection> {
        let chord = self.chord(from_anchor, direction)?;
        chord.first(self.caps(), shift, t_min, t_max)
    }

    /// The same without a branch, where that needs no exact numbers; see
    /// [`quick`](super::quick). It may take a line that the solid
    /// [rejects](ConvexSolid::rejects) as open.
    #[inline(always)]
    fn quick_first(&self, _from_anchor: DVec3, _direction: DVec3, _range: &Range) -> Quick {
        Quick::OPEN
    }

    /// [`ConvexSolid::first`] of eight rays that are seen from the anchor, for those that are
    /// `active`. Rays that take exact numbers are left open.
    #[inline(always)]
    fn first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        quick::first(self, rays, active)
    }

    /// [`ConvexSolid::exact_first`] likewise, for rays whose origins f64 has.
    #[inline(always)]
    fn exact_first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        if Self::QUICK_IS_EXACT {
            quick::first(self, rays, active)
        } else {
            QuickLanes::all_open(quick::near(self, rays, active))
        }
    }

    /// The point of a part of the surface that is nearest to `anchor +
    /// from_anchor`, its outward unit normal, parameters and error bound.
    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint;

    /// Where a point is. Exact: the point's numbers and the solid's are taken as
    /// they are.
    fn locate(&self, point: DVec3) -> Location;

    /// Whether a point of the boundary is on the surface of a part, as exactly. A point on
    /// an edge is on that of several.
    fn is_on(&self, part: Part, point: DVec3) -> bool;

    /// Whether the closed solid contains a point, as exactly.
    fn contains(&self, point: DVec3) -> bool {
        self.locate(point).is_held()
    }

    /// Bounds the distance of any two of its points.
    fn size(&self) -> f64;

    /// What a query that starts at a point of the surface may be displaced by.
    fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        SpawnMargin::of_solid(self, surface)
    }
}

/// Where a point is, seen from a closed solid; in the order of how far in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Location {
    /// Not of the solid. A point that is not finite is outside.
    Outside,
    /// Of its boundary, which is all of a solid without an inside.
    Boundary,
    /// Of its interior.
    Inside,
}

impl Location {
    /// By the sign of what is positive outside.
    #[must_use]
    pub(super) fn of_sign(outside: Ordering) -> Self {
        match outside {
            Ordering::Less => Self::Inside,
            Ordering::Equal => Self::Boundary,
            Ordering::Greater => Self::Outside,
        }
    }

    /// Whether the closed solid contains the point.
    #[must_use]
    pub fn is_held(self) -> bool {
        self != Self::Outside
    }
}
