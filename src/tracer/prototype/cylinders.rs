//! The cylinders of a prototype as Embree's primitives, one each.

use std::marker::PhantomData;

use super::blocks::GREATEST_RECORDS;
use super::described::Described;
use super::ends::{Ends, EndsKind};
use crate::embree::{Box32, GREATEST_PACKET, RaySet, UserGeometry};
use crate::scene::CylinderList;
use crate::solid::Cylinder;
use crate::tracer::counters;
use crate::tracer::query::{Packet, Query};

/// The cylinders of a prototype, where the description keeps them.
#[derive(Clone)]
pub(crate) struct Cylinders {
    described: Described,
}

impl Cylinders {
    pub fn new(described: &Described) -> Self {
        Self {
            described: described.clone(),
        }
    }

    /// Whose they are.
    #[inline(always)]
    pub fn described(&self) -> &Described {
        &self.described
    }

    /// All of them.
    #[inline(always)]
    pub fn records(&self) -> &CylinderList {
        &self.described.prototype().cylinders
    }

    /// How many there are.
    #[inline]
    pub fn len(&self) -> u32 {
        self.records().len() as u32
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
    pub cylinders: Cylinders,
    pub ends: PhantomData<E>,
}

impl<E: Ends> SingleCylinders<E> {
    /// The cylinder of a record, of which it is known what ends it has.
    #[inline(always)]
    fn cylinder(&self, record: u32) -> Cylinder {
        E::known(self.cylinders.cylinder(record))
    }
}

impl<E: Ends> UserGeometry for SingleCylinders<E> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.cylinders.len()
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.cylinders.grown_box(primitive)
    }

    #[inline(always)]
    fn intersect(&self, primitive: u32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        let before = query.bound();
        query.visit(&self.cylinder(primitive), &self.cylinders, primitive);
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, primitive: u32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        query.meets(&self.cylinder(primitive))
    }

    #[inline(always)]
    fn intersect_packet(
        &self,
        primitive: u32,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        let cylinder = self.cylinder(primitive);
        packet.visit::<E>(&cylinder, (&self.cylinders, primitive), rays, t_far)
    }

    #[inline(always)]
    fn occluded_packet(&self, primitive: u32, rays: RaySet, packet: &mut Packet) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        packet.meets::<E>(&self.cylinder(primitive), rays)
    }
}
