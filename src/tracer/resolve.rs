//! From the best hit of a query to the answer in world space.
//!
//! Point, normal, parameters and bounds are worked out once, for the hit that
//! won. The path of placements is walked down again, with the very steps of the
//! query, to the ray in the solid's own space; the surface point found there is
//! then carried up.
//!
//! **The error of the point.** The true surface is that of the solid's exact
//! numbers, carried through the exact placements. The point starts within the
//! surface's own bound of it. A placement `p = L c + T` stretches that by at
//! most `‖L‖` and rounds: three products and sums a component, below
//! `4 u |L| |c|`, and the last sum, `u |p|`. The inverse is not used on the way
//! up, so its error does not enter.
//!
//! **Where a spawned ray may start.** `solid::SpawnMargin` says what the solver
//! may displace. On the way up, counted in the space reached:
//!
//! - for each placement, `inverse_error` (see `math::placement`) times the
//!   distance to the child's origin, and times the solid's size for the
//!   direction;
//! - for the normal, its angle times the condition of the placement.

use std::sync::Arc;

use super::Hit;
use super::frame::LocalRay;
use super::prototype::Prototype;
use super::query::Place;
use super::traced::{Met, TracedSolid};
use crate::math::{ChildFromParent, PlacementErrors, Ray, UNIT_ROUNDOFF};
use crate::scene::{CylinderRecord, MaterialIndex, Scene, SolidRecord};
use crate::solid::{Meeting, SolidKind, SpawnMargin, SurfacePoint, surface_point, triple_product};

/// What a query is to work out of a hit.
#[derive(Clone, Copy)]
pub(crate) enum Which {
    /// The first meeting with the solid, which is at this `t`.
    FirstAt(f64),
    /// This one.
    This(Met),
}

/// A hit in its prototype's own space.
struct LocalHit {
    meeting: Meeting,
    surface: SurfacePoint,
    margin: SpawnMargin,
    primitive: u32,
    material: MaterialIndex,
}

/// What is to be worked out, once it is known of which solid.
struct Search<'a> {
    ray: &'a LocalRay,
    t_min: f64,
    which: Which,
}

impl Search<'_> {
    /// The meeting, of which a query that only knows its `t` finds the rest by
    /// `first`. The query went through the same operations: it is the same meeting.
    fn met(&self, first: impl FnOnce(f64) -> Option<Met>) -> Met {
        match self.which {
            Which::This(met) => met,
            Which::FirstAt(t) => first(t).expect("a hit is found again"),
        }
    }

    fn on_cylinder(&self, record: &CylinderRecord) -> LocalHit {
        let (cylinder, ray) = (record.cylinder(), self.ray);
        let from_p0 = ray.origin_from(cylinder.p0());
        let Met { meeting, .. } = self.met(|t| {
            let (direction, shift) = (ray.direction, ray.shift);
            let first = triple_product::first(&cylinder, from_p0, direction, shift, self.t_min, t);
            first.map(Met::whole)
        });
        let on_ray = from_p0 + ray.direction * meeting.t_local;
        let surface = surface_point(&cylinder, meeting.part, on_ray);
        LocalHit {
            meeting,
            surface,
            margin: SpawnMargin::new(&cylinder, &surface),
            primitive: record.primitive(),
            material: record.material(),
        }
    }

    fn on_solid<S: TracedSolid>(&self, record: &SolidRecord<S>) -> LocalHit {
        let met = self.met(|t| record.solid.first(self.ray, self.t_min, t));
        let surface = record.solid.surface(self.ray, &met);
        LocalHit {
            meeting: met.meeting,
            surface,
            margin: record.solid.spawn_margin(&met, &surface),
            primitive: record.primitive,
            material: record.material,
        }
    }
}

/// The answer for a hit of a query with `ray`.
pub(crate) fn resolve(
    scene: &Scene,
    root: &Arc<Prototype>,
    ray: &Ray,
    place: &Place,
    which: Which,
) -> Hit {
    // Down to the prototype that was hit.
    let mut local = LocalRay::new(ray);
    let mut placements = Vec::with_capacity(place.path.len());
    Prototype::along_way(root, place, |group, placement| {
        if let Some(placement) = placement {
            let way = ChildFromParent::new(&placement.parent_from_child);
            placements.push((way, placement.parent_from_child));
            local = local.in_child(&way);
        }
        local = group.frame.approach(&local);
    });
    let description = &scene.prototypes[place.prototype.0 as usize];

    // The point on the solid.
    let search = Search {
        ray: &local,
        t_min: ray.t_min,
        which,
    };
    let (solids, position) = (&description.solids, place.member.record as usize);
    let local = match place.member.kind {
        SolidKind::Cylinder => search.on_cylinder(&description.cylinders.get(position)),
        SolidKind::Sphere => search.on_solid(&solids.spheres[position]),
        SolidKind::Cuboid => search.on_solid(&solids.cuboids[position]),
        SolidKind::Cone => search.on_solid(&solids.cones[position]),
        SolidKind::RoundedCone => search.on_solid(&solids.rounded_cones[position]),
        SolidKind::Disk => search.on_solid(&solids.disks[position]),
        SolidKind::Union | SolidKind::Intersection | SolidKind::Difference => {
            search.on_solid(&solids.compositions[position])
        }
    };
    let LocalHit {
        meeting,
        surface,
        mut margin,
        primitive,
        material,
    } = local;

    // Up again to the world.
    let (mut point, mut normal, mut error) = (surface.point, surface.normal, surface.error);
    for (way, parent_from_child) in placements.iter().rev() {
        let errors = PlacementErrors::new(parent_from_child, way);
        let terms = (parent_from_child.matrix3.abs() * point.abs()).length();
        let moved = parent_from_child.matrix3 * point;
        point = moved + parent_from_child.translation;
        normal = way.parent_normal(normal);
        error = errors.stretch * error + UNIT_ROUNDOFF * (4.0 * terms + point.length());
        margin.size *= errors.stretch;
        margin.displacement = errors.stretch * margin.displacement
            + errors.inverse_error * (moved.length() + error + margin.size);
        margin.normal_error = errors.condition * (margin.normal_error + 16.0 * UNIT_ROUNDOFF);
    }

    Hit {
        t: meeting.t,
        point,
        error,
        normal,
        u: surface.u(),
        v: surface.v,
        prototype: place.prototype,
        solid: place.member.kind,
        primitive,
        part: meeting.part,
        crossing: meeting.crossing,
        instance: place.path.to_vec(),
        material,
        spawn_offset: margin.offset(point, error),
    }
}
