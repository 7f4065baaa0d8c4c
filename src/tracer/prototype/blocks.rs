//! Blocks of eight solids as Embree's primitives.
//!
//! A block contains solids that are near each other. Its [`Filter`] selects those that Embree's
//! ray may hit. Only these are solved, from their records, as if each were a primitive of its
//! own. Embree's tree has an eighth of the leaves, which saves memory and build time, and a ray
//! pays once for a leaf that it reaches instead of for each solid there.

use super::clusters::{Item, cluster};
use super::group_solids::{GroupSolids, Records};
use crate::embree::{Box32, GREATEST_PACKET, Ray32, RaySet, Rays32, Reached, UserGeometry};
use crate::math::LANES;
use crate::tracer::filter::{FILTER_BYTES, Filter, Filtered, NearPacket, survivors};
use crate::tracer::query::{Packet, Query};

/// The greatest number of rays of a packet that are tested one by one against all solids of a
/// block. More rays are tested together against one solid after another.
const FEW_RAYS: usize = 2;

/// The memory of the blocks of `solids`.
pub(crate) fn block_bytes(solids: u64) -> u64 {
    let records = solids.saturating_mul(size_of::<u32>() as u64);
    let blocks = solids.div_ceil(LANES as u64);
    let filters = blocks.saturating_mul(FILTER_BYTES as u64);
    filters.saturating_add(records)
}

/// The filter of a block.
type FilterOf<R> = <<R as Records>::Solid as Filtered>::Filter;

/// A user geometry with a primitive for each block.
pub(super) struct Blocked<R: Records<Solid: Filtered>> {
    solids: GroupSolids<R>,
    filters: Vec<FilterOf<R>>,
    /// The records in the order of blocks, [`LANES`] for each except the last.
    records: Vec<u32>,
}

impl<R: Records<Solid: Filtered>> Blocked<R> {
    /// Puts the solids into blocks, on up to `threads` threads.
    pub fn new(solids: GroupSolids<R>, threads: usize) -> Self {
        const { assert!(size_of::<FilterOf<R>>() == FILTER_BYTES, "a cache line") };
        let mut items: Vec<Item> = (0..solids.len())
            .map(|position| solids.record(position))
            .map(|number| Item {
                bounds: solids.grown_box(number),
                number,
            })
            .collect();
        cluster(&mut items, LANES, threads);
        let records: Vec<u32> = items.into_iter().map(|item| item.number).collect();
        Self {
            filters: filters(&solids, &records, threads),
            solids,
            records,
        }
    }

    /// The records of a block.
    #[inline(always)]
    fn records(&self, primitive: u32) -> &[u32] {
        let first = primitive as usize * LANES;
        let end = (first + LANES).min(self.records.len());
        &self.records[first..end]
    }

    /// The records of a block's solids that a ray may hit. Prefetches them.
    #[inline(always)]
    fn near(&self, primitive: u32, ray: &Ray32) -> Near<'_> {
        let near = Near {
            records: self.records(primitive),
            lanes: survivors(&self.filters[primitive as usize], ray),
        };
        near.clone().for_each(|record| self.solids.prefetch(record));
        near
    }

    /// For each solid of a block, the rays of a packet that may hit it.
    #[inline(always)]
    fn near_packet(&self, primitive: u32, rays: RaySet, rays32: &Rays32) -> [RaySet; LANES] {
        let filter = &self.filters[primitive as usize];
        let mut near = [RaySet::EMPTY; LANES];
        if rays.len() <= FEW_RAYS {
            for ray in rays {
                let lanes = survivors(filter, &rays32.ray(ray));
                for (lane, near) in near.iter_mut().enumerate() {
                    *near = *near | RaySet::from_bits(u16::from(lanes >> lane & 1) << ray);
                }
            }
        } else {
            let packet = NearPacket::new(filter.cell(), rays32, rays);
            let mut lanes = packet.lanes(filter);
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                near[lane] = packet.survivors(filter, lane);
            }
        }
        near
    }
}

/// Fewer filters than this are computed on one thread, which takes less than a millisecond.
const LEAST_FOR_THREADS: usize = 1 << 11;

/// The filters of records in the order of blocks.
fn filters<R: Records<Solid: Filtered>>(
    solids: &GroupSolids<R>,
    records: &[u32],
    threads: usize,
) -> Vec<FilterOf<R>> {
    let made = move |records: &[u32]| -> Vec<FilterOf<R>> {
        let blocks = records.chunks(LANES);
        blocks.map(|records| solids.filter(records)).collect()
    };
    let blocks = records.len().div_ceil(LANES);
    if threads < 2 || blocks < LEAST_FOR_THREADS {
        return made(records);
    }
    // Not on a pool of rayon's: see `cluster`.
    let mut filters = Vec::with_capacity(blocks);
    std::thread::scope(|scope| {
        let parts = records.chunks(blocks.div_ceil(threads) * LANES);
        let parts: Vec<_> = parts.map(|part| scope.spawn(move || made(part))).collect();
        for part in parts {
            match part.join() {
                Ok(part) => filters.extend(part),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
    });
    filters
}

/// Some records of a block.
#[derive(Clone)]
struct Near<'a> {
    records: &'a [u32],
    /// The remaining lanes, as bits.
    lanes: u8,
}

impl Iterator for Near<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        let lane = self.lanes.trailing_zeros() as usize;
        if self.lanes == 0 {
            return None;
        }
        self.lanes &= self.lanes - 1;
        Some(self.records[lane])
    }
}

impl<R: Records<Solid: Filtered>> UserGeometry for Blocked<R> {
    type Query = Query;

    fn primitive_count(&self) -> u32 {
        self.filters.len() as u32
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        let records = self.records(primitive).iter();
        records
            .map(|&record| self.solids.grown_box(record))
            .fold(Box32::EMPTY, |sum, one| sum.union(&one))
    }

    #[inline(always)]
    fn intersect(&self, at: Reached, ray: &Ray32, query: &mut Query) -> Option<f32> {
        query.called_back();
        let near = self.near(at.primitive, ray);
        if near.lanes == 0 {
            return None;
        }
        query.reach(at.instance, self.solids.prototype_ref());
        let before = query.bound();
        for record in near {
            self.solids.visit(record, query);
        }
        (query.bound() < before).then(|| query.t_far())
    }

    #[inline(always)]
    fn occluded(&self, at: Reached, ray: &Ray32, query: &mut Query) -> bool {
        query.called_back();
        let near = self.near(at.primitive, ray);
        if near.lanes == 0 {
            return false;
        }
        query.reach(at.instance, self.solids.prototype_ref());
        for record in near {
            if self.solids.intersects(record, query) {
                return true;
            }
        }
        false
    }

    #[inline(always)]
    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        packet.called_back();
        let near = self.near_packet(at.primitive, rays, rays32);
        if near.iter().all(|rays| rays.is_empty()) {
            return RaySet::EMPTY;
        }
        packet.reach(at.instance, self.solids.prototype_ref());
        let mut shorter = RaySet::EMPTY;
        for (&record, near) in self.records(at.primitive).iter().zip(near) {
            if !near.is_empty() {
                shorter = shorter | self.solids.visit_packet(record, near, t_far, packet);
            }
        }
        shorter
    }

    #[inline(always)]
    fn occluded_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        packet: &mut Packet,
    ) -> RaySet {
        packet.called_back();
        let near = self.near_packet(at.primitive, rays, rays32);
        if near.iter().all(|rays| rays.is_empty()) {
            return RaySet::EMPTY;
        }
        packet.reach(at.instance, self.solids.prototype_ref());
        let mut blocked = RaySet::EMPTY;
        for (&record, near) in self.records(at.primitive).iter().zip(near) {
            let near = near - blocked;
            if !near.is_empty() {
                blocked = blocked | self.solids.intersects_packet(record, near, packet);
            }
        }
        blocked
    }
}
