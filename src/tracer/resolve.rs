//! From the best hit of a query to the result in world space.
//!
//! The requested fields are computed once, for the best hit. The ray is mapped down the path of
//! placements again, with the same steps as in the query, to the solid's own space; the surface
//! point there is then mapped up.
//!
//! **The error of the point.** The true surface is that of the solid's exact numbers, mapped by
//! the exact placements. The point starts within the surface's own error bound. A placement
//! `p = L c + T` stretches that by at most `‖L‖` and rounds: three products and sums per
//! component, below `4 u |L| |c|`, and the last sum, `u |p|`. The inverse is not used for
//! mapping up, so its error does not enter.
//!
//! **The start of a spawned ray.** `solid::SpawnMargin` has the displacements of the solver.
//! Mapping up adds, in the parent's space:
//!
//! - for each placement, `inverse_error` (see `math::placement`) times the distance to the
//!   child's origin, and times the solid's size for the direction;
//! - for the normal, its angle times the condition of the placement.

use std::borrow::Borrow;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use smallvec::SmallVec;

use super::decisions::Decisions;
use super::frame::LocalRay;
use super::prototype::Prototype;
use super::query::SolidRef;
use super::traced::{SurfaceHit, TracedSolid};
use super::{Hit, HitFields};
use crate::math::{ChildFromParent, PlacementErrors, Ray, UNIT_ROUNDOFF};
use crate::scene::{Listed, MaterialIndex, Scene, SolidList};
use crate::solid::{Intersection, SpawnMargin, SurfacePoint};
use crate::with_solid_kind;

/// The intersection that a hit is computed from.
#[derive(Clone, Copy)]
pub(crate) enum Which {
    /// The first intersection with the solid, which is at this `t`.
    FirstAt(f64),
    /// This intersection.
    This(SurfaceHit),
}

/// A hit in its prototype's own space.
struct LocalHit {
    intersection: Intersection,
    surface: SurfacePoint,
    /// `None` if no rays are spawned.
    margin: Option<SpawnMargin>,
    primitive: u32,
    material: MaterialIndex,
}

/// The inputs for computing the hit of a solid.
struct Search<'a> {
    ray: &'a LocalRay,
    t_min: f64,
    decisions: Decisions,
    which: Which,
    fields: HitFields,
}

impl Search<'_> {
    /// The intersection. For a query that stored only its `t`, `first` computes it again by the
    /// same operations, with the same result.
    fn hit(&self, first: impl FnOnce(f64) -> Option<SurfaceHit>) -> SurfaceHit {
        match self.which {
            Which::This(hit) => hit,
            Which::FirstAt(t) => first(t).expect("a hit is found again"),
        }
    }

    fn on_solid<L: SolidList<Solid: TracedSolid>>(&self, list: &L, position: usize) -> LocalHit {
        let solid = list.solid(position);
        let solid = solid.borrow();
        let hit = self.hit(|t| solid.first(self.ray, self.decisions, self.t_min, t));
        let surface = solid.surface(self.ray, &hit);
        LocalHit {
            intersection: hit.intersection,
            surface,
            margin: self.margin(|| solid.spawn_margin(&hit, &surface)),
            primitive: list.primitive(position),
            material: list.material(position),
        }
    }

    fn margin(&self, margin: impl FnOnce() -> SpawnMargin) -> Option<SpawnMargin> {
        self.fields.contains(HitFields::SPAWN).then(margin)
    }
}

/// The fields that depend on the normal, and those that depend on the error.
const OF_NORMAL: HitFields = HitFields::NORMAL.union(HitFields::SPAWN);
const OF_ERROR: HitFields = HitFields::ERROR.union(HitFields::SPAWN);

/// A surface point that is mapped up to the world. Fields that are not needed are NaN; the
/// point, which costs least, is always computed.
struct Carried {
    fields: HitFields,
    point: DVec3,
    normal: DVec3,
    error: f64,
    margin: Option<SpawnMargin>,
}

impl Carried {
    /// In the solid's own space.
    fn new(fields: HitFields, surface: &SurfacePoint, margin: Option<SpawnMargin>) -> Self {
        let mut carried = Self {
            fields,
            point: surface.point,
            normal: DVec3::NAN,
            error: f64::NAN,
            margin,
        };
        if fields.intersects(OF_NORMAL) {
            carried.normal = surface.normal;
        }
        if fields.intersects(OF_ERROR) {
            carried.error = surface.error;
        }
        carried
    }

    /// From a child's space to its parent's.
    fn carry(&mut self, child_from_parent: &ChildFromParent, parent_from_child: &DAffine3) {
        let child_point = self.point;
        let moved = parent_from_child.matrix3 * child_point;
        self.point = moved + parent_from_child.translation;
        if self.fields.intersects(OF_NORMAL) {
            self.normal = child_from_parent.parent_normal(self.normal);
        }
        if !self.fields.intersects(OF_ERROR) {
            return;
        }
        let errors = PlacementErrors::new(parent_from_child, child_from_parent);
        let terms = (parent_from_child.matrix3.abs() * child_point.abs()).length();
        let rounding = UNIT_ROUNDOFF * (4.0 * terms + self.point.length());
        self.error = errors.stretch * self.error + rounding;
        if let Some(margin) = &mut self.margin {
            margin.size *= errors.stretch;
            margin.displacement = errors.stretch * margin.displacement
                + errors.inverse_error * (moved.length() + self.error + margin.size);
            margin.normal_error = errors.condition * (margin.normal_error + 16.0 * UNIT_ROUNDOFF);
        }
    }
}

/// The result for a hit of a query with `ray` and these decisions. Of the fields that
/// [`HitFields`] names, those that are not in `fields` are NaN, and the path is empty.
pub(crate) fn resolve(
    scene: &Scene,
    root: &Arc<Prototype>,
    ray: &Ray,
    place: &SolidRef,
    (decisions, which, fields): (Decisions, Which, HitFields),
) -> Hit {
    // Maps the ray down to the prototype that was hit.
    let mut local = LocalRay::new(ray);
    let mut placements = SmallVec::<[(ChildFromParent, &DAffine3); 4]>::new();
    Prototype::for_each_step(root, place, |group, placement| {
        if let Some(placement) = placement {
            let child_from_parent = ChildFromParent::new(&placement.parent_from_child);
            placements.push((child_from_parent, &placement.parent_from_child));
            local = local.in_child(&child_from_parent);
        }
        local = group.frame.approach(&local);
    });
    let description = &scene.prototypes[place.prototype.0 as usize];

    // Computes the point on the solid.
    let search = Search {
        ray: &local,
        t_min: ray.t_min,
        decisions,
        which,
        fields,
    };
    let (solids, position) = (&description.solids, place.member.record as usize);
    let local = with_solid_kind!(place.member.kind, S => {
        search.on_solid(S::list(solids), position)
    });
    let LocalHit {
        intersection,
        surface,
        margin,
        primitive,
        material,
    } = local;

    // Maps the point up to the world.
    let mut carried = Carried::new(fields, &surface, margin);
    for (child_from_parent, parent_from_child) in placements.iter().rev() {
        carried.carry(child_from_parent, parent_from_child);
    }
    let Carried {
        point,
        normal,
        error,
        margin,
        ..
    } = carried;
    let (u, v) = if fields.contains(HitFields::UV) {
        (surface.u(), surface.v)
    } else {
        (f64::NAN, f64::NAN)
    };
    let instance = if fields.contains(HitFields::PATH) {
        place.path.to_vec()
    } else {
        Vec::new()
    };

    Hit {
        t: intersection.t,
        point,
        error,
        normal,
        u,
        v,
        prototype: place.prototype,
        solid: place.member.kind,
        primitive,
        part: intersection.part,
        crossing: intersection.crossing,
        instance,
        material,
        spawn_offset: margin.map_or(f64::NAN, |margin| margin.offset(point, error)),
    }
}
