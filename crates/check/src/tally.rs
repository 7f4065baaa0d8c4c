//! Counts over many rays, added up in the order of the rays.

use std::ops::{ControlFlow, Range};

use rayon::prelude::*;

use super::outcome::{Convergence, Row, Violation, percent};

/// Receives the number of rays that are done and the number of all rays, and may stop the
/// check.
pub type Progress<'a> = dyn Fn(u64, u64) -> ControlFlow<()> + Sync + 'a;

/// A row as it grows.
#[derive(Clone, Debug)]
pub(crate) struct Tally {
    pub row: Row,
    /// The differences in `t` to the inscribed mesh, as lengths over the radius.
    pub dt_radii: Vec<f64>,
    /// The first violations.
    pub listed: Vec<Violation>,
}

impl Tally {
    pub fn new(row: Row) -> Self {
        Self {
            row,
            dt_radii: Vec::new(),
            listed: Vec::new(),
        }
    }

    /// Counts a ray.
    pub fn count(&mut self, is_hit: bool) {
        self.row.rays += 1;
        self.row.hits += u64::from(is_hit);
    }

    /// Adds later rays, and lists at most `most_listed` violations.
    pub fn add(&mut self, later: Self, most_listed: usize) {
        self.row.add(&later.row);
        self.dt_radii.extend(later.dt_radii);
        self.listed.extend(later.listed);
        self.listed.truncate(most_listed);
    }

    /// How close the meshes are. The 99th percentile is the least value that at least 99 of
    /// 100 do not exceed.
    pub fn convergence(&mut self, segments: u32) -> Convergence {
        self.dt_radii.sort_unstable_by(f64::total_cmp);
        let rank = (self.dt_radii.len() * 99).div_ceil(100);
        Convergence {
            segments,
            band_percent: percent(self.row.band, self.row.rays),
            p99_dt_r: rank.checked_sub(1).map_or(0.0, |at| self.dt_radii[at]),
        }
    }
}

/// Tallies the rays `range` of a row in blocks of `size`, on the threads of the rayon pool
/// that this is called in. The outcome is the same for any number of threads. `progress` gets
/// the number of rays of each block; `None` if it breaks off.
pub(crate) fn in_blocks<S: Default>(
    row: &Row,
    (range, size): (Range<u64>, u64),
    most_listed: usize,
    progress: impl Fn(u64) -> ControlFlow<()> + Sync,
    block: impl Fn(Range<u64>, &mut S, &mut Tally) + Sync,
) -> Option<Tally> {
    let count = range.end - range.start;
    let blocks: Option<Vec<Tally>> = (0..count.div_ceil(size))
        .into_par_iter()
        .map_init(S::default, |scratch, number| {
            let mut tally = Tally::new(row.clone());
            let start = range.start + number * size;
            block(start..range.end.min(start + size), scratch, &mut tally);
            progress(tally.row.rays).is_continue().then_some(tally)
        })
        .collect();
    let mut whole = Tally::new(row.clone());
    for tally in blocks? {
        whole.add(tally, most_listed);
    }
    Some(whole)
}
