//! The cylinders of a prototype as Embree's primitives, eight each.
//!
//! A block holds cylinders that are near together, number by number side by
//! side, so that the solver takes all eight at once. Embree's tree has an
//! eighth of the leaves then, which saves memory and the time to build; a
//! single ray gains most, for it has nothing else to fill the lanes with.

use std::marker::PhantomData;

use glam::DVec3;

use super::clusters::{Item, cluster};
use super::cylinders::Cylinders;
use super::ends::Ends;
use crate::embree::{Box32, GREATEST_PACKET, Ray32, RaySet, Reached, UserGeometry};
use crate::math::{LANES, LaneMask, LaneVectors, Lanes};
use crate::scene::Records;
use crate::solid::lanes::{CylinderLanes, RayLanes, first};
use crate::solid::{Caps, Cylinder};
use crate::tracer::counters;
use crate::tracer::frame::LocalRay;
use crate::tracer::query::{Packet, Query};

/// Up to eight cylinders.
pub(crate) trait CylinderBlock {
    /// The positions of the records in the description, in the order of lanes.
    fn records(&self) -> impl Iterator<Item = u32>;

    /// The position of a lane's record.
    fn record(&self, lane: usize) -> u32;

    /// Where a ray first meets each of them in a range.
    fn first<E: Ends>(&self, ray: &LocalRay, t_min: f64, t_max: f64) -> (LaneMask, Lanes);
}

/// A block with its numbers as `S`.
#[repr(C, align(64))]
pub(super) struct Block<S> {
    p0: [[S; LANES]; 3],
    p1: [[S; LANES]; 3],
    radius: [S; LANES],
    /// Which record and which ends, see [`tag`]; [`NO_RECORD`] where there is no
    /// cylinder. The numbers of such a lane are NaN, which no ray meets.
    tags: [u32; LANES],
}

const _: () = assert!(size_of::<Block<f64>>() == 512 && size_of::<Block<f32>>() == 256);

/// The tag of a lane that holds nothing.
const NO_RECORD: u32 = u32::MAX;

/// The most cylinders of a prototype that can be put into blocks: two bits of a
/// tag say which ends are closed.
pub(super) const GREATEST_RECORDS: usize = (1 << 30) - 1;

fn tag(record: u32, caps: Caps) -> u32 {
    record << 2 | u32::from(caps.at_p1()) << 1 | u32::from(caps.at_p0())
}

#[inline(always)]
fn caps_of(tag: u32) -> Caps {
    Caps::at(tag & 1 != 0, tag & 2 != 0)
}

/// The memory that the blocks of so many cylinders take.
pub(crate) fn block_bytes(cylinders: u64, records: Records) -> u64 {
    let block = match records {
        Records::F64 => size_of::<Block<f64>>(),
        Records::F32 => size_of::<Block<f32>>(),
    };
    cylinders
        .div_ceil(LANES as u64)
        .saturating_mul(block as u64)
}

/// A number of a block.
pub(super) trait Stored: Copy + Send + Sync + Into<f64> + 'static {
    /// What a lane without a cylinder holds.
    const NAN: Self;

    /// The same number; for f32, one that is known to be one.
    fn of(x: f64) -> Self;
}

impl Stored for f64 {
    const NAN: Self = Self::NAN;

    fn of(x: f64) -> Self {
        x
    }
}

impl Stored for f32 {
    const NAN: Self = Self::NAN;

    fn of(x: f64) -> Self {
        x as Self
    }
}

impl<S: Stored> Block<S> {
    fn new(cylinders: &Cylinders, items: &[Item]) -> Self {
        let mut block = Self {
            p0: [[S::NAN; LANES]; 3],
            p1: [[S::NAN; LANES]; 3],
            radius: [S::NAN; LANES],
            tags: [NO_RECORD; LANES],
        };
        for (lane, item) in items.iter().enumerate() {
            let cylinder = cylinders.cylinder(item.number);
            for axis in 0..3 {
                block.p0[axis][lane] = S::of(cylinder.p0()[axis]);
                block.p1[axis][lane] = S::of(cylinder.p1()[axis]);
            }
            block.radius[lane] = S::of(cylinder.radius());
            block.tags[lane] = tag(item.number, cylinder.caps());
        }
        block
    }

    /// The lanes that hold a cylinder: the first ones.
    #[inline(always)]
    fn len(&self) -> usize {
        let is_empty = |tag: &u32| *tag == NO_RECORD;
        self.tags.iter().position(is_empty).unwrap_or(LANES)
    }

    #[inline(always)]
    fn cylinder<E: Ends>(&self, lane: usize) -> Cylinder {
        let point = |of: &[[S; LANES]; 3]| {
            DVec3::new(of[0][lane].into(), of[1][lane].into(), of[2][lane].into())
        };
        let caps = caps_of(self.tags[lane]);
        let radius = self.radius[lane].into();
        E::known(Cylinder::from_valid(
            point(&self.p0),
            point(&self.p1),
            radius,
            caps,
        ))
    }
}

#[inline(always)]
fn lanes<S: Stored>(numbers: &[S; LANES]) -> Lanes {
    Lanes(numbers.map(Into::into))
}

#[inline(always)]
fn vectors<S: Stored>(numbers: &[[S; LANES]; 3]) -> LaneVectors {
    LaneVectors {
        x: lanes(&numbers[0]),
        y: lanes(&numbers[1]),
        z: lanes(&numbers[2]),
    }
}

impl<S: Stored> CylinderBlock for Block<S> {
    fn records(&self) -> impl Iterator<Item = u32> {
        (0..self.len()).map(|lane| self.record(lane))
    }

    #[inline(always)]
    fn record(&self, lane: usize) -> u32 {
        self.tags[lane] >> 2
    }

    #[inline(always)]
    fn first<E: Ends>(&self, ray: &LocalRay, t_min: f64, t_max: f64) -> (LaneMask, Lanes) {
        let p0 = vectors(&self.p0);
        let cylinders = CylinderLanes {
            axis: vectors(&self.p1) - p0,
            radius: lanes(&self.radius),
            caps: E::of_each(self.tags.map(caps_of)),
        };
        let rays = RayLanes {
            from_p0: LaneVectors::splat(ray.origin) - (p0 - LaneVectors::splat(ray.base)),
            direction: LaneVectors::splat(ray.direction),
            shift: Lanes::splat(ray.shift),
            t_min: Lanes::splat(t_min),
            t_max: Lanes::splat(t_max),
        };
        first(&cylinders, &rays, &LaneMask::splat(true))
    }
}

/// A user geometry with a primitive for each block.
pub(super) struct BlockedCylinders<E, S> {
    cylinders: Cylinders,
    blocks: Vec<Block<S>>,
    ends: PhantomData<E>,
}

impl<E: Ends, S: Stored> BlockedCylinders<E, S> {
    /// Puts the cylinders into blocks, on up to `threads` threads.
    pub fn new(cylinders: &Cylinders, threads: usize) -> Self {
        let mut items: Vec<Item> = (0..cylinders.len())
            .map(|position| cylinders.record(position))
            .map(|number| Item {
                bounds: cylinders.grown_box(number),
                number,
            })
            .collect();
        cluster(&mut items, LANES, threads);
        let blocks = items.chunks(LANES);
        Self {
            cylinders: cylinders.clone(),
            blocks: blocks.map(|items| Block::new(cylinders, items)).collect(),
            ends: PhantomData,
        }
    }
}

impl<E: Ends, S: Stored> UserGeometry for BlockedCylinders<E, S> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.blocks.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        let records = self.blocks[primitive as usize].records();
        records
            .map(|record| self.cylinders.grown_box(record))
            .fold(Box32::EMPTY, |sum, one| sum.union(&one))
    }

    #[inline(always)]
    fn intersect(&self, at: Reached, _: &Ray32, query: &mut Query) -> Option<f32> {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.cylinders.described());
        let before = query.bound();
        query.visit_block::<E>(&self.blocks[at.primitive as usize], &self.cylinders);
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, at: Reached, _: &Ray32, query: &mut Query) -> bool {
        counters::called_back();
        query.callbacks += 1;
        query.reach(at.instance, self.cylinders.described());
        query.meets_block::<E>(&self.blocks[at.primitive as usize])
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
        let block = &self.blocks[at.primitive as usize];
        let mut shorter = RaySet::EMPTY;
        for lane in 0..block.len() {
            let place = (&self.cylinders, block.record(lane));
            shorter = shorter | packet.visit::<E>(&block.cylinder::<E>(lane), place, rays, t_far);
        }
        shorter
    }

    #[inline(always)]
    fn occluded_packet(&self, at: Reached, rays: RaySet, packet: &mut Packet) -> RaySet {
        counters::called_back();
        packet.callbacks += 1;
        packet.reach(at.instance, self.cylinders.described());
        let block = &self.blocks[at.primitive as usize];
        let mut blocked = RaySet::EMPTY;
        for lane in 0..block.len() {
            blocked = blocked | packet.meets::<E>(&block.cylinder::<E>(lane), rays - blocked);
            if blocked == rays {
                break;
            }
        }
        blocked
    }
}
