//! The interface of every convex kind of solid.
//!
//! Solids are closed convex sets (a disk is one without an inside), so a line is inside a solid
//! in a single closed interval, its [`Chord`]. Every query of a ray follows from that interval
//! and from which parts of the boundary exist; `chord.rs` has the one step that turns it into
//! hits.

use std::cmp::Ordering;
use std::fmt::Debug;

use glam::DVec3;

use super::lanes::RayLanes;
use super::quick::{Quick, QuickLanes, Range};
use super::{Caps, Chord, Intersection, Part, RayOrigin, SolidKind, SpawnMargin, SurfacePoint};
use crate::math::{Bounds, LANES, LaneMask, Lanes};

/// A kind of solid, a row of [`for_each_solid!`](crate::for_each_solid).
///
/// Solvers take a ray's origin relative to the solid's [anchor](ConvexSolid::anchor): the
/// caller computes the difference once, where its numbers are exact. The largest component of
/// the direction is between 2^-100 and 2^100 in size; with the ranges that constructors
/// enforce, nothing overflows.
pub trait ConvexSolid: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// The kind.
    const KIND: SolidKind;

    /// Whether [`ConvexSolid::quick_first`], if it is not open, also has the bits of
    /// [`ConvexSolid::exact_first`], for a ray whose origin is an f64 point.
    const QUICK_IS_EXACT: bool = true;

    /// A box that contains it, rounded outward.
    fn bounds(&self) -> Bounds;

    /// The origin of the solver's coordinates.
    fn anchor(&self) -> DVec3;

    /// Its center, about which it is turned: the middle of the axis, if it has one, rounded.
    fn center(&self) -> DVec3;

    /// The radius of its thickest part; for a cuboid, half of its least width.
    fn radius(&self) -> f64;

    /// Whether its surface is the boundary of a solid with an inside.
    fn is_closed(&self) -> bool {
        self.caps() == Caps::Both
    }

    /// The disks of the surface; [`Caps::Both`] for solids without open ends.
    fn caps(&self) -> Caps {
        Caps::Both
    }

    /// The interval of `t` in which the line `anchor + from_anchor + t * direction` is inside
    /// the closed solid, or `None` if it misses. A non-finite argument is a miss.
    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord>;

    /// The interval in which the line `origin + t * direction` is inside the closed solid,
    /// decided from the stated numbers: whether there is one, its parts, the order of its ends
    /// and the signs of their `t` are those of exact arithmetic on the solid and the line.
    /// [`ConvexSolid::chord`], in contrast, decides from the rounded difference that it is
    /// given, and for solids with two ends from the rounded axis.
    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord>;

    /// The first intersection of that line with the surface, with
    /// `t_min <= t + shift <= t_max`, decided in the same way; see [`Chord::first`].
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

    /// Whether a few products prove that the line misses the closed solid; `false` is
    /// inconclusive. There is no branch in it, so that a row of rays is tested at once.
    #[inline(always)]
    fn rejects(&self, _from_anchor: DVec3, _direction: DVec3) -> bool {
        false
    }

    /// The first intersection of that line with the surface, with
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

    /// As [`ConvexSolid::first`] without a branch, if that needs no exact numbers; see
    /// [`quick`](super::quick). A line that the solid [rejects](ConvexSolid::rejects) may be
    /// open.
    #[inline(always)]
    fn quick_first(&self, _from_anchor: DVec3, _direction: DVec3, _range: &Range) -> Quick {
        Quick::OPEN
    }

    /// [`ConvexSolid::first`] for those of eight rays that are `active`, with origins relative
    /// to the anchor. Rays that need exact numbers are left open.
    #[inline(always)]
    fn first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        quick_lanes(self, rays, active)
    }

    /// [`ConvexSolid::exact_first`] in the same way, for rays whose origins are f64 points.
    #[inline(always)]
    fn exact_first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        if Self::QUICK_IS_EXACT {
            quick_lanes(self, rays, active)
        } else {
            QuickLanes::all_open(near(self, rays, active))
        }
    }

    /// The point of a part of the surface that is nearest to `anchor + from_anchor`, with its
    /// outward unit normal, parameters and error bound.
    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint;

    /// The location of a point. It is exact: the numbers of the point and of the solid are
    /// taken as they are.
    fn locate(&self, point: DVec3) -> Location;

    /// Whether a point of the boundary is on a part of the surface, exactly. A point on an edge
    /// is on several parts.
    fn is_on(&self, part: Part, point: DVec3) -> bool;

    /// Whether the closed solid contains a point, exactly.
    fn contains(&self, point: DVec3) -> bool {
        self.locate(point).is_held()
    }

    /// Bounds the distance between any two of its points.
    fn size(&self) -> f64;

    /// The displacement of a query that starts at a point of the surface.
    fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        SpawnMargin::of_solid(self, surface)
    }
}

/// The `active` rays that do not certainly miss the solid.
#[inline(always)]
fn near(solid: &impl ConvexSolid, rays: &RayLanes, active: &LaneMask) -> LaneMask {
    let mut near = LaneMask::splat(false);
    for lane in 0..LANES {
        let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
        near.0[lane] = active.0[lane] & !solid.rejects(x, d);
    }
    near
}

/// [`ConvexSolid::first`] of the `active` rays, whose origins are relative to the solid's
/// anchor.
#[inline(always)]
fn quick_lanes(solid: &impl ConvexSolid, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
    let (mut open, mut hit) = (LaneMask::splat(false), LaneMask::splat(false));
    let mut t = Lanes::splat(0.0);
    let near = near(solid, rays, active);
    if near.any() {
        for lane in 0..LANES {
            let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
            let range = Range {
                shift: rays.shift.0[lane],
                t_min: rays.t_min.0[lane],
                t_max: rays.t_max.0[lane],
            };
            let quick = solid.quick_first(x, d, &range);
            open.0[lane] = near.0[lane] & quick.is_open;
            hit.0[lane] = near.0[lane] & !quick.is_open & quick.is_hit;
            t.0[lane] = quick.t;
        }
    }
    QuickLanes { open, hit, t }
}

impl SpawnMargin {
    /// The margin in the space of a solid of any kind.
    #[must_use]
    pub fn of_solid(solid: &impl ConvexSolid, surface: &SurfacePoint) -> Self {
        let size = solid.size();
        let seen = surface.point.length() + solid.anchor().length() + size;
        Self::new(seen, size)
    }
}

/// The location of a point relative to a closed solid, ordered from outside to inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Location {
    /// Not in the solid. A point that is not finite is outside.
    Outside,
    /// On the boundary, which is all of a solid without an inside.
    Boundary,
    /// In the interior.
    Inside,
}

impl Location {
    /// From the sign of a quantity that is positive outside.
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
