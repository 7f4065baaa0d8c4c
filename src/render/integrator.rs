//! From a camera ray to the light it sees.
//!
//! - `normal`: the outward unit normal `n` as the linear colour `n/2 + 1/2`,
//!   just as `trace` reports it (not turned to the viewer); black, which is
//!   no normal's colour, where the ray misses.
//! - `ao`: 1 where a ray of unlimited length in a cosine-distributed direction
//!   leaves the scene and 0 where it meets a surface, so the mean is the
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

use super::{Lights, PixelSampler};
use crate::math::Ray;
use crate::scene::{AimedCamera, Integrator, Material};
use crate::tracer::{Hit, Tracer};

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
    pub(super) materials: &'a [Material],
    pub(super) camera: AimedCamera,
    pub(super) lights: Lights,
    pub(super) integrator: Integrator,
}

impl View<'_> {
    /// The linear colour of one sample of the pixel in column `x`, row `y`.
    pub(super) fn sample(
        &self,
        (x, y): (u32, u32),
        sampler: &PixelSampler,
        sample: u32,
        rays: &mut RayCounts,
    ) -> DVec3 {
        let (across, down) = sampler.place(sample);
        let position = DVec2::new(f64::from(x) + across, f64::from(y) + down);
        let ray = self.camera.ray(position);
        rays.camera += 1;
        let hit = self.tracer.closest(&ray);
        match (self.integrator, hit) {
            (Integrator::Normal, Some(hit)) => hit.normal * 0.5 + 0.5,
            (Integrator::Normal, None) => DVec3::ZERO,
            (Integrator::Ao, Some(hit)) => {
                DVec3::splat(self.openness(&ray, &hit, sampler.direction(sample), rays))
            }
            (Integrator::Ao, None) => DVec3::ONE,
            (Integrator::Sun, Some(hit)) => {
                let reflectance = self.materials[usize::from(hit.material.0)].color;
                let sunlight = self.sunlight(&ray, &hit, rays);
                let skylight = self.lights.sky().map_or(DVec3::ZERO, |radiance| {
                    radiance * self.openness(&ray, &hit, sampler.direction(sample), rays)
                });
                reflectance * (sunlight * std::f64::consts::FRAC_1_PI + skylight)
            }
            (Integrator::Sun, None) => self.lights.miss(),
        }
    }

    /// The sun's irradiance at a hit. No ray is spent on a surface that faces
    /// away.
    fn sunlight(&self, ray: &Ray, hit: &Hit, rays: &mut RayCounts) -> DVec3 {
        let Some(sun) = self.lights.sun() else {
            return DVec3::ZERO;
        };
        let cosine = facing_normal(ray, hit).dot(sun.direction);
        if cosine <= 0.0 {
            return DVec3::ZERO;
        }
        rays.shadow += 1;
        if self.tracer.occluded(&hit.spawn(sun.direction)) {
            return DVec3::ZERO;
        }
        sun.irradiance * cosine
    }

    /// 1 when a direction drawn with `numbers` leaves the scene, else 0.
    fn openness(&self, ray: &Ray, hit: &Hit, numbers: (f64, f64), rays: &mut RayCounts) -> f64 {
        rays.ao += 1;
        let direction = cosine_direction(facing_normal(ray, hit), numbers);
        if self.tracer.occluded(&hit.spawn(direction)) {
            0.0
        } else {
            1.0
        }
    }
}

/// The unit normal on the side that the ray comes from.
fn facing_normal(ray: &Ray, hit: &Hit) -> DVec3 {
    if hit.normal.dot(ray.direction) > 0.0 {
        -hit.normal
    } else {
        hit.normal
    }
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
    use crate::math::Random;

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
