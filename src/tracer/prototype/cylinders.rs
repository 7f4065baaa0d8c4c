//! The cylinders of a group as Embree's primitives, one each.

use std::marker::PhantomData;
use std::sync::Arc;

use super::blocks::GREATEST_RECORDS;
use super::described::Described;
use super::ends::{Ends, EndsKind};
use super::members::{List, Members};
use super::numbers::Numbers;
use crate::embree::{Box32, GREATEST_PACKET, Ray32, RaySet, Reached, UserGeometry};
use crate::scene::{CylinderList, CylinderRecord};
use crate::solid::{Cylinder, SolidKind};
use crate::tracer::counters;
use crate::tracer::query::{Packet, Query};

/// The cylinders of a group, where the description keeps them.
#[derive(Clone)]
pub(crate) struct Cylinders {
    described: Described,
    /// The positions of their records.
    numbers: Numbers,
}

impl Cylinders {
    pub fn new(described: &Described, members: &Members) -> Self {
        Self {
            described: described.clone(),
            numbers: members.of(List::Solids(SolidKind::Cylinder)).clone(),
        }
    }

    /// Whose they are.
    #[inline(always)]
    pub fn described(&self) -> &Described {
        &self.described
    }

    /// The list of the prototype.
    #[inline(always)]
    pub fn records(&self) -> &CylinderList {
        &self.described.prototype().cylinders
    }

    /// How many there are.
    #[inline]
    pub fn len(&self) -> u32 {
        self.numbers.len()
    }

    /// The position of the record of the cylinder at a position.
    #[inline(always)]
    pub fn record(&self, position: u32) -> u32 {
        self.numbers.number(position)
    }

    /// Which ends they have.
    pub fn ends(&self) -> EndsKind {
        EndsKind::of(self.records())
    }

    /// Whether they are few enough for blocks.
    pub fn fit_blocks(&self) -> bool {
        self.records().len() <= GREATEST_RECORDS
    }

    /// The cylinder of a record.
    #[inline(always)]
    pub fn cylinder(&self, record: u32) -> Cylinder {
        self.records().get(record as usize).cylinder()
    }

    /// The box of a record in the frame of the Embree scene.
    pub fn grown_box(&self, record: u32) -> Box32 {
        self.described.grown_box(&self.cylinder(record).bounds())
    }
}

/// A user geometry with a primitive for each cylinder.
pub(super) struct SingleCylinders<E> {
    cylinders: Cylinders,
    /// The records, if they are of f64. A callback gets to one from here, not
    /// through scene, prototype and list, each of which it would wait for.
    records: Option<Arc<Vec<CylinderRecord>>>,
    ends: PhantomData<E>,
}

impl<E: Ends> SingleCylinders<E> {
    pub fn new(cylinders: Cylinders) -> Self {
        Self {
            records: cylinders.records().shared_f64(),
            cylinders,
            ends: PhantomData,
        }
    }

    /// The cylinder of a record, of which it is known what ends it has.
    #[inline(always)]
    fn cylinder(&self, record: u32) -> Cylinder {
        E::known(match &self.records {
            Some(records) => records[record as usize].cylinder(),
            None => self.cylinders.cylinder(record),
        })
    }
}

impl<E: Ends> UserGeometry for SingleCylinders<E> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.cylinders.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.cylinders.grown_box(self.cylinders.record(primitive))
    }

    #[inline(always)]
    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.cylinders.described());
        let before = query.bound();
        let record = self.cylinders.record(at.primitive);
        query.visit(&self.cylinder(record), &self.cylinders, record);
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.cylinders.described());
        query.meets(&self.cylinder(self.cylinders.record(at.primitive)))
    }

    #[inline(always)]
    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        packet.reach(at.instance, self.cylinders.described());
        let record = self.cylinders.record(at.primitive);
        packet.visit::<E>(
            &self.cylinder(record),
            (&self.cylinders, record),
            rays,
            t_far,
        )
    }

    #[inline(always)]
    fn occluded_packet(&self, at: Reached, rays: RaySet, packet: &mut Packet) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        packet.reach(at.instance, self.cylinders.described());
        let record = self.cylinders.record(at.primitive);
        packet.meets::<E>(&self.cylinder(record), rays)
    }
}
