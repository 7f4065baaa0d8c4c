//! The placements of a group: Embree's instances, or primitives whose callback traces what they
//! place.

use std::sync::Arc;

use super::instances::{Image, instance_map};
use super::numbers::Numbers;
use super::opened::Through;
use super::outline::Divided;
use super::placement_margin::PlacementMargin;
use super::{Children, Group};
use crate::embree::{
    self, Box32, GREATEST_PACKET, GeometryId, Ray32, RaySet, Rays32, Reached, SceneBuilder,
    UserGeometry,
};
use crate::math::{Bounds, ChildFromParent};
use crate::scene::{Placement, PrototypeIndex, Scene};
use crate::tracer::counters;
use crate::tracer::frame::{Frame, LocalRay};
use crate::tracer::query::{Packet, Query};

/// Placements of a prototype, each for the child's group with the same number. The description
/// stores them: a primitive takes no other memory than its leaf in Embree's tree.
///
/// The map into the child's space is computed on each visit. It takes some forty operations
/// without a branch, compared with the hundreds of a nested traversal; storing it would take as
/// much memory again as the placement.
pub(super) struct Placements {
    pub description: Arc<Scene>,
    pub prototype: PrototypeIndex,
    pub frame: Frame,
    pub placement_margin: PlacementMargin,
    pub children: Children<Group>,
    /// The numbers of the placements.
    pub all: Numbers,
    /// The numbers of those that rays may reach.
    pub reached: Divided,
}

impl Placements {
    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.prototype.0 as usize].placements
    }

    /// A placement and the group that it places, if that is not empty.
    #[inline]
    fn get(&self, index: u32) -> Option<(&Placement, &Arc<Group>)> {
        let placement = &self.placements()[index as usize];
        Some((placement, self.children.of(placement.of)?))
    }

    /// Calls `each` for each instance, with its placements, its map and its group.
    fn for_each_instance<E>(
        &self,
        mut each: impl FnMut(Through, &Image, &Arc<Group>) -> Result<(), E>,
    ) -> Result<(), E> {
        for number in self.reached.instances.iter() {
            if let Some((placement, child)) = self.get(number) {
                let image = Image::new(&self.placement_margin, placement);
                each(Through::One(number), &image, child)?;
            }
        }
        for outer in self.reached.opened.iter() {
            let Some((placement, opened)) = self.get(outer) else {
                continue;
            };
            for within in opened.placements() {
                for inner in within.all.iter() {
                    let Some((placed, child)) = within.get(inner) else {
                        continue;
                    };
                    let image = Image::new(&self.placement_margin, placement)
                        .through(&within.placement_margin, placed);
                    each(Through::Two { outer, inner }, &image, child)?;
                }
            }
        }
        Ok(())
    }

    /// Builds the instanced groups. This has to be done before the scene with the instances is
    /// built.
    pub fn build_instanced(&self) {
        let mut last: Option<*const Group> = None;
        let built = self.for_each_instance(|_, _, child| {
            if last.replace(Arc::as_ptr(child)) == Some(Arc::as_ptr(child)) {
                return Ok(());
            }
            child.build()
        });
        // An error is reported again when the instances are attached.
        let _ = built;
    }

    /// Whether there are instances.
    pub fn has_instances(&self) -> bool {
        self.reached.instances.len() + self.reached.opened.len() > 0
    }

    /// The number of instances.
    pub fn instance_count(&self) -> u64 {
        let mut count = 0;
        let counted = self.for_each_instance(|_, _, _| {
            count += 1;
            Ok::<_, std::convert::Infallible>(())
        });
        counted.map_or(0, |()| count)
    }

    /// Adds the instances, numbered by their placements.
    pub fn attach_instances(&self, builder: &mut SceneBuilder<Query>) -> Result<(), embree::Error> {
        for outer in self.reached.opened.iter() {
            if let Some((_, opened)) = self.get(outer) {
                opened.open();
            }
        }
        let placements = self.placements().len();
        self.for_each_instance(|through, image, child| {
            let map = instance_map(&self.frame, image, &child.frame);
            let number = GeometryId(through.number(placements));
            builder.attach_instance_as(number, child.joined()?, &map)
        })
    }

    /// Passes the query's ray to `trace`, in the space of the placed group.
    #[inline]
    pub fn visit<T: Default>(
        &self,
        index: u32,
        query: &mut Query,
        trace: impl FnOnce(&Group, &LocalRay, &mut Query) -> T,
    ) -> T {
        let Some((placement, child)) = self.get(index) else {
            return T::default();
        };
        counters::passed_on(1);
        query.position.leave_instance();
        let child_from_parent = ChildFromParent::new(&placement.parent_from_child);
        let ray = query.ray().in_child(&child_from_parent);
        query.position.path.push(index);
        let answer = trace(child, &ray, query);
        query.position.path.pop();
        answer
    }

    /// Passes a packet to `trace`, in the space of the placed group.
    #[inline]
    fn visit_packet(
        &self,
        index: u32,
        rays: RaySet,
        packet: &mut Packet,
        trace: impl FnOnce(&Group, &mut Packet) -> RaySet,
    ) -> RaySet {
        let Some((placement, child)) = self.get(index) else {
            return RaySet::EMPTY;
        };
        counters::passed_on(rays.len() as u32);
        packet.arrive_through(&ChildFromParent::new(&placement.parent_from_child));
        packet.position.path.push(index);
        let answer = trace(child, packet);
        packet.position.path.pop();
        answer
    }
}

impl UserGeometry for Arc<Placements> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.reached.called_back.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        // An empty child may have any box; the least is best.
        let reach = self.get(self.reached.called_back.number(primitive)).map_or(
            Bounds::at(self.frame.center()),
            |(placement, child)| {
                let count = self.placements().len();
                let (placement_margin, reach) = (&self.placement_margin, &child.reach);
                placement_margin.tight_reach(placement, reach, &child.parts, count)
            },
        );
        self.frame.grown_box(&reach)
    }

    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        query.called_back();
        let before = query.bound();
        let number = self.reached.called_back.number(at.primitive);
        self.visit(number, query, Group::search);
        (query.bound() < before).then(|| query.t_far())
    }

    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        query.called_back();
        let number = self.reached.called_back.number(at.primitive);
        self.visit(number, query, Group::occluded)
    }

    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        _: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        packet.called_back();
        let number = self.reached.called_back.number(at.primitive);
        let shorter = self.visit_packet(number, rays, packet, |child, packet| {
            child.search_packet(rays, packet)
        });
        for ray in shorter {
            t_far[ray] = packet.t_far(ray);
        }
        shorter
    }

    fn occluded_packet(
        &self,
        at: Reached,
        rays: RaySet,
        _: &Rays32,
        packet: &mut Packet,
    ) -> RaySet {
        packet.called_back();
        let number = self.reached.called_back.number(at.primitive);
        self.visit_packet(number, rays, packet, |child, packet| {
            child.occluded_packet(rays, packet)
        })
    }
}
