//! From a scene's description to committed Embree scenes, and hits in world
//! space.
//!
//! [`Tracer::new`] builds one Embree scene for each prototype that the root
//! needs. A query walks them with an f64 ray: Embree's f32 ray only finds
//! candidates (`frame`), the callbacks of a prototype solve or hand on to a
//! placed prototype (`prototype`), the query keeps the best hit (`query`), and
//! what the caller wants to know of it is worked out at the end (`resolve`).

mod all_hits;
mod build;
mod estimate;
mod found;
mod frame;
mod hit;
mod prototype;
mod query;
mod resolve;
mod workers;

use std::num::NonZeroUsize;
use std::sync::Arc;

pub use all_hits::{AllHits, DEFAULT_BATCH};
pub use build::TracerError;
pub use estimate::MemoryEstimate;
pub use hit::Hit;
pub use workers::workers;

use crate::embree::{Device, DeviceOptions, MaxIsa};
use crate::math::{Bounds, Ray, power_of_two, power_of_two_below};
use crate::scene::{CylinderRecord, Placement, PrototypeIndex, Scene};
use build::Plan;
use found::{Found, Keep};
use frame::LocalRay;
use prototype::Prototype;
use query::Query;

/// How a tracer is built.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Threads that Embree builds with; as many as there are cores if `None`.
    pub threads: Option<NonZeroUsize>,
    /// The widest instruction set that Embree may use; the machine's best if
    /// `None`. It changes speed only.
    pub max_isa: Option<MaxIsa>,
}

/// What was built, and what was not.
#[derive(Clone, Debug)]
pub struct Statistics {
    /// Cylinders in the prototypes that were built.
    pub cylinders_unique: u64,
    /// Cylinders in the scene with every placement counted.
    pub cylinders_instanced: u128,
    /// Placements in the scene, those within placed prototypes counted each
    /// time.
    pub instances: u128,
    /// Memory that Embree holds.
    pub embree_bytes: usize,
    /// Memory of the records of cylinders and placements.
    pub records_bytes: usize,
    /// What was left out because the scene does not need it.
    pub skipped: Vec<String>,
    /// The version of the Embree library.
    pub embree_version: String,
    /// The instruction set in use.
    pub isa: String,
}

/// A scene that rays can be traced through, from any number of threads.
pub struct Tracer {
    scene: Arc<Scene>,
    root: Option<Arc<Prototype>>,
    statistics: Statistics,
}

impl Tracer {
    /// Builds what the root of `scene` needs.
    ///
    /// # Errors
    /// When Embree refuses, or a placement cannot be traced accurately.
    pub fn new(scene: Arc<Scene>, options: &Options) -> Result<Self, TracerError> {
        let plan = Plan::new(&scene)?;
        let device = Device::new(&DeviceOptions {
            threads: options.threads,
            max_isa: options.max_isa,
        })?;
        let built = build::build(&device, &scene, &plan)?;
        let statistics = Statistics {
            cylinders_unique: plan
                .order
                .iter()
                .map(|index| scene.prototypes[index.0 as usize].cylinders.len() as u64)
                .sum(),
            cylinders_instanced: plan.instanced_cylinders[0],
            instances: plan.instances[0],
            embree_bytes: device.memory_bytes(),
            records_bytes: records_bytes(&scene, &built),
            skipped: skipped(&scene, &plan),
            embree_version: device.version().to_string(),
            isa: MaxIsa::name_in_use(options.max_isa).to_owned(),
        };
        let root = built.into_iter().next().flatten();
        Ok(Self {
            scene,
            root,
            statistics,
        })
    }

    /// The first point of a surface that the ray meets. Of several at the same
    /// `t`, that of the least instance path, then of the least primitive.
    ///
    /// `None` if there is none, or if the ray is not valid
    /// ([`Ray::is_valid`]).
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.answer(ray, Prototype::search)
    }

    /// As [`Tracer::closest`], without Embree: every placement and every solid
    /// is tried. It is the witness that the traversal loses nothing, with the
    /// same solver, and very slow.
    #[must_use]
    pub fn closest_exhaustive(&self, ray: &Ray) -> Option<Hit> {
        self.answer(ray, Prototype::search_exhaustively)
    }

    /// Every point of a surface that the ray meets, in order of `t`, then of
    /// instance path, primitive, entry before exit, and part. The first is that
    /// of [`Tracer::closest`].
    ///
    /// The hits are found on the way, `batch` of them in a traversal, so that
    /// memory does not grow with their number; the answer is the same for
    /// every `batch`, which is taken as at least 1. A tangent is an entry and an exit at the same `t`.
    #[must_use]
    pub fn all_hits(&self, ray: &Ray, batch: usize) -> AllHits<'_> {
        AllHits::new(self, ray, batch)
    }

    /// Whether the ray meets any surface.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let Some(root) = &self.root else { return false };
        let Some((ray, _)) = with_usual_length(ray) else {
            return false;
        };
        root.occluded(&LocalRay::new(&ray), &mut Query::first(&ray))
    }

    /// The box around all surfaces, in world space; empty for an empty scene.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.root.as_ref().map_or(Bounds::EMPTY, |root| root.bounds)
    }

    /// What was built.
    #[must_use]
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The scene that was built.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    fn answer(
        &self,
        ray: &Ray,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query),
    ) -> Option<Hit> {
        let root = self.root.as_ref()?;
        let (ray, factors) = with_usual_length(ray)?;
        let mut query = Query::first(&ray);
        trace(root, &LocalRay::new(&ray), &mut query);
        match query.keep {
            Keep::First(Some(found)) => Some(self.resolved(root, &ray, factors, &found)),
            _ => None,
        }
    }

    /// The answer for a hit of the ray in use.
    fn resolved(
        &self,
        root: &Arc<Prototype>,
        ray: &Ray,
        [unit, lift]: [f64; 2],
        found: &Found,
    ) -> Hit {
        let mut hit = resolve::resolve(&self.scene, root, ray, found);
        hit.t = hit.t * unit * lift;
        hit
    }
}

/// Directions whose largest component is within these need no scaling: with
/// [`crate::scene::GREATEST_STRETCH`] they stay within what the solvers can square.
const USUAL_LENGTHS: std::ops::Range<f64> = power_of_two(-32)..power_of_two(32);

/// The ray with a direction of a size that the solvers can square, and the two
/// factors that turn its `t` back; `None` for a ray that is not valid.
///
/// The scaling is by powers of two, so it is exact (but for components and
/// limits 2^-900 times smaller than the rest).
#[inline]
fn with_usual_length(ray: &Ray) -> Option<(Ray, [f64; 2])> {
    if !ray.is_valid() {
        return None;
    }
    let length = ray.direction.abs().max_element();
    if USUAL_LENGTHS.contains(&length) {
        return Some((*ray, [1.0; 2]));
    }
    Some(rescaled(ray, length))
}

#[cold]
fn rescaled(ray: &Ray, length: f64) -> (Ray, [f64; 2]) {
    // A denormal length is lifted first: the inverse of its power of two would
    // overflow.
    let lift = if length < f64::MIN_POSITIVE {
        power_of_two(600)
    } else {
        1.0
    };
    let unit = 1.0 / power_of_two_below(length * lift);
    let rescaled = Ray {
        origin: ray.origin,
        direction: ray.direction * lift * unit,
        t_min: ray.t_min / lift / unit,
        t_max: ray.t_max / lift / unit,
    };
    (rescaled, [unit, lift])
}

/// The memory of what is kept for solids and placements beside Embree's.
fn records_bytes(scene: &Scene, built: &[Option<Arc<Prototype>>]) -> usize {
    let described: usize = scene
        .prototypes
        .iter()
        .map(|prototype| {
            prototype.cylinders.len() * size_of::<CylinderRecord>()
                + prototype.placements.len() * size_of::<Placement>()
        })
        .sum();
    described
        + built
            .iter()
            .flatten()
            .map(|prototype| prototype.placement_bytes())
            .sum::<usize>()
}

/// A sentence for each prototype that no placement needs, and one for rows
/// that are no solid.
fn skipped(scene: &Scene, plan: &Plan) -> Vec<String> {
    let rows = (scene.skipped_rows > 0)
        .then(|| format!("degenerate rows of tables: {}", scene.skipped_rows));
    let is_needed = |index| plan.order.contains(&PrototypeIndex(index as u32));
    let prototypes = scene
        .prototypes
        .iter()
        .enumerate()
        .filter(|(index, _)| !is_needed(*index))
        .map(|(_, prototype)| {
            format!(
                "prototype \"{}\" is placed nowhere: not built",
                prototype.name
            )
        });
    rows.into_iter().chain(prototypes).collect()
}
