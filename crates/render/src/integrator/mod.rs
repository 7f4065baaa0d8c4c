//! From a camera ray to the light it sees.
//!
//! - `normal`: the outward unit normal `n` as the linear colour `n/2 + 1/2`,
//!   just as `trace` reports it (not turned to the viewer); black, which is
//!   no normal's colour, where the ray misses.
//! - `ao` and `sun`: see [`direct`].
//! - `path`: see [`path`].
//!
//! Surfaces are two-sided: they are lit on the side the viewer is on, so that
//! open tubes show their inside.

mod direct;
mod media;
mod occlusion;
mod path;
mod segment;
mod vertex;

use glam::{DVec2, DVec3};

use super::Lights;
use super::bsdf::Bsdf;
use super::clips::Clips;
use super::colors::Colors;
use super::depth_cue::DepthCue;
use super::sampler::PixelSampler;
use cyltrace::math::{Bounds, Ray};
use cyltrace::scene::{AimedCamera, Integrator, MaterialKind, RenderSettings, Scene};
use cyltrace::tracer::{HitFields, PartialHit, Tracer};
use occlusion::Occlusion;
use path::Paths;

/// The dimensions of numbers that samples need for some purposes only. Those of paths follow.
const SUN: u32 = 0;
const LENS: u32 = 1;

/// How many rays were traced, by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// Towards the sun and other lights.
    pub shadow: u64,
    /// In cosine-distributed directions, of `ao` or towards the sky.
    pub ao: u64,
    /// In directions from which surfaces scatter light, of `path`.
    pub scattered: u64,
}

impl RayCounts {
    /// The names of the purposes in figures.
    pub const PURPOSES: [&'static str; 4] = ["camera", "shadow", "ao", "scattered"];

    /// The rays of each purpose, in the order of [`RayCounts::PURPOSES`].
    #[must_use]
    pub fn by_purpose(&self) -> [u64; 4] {
        [self.camera, self.shadow, self.ao, self.scattered]
    }

    /// All rays.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.by_purpose().iter().sum()
    }
}

impl std::ops::Add for RayCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            camera: self.camera + other.camera,
            shadow: self.shadow + other.shadow,
            ao: self.ao + other.ao,
            scattered: self.scattered + other.scattered,
        }
    }
}

/// What a sample is made of.
pub(super) struct View<'a> {
    pub(super) tracer: &'a Tracer,
    pub(super) colors: Colors,
    pub(super) camera: AimedCamera,
    pub(super) lights: Lights,
    pub(super) integrator: Integrator,
    pub(super) settings: RenderSettings,
    /// How each material scatters light, for `path`; `None` for those that emit light.
    bsdfs: Vec<Option<Box<dyn Bsdf>>>,
    /// Whether a ray may be in glass.
    has_glass: bool,
    clips: Clips,
    depth_cue: Option<DepthCue>,
    /// A box around the scene.
    bounds: Bounds,
}

/// A sample of a pixel.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// The pixel's column and row.
    pub pixel: (u32, u32),
    pub sampler: PixelSampler,
    pub number: u32,
}

impl Sample {
    /// Two numbers for a direction.
    fn direction(&self) -> (f64, f64) {
        self.sampler.direction(self.number)
    }

    /// Two numbers for another purpose.
    fn pair(&self, dimension: u32) -> (f64, f64) {
        self.sampler.pair(dimension, self.number)
    }
}

/// Many samples at a time, in steps: all rays of one purpose are traced
/// together, so that coherent ones share work. What is kept
/// between the steps is kept here, to be used again.
#[derive(Default)]
pub(super) struct Batch {
    rays: Vec<Ray>,
    hits: Vec<Option<PartialHit>>,
    /// The depths of the surfaces that the camera sees, infinite where there is none; empty
    /// without a depth cue.
    depths: Vec<f64>,
    /// The colours of the samples, in their order.
    pub colors: Vec<DVec3>,
    occlusion: Occlusion,
    paths: Paths,
}

impl Batch {
    /// Whether the camera ray of a sample hit something.
    pub(super) fn is_hit(&self, sample: usize) -> bool {
        match self.paths.is_hit(sample) {
            Some(is_hit) => is_hit,
            None => self.hits[sample].is_some(),
        }
    }
}

impl<'a> View<'a> {
    /// The view of a picture of this integrator.
    pub fn new(tracer: &'a Tracer, camera: AimedCamera, integrator: Integrator) -> Self {
        let scene: &Scene = tracer.scene();
        let bsdfs: Vec<_> = match integrator {
            Integrator::Path => scene.materials.iter().map(super::bsdf::of).collect(),
            Integrator::Sun | Integrator::Ao | Integrator::Normal => Vec::new(),
        };
        let transmits =
            |bsdf: &Option<Box<dyn Bsdf>>| bsdf.as_ref().is_some_and(|one| one.transmits());
        let bounds = tracer.bounds();
        let lights = match integrator {
            Integrator::Sun | Integrator::Path => Lights::of(scene, &bounds, integrator),
            Integrator::Ao | Integrator::Normal => Lights::default(),
        };
        Self {
            depth_cue: DepthCue::of(scene, &camera, &bounds, &lights, integrator),
            has_glass: bsdfs.iter().any(transmits),
            tracer,
            clips: Clips::new(&scene.clips),
            colors: Colors::new(tracer.scene()),
            camera,
            lights,
            bounds,
            integrator,
            settings: scene.render,
            bsdfs,
        }
    }

    /// Works out the linear colours of samples, which are best near each other.
    pub(super) fn trace(&self, samples: &[Sample], batch: &mut Batch, rays: &mut RayCounts) {
        batch.rays.clear();
        batch.rays.extend(samples.iter().map(|sample| {
            let (across, down) = sample.sampler.place(sample.number);
            let (x, y) = sample.pixel;
            let position = DVec2::new(f64::from(x) + across, f64::from(y) + down);
            match self.camera.has_lens() {
                true => self.camera.ray_through_lens(position, sample.pair(LENS)),
                false => self.camera.ray(position),
            }
        }));
        rays.camera += samples.len() as u64;
        batch.colors.clear();
        match self.integrator {
            Integrator::Normal => self.normals(batch),
            Integrator::Ao => self.ambient_occlusion(samples, batch, rays),
            Integrator::Sun => self.sunlight_and_sky(samples, batch, rays),
            Integrator::Path => self.paths(samples, batch, rays),
        }
        if let Some(cue) = &self.depth_cue {
            for (color, &depth) in batch.colors.iter_mut().zip(&batch.depths) {
                if depth.is_finite() {
                    *color = cue.faded(*color, depth);
                }
            }
        }
    }

    fn normals(&self, batch: &mut Batch) {
        self.closest_to_camera(batch, HitFields::NORMAL);
        let hits = batch.hits.iter().map(Option::as_ref);
        let color = |hit: &PartialHit| normal(hit) * 0.5 + 0.5;
        let colors = hits.map(|hit| hit.map_or(DVec3::ZERO, color));
        batch.colors.extend(colors);
    }

    /// The radiance that a solid emits at a hit; `None` of a material that emits no light.
    fn emitted(&self, hit: &PartialHit) -> Option<DVec3> {
        let material = &self.tracer.scene().materials[usize::from(hit.material().0)];
        match material.kind {
            MaterialKind::Light { strength } => Some(self.colors.at(hit) * strength),
            _ => None,
        }
    }

    /// The first hits of the batch's rays, which start at the camera.
    fn closest_to_camera(&self, batch: &mut Batch, fields: HitFields) {
        self.first_hits(&mut batch.rays, fields, &mut batch.hits);
        if self.depth_cue.is_none() {
            return;
        }
        let depth = |(ray, hit): (&Ray, &Option<PartialHit>)| match hit {
            Some(hit) if !self.is_hidden(ray, hit) => self.camera.depth(ray.at(hit.t())),
            _ => f64::INFINITY,
        };
        batch.depths.clear();
        let seen = batch.rays.iter().zip(&batch.hits);
        batch.depths.extend(seen.map(depth));
    }

    /// Whether a light with a place, which only paths see, is before the hit of a camera ray.
    pub(super) fn is_hidden(&self, ray: &Ray, hit: &PartialHit) -> bool {
        let before = Ray {
            t_min: 0.0,
            t_max: hit.t(),
            ..*ray
        };
        self.integrator == Integrator::Path && self.lights.is_on(&before)
    }

    /// The first hits of the batch's rays.
    fn closest(&self, batch: &mut Batch, fields: HitFields) {
        self.tracer
            .closest_batch_with(&batch.rays, fields, &mut batch.hits);
    }

    /// The first hits of rays from the camera. Clip planes shorten the rays.
    pub(super) fn first_hits(
        &self,
        rays: &mut [Ray],
        fields: HitFields,
        hits: &mut Vec<Option<PartialHit>>,
    ) {
        self.clips.first_hits(self.tracer, rays, fields, hits);
    }

    /// A ray from a hit, up to where it leaves what clip planes leave.
    fn spawn(&self, hit: &PartialHit, direction: DVec3) -> Ray {
        let ray = hit.spawn(direction);
        let ray = ray.expect("every integrator that spawns rays requests it");
        self.clips.limited(ray, hit)
    }
}

/// The unit normal on the side that the ray comes from.
fn facing_normal(ray: &Ray, hit: &PartialHit) -> DVec3 {
    let normal = normal(hit);
    if normal.dot(ray.direction) > 0.0 {
        -normal
    } else {
        normal
    }
}

fn normal(hit: &PartialHit) -> DVec3 {
    hit.normal().expect("every integrator requests normals")
}
