//! Whether an external hit agrees with the exact one, within a distance.
//!
//! # What is proven wrong
//!
//! Let the surface, and the ray against it, be displaced by at most a length `δ`
//! in all (the *allowance*), continuously: a mesh within `δ`, or what an f32
//! renderer makes of both. An answer is listed only if no such displacement
//! explains it:
//!
//! - a reported hit that is farther than `δ` from the surface of every solid;
//! - a reported hit outside of the ray's range, or a hit or a miss after the ray, within
//!   its range, passed *through* a surface: from deeper than `δ` on one side to
//!   deeper than `δ` on the other. A capped solid has an inside. Displacing its
//!   surface by `δ` leaves both points on their sides, so the ray crosses the displaced
//!   surface between them. With an open end the same is true if the ray stays
//!   farther than `δ` from the plane of that end: while the surface moves to its
//!   displaced place along straight lines, no end of the segment comes to lie on it and the
//!   segment does not touch the rim, so the parity of the number of crossings does not
//!   change, and it is odd. A disk is crossed if the ray, within `δ` of its plane, stays
//!   farther than `δ` from the rim.
//!
//! More is known about a mesh of one fit: it lies between two solids (`deviation`), and the
//! statements above apply to both of them, with a `δ` that is a rounding.
//!
//! The part of `δ/|d|` that does not depend on the solid applies to the reported `t` itself.
//! `nearness` bounds depths and distances in placed solids. Every solid has its own `δ`, which
//! `tolerance` derives. No ray passes through a solid thinner than `δ`: a ray whose
//! exact hit is on one is *coarse*, and a comparison with such a ray fails.
//!
//! A composition is crossed in the same way, by a lower bound of the depth. A point
//! farther than `δ` from all of its leaves' surfaces is as far from its own. That
//! a point is near its surface cannot be proven: such an answer is in the band below.
//!
//! # What agrees
//!
//! An answer agrees if `t` differs by at most `δ/|d|`, or if the reported point is proven
//! to be within `δ` of the solid that the ray hits first: at grazing incidence a ray hits a
//! mesh within `δ` far along the ray. The other answers are near a silhouette, an edge
//! or another solid and neither proven right nor wrong. They are counted as the
//! *silhouette band*.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use super::deviation::Deviation;
use super::hit_solid::HitSolid;
use super::surfaces::Surfaces;
use super::tolerance::{Allowance, Tolerance, way};
use crate::outcome::{Expected, Outcome, Row, RowTolerance, Violation, Witness};
use crate::reported_hit::BLOCK;
use crate::solids::scene_solid::{SceneSolid, find};
use crate::tally::{Progress, Tally, in_blocks};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;
use cyltrace::tracer::{DEFAULT_BATCH, HitFields, PartialHit, Tracer};
use cyltrace_oracle::{ExactAffine, placed_hits_of_any};

/// Hits of one ray whose solids are examined.
const MOST_HITS: usize = 256;

/// Answers of another program or of a mesh, compared with exact ones.
pub(super) struct Comparison<'a> {
    tracer: &'a Tracer,
    surfaces: Surfaces<'a>,
    tolerance: Tolerance,
    most_listed: usize,
}

/// The verdict on one answer.
enum Verdict {
    Agrees,
    Silhouette,
    Disagrees,
}

impl<'a> Comparison<'a> {
    pub fn new(tracer: &'a Tracer, tolerance: Tolerance, most_listed: usize) -> Self {
        Self {
            tracer,
            surfaces: Surfaces::new(tracer.scene(), tolerance.deviation),
            tolerance,
            most_listed,
        }
    }

    /// Compares the `reported` hit of each ray, in the rayon pool that this is called in.
    /// `None` if `progress` breaks off.
    pub fn run(
        &self,
        (class, witness): (&'static str, Witness),
        rays: &[Ray],
        progress: &Progress,
        reported: impl Fn(usize) -> Option<f64> + Sync,
    ) -> Option<Outcome> {
        let mut row = Row::new(class, witness, None);
        row.tolerance = Some(RowTolerance {
            greatest: self.tolerance.deviation.everywhere(),
            least_radius: self.surfaces.least_radius(),
            is_any_lost: self.surfaces.is_any_lost(),
            tessellated: match self.tolerance.deviation {
                Deviation::Everywhere(_) => None,
                Deviation::Tessellated { segments, fit } => Some((segments, fit)),
            },
        });
        let count = rays.len() as u64;
        let done = AtomicU64::new(0);
        let progress = |rays| {
            let before = done.fetch_add(rays, Ordering::Relaxed);
            progress(before + rays, count)
        };
        let block = |range: Range<u64>, (): &mut (), tally: &mut Tally| {
            for index in range {
                let ray = &rays[index as usize];
                self.add(tally, index, ray, reported(index as usize));
            }
        };
        let tally = in_blocks(&row, (0..count, BLOCK), self.most_listed, progress, block)?;
        let Tally {
            mut row, listed, ..
        } = tally;
        // A coarse ray may be in the band as well.
        row.witnessed = row.rays.saturating_sub(row.band + row.unwitnessed);
        Some(Outcome {
            rows: vec![row],
            violations: listed,
            ..Outcome::default()
        })
    }

    /// Compares the answer for one more ray.
    fn add(&self, tally: &mut Tally, index: u64, ray: &Ray, reported: Option<f64>) {
        let scene = self.tracer.scene();
        let exact = self.tracer.closest_with(ray, HitFields::PATH);
        let exact_t = exact.as_ref().map(PartialHit::t);
        tally.count(exact.is_some());
        let greatest = self.surfaces.greatest_coordinate();
        let Some(way) = way(ray, reported, exact_t, greatest) else {
            // Both miss.
            return;
        };
        let allowance = self.tolerance.along(ray, way);
        let first = exact
            .as_ref()
            .map(|hit| HitSolid::new(scene, hit, self.tolerance.deviation));
        let near = match &first {
            Some(first) => {
                let margin = first.margin(&allowance);
                tally.row.unwitnessed += u64::from(!(margin.length < first.spare_radius));
                first.in_world(margin)
            }
            None => allowance.of(way.min(greatest)),
        };
        if let Some(tolerance) = &mut tally.row.tolerance {
            tolerance.greatest = tolerance.greatest.max(near);
        }
        match self.judge(ray, reported, exact_t, &allowance) {
            Verdict::Agrees => {}
            Verdict::Silhouette => tally.row.band += 1,
            Verdict::Disagrees => {
                tally.row.violations += 1;
                if tally.listed.len() < self.most_listed {
                    let expected = Expected::Exact {
                        t: exact_t,
                        oracle: exact.and_then(|hit| oracle_t(scene, ray, &hit)),
                        allowance: near,
                    };
                    tally
                        .listed
                        .push(Violation::new(&tally.row, index, *ray, reported, expected));
                }
            }
        }
    }

    /// Whether an answer is right within an allowance: see the head of this file.
    fn judge(
        &self,
        ray: &Ray,
        reported: Option<f64>,
        exact: Option<f64>,
        allowance: &Allowance,
    ) -> Verdict {
        let speed = ray.direction.length();
        let offset = match (reported, exact) {
            (None, None) => return Verdict::Agrees,
            (Some(reported), Some(exact)) => (reported - exact).abs(),
            _ => f64::INFINITY,
        };
        // Without any allowance, the same `t` agrees.
        if offset == 0.0 {
            return Verdict::Agrees;
        }
        // If the length of the direction underflows, a difference in `t` is no distance.
        if !speed.is_normal() {
            return Verdict::Disagrees;
        }
        let mut solids: Vec<HitSolid> = Vec::new();
        let scene = self.tracer.scene();
        let hits = self.tracer.all_hits(ray, DEFAULT_BATCH);
        for hit in hits.with(HitFields::PATH).take(MOST_HITS) {
            match solids.iter_mut().find(|known| known.is_of(&hit)) {
                Some(known) => known.at.push(hit.t()),
                None => solids.push(HitSolid::new(scene, &hit, self.tolerance.deviation)),
            }
        }
        // The first along the ray is the solid of the exact hit.
        let own = solids.first();
        let own_distance = own.map_or(0.0, |own| own.in_world(own.margin(allowance)));
        let along = own_distance / speed;
        let is_beside =
            |t: f64| own.is_some_and(|own| own.is_far(ray.at(t), own.margin(allowance)));
        if offset <= along && !reported.is_some_and(is_beside) {
            return Verdict::Agrees;
        }
        let is_passed = |solid: &HitSolid| {
            let margin = solid.margin(allowance);
            let along = margin.length / speed;
            let (start, end) = (ray.t_min + along, reported.unwrap_or(ray.t_max) - along);
            solid.is_crossed(ray, (start, end), margin)
        };
        if solids.iter().any(is_passed) {
            return Verdict::Disagrees;
        }
        let Some(reported) = reported else {
            return Verdict::Silhouette;
        };
        let point = ray.at(reported);
        let greatest = self.surfaces.greatest_coordinate();
        let farthest_off = allowance.of(greatest) + self.surfaces.greatest_deviation();
        let beyond = match own {
            Some(_) => along,
            None => farthest_off / speed,
        };
        if !(ray.t_min - beyond..=ray.t_max + beyond).contains(&reported) {
            return Verdict::Disagrees;
        }
        // Beyond all surfaces; also if the point overflows.
        if !(point.length() <= 1.001 * (greatest + farthest_off)) {
            return Verdict::Disagrees;
        }
        if own.is_some_and(|own| own.is_near(point, own.margin(allowance))) && !is_beside(reported)
        {
            return Verdict::Agrees;
        }
        if self.surfaces.may_be_near(point, allowance) {
            Verdict::Silhouette
        } else {
            Verdict::Disagrees
        }
    }
}

/// The oracle's `t` of the first hit with the solid of a hit; `None` if it misses, and for
/// a composition.
fn oracle_t(scene: &Scene, ray: &Ray, hit: &PartialHit) -> Option<f64> {
    let path = hit.instance().unwrap_or_default();
    let (placements, found) = find(scene, path, hit.primitive());
    let identity = ExactAffine::identity();
    let world_from_object = placements
        .iter()
        .fold(identity, |whole, one| whole.after(&ExactAffine::new(one)));
    let SceneSolid::Single(solid) = found else {
        return None;
    };
    let hits = placed_hits_of_any(&solid, &world_from_object, ray);
    hits.first().map(|hit| hit.t_f64())
}
