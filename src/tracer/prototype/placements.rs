//! The placements of a group as Embree's primitives.

use std::sync::Arc;

use super::numbers::Numbers;
use super::sight::Sight;
use super::{Children, Group};
use crate::embree::{
    Box32, GREATEST_PACKET, Instructions, Ray32, RaySet, Rays32, Reached, UserGeometry,
};
use crate::math::{Bounds, ChildFromParent};
use crate::scene::{Placement, PrototypeIndex, Scene};
use crate::tracer::counters;
use crate::tracer::frame::{Frame, IntoChild, LocalRay, PacketRays};
use crate::tracer::query::{Packet, Query};

/// Placements of a prototype, each of them for the group with the same number of what
/// it places. The description keeps them: there is
/// nothing else in memory of a placement but its leaf in Embree's tree.
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
    /// The numbers of those that rays may reach.
    pub in_view: Numbers,
    pub instructions: Instructions,
}

impl Placements {
    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.prototype.0 as usize].placements
    }

    /// A placement and the group it places, if there is anything.
    #[inline]
    fn get(&self, index: u32) -> Option<(&Placement, &Arc<Group>)> {
        let placement = &self.placements()[index as usize];
        Some((placement, self.children.of(placement.of)?))
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
        let way = ChildFromParent::new(&placement.parent_from_child);
        let ray = query.level().ray.in_child(&way);
        query.path.push(index);
        let answer = trace(child, &ray, query);
        query.path.pop();
        answer
    }

    /// Hands rays of a packet to `trace` likewise.
    #[inline]
    fn visit_packet(
        &self,
        index: u32,
        rays: RaySet,
        packet: &mut Packet,
        trace: impl FnOnce(&Group, &PacketRays, &mut Packet) -> RaySet,
    ) -> RaySet {
        let Some((placement, child)) = self.get(index) else {
            return RaySet::EMPTY;
        };
        counters::handed_on(rays.len() as u32);
        let way = ChildFromParent::new(&placement.parent_from_child);
        let in_child = self.instructions.run(IntoChild {
            rays: packet.rays(),
            way: &way,
        });
        packet.path.push(index);
        let answer = trace(child, &in_child, packet);
        packet.path.pop();
        answer
    }
}

impl UserGeometry for Arc<Placements> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.in_view.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        // Where nothing is placed any box will do; the least is best.
        let reach = self
            .get(self.in_view.number(primitive))
            .map_or(Bounds::at(self.frame.centre()), |(placement, child)| {
                self.sight.placement_reach(placement, &child.reach)
            });
        self.frame.grown_box(&reach)
    }

    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        let before = query.bound();
        self.visit(self.in_view.number(at.primitive), query, Group::search);
        (query.bound() < before).then(|| query.t_far())
    }

    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        self.visit(self.in_view.number(at.primitive), query, Group::occluded)
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
        let number = self.in_view.number(at.primitive);
        let shorter = self.visit_packet(number, rays, packet, |child, in_child, packet| {
            child.search_packet(rays, in_child, packet)
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
        let number = self.in_view.number(at.primitive);
        self.visit_packet(number, rays, packet, |child, in_child, packet| {
            child.occluded_packet(rays, in_child, packet)
        })
    }
}
