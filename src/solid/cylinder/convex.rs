//! The cylinder as a convex solid: which solver serves which query.

use glam::DVec3;

use super::{Cylinder, middle};
use crate::math::{Bounds, LANES, LaneMask, LaneVectors, Lanes};
use crate::solid::lanes::{self, AllCapped, AllOpen, CylinderLanes, LaneCaps, MixedCaps, RayLanes};
use crate::solid::quick::QuickLanes;
use crate::solid::{
    Caps, Chord, ConvexSolid, Intersection, Location, Part, RayOrigin, SolidKind, SpawnMargin,
    SurfacePoint, settled, surface_point, triple_product,
};

/// A cylinder in eight lanes, with its caps.
#[inline(always)]
fn eight<C: LaneCaps>(cylinder: &Cylinder, caps: C) -> CylinderLanes<C> {
    CylinderLanes {
        axis: LaneVectors::splat(cylinder.p1 - cylinder.p0),
        radius: Lanes::splat(cylinder.radius),
        caps,
    }
}

impl ConvexSolid for Cylinder {
    const KIND: SolidKind = SolidKind::Cylinder;

    fn bounds(&self) -> Bounds {
        self.bounds()
    }

    fn anchor(&self) -> DVec3 {
        self.p0
    }

    fn center(&self) -> DVec3 {
        middle(self.p0(), self.p1())
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn caps(&self) -> Caps {
        self.caps
    }

    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        triple_product::chord(self, from_anchor, direction)
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        settled::chord(self, origin, direction)
    }

    fn exact_first(
        &self,
        origin: &RayOrigin,
        direction: DVec3,
        shift: f64,
        range: [f64; 2],
    ) -> Option<Intersection> {
        settled::first(self, origin, direction, shift, range)
    }

    #[inline(always)]
    fn first(
        &self,
        from_anchor: DVec3,
        direction: DVec3,
        shift: f64,
        t_min: f64,
        t_max: f64,
    ) -> Option<Intersection> {
        triple_product::first(self, from_anchor, direction, shift, t_min, t_max)
    }

    // Caps that are known at compile time leave one of the three cases.
    #[inline(always)]
    fn first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        let (hit, t) = match self.caps {
            Caps::Both => lanes::first(&eight(self, AllCapped), rays, active),
            Caps::None => lanes::first(&eight(self, AllOpen), rays, active),
            caps => lanes::first(&eight(self, MixedCaps([caps; LANES])), rays, active),
        };
        QuickLanes {
            open: LaneMask::splat(false),
            hit,
            t,
        }
    }

    #[inline(always)]
    fn exact_first_in_lanes(&self, rays: &RayLanes, active: &LaneMask) -> QuickLanes {
        match self.caps {
            Caps::Both => settled::first_in_lanes(&eight(self, AllCapped), rays, active),
            Caps::None => settled::first_in_lanes(&eight(self, AllOpen), rays, active),
            caps => {
                let caps = MixedCaps([caps; LANES]);
                settled::first_in_lanes(&eight(self, caps), rays, active)
            }
        }
    }

    fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        surface_point(self, part, from_anchor)
    }

    /// The result of the cone with equal radii, which is the same set.
    fn locate(&self, point: DVec3) -> Location {
        self.as_cone().locate(point)
    }

    fn is_on(&self, part: Part, point: DVec3) -> bool {
        self.as_cone().is_on(part, point)
    }

    fn size(&self) -> f64 {
        (self.p1 - self.p0).length() + 2.0 * self.radius
    }

    fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        let (p0, p1) = (self.p0, self.p1);
        let seen = surface.point.length() + p0.length() + p1.length() + 2.0 * self.radius;
        SpawnMargin::new(seen, self.size())
    }
}
