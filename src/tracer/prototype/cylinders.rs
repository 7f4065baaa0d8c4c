//! The cylinders of a group.

use std::marker::PhantomData;

use smallvec::SmallVec;

use super::ends::{Ends, EndsKind};
use super::members::{List, Members};
use super::numbers::Numbers;
use super::prototype_ref::PrototypeRef;
use super::solids::{Filtered, Solids};
use crate::embree::{Box32, GREATEST_PACKET, RaySet, prefetch};
use crate::math::LANES;
use crate::scene::{CylinderList, SharedRecords};
use crate::solid::{Cylinder, SolidKind};
use crate::tracer::filter::{CylinderFilter, HasFilter};
use crate::tracer::query::{Packet, Query};

/// The cylinders of a group, where the description keeps them.
#[derive(Clone)]
pub(crate) struct Cylinders {
    prototype_ref: PrototypeRef,
    /// The positions of their records.
    numbers: Numbers,
}

impl Cylinders {
    pub fn new(prototype_ref: &PrototypeRef, members: &Members) -> Self {
        Self {
            prototype_ref: prototype_ref.clone(),
            numbers: members.of(List::Solids(SolidKind::Cylinder)).clone(),
        }
    }

    /// Whose they are.
    #[inline(always)]
    pub fn prototype_ref(&self) -> &PrototypeRef {
        &self.prototype_ref
    }

    /// The list of the prototype.
    #[inline(always)]
    pub fn records(&self) -> &CylinderList {
        &self.prototype_ref.prototype().cylinders
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

    /// The cylinder of a record.
    #[inline(always)]
    pub fn cylinder(&self, record: u32) -> Cylinder {
        self.records().get(record as usize).cylinder()
    }

    /// The box of a record in the frame of the Embree scene.
    pub fn grown_box(&self, record: u32) -> Box32 {
        self.prototype_ref
            .grown_box(&self.cylinder(record).bounds())
    }
}

/// The cylinders of a group whose ends are known to be `E`.
pub(super) struct KnownCylinders<E> {
    cylinders: Cylinders,
    /// A callback gets to a record from here, not through scene, prototype and list, each of
    /// which it would wait for.
    records: SharedRecords,
    ends: PhantomData<E>,
}

impl<E: Ends> KnownCylinders<E> {
    pub fn new(cylinders: Cylinders) -> Self {
        Self {
            records: cylinders.records().shared(),
            cylinders,
            ends: PhantomData,
        }
    }

    /// The cylinder of a record.
    #[inline(always)]
    fn cylinder(&self, record: u32) -> Cylinder {
        E::known(self.records.cylinder(record as usize))
    }
}

impl<E: Ends> Solids for KnownCylinders<E> {
    #[inline(always)]
    fn prototype_ref(&self) -> &PrototypeRef {
        self.cylinders.prototype_ref()
    }

    fn len(&self) -> u32 {
        self.cylinders.len()
    }

    #[inline(always)]
    fn record(&self, position: u32) -> u32 {
        self.cylinders.record(position)
    }

    fn grown_box(&self, record: u32) -> Box32 {
        self.cylinders.grown_box(record)
    }

    #[inline(always)]
    fn prefetch(&self, record: u32) {
        match &self.records {
            SharedRecords::F64(records) => prefetch(&records[record as usize]),
            SharedRecords::F32(records) => prefetch(&records[record as usize]),
        }
    }

    #[inline(always)]
    fn visit(&self, record: u32, query: &mut Query) {
        query.visit(&self.cylinder(record), &self.cylinders, record);
    }

    #[inline(always)]
    fn meets(&self, record: u32, query: &Query) -> bool {
        query.meets(&self.cylinder(record))
    }

    #[inline(always)]
    fn visit_packet(
        &self,
        record: u32,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        let place = (&self.cylinders, record);
        packet.visit::<E>(&self.cylinder(record), place, rays, t_far)
    }

    #[inline(always)]
    fn meets_packet(&self, record: u32, rays: RaySet, packet: &Packet) -> RaySet {
        packet.meets::<E>(&self.cylinder(record), rays)
    }
}

impl<E: Ends> Filtered for KnownCylinders<E> {
    type Filter = CylinderFilter;

    fn filter(&self, records: &[u32]) -> CylinderFilter {
        let cylinders: SmallVec<[Cylinder; LANES]> = records
            .iter()
            .map(|&record| self.cylinder(record))
            .collect();
        Cylinder::filter(&cylinders, self.cylinders.prototype_ref().frame())
    }
}
