//! From a scene's description to Embree scenes, and hits in world space.
//!
//! [`Tracer::new`] prepares each prototype that the root uses; its Embree scene is built at
//! once or when a ray first reaches it ([`BuildTime`]). A query traverses them with an f64 ray,
//! or with a packet of coherent rays (`batch`). Embree's f32 rays only find candidates
//! (`frame`). The callbacks of a prototype solve, or continue in a placed prototype
//! (`prototype`), and the query keeps the best hits (`query`). The requested fields are
//! computed at the end (`partial_hit`, `resolve`).

mod all_hits;
mod batch;
mod build;
mod contains;
pub mod counters;
mod cut;
mod decisions;
mod estimate;
mod filter;
mod first_hit;
mod frame;
mod hit;
mod kinds;
mod options;
mod outliers;
mod partial_hit;
mod prototype;
mod query;
mod resolve;
mod statistics;
mod traced;
mod workers;

use std::sync::Arc;

pub use all_hits::{AllHits, DEFAULT_BATCH};
pub use build::TracerError;
pub use contains::Containing;
use estimate::INSTANCE_BYTES;
pub use estimate::MemoryEstimate;
pub use filter::FilterLosses;
pub use first_hit::FirstHit;
pub(crate) use frame::LocalRay;
pub use hit::Hit;
pub use options::{BuildTime, Layout, Options};
pub use outliers::{Outlier, outliers};
pub use partial_hit::{HitFields, PartialHit};
pub use statistics::Statistics;
pub use workers::workers;

use crate::embree::{Device, DeviceOptions, MaxIsa};
use crate::math::{Bounds, Ray, power_of_two, power_of_two_below};
use crate::scene::Scene;
use build::Plan;
use decisions::Decisions;
use glam::DVec3;
use prototype::{BuildContext, Prototype};
use query::{Query, QueryMode, SolidRef};
use resolve::Which;
use statistics::Counted;

/// A scene for tracing rays, from any number of threads.
pub struct Tracer {
    scene: Arc<Scene>,
    root: Option<Arc<Prototype>>,
    /// Everything that the root uses, by index.
    prototypes: Vec<Option<Arc<Prototype>>>,
    device: Device,
    options: Options,
    isa: &'static str,
    /// Whether the installed Embree supports packets.
    traces_packets: bool,
    counted: Counted,
    /// The center of the scene, and the greatest distance from it at which a ray may start.
    center: DVec3,
    farthest: f64,
}

impl Tracer {
    /// Prepares `scene` for tracing. `options` decide what is built at once and what later.
    ///
    /// # Errors
    /// When Embree reports an error, or a placement cannot be traced accurately.
    pub fn new(scene: Arc<Scene>, options: &Options) -> Result<Self, TracerError> {
        let plan = Plan::new(&scene)?;
        let device = Device::new(&DeviceOptions {
            threads: options.threads,
            max_isa: options.max_isa,
        })?;
        let context = BuildContext {
            device: device.clone(),
            layout: options.layout,
            view: options.view,
            packet_width: device.packet_width(),
            threads: options
                .threads
                .or_else(|| std::thread::available_parallelism().ok())
                .map_or(1, usize::from),
        };
        let prototypes = build::make(&context, &scene, &plan);
        if options.build == BuildTime::AtOnce {
            for prototype in prototypes.iter().flatten() {
                prototype.build()?;
            }
        }
        let root = prototypes.first().cloned().flatten();
        let bounds = root.as_ref().map_or(Bounds::EMPTY, |root| root.bounds);
        Ok(Self {
            root,
            center: bounds.center(),
            farthest: GREATEST_DISTANCE * (bounds.upper - bounds.lower).max_element(),
            prototypes,
            traces_packets: device.packet_width().is_some(),
            device,
            options: options.clone(),
            isa: MaxIsa::name_in_use(options.max_isa),
            counted: Counted::new(&scene, &plan),
            scene,
        })
    }

    /// The first hit of the ray. Of several at the same `t`, that of the least instance path,
    /// then of the least primitive.
    ///
    /// `None` if there is none, if the ray is not valid ([`Ray::is_valid`]), or if it starts
    /// farther than 2^100 times the size of the scene from the scene's center.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let first = self.first_hit(ray)?;
        Some(self.hit(ray, &first))
    }

    /// As [`Tracer::closest`], with only the given fields computed.
    #[must_use]
    pub fn closest_with(&self, ray: &Ray, fields: HitFields) -> Option<PartialHit> {
        let first = self.first_hit(ray)?;
        Some(self.hit_with(ray, &first, fields))
    }

    /// As [`Tracer::closest`], but computes only the `t` of the hit and its solid.
    /// [`Tracer::hit`] computes the rest.
    #[must_use]
    pub fn first_hit(&self, ray: &Ray) -> Option<FirstHit> {
        self.first_hit_and_callbacks(ray).0
    }

    /// [`Tracer::first_hit`], and the number of callbacks.
    fn first_hit_and_callbacks(&self, ray: &Ray) -> (Option<FirstHit>, u32) {
        self.answer(ray, Prototype::search)
    }

    /// All fields of a first hit.
    ///
    /// # Panics
    /// When `first` is not a hit of this ray and this tracer. It may then also return a wrong
    /// hit.
    #[must_use]
    pub fn hit(&self, ray: &Ray, first: &FirstHit) -> Hit {
        self.hit_of_first(ray, first, HitFields::all())
    }

    /// As [`Tracer::hit`], with only the given fields computed.
    ///
    /// # Panics
    /// As [`Tracer::hit`].
    #[must_use]
    pub fn hit_with(&self, ray: &Ray, first: &FirstHit, fields: HitFields) -> PartialHit {
        PartialHit::new(self.hit_of_first(ray, first, fields), fields)
    }

    fn hit_of_first(&self, ray: &Ray, first: &FirstHit, fields: HitFields) -> Hit {
        let root = self.root.as_ref().expect("a hit is in a scene with a root");
        let (ray, factor) = self.normalized(ray).expect("a ray that hits is valid");
        let which = Which::FirstAt(first.nearest.t);
        self.resolved(root, (&ray, factor), &first.nearest.place, which, fields)
    }

    /// As [`Tracer::closest`], without Embree: it tries every placement and every solid. It
    /// verifies that the traversal loses nothing, with the same solver, and is very slow.
    #[must_use]
    pub fn closest_exhaustive(&self, ray: &Ray) -> Option<Hit> {
        let first = self.answer(ray, Prototype::search_exhaustively).0?;
        Some(self.hit(ray, &first))
    }

    /// All hits of the ray, in order of `t`, then of instance path, primitive, entry before
    /// exit, and part. The first is that of [`Tracer::closest`].
    ///
    /// The iterator finds `batch` hits per traversal, and more if very many solids overlap, in
    /// a time of N log N for N hits. The result is the same for every `batch`, which is at
    /// least 1. A tangent is an entry and an exit at the same `t`.
    #[must_use]
    pub fn all_hits(&self, ray: &Ray, batch: usize) -> AllHits<'_> {
        AllHits::new(self, ray, batch)
    }

    /// Whether the ray hits any surface.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_and_callbacks(ray).0
    }

    /// [`Tracer::occluded`], and the number of callbacks.
    fn occluded_and_callbacks(&self, ray: &Ray) -> (bool, u32) {
        let (Some(root), Some((ray, _))) = (&self.root, self.normalized(ray)) else {
            return (false, 0);
        };
        let mut query = Query::first(&ray, self.decisions());
        let is_blocked = root.occluded(&LocalRay::new(&ray), &mut query);
        (is_blocked, query.callbacks)
    }

    /// The box around all surfaces, in world space; empty for an empty scene.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.root.as_ref().map_or(Bounds::EMPTY, |root| root.bounds)
    }

    /// Statistics of what was built so far.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let prototypes = self.prototypes.iter().flatten();
        let kept: usize = prototypes.map(|prototype| prototype.kept_bytes()).sum();
        Statistics {
            unique: self.counted.unique,
            instanced: self.counted.instanced,
            instances: self.counted.instances,
            embree_instances: self.embree_instances(),
            embree_bytes: self.device.memory_bytes() + self.uncounted_bytes(),
            records_bytes: self.counted.described_bytes + kept,
            skipped: statistics::skipped(&self.scene, &self.prototypes, &self.options),
            embree_version: self.device.version().to_string(),
            isa: self.isa.to_owned(),
        }
    }

    /// The memory that Embree does not count: that of instances, before version 4.
    fn uncounted_bytes(&self) -> usize {
        if self.device.version().major >= 4 {
            return 0;
        }
        (self.embree_instances() * INSTANCE_BYTES) as usize
    }

    fn embree_instances(&self) -> u64 {
        let prototypes = self.prototypes.iter().flatten();
        prototypes.map(|prototype| prototype.instances()).sum()
    }

    /// How queries decide about hits.
    #[inline(always)]
    fn decisions(&self) -> Decisions {
        Decisions::new(self.options.exact)
    }

    /// The scene that was built.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The normalized ray, and the factor from its `t` to the caller's; `None` for a ray that
    /// is not valid or starts too far away.
    #[inline]
    fn normalized(&self, ray: &Ray) -> Option<(Ray, f64)> {
        let distance = (ray.origin - self.center).abs().max_element();
        (distance <= self.farthest)
            .then(|| normalize_direction(ray))
            .flatten()
    }

    fn answer(
        &self,
        ray: &Ray,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query),
    ) -> (Option<FirstHit>, u32) {
        let (Some(root), Some((ray, factor))) = (&self.root, self.normalized(ray)) else {
            return (None, 0);
        };
        let mut query = Query::first(&ray, self.decisions());
        trace(root, &LocalRay::new(&ray), &mut query);
        let first = match query.mode {
            QueryMode::First(nearest) => nearest.map(|nearest| FirstHit::new(nearest, factor)),
            QueryMode::Next(_) | QueryMode::Containing(_) => None,
        };
        (first, query.callbacks)
    }

    /// The result for a hit of the normalized ray, with the factor from its `t` to the
    /// caller's.
    fn resolved(
        &self,
        root: &Arc<Prototype>,
        (ray, factor): (&Ray, f64),
        place: &SolidRef,
        which: Which,
        fields: HitFields,
    ) -> Hit {
        let search = (self.decisions(), which, fields);
        let mut hit = resolve::resolve(&self.scene, root, ray, place, search);
        hit.t *= factor;
        hit
    }
}

/// The greatest distance from the center of a scene at which a ray may start, in sizes of the
/// scene's box: 2^100. From there f64 distinguishes only points of a ray that are 2^47 scenes
/// apart, and the double-double step that moves the ray near (`frame`) leaves 2^-6 of the
/// scene.
const GREATEST_DISTANCE: f64 = power_of_two(100);

/// Directions whose largest component is in this range need no scaling: with
/// [`crate::scene::GREATEST_STRETCH`] they stay within what the solvers can square.
const UNSCALED_LENGTHS: std::ops::Range<f64> = power_of_two(-32)..power_of_two(32);

/// The ray with a direction that the solvers can square, and the factor from its `t` to the
/// caller's; `None` for a ray that is not valid.
///
/// The factor is a power of two, so the scaling is exact (except for components of the
/// direction 2^-1000 times smaller than the largest).
#[inline]
fn normalize_direction(ray: &Ray) -> Option<(Ray, f64)> {
    if !ray.is_valid() {
        return None;
    }
    let length = ray.direction.abs().max_element();
    if UNSCALED_LENGTHS.contains(&length) {
        return Some((*ray, 1.0));
    }
    Some(rescaled(ray, length))
}

/// A limit of `t` that leaves the range of f64 is rounded inward. So a `t` within the scaled
/// limits is within the stated ones when it is scaled back: rounding to nearest never reorders
/// numbers.
#[cold]
fn rescaled(ray: &Ray, length: f64) -> (Ray, f64) {
    let factor = 1.0 / power_of_two_below(length);
    let (mut t_min, mut t_max) = (ray.t_min / factor, ray.t_max / factor);
    if t_min * factor < ray.t_min {
        t_min = t_min.next_up();
    }
    if t_max * factor > ray.t_max {
        t_max = t_max.next_down();
    }
    let rescaled = Ray {
        origin: ray.origin,
        direction: ray.direction * factor,
        t_min,
        t_max,
    };
    (rescaled, factor)
}
