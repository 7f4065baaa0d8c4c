//! A hit told from elsewhere against the exact one, within a distance.
//!
//! # What is proven wrong
//!
//! Let the surface, and the ray against it, be displaced by at most a length `δ`
//! in all (the *allowance*), continuously: a mesh within `δ`, or what an f32
//! renderer makes of both. An answer is listed only where no such displacement
//! gives it:
//!
//! - a told hit that is farther than `δ` from the surface of every solid;
//! - a told hit outside of the ray's range, or a hit or a miss after the ray, within
//!   its range, passed *through* a surface: from deeper than `δ` on one side to
//!   deeper than `δ` on the other. A capped solid has an inside, and displacing its
//!   surface by `δ` leaves what is deeper on its side, so the displaced surface is
//!   met in between. With an open end the same is true as long as the ray stays
//!   farther than `δ` from the plane of that end: no end of the way comes to lie on
//!   the surface, and the way meets no rim, while the surface is moved to its
//!   displaced place along straight lines; so whether the number of crossings is
//!   odd does not change, and it was one. It is the same with a disk, as long as the
//!   ray, within `δ` of its plane, stays farther than `δ` from the rim.
//!
//! Of a mesh of one fit more is known: it lies between two solids (`deviation`), and what is said
//! of the surface here is said of both, with a `δ` that is a rounding.
//!
//! The told `t` itself is given the part of `δ/|d|` that does not depend on the solid. `nearness` bounds
//! depths and distances in placed solids. Every solid has a `δ` of its own, which
//! `tolerance` derives. A solid thinner than `δ` is never passed through: a ray whose
//! exact hit is on one is *coarse*, and a comparison with such a ray fails.
//!
//! A solid that is composed of others is passed through alike, by a lower bound of the
//! depth; what is farther than `δ` from all of their surfaces is as far from its own. That
//! a point is near its surface is not proven: then the answer is in the band below.
//!
//! # What agrees
//!
//! An answer agrees if `t` differs by at most `δ/|d|`, or if the told point is proven
//! to be within `δ` of the solid that the ray meets first: at grazing incidence a
//! mesh within `δ` is met far along the ray. The rest is near a silhouette, an edge
//! or another solid and neither proven right nor wrong: it is counted, as the
//! *silhouette band*.

use super::deviation::Deviation;
use super::hit_solid::{Found, HitSolid, find, path};
use super::surfaces::Surfaces;
use super::tolerance::{Allowance, Tolerance, way};
use crate::Witness;
use cyltrace::math::Ray;
use cyltrace::scene::Scene;
use cyltrace::tracer::{DEFAULT_BATCH, HitFields, PartialHit, Tracer};
use cyltrace_oracle::{ExactAffine, placed_hits_of_any};
use cyltrace_output::figure;

/// Hits of one ray whose solids are looked at.
const MOST_HITS: usize = 256;

/// How hits from elsewhere compare with the exact ones.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// How the rays were made: `given`, or `around` the scene.
    pub class: &'static str,
    /// Where the hits come from.
    pub witness: Witness,
    /// What the answers may be off.
    tolerance: Tolerance,
    /// Rays compared.
    pub rays: u64,
    /// Rays that hit by the exact answer.
    pub hits: u64,
    /// Rays whose answer is neither proven right nor wrong: near a silhouette, an
    /// edge or another solid.
    pub silhouette: u64,
    /// Rays whose answer is proven wrong.
    pub disagreements: u64,
    /// Rays whose exact hit is on a solid with a radius that is not greater than the allowance there, so
    /// that no answer could be proven wrong.
    pub coarse: u64,
    /// The greatest allowance of any ray, as a length.
    pub max_allowance: f64,
    /// The part of all allowances that depends neither on the ray nor on the solid: a mesh's
    /// deviation where one is stated for all solids.
    pub fixed_allowance: f64,
    /// Whether the mesh of some solid may lack as much as its radius.
    pub is_any_lost: bool,
    /// The least radius of the scene's solids; infinite where there are none.
    pub least_radius: f64,
    /// The greatest distance, along a ray, of a hit that agrees from the exact
    /// one, in units of the allowance.
    pub max_offset: f64,
    /// The first disagreements, by the ray's number.
    pub listed: Vec<Disagreement>,
}

/// A ray on which the answers differ.
#[derive(Clone, Debug)]
pub struct Disagreement {
    /// The ray's number.
    pub index: u64,
    /// The ray.
    pub ray: Ray,
    /// The given `t`; `None` for a miss.
    pub told: Option<f64>,
    /// The exact `t`; `None` for a miss.
    pub exact: Option<f64>,
    /// What the oracle says of the solid that is hit, as a check of `exact`. It knows
    /// placed cylinders, and other solids where they are not placed.
    pub oracle: Option<f64>,
    /// The length within which the answers should have agreed.
    pub allowance: f64,
}

/// What one comparison came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// With the distance along the ray in units of the allowance.
    Agrees(f64),
    Silhouette,
    Disagrees,
}

impl Agreement {
    /// Nothing compared yet.
    pub(super) fn new(
        class: &'static str,
        witness: Witness,
        tolerance: Tolerance,
        surfaces: &Surfaces,
    ) -> Self {
        Self {
            class,
            witness,
            tolerance,
            rays: 0,
            hits: 0,
            silhouette: 0,
            disagreements: 0,
            coarse: 0,
            max_allowance: 0.0,
            fixed_allowance: tolerance.deviation.everywhere(),
            least_radius: surfaces.least_radius(),
            is_any_lost: surfaces.is_any_lost(),
            max_offset: 0.0,
            listed: Vec::new(),
        }
    }

    /// Compares the answer for one more ray.
    pub(super) fn add(
        &mut self,
        (tracer, surfaces): (&Tracer, &Surfaces),
        index: u64,
        ray: &Ray,
        told: Option<f64>,
        most_listed: usize,
    ) {
        let exact = tracer.closest_with(ray, HitFields::PATH);
        let exact_t = exact.as_ref().map(PartialHit::t);
        self.rays += 1;
        self.hits += u64::from(exact.is_some());
        let Some(way) = way(ray, told, exact_t, surfaces.greatest_coordinate()) else {
            // Both miss.
            return;
        };
        let allowance = self.tolerance.along(ray, way);
        let first = exact
            .as_ref()
            .map(|hit| HitSolid::new(tracer.scene(), hit, self.tolerance.deviation));
        let near = match &first {
            Some(first) => {
                let margin = first.margin(&allowance);
                self.coarse += u64::from(!(margin.length < first.spare_radius));
                first.in_world(margin)
            }
            None => allowance.of(way.min(surfaces.greatest_coordinate())),
        };
        self.max_allowance = self.max_allowance.max(near);
        match judge(
            (tracer, surfaces, self.tolerance.deviation),
            ray,
            told,
            exact.as_ref(),
            &allowance,
        ) {
            Verdict::Agrees(offset) => self.max_offset = self.max_offset.max(offset),
            Verdict::Silhouette => self.silhouette += 1,
            Verdict::Disagrees => {
                self.disagreements += 1;
                if self.listed.len() < most_listed {
                    self.listed.push(Disagreement {
                        index,
                        ray: *ray,
                        told,
                        exact: exact_t,
                        oracle: exact.and_then(|hit| oracle_t(tracer.scene(), ray, &hit)),
                        allowance: near,
                    });
                }
            }
        }
    }

    /// What a mesh may be off; 0 everywhere for hits.
    #[must_use]
    pub fn deviation(&self) -> Deviation {
        self.tolerance.deviation
    }

    /// Rays whose answer is proven right or wrong. A coarse ray may be in the band as well.
    #[must_use]
    pub fn judged(&self) -> u64 {
        self.rays.saturating_sub(self.silhouette + self.coarse)
    }

    /// Why the comparison proves too little, where it does.
    #[must_use]
    pub fn shortfall(&self) -> Option<String> {
        if self.rays == 0 {
            return Some(String::from("there is no ray to compare"));
        }
        if self.hits == 0 && self.witness == Witness::UserMesh {
            return Some(String::from(
                "no ray hits a solid, so nothing is known of the mesh",
            ));
        }
        if self.is_any_lost || self.coarse > 0 {
            return Some(format!(
                "the tolerance reaches the radius of a solid, which no answer could then be proven wrong about: it is {} at most, the least radius is {}, and {} of {} rays hit such a solid",
                figure(self.max_allowance.max(self.fixed_allowance)),
                figure(self.least_radius),
                self.coarse,
                self.rays
            ));
        }
        (2 * self.judged() < self.rays).then(|| {
            let (judged, rays) = (self.judged(), self.rays);
            format!("only {judged} of {rays} answers could be judged, which is less than half")
        })
    }

    /// Whether no answer is wrong, and enough are judged to say so.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.disagreements == 0 && self.shortfall().is_none()
    }

    /// Adds what was found for the rays that follow.
    pub(crate) fn append(&mut self, other: Self, most_listed: usize) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.silhouette += other.silhouette;
        self.disagreements += other.disagreements;
        self.coarse += other.coarse;
        self.max_allowance = self.max_allowance.max(other.max_allowance);
        self.max_offset = self.max_offset.max(other.max_offset);
        self.listed.extend(other.listed);
        self.listed.truncate(most_listed);
    }
}

/// Whether an answer is right within an allowance: see the head of this file.
fn judge(
    (tracer, surfaces, deviation): (&Tracer, &Surfaces, Deviation),
    ray: &Ray,
    told: Option<f64>,
    exact: Option<&PartialHit>,
    allowance: &Allowance,
) -> Verdict {
    let speed = ray.direction.length();
    let offset = match (told, exact) {
        (None, None) => return Verdict::Agrees(0.0),
        (Some(told), Some(exact)) => (told - exact.t()).abs(),
        _ => f64::INFINITY,
    };
    // Without any allowance, the same `t` agrees.
    if offset == 0.0 {
        return Verdict::Agrees(0.0);
    }
    // Of a direction whose length leaves f64, a difference in `t` is no distance.
    if !speed.is_normal() {
        return Verdict::Disagrees;
    }
    let mut met: Vec<HitSolid> = Vec::new();
    let hits = tracer.all_hits(ray, DEFAULT_BATCH).with(HitFields::PATH);
    for hit in hits.take(MOST_HITS) {
        match met.iter_mut().find(|met| met.is_of(&hit)) {
            Some(known) => known.at.push(hit.t()),
            None => met.push(HitSolid::new(tracer.scene(), &hit, deviation)),
        }
    }
    // The first along the ray is the solid of the exact hit.
    let own = met.first();
    let own_distance = own.map_or(0.0, |own| own.in_world(own.margin(allowance)));
    let along = own_distance / speed;
    let is_beside = |t: f64| own.is_some_and(|own| own.is_far(ray.at(t), own.margin(allowance)));
    if offset <= along && !told.is_some_and(is_beside) {
        return Verdict::Agrees(offset / along);
    }
    let is_passed = |met: &HitSolid| {
        let margin = met.margin(allowance);
        let along = margin.length / speed;
        let (start, end) = (ray.t_min + along, told.unwrap_or(ray.t_max) - along);
        met.is_crossed(ray, (start, end), margin)
    };
    if met.iter().any(is_passed) {
        return Verdict::Disagrees;
    }
    let Some(told) = told else {
        return Verdict::Silhouette;
    };
    let point = ray.at(told);
    let greatest = surfaces.greatest_coordinate();
    let farthest_off = allowance.of(greatest) + surfaces.greatest_deviation();
    let beyond = match own {
        Some(_) => along,
        None => farthest_off / speed,
    };
    if !(ray.t_min - beyond..=ray.t_max + beyond).contains(&told) {
        return Verdict::Disagrees;
    }
    // Beyond all surfaces; also if it is so far that it is no number.
    if !(point.length() <= 1.001 * (greatest + farthest_off)) {
        return Verdict::Disagrees;
    }
    if own.is_some_and(|own| own.is_near(point, own.margin(allowance))) && !is_beside(told) {
        return Verdict::Agrees(offset / along);
    }
    if surfaces.may_be_near(point, allowance) {
        Verdict::Silhouette
    } else {
        Verdict::Disagrees
    }
}

/// The exact `t` of the first hit with the solid of a hit, by the oracle; `None` when
/// it misses, and for a composition.
fn oracle_t(scene: &Scene, ray: &Ray, hit: &PartialHit) -> Option<f64> {
    let (placements, found) = find(scene, path(hit), hit.primitive());
    let world_from_object = placements
        .iter()
        .fold(ExactAffine::identity(), |whole, one| {
            whole.after(&ExactAffine::new(one))
        });
    let Found::Single(solid) = found else {
        return None;
    };
    let hits = placed_hits_of_any(&solid, &world_from_object, ray);
    hits.first().map(|hit| hit.t_f64())
}
