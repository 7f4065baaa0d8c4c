//! The interface of a solid of any kind to a query.
//!
//! A convex solid computes hits from the one interval of a line inside it. A line may intersect
//! another solid in several intervals. Such a solid computes hits itself, and a *leaf* in the
//! hit selects the operand with the surface.

use glam::DVec3;

use super::decisions::{Decisions, exact_first};
use super::frame::{LocalRay, PacketRays};
use crate::math::{Bounds, LANES, LaneMask, LaneVectors, Lanes};
use crate::scene::Listed;
use crate::solid::lanes::RayLanes;
use crate::solid::quick::QuickLanes;
use crate::solid::{
    ComposedIntersection, Composition, ConvexSolid, Intersection, SolidKind, SpawnMargin,
    SurfacePoint,
};

/// An intersection with a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceHit {
    pub intersection: Intersection,
    /// The operand that is hit; 0 for a convex solid.
    pub leaf: u32,
    /// Whether the normal is the operand's reversed.
    pub is_reversed: bool,
    /// The number of the crossing, for a solid that may be entered more than once; 0 for a
    /// convex solid.
    pub rank: u32,
}

impl SurfaceHit {
    /// An intersection with a convex solid.
    #[inline(always)]
    pub fn whole(intersection: Intersection) -> Self {
        Self {
            intersection,
            leaf: 0,
            is_reversed: false,
            rank: 0,
        }
    }
}

/// A row of a packet's rays and their ranges.
pub(crate) struct RowOfPacket<'a> {
    pub rays: &'a PacketRays,
    pub row: usize,
    pub t_min: &'a Lanes,
    pub t_max: &'a Lanes,
}

impl RowOfPacket<'_> {
    /// Whether no ray was moved nearer, so that all origins are f64 points.
    pub fn is_plain(&self) -> bool {
        let base = &self.rays.base[self.row];
        (0..LANES).all(|lane| base.lane(lane) == DVec3::ZERO)
    }

    /// The rays relative to a point.
    #[inline(always)]
    pub fn seen_from(&self, point: DVec3) -> RayLanes {
        let (rays, row) = (self.rays, self.row);
        RayLanes {
            from_p0: rays.origin[row] - (LaneVectors::splat(point) - rays.base[row]),
            direction: rays.direction[row],
            shift: rays.shift[row],
            t_min: *self.t_min,
            t_max: *self.t_max,
        }
    }
}

/// A solid in a query.
pub(crate) trait TracedSolid: Listed + Send + Sync {
    /// The kind, which selects its list.
    fn kind(&self) -> SolidKind;

    /// A box that contains it.
    fn bounds(&self) -> Bounds;

    /// The first intersections of the `active` rays of a row. Open rays are left to
    /// [`TracedSolid::first`].
    #[inline(always)]
    fn first_in_row(&self, _: &RowOfPacket, active: LaneMask) -> QuickLanes {
        QuickLanes::all_open(active)
    }

    /// As [`TracedSolid::first_in_row`], decided exactly.
    #[inline(always)]
    fn exact_first_in_row(&self, _: &RowOfPacket, active: LaneMask) -> QuickLanes {
        QuickLanes::all_open(active)
    }

    /// The first intersection of the ray with the surface in a range of the whole ray's `t`.
    fn first(
        &self,
        ray: &LocalRay,
        decisions: Decisions,
        t_min: f64,
        t_max: f64,
    ) -> Option<SurfaceHit>;

    /// Passes all such intersections to `keep`.
    fn for_each_hit(
        &self,
        ray: &LocalRay,
        decisions: Decisions,
        t_min: f64,
        t_max: f64,
        keep: impl FnMut(SurfaceHit),
    );

    /// The point of the surface at a hit.
    fn surface(&self, ray: &LocalRay, hit: &SurfaceHit) -> SurfacePoint;

    /// The displacement of a query that starts at that point.
    fn spawn_margin(&self, hit: &SurfaceHit, surface: &SurfacePoint) -> SpawnMargin;

    /// Whether the closed solid contains a point.
    fn contains(&self, point: DVec3) -> bool;

    /// Whether its surface is the boundary of a solid with an inside.
    fn is_closed(&self) -> bool;
}

impl<S: ConvexSolid + Listed> TracedSolid for S {
    #[inline(always)]
    fn kind(&self) -> SolidKind {
        S::KIND
    }

    fn bounds(&self) -> Bounds {
        ConvexSolid::bounds(self)
    }

    #[inline(always)]
    fn first_in_row(&self, row: &RowOfPacket, active: LaneMask) -> QuickLanes {
        self.first_in_lanes(&row.seen_from(self.anchor()), &active)
    }

    #[inline(always)]
    fn exact_first_in_row(&self, row: &RowOfPacket, active: LaneMask) -> QuickLanes {
        if row.is_plain() {
            self.exact_first_in_lanes(&row.seen_from(self.anchor()), &active)
        } else {
            QuickLanes::all_open(active)
        }
    }

    #[inline(always)]
    fn first(
        &self,
        ray: &LocalRay,
        decisions: Decisions,
        t_min: f64,
        t_max: f64,
    ) -> Option<SurfaceHit> {
        let intersection = match decisions {
            Decisions::Rounded => {
                let from_anchor = ray.origin_from(self.anchor());
                self.first(from_anchor, ray.direction, ray.shift, t_min, t_max)
            }
            Decisions::Exact => exact_first(self, ray, t_min, t_max),
        };
        intersection.map(SurfaceHit::whole)
    }

    fn for_each_hit(
        &self,
        ray: &LocalRay,
        decisions: Decisions,
        t_min: f64,
        t_max: f64,
        keep: impl FnMut(SurfaceHit),
    ) {
        if let Some(chord) = decisions.chord(self, ray) {
            let intersections = chord.intersections(self.caps(), ray.shift, t_min, t_max);
            intersections.map(SurfaceHit::whole).for_each(keep);
        }
    }

    fn surface(&self, ray: &LocalRay, hit: &SurfaceHit) -> SurfacePoint {
        let Intersection { part, t_local, .. } = hit.intersection;
        let from_anchor = ray.origin_from(self.anchor()) + ray.direction * t_local;
        self.surface_point(part, from_anchor)
    }

    fn spawn_margin(&self, _: &SurfaceHit, surface: &SurfacePoint) -> SpawnMargin {
        ConvexSolid::spawn_margin(self, surface)
    }

    fn contains(&self, point: DVec3) -> bool {
        ConvexSolid::contains(self, point)
    }

    fn is_closed(&self) -> bool {
        ConvexSolid::is_closed(self)
    }
}

impl From<ComposedIntersection> for SurfaceHit {
    fn from(hit: ComposedIntersection) -> Self {
        Self {
            intersection: hit.intersection,
            leaf: hit.leaf,
            is_reversed: hit.is_reversed,
            rank: hit.rank,
        }
    }
}

impl From<&SurfaceHit> for ComposedIntersection {
    fn from(hit: &SurfaceHit) -> Self {
        Self {
            intersection: hit.intersection,
            leaf: hit.leaf,
            is_reversed: hit.is_reversed,
            rank: hit.rank,
        }
    }
}

impl TracedSolid for Composition {
    fn kind(&self) -> SolidKind {
        self.kind()
    }

    fn bounds(&self) -> Bounds {
        self.bounds()
    }

    fn first(&self, ray: &LocalRay, _: Decisions, t_min: f64, t_max: f64) -> Option<SurfaceHit> {
        let from = |anchor| ray.origin_from(anchor);
        self.first(from, ray.direction, ray.shift, [t_min, t_max])
            .map(SurfaceHit::from)
    }

    fn for_each_hit(
        &self,
        ray: &LocalRay,
        _: Decisions,
        t_min: f64,
        t_max: f64,
        mut keep: impl FnMut(SurfaceHit),
    ) {
        let from = |anchor| ray.origin_from(anchor);
        let range = [t_min, t_max];
        self.intersections(from, ray.direction, ray.shift, range, |hit| {
            keep(hit.into())
        });
    }

    fn surface(&self, ray: &LocalRay, hit: &SurfaceHit) -> SurfacePoint {
        self.surface(&hit.into(), |anchor| {
            ray.origin_from(anchor) + ray.direction * hit.intersection.t_local
        })
    }

    fn spawn_margin(&self, hit: &SurfaceHit, surface: &SurfacePoint) -> SpawnMargin {
        self.spawn_margin(&hit.into(), surface)
    }

    fn contains(&self, point: DVec3) -> bool {
        self.contains(point)
    }

    fn is_closed(&self) -> bool {
        true
    }
}
