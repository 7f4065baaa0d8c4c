//! The placements of a group: as Embree's instances, or as primitives whose callback
//! traces what they place.

use std::sync::Arc;

use super::instances::instance_map;
use super::numbers::Numbers;
use super::sight::Sight;
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

/// Placements of a prototype, each of them for the group with the same number of what
/// it places. The description keeps them: there is
/// nothing else in memory of a primitive but its leaf in Embree's tree.
///
/// The way back into the child's space is worked out on each visit. It is some
/// forty operations without a branch, beside the hundreds of a nested
/// traversal; keeping it would take as much memory again as the placement.
pub(super) struct Placements {
    pub description: Arc<Scene>,
    pub prototype: PrototypeIndex,
    pub frame: Frame,
    pub sight: Sight,
    pub children: Children<Group>,
    /// The numbers of the placements.
    pub all: Numbers,
    /// The numbers of those that rays may reach: the ones that are Embree's instances,
    /// and the ones that are primitives.
    pub instances: Numbers,
    pub called_back: Numbers,
}

impl Placements {
    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.prototype.0 as usize].placements
    }

    /// What a placement places.
    fn of(&self, index: u32) -> PrototypeIndex {
        self.placements()[index as usize].of
    }

    /// A placement and the group it places, if there is anything.
    #[inline]
    fn get(&self, index: u32) -> Option<(&Placement, &Arc<Group>)> {
        let placement = &self.placements()[index as usize];
        Some((placement, self.children.of(placement.of)?))
    }

    /// The groups that there are instances of. They are built before the scene that the
    /// instances are in.
    pub fn instanced(&self) -> Vec<&Arc<Group>> {
        let mut indices: Vec<_> = self
            .instances
            .iter()
            .map(|number| self.of(number))
            .collect();
        indices.sort_unstable();
        indices.dedup();
        let groups = indices.into_iter();
        groups.filter_map(|index| self.children.of(index)).collect()
    }

    /// Adds the instances, whose numbers are those of the placements.
    pub fn attach_instances(&self, builder: &mut SceneBuilder<Query>) -> Result<(), embree::Error> {
        for number in self.instances.iter() {
            let Some((placement, child)) = self.get(number) else {
                continue;
            };
            let map = instance_map(&self.frame, placement, &child.frame);
            builder.attach_instance_as(GeometryId(number), child.joined()?, &map)?;
        }
        Ok(())
    }

    /// Hands the query's ray to `trace` in the space of the placed group.
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
        counters::handed_on(1);
        query.leave_instance();
        let way = ChildFromParent::new(&placement.parent_from_child);
        let ray = query.ray().in_child(&way);
        query.path.push(index);
        let answer = trace(child, &ray, query);
        query.path.pop();
        answer
    }

    /// Brings a packet to the placed group for `trace`, likewise.
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
        counters::handed_on(rays.len() as u32);
        packet.arrive_through(&ChildFromParent::new(&placement.parent_from_child));
        packet.path.push(index);
        let answer = trace(child, packet);
        packet.path.pop();
        answer
    }
}

impl UserGeometry for Arc<Placements> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.called_back.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        // Where nothing is placed any box will do; the least is best.
        let reach = self.get(self.called_back.number(primitive)).map_or(
            Bounds::at(self.frame.centre()),
            |(placement, child)| {
                let count = self.placements().len();
                let (sight, reach) = (&self.sight, &child.reach);
                sight.tight_reach(placement, reach, &child.parts, count)
            },
        );
        self.frame.grown_box(&reach)
    }

    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        let before = query.bound();
        self.visit(self.called_back.number(at.primitive), query, Group::search);
        (query.bound() < before).then(|| query.t_far())
    }

    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        self.visit(
            self.called_back.number(at.primitive),
            query,
            Group::occluded,
        )
    }

    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        _: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        let number = self.called_back.number(at.primitive);
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
        counters::called_back();
        packet.callbacks += 1;
        let number = self.called_back.number(at.primitive);
        self.visit_packet(number, rays, packet, |child, packet| {
            child.occluded_packet(rays, packet)
        })
    }
}
