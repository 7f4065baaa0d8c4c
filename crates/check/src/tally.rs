//! Counts over many rays, added up in the order of the rays.

use super::outcome::{ClassRow, Convergence, Violation, Witness};
use super::{Class, ReportedHit};

/// What some rays of one row came to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    pub rays: u64,
    pub hits: u64,
    pub witnessed: u64,
    pub band: u64,
    pub unwitnessed: u64,
    pub triangle_errors: u64,
    pub violations: u64,
    pub wrong_normals: u64,
    pub max_dt_over_chord: f64,
    /// The differences in `t` to the inner prism, as lengths over the radius.
    pub dt_radii: Vec<f64>,
    /// The first violations.
    pub listed: Vec<Violation>,
}

impl Tally {
    /// Counts a ray and its answer.
    pub fn count(&mut self, answer: Option<&ReportedHit>) {
        self.rays += 1;
        self.hits += u64::from(answer.is_some());
    }

    /// Adds the counts of later rays, and lists no more than `most` violations.
    pub fn add(&mut self, later: Self, most: usize) {
        self.rays += later.rays;
        self.hits += later.hits;
        self.witnessed += later.witnessed;
        self.band += later.band;
        self.unwitnessed += later.unwitnessed;
        self.triangle_errors += later.triangle_errors;
        self.violations += later.violations;
        self.wrong_normals += later.wrong_normals;
        self.max_dt_over_chord = self.max_dt_over_chord.max(later.max_dt_over_chord);
        self.dt_radii.extend(later.dt_radii);
        self.listed.extend(later.listed);
        self.listed.truncate(most);
    }

    /// The row that the counts make.
    pub fn row(&self, class: Class, witness: Witness, segments: Option<u32>) -> ClassRow {
        ClassRow {
            class,
            witness,
            segments,
            rays: self.rays,
            hits: self.hits,
            witnessed: self.witnessed,
            band: self.band,
            unwitnessed: self.unwitnessed,
            triangle_errors: self.triangle_errors,
            violations: self.violations,
            wrong_normals: self.wrong_normals,
            max_dt_over_chord: self.max_dt_over_chord,
        }
    }

    /// How near the prisms are; the 99th percentile is the least value that at
    /// least 99 of 100 do not exceed.
    pub fn convergence(&mut self, segments: u32) -> Convergence {
        self.dt_radii.sort_unstable_by(f64::total_cmp);
        let rank = (self.dt_radii.len() * 99).div_ceil(100);
        Convergence {
            segments,
            band_percent: 100.0 * self.band as f64 / self.rays.max(1) as f64,
            p99_dt_r: rank.checked_sub(1).map_or(0.0, |at| self.dt_radii[at]),
        }
    }
}
