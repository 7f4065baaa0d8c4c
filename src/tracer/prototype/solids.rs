//! The solids of one kind in a group, as user geometries see them, and the plainest of
//! those: a primitive of Embree's for each solid.

use super::prototype_ref::PrototypeRef;
use crate::embree::{Box32, GREATEST_PACKET, Ray32, RaySet, Rays32, Reached, UserGeometry};
use crate::tracer::counters;
use crate::tracer::filter::Filter;
use crate::tracer::query::{Packet, Query};

/// The solids of one kind in a group. A solid is known by the position of its record in the
/// description.
pub(super) trait Solids: Send + Sync + 'static {
    /// Whose they are.
    fn prototype_ref(&self) -> &PrototypeRef;

    /// How many there are.
    fn len(&self) -> u32;

    /// The record of the solid at a position.
    fn record(&self, position: u32) -> u32;

    /// The box of a solid in the frame of the Embree scene.
    fn grown_box(&self, record: u32) -> Box32;

    /// Begins to bring a record near to the processor.
    fn prefetch(&self, record: u32);

    /// Keeps of the points where the query's ray meets a solid those that are wanted.
    fn visit(&self, record: u32, query: &mut Query);

    /// Whether the query's ray meets a solid.
    fn meets(&self, record: u32, query: &Query) -> bool;

    /// As [`visit`](Self::visit) for rays of a packet. Returns those that end earlier now,
    /// whose `t_far` is set.
    fn visit_packet(
        &self,
        record: u32,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet;

    /// Those of the rays that meet a solid.
    fn meets_packet(&self, record: u32, rays: RaySet, packet: &Packet) -> RaySet;
}

/// Solids of a kind that has a filter.
pub(super) trait Filtered: Solids {
    /// The filter of a block.
    type Filter: Filter;

    /// The filter of up to eight solids, whose lanes are in this order.
    fn filter(&self, records: &[u32]) -> Self::Filter;
}

/// A user geometry with a primitive for each solid.
pub(super) struct Single<S>(pub S);

impl<S: Solids> UserGeometry for Single<S> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.0.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.0.grown_box(self.0.record(primitive))
    }

    #[inline(always)]
    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.0.prototype_ref());
        let before = query.bound();
        self.0.visit(self.0.record(at.primitive), query);
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.0.prototype_ref());
        self.0.meets(self.0.record(at.primitive), query)
    }

    #[inline(always)]
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
        packet.reach(at.instance, self.0.prototype_ref());
        let record = self.0.record(at.primitive);
        self.0.visit_packet(record, rays, t_far, packet)
    }

    #[inline(always)]
    fn occluded_packet(
        &self,
        at: Reached,
        rays: RaySet,
        _: &Rays32,
        packet: &mut Packet,
    ) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        packet.reach(at.instance, self.0.prototype_ref());
        let record = self.0.record(at.primitive);
        self.0.meets_packet(record, rays, packet)
    }
}
