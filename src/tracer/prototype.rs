//! A prototype's committed Embree scene and what its callbacks do.
//!
//! A prototype has at most two user geometries, one of its cylinders and one
//! of its placements; it has only those that it needs.

use std::sync::Arc;

use glam::DVec3;

use super::frame::{FAR, Frame, LocalRay};
use super::query::Query;
use crate::embree::{self, Box32, Device, SceneBuilder, UserGeometry};
use crate::math::{Bounds, ChildFromParent, PlacementErrors, UNIT_ROUNDOFF};
use crate::scene::{CylinderRecord, Placement, PrototypeIndex, Scene};

/// A prototype that can be traced.
pub(crate) struct Prototype {
    /// Holds all its solids.
    pub bounds: Bounds,
    /// Holds every point at which a query may place a hit: `bounds`, and what
    /// roundings on the way through placements can add to it.
    reach: Bounds,
    pub frame: Frame,
    scene: embree::Scene<Query>,
    cylinders: CylinderGeometry,
    placements: Arc<PlacementGeometry>,
}

/// A placement as it is traced.
pub(crate) struct PlacementRecord {
    pub child_from_parent: ChildFromParent,
    /// The position in [`PlacementGeometry::children`].
    child: u32,
}

/// The child of a placement of a prototype that holds nothing.
const NO_CHILD: u32 = u32::MAX;

#[derive(Clone)]
struct CylinderGeometry {
    description: Arc<Scene>,
    prototype: PrototypeIndex,
    frame: Frame,
}

struct PlacementGeometry {
    description: Arc<Scene>,
    prototype: PrototypeIndex,
    frame: Frame,
    /// [`Prototype::bounds`] of the prototype that holds the placements.
    bounds: Bounds,
    records: Vec<PlacementRecord>,
    children: Vec<Arc<Prototype>>,
}

impl Prototype {
    /// Builds a prototype whose children are built. `built` answers with the
    /// child of an index; `None` for one that holds nothing.
    ///
    /// Answers `None` if the prototype itself holds nothing.
    pub fn build(
        device: &Device,
        description: &Arc<Scene>,
        index: PrototypeIndex,
        built: &[Option<Arc<Self>>],
    ) -> Result<Option<Arc<Self>>, embree::Error> {
        let prototype = &description.prototypes[index.0 as usize];
        let child = |placement: &Placement| built[placement.of.0 as usize].as_ref();
        let cylinders = prototype
            .cylinders
            .iter()
            .fold(Bounds::EMPTY, |sum, record| {
                sum.union(&record.cylinder().bounds())
            });
        let with_placements = |of: &dyn Fn(&Placement, &Self) -> Bounds| {
            prototype
                .placements
                .iter()
                .filter_map(|placement| Some(of(placement, child(placement)?)))
                .fold(cylinders, |sum, bounds| sum.union(&bounds))
        };
        let bounds = with_placements(&|placement, child| {
            child.bounds.transformed(&placement.parent_from_child)
        });
        if bounds.is_empty() {
            return Ok(None);
        }
        let reach = with_placements(&|placement, child| placement_reach(placement, child, &bounds));
        let frame = Frame::new(&reach);

        let mut children: Vec<Arc<Self>> = Vec::new();
        let mut position_of = vec![NO_CHILD; built.len()];
        let record_of = |placement: &Placement| {
            let position = &mut position_of[placement.of.0 as usize];
            if let Some(child) = child(placement)
                && *position == NO_CHILD
            {
                *position = children.len() as u32;
                children.push(Arc::clone(child));
            }
            PlacementRecord {
                child_from_parent: ChildFromParent::new(&placement.parent_from_child),
                child: *position,
            }
        };
        let records = prototype.placements.iter().map(record_of).collect();

        let cylinders = CylinderGeometry {
            description: Arc::clone(description),
            prototype: index,
            frame: frame.clone(),
        };
        let placements = Arc::new(PlacementGeometry {
            description: Arc::clone(description),
            prototype: index,
            frame: frame.clone(),
            bounds,
            records,
            children,
        });
        let mut builder = SceneBuilder::new(device)?;
        if !prototype.cylinders.is_empty() {
            builder.attach_user(cylinders.clone())?;
        }
        if !placements.children.is_empty() {
            builder.attach_user(Arc::clone(&placements))?;
        }
        let scene = builder.commit()?;
        Ok(Some(Arc::new(Self {
            bounds,
            reach,
            frame,
            scene,
            cylinders,
            placements,
        })))
    }

    /// The bytes of the records that are kept beside the description's.
    pub fn placement_bytes(&self) -> usize {
        self.placements.records.len() * size_of::<PlacementRecord>()
    }

    /// A placement and the prototype it places, which is there because a hit
    /// lies in it.
    pub fn placement(&self, index: u32) -> (&PlacementRecord, &Arc<Self>) {
        let record = &self.placements.records[index as usize];
        (record, &self.placements.children[record.child as usize])
    }

    /// Traces for the hits that `query` keeps.
    pub fn search(&self, ray: &LocalRay, query: &mut Query) {
        if let Some((level, ray32)) = query.enter(&self.frame, ray) {
            let outer = query.level.replace(level);
            self.scene.closest(&ray32, query);
            query.level = outer;
        }
    }

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &LocalRay, query: &mut Query) -> bool {
        let Some((level, ray32)) = query.enter(&self.frame, ray) else {
            return false;
        };
        let outer = query.level.replace(level);
        let hit = self.scene.any(&ray32, query);
        query.level = outer;
        hit
    }

    /// As [`Prototype::search`], but visits every primitive instead of asking
    /// Embree for candidates.
    pub fn search_exhaustively(&self, ray: &LocalRay, query: &mut Query) {
        let Some((level, _)) = query.enter(&self.frame, ray) else {
            return;
        };
        let outer = query.level.replace(level);
        for record in 0..self.cylinders.records().len() as u32 {
            self.cylinders.visit(record, query);
        }
        for placement in 0..self.placements.records.len() as u32 {
            self.placements
                .visit(placement, query, Self::search_exhaustively);
        }
        query.level = outer;
    }
}

impl CylinderGeometry {
    fn records(&self) -> &[CylinderRecord] {
        &self.description.prototypes[self.prototype.0 as usize].cylinders
    }

    #[inline]
    fn visit(&self, index: u32, query: &mut Query) {
        query.visit(&self.records()[index as usize], self.prototype, index);
    }
}

impl UserGeometry for CylinderGeometry {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.records().len() as u32
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.frame
            .grown_box(&self.records()[primitive as usize].cylinder().bounds())
    }

    #[inline]
    fn intersect(&self, primitive: u32, query: &mut Query) -> Option<f32> {
        shorter(query, |query| self.visit(primitive, query))
    }

    #[inline]
    fn occluded(&self, primitive: u32, query: &mut Query) -> bool {
        query.meets(&self.records()[primitive as usize])
    }
}

/// Lets `visit` find hits, and answers with Embree's new `t_far` if that leaves
/// less room for others.
#[inline]
fn shorter(query: &mut Query, visit: impl FnOnce(&mut Query)) -> Option<f32> {
    let before = query.bound();
    visit(query);
    (query.bound() < before).then(|| query.t_far())
}

impl PlacementGeometry {
    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.prototype.0 as usize].placements
    }

    /// Hands the query's ray to `trace` in the space of the placed prototype.
    #[inline]
    fn visit<T: Default>(
        &self,
        index: u32,
        query: &mut Query,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query) -> T,
    ) -> T {
        let record = &self.records[index as usize];
        let Some(child) = self.children.get(record.child as usize) else {
            return T::default();
        };
        let ray = record.child_ray(&query.level().ray);
        query.path.push(index);
        let answer = trace(child, &ray, query);
        query.path.pop();
        answer
    }
}

impl PlacementRecord {
    /// The ray in the space of the placed prototype. The direction keeps its
    /// length, so that `t` keeps its meaning.
    #[inline]
    pub fn child_ray(&self, ray: &LocalRay) -> LocalRay {
        let way = &self.child_from_parent;
        LocalRay {
            origin: way.vector(ray.origin_from(way.translation())),
            direction: way.vector(ray.direction),
            base: DVec3::ZERO,
            shift: ray.shift,
        }
    }
}

impl UserGeometry for Arc<PlacementGeometry> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.records.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        let placement = &self.placements()[primitive as usize];
        let child = self
            .children
            .get(self.records[primitive as usize].child as usize);
        // Where nothing is placed any box will do; the least is best.
        let reach = child.map_or(Bounds::at(self.frame.centre()), |child| {
            placement_reach(placement, child, &self.bounds)
        });
        self.frame.grown_box(&reach)
    }

    fn intersect(&self, primitive: u32, query: &mut Query) -> Option<f32> {
        shorter(query, |query| {
            self.visit(primitive, query, Prototype::search)
        })
    }

    fn occluded(&self, primitive: u32, query: &mut Query) -> bool {
        self.visit(primitive, query, Prototype::occluded)
    }
}

/// Where hits in a placed child may be, in the space of its parent, whose
/// bounds are `parent`: the image of the child's reach, grown by what the
/// roundings of the child's ray and of the solvers that get it can displace.
///
/// Both are relative to the distance of the ray's origin from the child's. The
/// origin is less than `√3` [`FAR`] units of the parent's frame from the
/// parent's centre, or was moved nearer; a unit is at most the radius of the
/// parent's reach, which [`crate::scene::GREATEST_CONDITION`] keeps below twice
/// that of its bounds.
fn placement_reach(placement: &Placement, child: &Prototype, parent: &Bounds) -> Bounds {
    let image = child.reach.transformed(&placement.parent_from_child);
    let way = ChildFromParent::new(&placement.parent_from_child);
    let errors = PlacementErrors::new(&placement.parent_from_child, &way);
    let displacement = 2.0 * errors.inverse_error + 16.0 * UNIT_ROUNDOFF * errors.condition;
    let from_centre = (parent.centre() - way.translation()).length();
    let distance = 4.0 * FAR * (0.5 * parent.extent().length()) + from_centre;
    image.grown(displacement * distance)
}
