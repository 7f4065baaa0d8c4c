//! Integrators of one reflection.
//!
//! - `ao`: 1 where a ray in a cosine-distributed direction hits no surface within a distance,
//!   which may be infinite, and 0 elsewhere. So the mean is the visible part of an open sky,
//!   weighted as a diffuse surface sees it. A camera ray that misses sees the sky itself: 1.
//! - `sun`: diffuse surfaces under a sun of the irradiance `E` and a sky or an environment of the
//!   radiance `L`. A surface of reflectance `ρ` that faces the sun at the cosine `c` sends out
//!   `ρ (E c S / π + L V)`, where `S` is the part of the sun that is seen and `V` the part of the
//!   directions, weighted by their cosine, that leave the scene. Light is not reflected twice.
//!   Materials of all kinds count as diffuse, and one that emits light shows its radiance.

use std::f64::consts::FRAC_1_PI;

use cyltrace::tracer::HitFields;
use glam::DVec3;

use super::{Batch, RayCounts, SUN, Sample, View, facing_normal};
use crate::bsdf::cosine_direction;
use crate::frame::Frame;
use crate::sampler::Pairs;

impl View<'_> {
    pub(super) fn ambient_occlusion(
        &self,
        samples: &[Sample],
        batch: &mut Batch,
        rays: &mut RayCounts,
    ) {
        self.closest_to_camera(batch, HitFields::NORMAL | HitFields::SPAWN);
        let hits = batch.hits.iter();
        let colors = hits.map(|hit| {
            if hit.is_some() {
                DVec3::ZERO
            } else {
                DVec3::ONE
            }
        });
        batch.colors.extend(colors);
        let open = |_| DVec3::ONE;
        self.add_sky(samples, batch, rays, self.settings.ao_distance, open);
    }

    pub(super) fn sunlight_and_sky(
        &self,
        samples: &[Sample],
        batch: &mut Batch,
        rays: &mut RayCounts,
    ) {
        let fields = HitFields::NORMAL | HitFields::SPAWN | self.colors.fields();
        self.closest_to_camera(batch, fields);
        let rays_and_hits = batch.rays.iter().zip(&batch.hits);
        let colors = rays_and_hits.map(|(ray, hit)| match hit {
            Some(_) => DVec3::ZERO,
            None => self.lights.miss(ray.direction.normalize()),
        });
        batch.colors.extend(colors);
        self.add_sunlight(samples, batch, rays);
        if self.lights.has_sky() {
            let radiance = |direction| self.lights.sky(direction).unwrap_or_default();
            self.add_sky(samples, batch, rays, f64::INFINITY, radiance);
        }
        for (color, hit) in batch.colors.iter_mut().zip(&batch.hits) {
            let Some(hit) = hit else {
                continue;
            };
            match self.emitted(hit) {
                Some(radiance) => *color = radiance,
                None => *color *= self.colors.at(hit),
            }
        }
    }

    /// Adds the sun's light at the hits: its irradiance over π. No ray is spent
    /// on a surface that faces away.
    fn add_sunlight(&self, samples: &[Sample], batch: &mut Batch, rays: &mut RayCounts) {
        let Some(sun) = self.lights.sun() else {
            return;
        };
        let shadows = &mut batch.occlusion;
        shadows.clear();
        let mut pairs = Pairs::new(SUN);
        for (sample, (ray, hit)) in batch.rays.iter().zip(&batch.hits).enumerate() {
            let Some(hit) = hit.as_ref().filter(|hit| self.emitted(hit).is_none()) else {
                continue;
            };
            let numbers = match sun.has_extent() {
                true => pairs.of(&samples[sample].sampler, samples[sample].number),
                false => (0.0, 0.0),
            };
            let (direction, arriving) = sun.towards(numbers);
            let cosine = facing_normal(ray, hit).dot(direction);
            if cosine > 0.0 {
                let light = arriving * cosine * FRAC_1_PI;
                shadows.push(sample, self.spawn(hit, direction), light);
            }
        }
        rays.shadow += shadows.add_to(&mut batch.colors, self.tracer);
    }

    /// Adds the radiance of a direction at the hits from which a direction drawn with the sample's numbers is
    /// free up to a distance.
    fn add_sky(
        &self,
        samples: &[Sample],
        batch: &mut Batch,
        rays: &mut RayCounts,
        distance: f64,
        radiance: impl Fn(DVec3) -> DVec3,
    ) {
        let openings = &mut batch.occlusion;
        openings.clear();
        for (number, (ray, hit)) in batch.rays.iter().zip(&batch.hits).enumerate() {
            if let Some(hit) = hit {
                let direction = cosine_direction(samples[number].direction());
                let direction = Frame::about(facing_normal(ray, hit)).in_world(direction);
                let mut ray = self.spawn(hit, direction);
                ray.t_max = ray.t_max.min(distance);
                openings.push(number, ray, radiance(direction));
            }
        }
        rays.ao += openings.add_to(&mut batch.colors, self.tracer);
    }
}
