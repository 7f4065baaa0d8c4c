//! From a camera ray to the light it sees.
//!
//! - `normal`: the outward unit normal `n` as the linear colour `n/2 + 1/2`,
//!   just as `trace` reports it (not turned to the viewer); black, which is
//!   no normal's colour, where the ray misses.
//! - `ao`: 1 where a ray of unlimited length in a cosine-distributed direction
//!   leaves the scene and 0 if it hits a surface, so the mean is the
//!   visible part of an open sky, weighted as a diffuse surface sees it. A
//!   camera ray that misses sees the sky itself: 1.
//! - `sun`: diffuse surfaces under a sun (parallel light of irradiance `E`)
//!   and a sky (the same radiance `L` everywhere). A surface of reflectance
//!   `ρ` that faces the sun at the cosine `c` sends out
//!   `ρ (E c S / π + L V)`, where `S` says whether the sun is seen and `V`
//!   whether a cosine-distributed direction leaves the scene. Light is not
//!   reflected twice.
//!
//! Surfaces are two-sided: they are lit on the side the viewer is on, so that
//! open tubes show their inside.

use glam::{DVec2, DVec3};

use super::Lights;
use super::colors::Colors;
use super::sampler::PixelSampler;
use cyltrace::math::Ray;
use cyltrace::scene::{AimedCamera, Integrator};
use cyltrace::tracer::{HitFields, PartialHit, Tracer};

/// How many rays were traced, by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// Towards the sun.
    pub shadow: u64,
    /// In cosine-distributed directions, of `ao` or towards the sky.
    pub ao: u64,
}

impl RayCounts {
    /// All rays.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.ao
    }
}

impl std::ops::Add for RayCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            camera: self.camera + other.camera,
            shadow: self.shadow + other.shadow,
            ao: self.ao + other.ao,
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
}

/// Many samples at a time, in steps: all rays of one purpose are traced
/// together, so that coherent ones share work. What is kept
/// between the steps is kept here, to be used again.
#[derive(Default)]
pub(super) struct Batch {
    rays: Vec<Ray>,
    hits: Vec<Option<PartialHit>>,
    /// The colours of the samples, in their order.
    pub colors: Vec<DVec3>,
    occlusion: Occlusion,
}

/// Rays for occlusion only, and the samples
/// they are for.
#[derive(Default)]
struct Occlusion {
    samples: Vec<usize>,
    rays: Vec<Ray>,
    blocked: Vec<bool>,
}

impl Occlusion {
    fn clear(&mut self) {
        self.samples.clear();
        self.rays.clear();
    }

    fn push(&mut self, sample: usize, ray: Ray) {
        self.samples.push(sample);
        self.rays.push(ray);
    }

    /// Traces the rays, and hands on the samples whose ray hits nothing.
    fn free(&mut self, tracer: &Tracer) -> impl Iterator<Item = usize> {
        tracer.occluded_batch(&self.rays, &mut self.blocked);
        let answers = self.samples.iter().zip(&self.blocked);
        answers.filter_map(|(sample, blocked)| (!blocked).then_some(*sample))
    }
}

impl View<'_> {
    /// Works out the linear colours of samples, which are best near each other.
    pub(super) fn trace(&self, samples: &[Sample], batch: &mut Batch, rays: &mut RayCounts) {
        batch.rays.clear();
        batch.rays.extend(samples.iter().map(|sample| {
            let (across, down) = sample.sampler.place(sample.number);
            let (x, y) = sample.pixel;
            let position = DVec2::new(f64::from(x) + across, f64::from(y) + down);
            self.camera.ray(position)
        }));
        rays.camera += samples.len() as u64;
        let fields = match self.integrator {
            Integrator::Normal => HitFields::NORMAL,
            Integrator::Ao => HitFields::NORMAL | HitFields::SPAWN,
            Integrator::Sun | Integrator::Path => {
                HitFields::NORMAL | HitFields::SPAWN | self.colors.fields()
            }
        };
        self.tracer
            .closest_batch_with(&batch.rays, fields, &mut batch.hits);

        batch.colors.clear();
        let color = |hit: &Option<PartialHit>| match (self.integrator, hit) {
            (Integrator::Normal, Some(hit)) => normal(hit) * 0.5 + 0.5,
            (Integrator::Normal, None)
            | (Integrator::Ao | Integrator::Sun | Integrator::Path, Some(_)) => DVec3::ZERO,
            (Integrator::Ao, None) => DVec3::ONE,
            (Integrator::Sun | Integrator::Path, None) => self.lights.miss(),
        };
        batch.colors.extend(batch.hits.iter().map(color));
        match self.integrator {
            Integrator::Normal => {}
            Integrator::Ao => self.add_sky(samples, batch, rays, DVec3::ONE),
            Integrator::Sun | Integrator::Path => {
                self.add_sunlight(batch, rays);
                if let Some(radiance) = self.lights.sky() {
                    self.add_sky(samples, batch, rays, radiance);
                }
                for (color, hit) in batch.colors.iter_mut().zip(&batch.hits) {
                    if let Some(hit) = hit {
                        *color *= self.colors.at(hit);
                    }
                }
            }
        }
    }

    /// Adds the sun's light at the hits: its irradiance over π. No ray is spent
    /// on a surface that faces away.
    fn add_sunlight(&self, batch: &mut Batch, rays: &mut RayCounts) {
        let Some(sun) = self.lights.sun() else {
            return;
        };
        let shadows = &mut batch.occlusion;
        shadows.clear();
        let cosine = |ray: &Ray, hit: &PartialHit| facing_normal(ray, hit).dot(sun.direction);
        for (sample, (ray, hit)) in batch.rays.iter().zip(&batch.hits).enumerate() {
            if let Some(hit) = hit.as_ref().filter(|hit| cosine(ray, hit) > 0.0) {
                shadows.push(sample, spawn(hit, sun.direction));
            }
        }
        rays.shadow += shadows.rays.len() as u64;
        for sample in shadows.free(self.tracer) {
            if let Some(hit) = &batch.hits[sample] {
                let cosine = cosine(&batch.rays[sample], hit);
                batch.colors[sample] += sun.irradiance * cosine * std::f64::consts::FRAC_1_PI;
            }
        }
    }

    /// Adds `radiance` at the hits from which a direction drawn with the sample's
    /// numbers leaves the scene.
    fn add_sky(
        &self,
        samples: &[Sample],
        batch: &mut Batch,
        rays: &mut RayCounts,
        radiance: DVec3,
    ) {
        let openings = &mut batch.occlusion;
        openings.clear();
        for (number, (ray, hit)) in batch.rays.iter().zip(&batch.hits).enumerate() {
            if let Some(hit) = hit {
                let numbers = samples[number].direction();
                let direction = cosine_direction(facing_normal(ray, hit), numbers);
                openings.push(number, spawn(hit, direction));
            }
        }
        rays.ao += openings.rays.len() as u64;
        for sample in openings.free(self.tracer) {
            batch.colors[sample] += radiance;
        }
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

fn spawn(hit: &PartialHit, direction: DVec3) -> Ray {
    hit.spawn(direction)
        .expect("every integrator that spawns rays requests it")
}

/// A direction about the unit vector `normal` whose density is the cosine
/// between them over π, from two uniform numbers in [0, 1).
fn cosine_direction(normal: DVec3, (first, second): (f64, f64)) -> DVec3 {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let radius = first.sqrt();
    let (sine, cosine) = libm::sincos(second * std::f64::consts::TAU);
    tangent * (radius * cosine) + bitangent * (radius * sine) + normal * (1.0 - first).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Random;

    #[test]
    fn cosine_direction_above_the_surface_and_two_thirds_mean() {
        let mut random = Random::new(31, 0);
        for case in 0..50 {
            let normal = random.direction();
            let sampler = PixelSampler::new(31, case);
            let mut mean = 0.0;
            let samples = 1024;
            for sample in 0..samples {
                let direction = cosine_direction(normal, sampler.direction(sample));
                assert!((direction.length() - 1.0).abs() < 1e-14, "case {case}");
                assert!(
                    direction.dot(normal) > 0.0,
                    "seed 31 case {case} {normal:?}"
                );
                mean += direction.dot(normal) / f64::from(samples);
            }
            // The mean of the cosine under the density cos/π is 2/3.
            assert!((mean - 2.0 / 3.0).abs() < 2e-3, "case {case}: {mean}");
        }
    }
}
