//! The solids of one kind in a group, for user geometries, and the simplest geometry: one
//! primitive per solid.

use std::borrow::Borrow;
use std::marker::PhantomData;

use smallvec::SmallVec;

use super::numbers::Numbers;
use super::prototype_ref::PrototypeRef;
use crate::embree::{
    Box32, GREATEST_PACKET, Ray32, RaySet, Rays32, Reached, UserGeometry, prefetch,
};
use crate::math::LANES;
use crate::scene::SolidList;
use crate::tracer::filter::Filtered;
use crate::tracer::query::{Packet, Query};
use crate::tracer::traced::TracedSolid;

/// Access for callbacks to the solids of one kind, by the positions of their records in the
/// description.
pub(crate) trait Records: Send + Sync + 'static {
    /// The kind.
    type Solid: TracedSolid;

    /// The solid of a record.
    fn solid(&self, prototype_ref: &PrototypeRef, record: u32) -> impl Borrow<Self::Solid>;

    /// Prefetches a record.
    fn prefetch(&self, prototype_ref: &PrototypeRef, record: u32);

    /// As [`Query::visit`]. Not inlined by default: a solver with branches gains nothing from
    /// being compiled for each instruction set.
    fn visit(&self, prototype_ref: &PrototypeRef, record: u32, query: &mut Query) {
        query.visit::<Self::Solid>(
            self.solid(prototype_ref, record).borrow(),
            prototype_ref,
            record,
        );
    }

    /// As [`Query::intersects`], in the same way.
    fn intersects(&self, prototype_ref: &PrototypeRef, record: u32, query: &Query) -> bool {
        query.intersects::<Self::Solid>(self.solid(prototype_ref, record).borrow())
    }
}

/// The records in the list of the prototype.
pub(crate) struct InPrototype<S>(PhantomData<fn() -> S>);

impl<S> InPrototype<S> {
    pub fn new() -> Self {
        Self(PhantomData)
    }
}

impl<S: TracedSolid> Records for InPrototype<S> {
    type Solid = S;

    #[inline(always)]
    fn solid(&self, prototype_ref: &PrototypeRef, record: u32) -> impl Borrow<S> {
        S::list(&prototype_ref.prototype().solids).solid(record as usize)
    }

    #[inline(always)]
    fn prefetch(&self, prototype_ref: &PrototypeRef, record: u32) {
        prefetch::<S>(self.solid(prototype_ref, record).borrow());
    }
}

/// The solids of one kind in a group.
pub(crate) struct GroupSolids<R> {
    prototype_ref: PrototypeRef,
    /// The positions of their records.
    numbers: Numbers,
    records: R,
}

impl<R: Records> GroupSolids<R> {
    pub fn new(prototype_ref: &PrototypeRef, numbers: &Numbers, records: R) -> Self {
        Self {
            prototype_ref: prototype_ref.clone(),
            numbers: numbers.clone(),
            records,
        }
    }

    /// The prototype of the solids.
    #[inline(always)]
    pub fn prototype_ref(&self) -> &PrototypeRef {
        &self.prototype_ref
    }

    /// The number of solids.
    pub fn len(&self) -> u32 {
        self.numbers.len()
    }

    /// The record of the solid at a position.
    #[inline(always)]
    pub fn record(&self, position: u32) -> u32 {
        self.numbers.number(position)
    }

    /// The solid of a record.
    #[inline(always)]
    fn solid(&self, record: u32) -> impl Borrow<R::Solid> {
        self.records.solid(&self.prototype_ref, record)
    }

    /// The box of a solid in the frame of the Embree scene.
    pub fn grown_box(&self, record: u32) -> Box32 {
        let bounds = TracedSolid::bounds(self.solid(record).borrow());
        if bounds.is_empty() {
            // The result of set operations may be empty; Embree requires a box anyway.
            return Box32 {
                lower: [0.0; 3],
                upper: [0.0; 3],
            };
        }
        self.prototype_ref.grown_box(&bounds)
    }

    /// Prefetches a record.
    #[inline(always)]
    pub fn prefetch(&self, record: u32) {
        self.records.prefetch(&self.prototype_ref, record);
    }

    /// Keeps the hits of the query's ray with a solid that the query is for.
    #[inline(always)]
    pub fn visit(&self, record: u32, query: &mut Query) {
        self.records.visit(&self.prototype_ref, record, query);
    }

    /// Whether the query's ray hits a solid.
    #[inline(always)]
    pub fn intersects(&self, record: u32, query: &Query) -> bool {
        self.records.intersects(&self.prototype_ref, record, query)
    }

    /// As [`visit`](Self::visit) for rays of a packet. Returns the rays that now end earlier,
    /// and sets their `t_far`.
    // Inlined for the rows of lanes within; see `embree::callback`.
    #[inline(always)]
    pub fn visit_packet(
        &self,
        record: u32,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        let place = (&self.prototype_ref, record);
        packet.visit::<R::Solid>(self.solid(record).borrow(), place, rays, t_far)
    }

    /// The rays that hit a solid.
    #[inline(always)]
    pub fn intersects_packet(&self, record: u32, rays: RaySet, packet: &Packet) -> RaySet {
        packet.intersects::<R::Solid>(self.solid(record).borrow(), rays)
    }
}

impl<R: Records<Solid: Filtered>> GroupSolids<R> {
    /// The filter of up to eight solids, in lanes of this order.
    pub fn filter(&self, records: &[u32]) -> <R::Solid as Filtered>::Filter {
        let solids = records.iter().map(|&record| *self.solid(record).borrow());
        let solids: SmallVec<[R::Solid; LANES]> = solids.collect();
        R::Solid::filter(&solids, self.prototype_ref.frame(), 1.0)
    }
}

/// A user geometry with a primitive for each solid.
pub(crate) struct Single<R>(pub GroupSolids<R>);

impl<R: Records> UserGeometry for Single<R> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.0.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.0.grown_box(self.0.record(primitive))
    }

    #[inline(always)]
    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        query.called_back();
        query.reach(at.instance, self.0.prototype_ref());
        let before = query.bound();
        self.0.visit(self.0.record(at.primitive), query);
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        query.called_back();
        query.reach(at.instance, self.0.prototype_ref());
        self.0.intersects(self.0.record(at.primitive), query)
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
        packet.called_back();
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
        packet.called_back();
        packet.reach(at.instance, self.0.prototype_ref());
        let record = self.0.record(at.primitive);
        self.0.intersects_packet(record, rays, packet)
    }
}
