//! Orders cylinders so that neighbors in space are neighbors in memory.
//!
//! A ray visits cylinders that are close together, so such an order makes it touch
//! fewer pages and neighboring cache lines. Most files already have one: they follow
//! a branch, or a lattice row by row. Other lists are sorted along a Morton curve of
//! the cylinders' centers; `docs/performance.md` states the gain.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::{CylinderList, Storage};
use crate::math::{Bounds, morton_code_3};
use crate::scene::CylinderRecord;

/// Shorter lists keep their order: 256 kB fit into the inner caches in any order.
const LEAST_CYLINDERS: usize = 1 << 12;

/// A list is in order if the mean distance of neighbors is at most this many times
/// the distance that they would have if they filled their box evenly. The ratio is
/// 1.6 along a Morton curve, and 11 or more for a random order.
const GREATEST_JUMP: f64 = 4.0;

impl CylinderList {
    /// Sorts the list so that neighbors in space are neighbors in memory. This makes
    /// tracing faster and changes no result: cylinders keep their numbers. A short list,
    /// one that is already in such an order, and one of f32, whose numbers are stored as
    /// runs, keep their order.
    ///
    /// The sort takes 80 bytes a cylinder while it runs.
    pub fn arrange(&mut self) {
        let Storage::F64(records) = &mut self.storage else {
            return;
        };
        if records.len() < LEAST_CYLINDERS {
            return;
        }
        let union = |one: Bounds, other: Bounds| one.union(&other);
        let middles = records.par_iter().map(|record| Bounds::at(middle(record)));
        let bounds = middles.reduce(|| Bounds::EMPTY, union);
        if is_in_order(records, &bounds) {
            return;
        }
        let cells = f64::from(1 << 21) / bounds.extent().max_element();
        let code = |record: &CylinderRecord| {
            let cell = (middle(record) - bounds.lower) * cells;
            morton_code_3(cell.to_array().map(|x| (x as u32).min((1 << 21) - 1)))
        };
        let numbered = records.par_iter().enumerate();
        let mut order: Vec<(u64, u32)> = numbered
            .map(|(position, record)| (code(record), position as u32))
            .collect();
        order.par_sort_unstable();
        let arranged = order.par_iter();
        let arranged = arranged.map(|&(_, position)| records[position as usize]);
        *records = Arc::new(arranged.collect());
        self.by_primitive.take();
    }
}

fn middle(record: &CylinderRecord) -> DVec3 {
    let cylinder = record.cylinder();
    0.5 * cylinder.p0() + 0.5 * cylinder.p1()
}

/// Whether neighbors are close enough, as they are if all cylinders coincide.
fn is_in_order(records: &[CylinderRecord], bounds: &Bounds) -> bool {
    let jump = |pair: &[CylinderRecord]| (middle(&pair[1]) - middle(&pair[0])).length();
    let sum: f64 = records.windows(2).map(jump).sum();
    let mean = sum / (records.len() - 1) as f64;
    let extent = bounds.extent();
    let spacing = extent.max_element() / libm::cbrt(records.len() as f64);
    // Written so that NaN counts as in order.
    !(mean > GREATEST_JUMP * spacing)
}
