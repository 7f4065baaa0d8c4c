//! A hit told from elsewhere against the exact one, within a distance.
//!
//! # What is allowed
//!
//! Let every point of the surface, and the ray, be displaced by at most a
//! length `δ` (the *allowance*). What a ray then meets is what some ray of the
//! same direction within `δ` meets, up to `δ` along. So the answer is compared
//! with those of rays moved sideways in eight directions, in three rings up to
//! `ρ = δ / cos(π/8)`: the octagon of that circumradius holds the disc of
//! radius `δ`. Where a moved ray meets another part of a surface than the ray
//! itself, the border between them is found by bisection, and both sides of it
//! count. Two more rays have their range moved by `δ` at both ends.
//!
//! All hits of these rays with one part of one solid, in one sense (entering or
//! leaving), span an interval of `t`. A told hit
//!
//! - **agrees** if it is within `δ/|d|` of the interval of the part that the ray
//!   itself meets first. On a slanted surface that interval is as wide as the
//!   slant makes it: `δ` sideways is `δ tan θ` along;
//! - is **at a silhouette** if it is so for another part that some moved ray meets
//!   first; a told miss, if some moved ray misses;
//! - is **at a silhouette** too if some moved ray misses the solid that the ray meets
//!   first, and the told hit is on the ray's way through that solid: a facet
//!   that stands for the turn of the wall reaches beyond the tangent, and the way
//!   is short there, about `√(8 r δ)`;
//! - **disagrees** otherwise.
//!
//! Twenty-six rays are a sample: where solids thinner than `δ` crowd, one can lie
//! between them, and a right answer is listed. So the allowance is to be below
//! the radius of what the scene holds.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_8};

use glam::DVec3;

use super::Witness;
use crate::math::Ray;
use crate::oracle::{ExactAffine, placed_first_hit};
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::{Crossing, Part};
use crate::tracer::{DEFAULT_BATCH, Hit, Tracer};

/// The unit roundoff of f32.
pub(super) const UNIT_ROUNDOFF_32: f64 = 1.0 / (1 << 24) as f64;

/// What a ray's displacement and a surface's come to in an f32 renderer, in
/// units of 2^-24 of the distances: the origin 1, the direction 1, end points
/// and radius 2, a placement's matrix 4, the ray taken through it 4, and the
/// solver's last sum and product 4.
const F32_ROUNDINGS: f64 = 16.0;

/// The relative tolerance that suits a renderer in f32: 16 · 2^-24.
pub const F32_TOLERANCE: f64 = F32_ROUNDINGS * UNIT_ROUNDOFF_32;

/// Halvings of a sideways step: beyond these the allowance itself is as rough.
const HALVINGS: u32 = 24;

/// Hits of one moved ray that are looked at.
const MOST_HITS: usize = 256;

/// How hits from elsewhere compare with the exact ones.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// How the rays were made: `given`, or `around` the scene.
    pub class: &'static str,
    /// Where the hits come from.
    pub witness: Witness,
    /// Rays compared.
    pub rays: u64,
    /// Rays that hit by the exact answer.
    pub hits: u64,
    /// Rays whose answer is that of a ray within the allowance, across a
    /// silhouette or an edge.
    pub silhouette: u64,
    /// Rays whose answer is wrong.
    pub disagreements: u64,
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
    /// The `t` from elsewhere; `None` for a miss.
    pub told: Option<f64>,
    /// The exact `t`; `None` for a miss.
    pub exact: Option<f64>,
    /// What the oracle says of the solid that is hit, as a check of `exact`.
    pub oracle: Option<f64>,
    /// The length within which the answers should have agreed.
    pub allowance: f64,
}

/// What one comparison came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// With the distance along the ray in units of the allowance.
    Agrees(f64),
    Silhouette,
    Disagrees,
}

/// A part of a solid, met in one sense.
type Surface = (Vec<u32>, u32, Part, Crossing);

fn surface(hit: &Hit) -> Surface {
    (hit.instance.clone(), hit.primitive, hit.part, hit.crossing)
}

impl Agreement {
    /// Nothing compared yet.
    pub(super) fn new(class: &'static str, witness: Witness) -> Self {
        Self {
            class,
            witness,
            rays: 0,
            hits: 0,
            silhouette: 0,
            disagreements: 0,
            max_offset: 0.0,
            listed: Vec::new(),
        }
    }

    /// Compares the answer for one more ray.
    pub(super) fn add(
        &mut self,
        tracer: &Tracer,
        index: u64,
        ray: &Ray,
        told: Option<f64>,
        most_listed: usize,
        allowance: impl FnOnce(Option<f64>) -> f64,
    ) {
        let exact = tracer.closest(ray);
        let allowance = allowance(exact.as_ref().map(|hit| hit.t));
        self.rays += 1;
        self.hits += u64::from(exact.is_some());
        match judge(tracer, ray, told, exact.as_ref(), allowance) {
            Verdict::Agrees(offset) => self.max_offset = self.max_offset.max(offset),
            Verdict::Silhouette => self.silhouette += 1,
            Verdict::Disagrees => {
                self.disagreements += 1;
                if self.listed.len() < most_listed {
                    self.listed.push(Disagreement {
                        index,
                        ray: *ray,
                        told,
                        exact: exact.as_ref().map(|hit| hit.t),
                        oracle: exact.and_then(|hit| oracle_t(tracer.scene(), ray, &hit)),
                        allowance,
                    });
                }
            }
        }
    }

    /// Adds what was found for the rays that follow.
    pub(super) fn append(&mut self, other: Self, most_listed: usize) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.silhouette += other.silhouette;
        self.disagreements += other.disagreements;
        self.max_offset = self.max_offset.max(other.max_offset);
        self.listed.extend(other.listed);
        self.listed.truncate(most_listed);
    }
}

/// The allowance for a renderer of relative accuracy `tolerance`: that part of
/// all the distances that its arithmetic sees, which are the ray's origin, the
/// way to the hit, and the scene's greatest coordinate. A miss has come past
/// the scene.
pub(super) fn allowance(tolerance: f64, ray: &Ray, t: Option<f64>, greatest: f64) -> f64 {
    let origin = ray.origin.length();
    let way = t.map_or(origin + 2.0 * greatest, |t| {
        t.abs() * ray.direction.length()
    });
    tolerance * (origin + way + greatest)
}

/// The length of the farthest corner of the box around a scene.
pub(super) fn greatest_coordinate(tracer: &Tracer) -> f64 {
    let bounds = tracer.bounds();
    if bounds.is_empty() {
        return 0.0;
    }
    bounds.lower.abs().max(bounds.upper.abs()).length()
}

/// Whether an answer is right within an allowance: see the head of this file.
fn judge(
    tracer: &Tracer,
    ray: &Ray,
    told: Option<f64>,
    exact: Option<&Hit>,
    allowance: f64,
) -> Verdict {
    let along = allowance / ray.direction.length();
    match (told, exact) {
        (None, None) => return Verdict::Agrees(0.0),
        (Some(told), Some(exact)) if (told - exact.t).abs() <= along => {
            let offset = (told - exact.t).abs() / along;
            return Verdict::Agrees(if offset.is_nan() { 0.0 } else { offset });
        }
        _ => {}
    }
    let own = exact.map(surface);
    let near = Neighbourhood::of(tracer, ray, own.as_ref(), allowance);
    let Some(told) = told else {
        return if near.some_miss {
            Verdict::Silhouette
        } else {
            Verdict::Disagrees
        };
    };
    let holds = |surface: &Surface| {
        let met = near.met.iter().filter(|(one, _)| one == surface);
        let (low, high) = met.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, t)| {
            (low.min(*t), high.max(*t))
        });
        (low - along..=high + along).contains(&told)
    };
    match exact {
        Some(exact) if own.as_ref().is_some_and(holds) => {
            Verdict::Agrees((told - exact.t).abs() / along)
        }
        _ if near.first.iter().any(holds) => Verdict::Silhouette,
        Some(_) if near.some_miss_own && near.own_way(told, along) => Verdict::Silhouette,
        _ => Verdict::Disagrees,
    }
}

/// What the rays near one meet.
#[derive(Default)]
struct Neighbourhood {
    /// What some ray meets first.
    first: Vec<Surface>,
    /// Every hit of every ray.
    met: Vec<(Surface, f64)>,
    some_miss: bool,
    /// The ray's own way through the solid that it meets first, and whether some
    /// ray misses that solid.
    own: Vec<f64>,
    own_solid: Option<(Vec<u32>, u32)>,
    some_miss_own: bool,
}

impl Neighbourhood {
    fn of(tracer: &Tracer, ray: &Ray, own: Option<&Surface>, allowance: f64) -> Self {
        let mut near = Self::default();
        near.look(tracer, ray);
        near.own_solid = own.map(|(instance, primitive, ..)| (instance.clone(), *primitive));
        let met = near.met.iter().filter(|(one, _)| near.is_own(one));
        near.own = met.map(|(_, t)| *t).collect();
        let along = allowance / ray.direction.length();
        for [start, end] in [[-along, along], [along, -along]] {
            let moved = Ray {
                t_min: ray.t_min + start,
                t_max: ray.t_max + end,
                ..*ray
            };
            near.look(tracer, &moved);
        }
        let across = ray.direction.normalize().any_orthonormal_vector();
        let upward = ray.direction.normalize().cross(across);
        let radius = allowance / libm::cos(FRAC_PI_8);
        for direction in 0..8 {
            let (sin, cos) = libm::sincos(FRAC_PI_4 * f64::from(direction));
            let step = (across * cos + upward * sin) * radius;
            let mut inner = 0.0;
            for ring in 1..=3 {
                let outer = f64::from(ring) / 3.0;
                if near.look(tracer, &beside(ray, step * outer)).as_ref() != own {
                    near.find_border(tracer, ray, own, step, [inner, outer]);
                    break;
                }
                inner = outer;
            }
            near.look(tracer, &beside(ray, step));
        }
        near
    }

    fn is_own(&self, (instance, primitive, ..): &Surface) -> bool {
        let own = self.own_solid.as_ref();
        own.is_some_and(|own| own.0 == *instance && own.1 == *primitive)
    }

    /// Whether `t` is on the ray's way through its own solid.
    fn own_way(&self, t: f64, along: f64) -> bool {
        let before = self.own.iter().any(|&met| met - along <= t);
        before && self.own.iter().any(|&met| t <= met + along)
    }

    /// Narrows the place between two parts of `step` where the surface stops to be
    /// the ray's own.
    fn find_border(
        &mut self,
        tracer: &Tracer,
        ray: &Ray,
        own: Option<&Surface>,
        step: DVec3,
        [mut inner, mut outer]: [f64; 2],
    ) {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inner + outer);
            if self.look(tracer, &beside(ray, step * middle)).as_ref() == own {
                inner = middle;
            } else {
                outer = middle;
            }
        }
    }

    /// Notes what a ray meets; the answer is what it meets first.
    fn look(&mut self, tracer: &Tracer, ray: &Ray) -> Option<Surface> {
        let mut first = None;
        let mut meets_own = false;
        for hit in tracer.all_hits(ray, DEFAULT_BATCH).take(MOST_HITS) {
            let surface = surface(&hit);
            if first.is_none() {
                first = Some(surface.clone());
            }
            meets_own |= self.is_own(&surface);
            self.met.push((surface, hit.t));
        }
        self.some_miss_own |= self.own_solid.is_some() && !meets_own;
        match &first {
            Some(surface) if !self.first.contains(surface) => self.first.push(surface.clone()),
            Some(_) => {}
            None => self.some_miss = true,
        }
        first
    }
}

/// The ray moved sideways.
fn beside(ray: &Ray, step: DVec3) -> Ray {
    Ray {
        origin: ray.origin + step,
        ..*ray
    }
}

/// The exact `t` of the first hit with the solid of a hit, by the oracle;
/// `None` when it misses.
fn oracle_t(scene: &Scene, ray: &Ray, hit: &Hit) -> Option<f64> {
    let mut world_from_object = ExactAffine::identity();
    let mut prototype = &scene.prototypes[PrototypeIndex::ROOT.0 as usize];
    for &placement in &hit.instance {
        let placement = &prototype.placements[placement as usize];
        world_from_object =
            world_from_object.after(&ExactAffine::new(&placement.parent_from_child));
        prototype = &scene.prototypes[placement.of.0 as usize];
    }
    let mut records = prototype.cylinders.iter();
    let record = records.find(|record| record.primitive() == hit.primitive)?;
    let truth = placed_first_hit(&record.cylinder(), &world_from_object, ray);
    truth.hit.map(|hit| hit.t_f64())
}
