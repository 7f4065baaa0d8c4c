//! Light that arrives unless something is in between.

use cyltrace::math::Ray;
use cyltrace::tracer::Tracer;
use glam::DVec3;

/// Rays for occlusion only, the samples they are for and the light that each brings.
#[derive(Default)]
pub(super) struct Occlusion {
    samples: Vec<usize>,
    light: Vec<DVec3>,
    rays: Vec<Ray>,
    blocked: Vec<bool>,
}

impl Occlusion {
    pub fn clear(&mut self) {
        self.samples.clear();
        self.light.clear();
        self.rays.clear();
    }

    pub fn push(&mut self, sample: usize, ray: Ray, light: DVec3) {
        self.samples.push(sample);
        self.light.push(light);
        self.rays.push(ray);
    }

    /// Traces the rays, adds the light of those that hit nothing to the colors of their samples,
    /// and returns how many rays there were.
    pub fn add_to(&mut self, colors: &mut [DVec3], tracer: &Tracer) -> u64 {
        tracer.occluded_batch(&self.rays, &mut self.blocked);
        let samples = self.samples.iter().zip(&self.light);
        for ((&sample, &light), blocked) in samples.zip(&self.blocked) {
            if !blocked {
                colors[sample] += light;
            }
        }
        self.rays.len() as u64
    }
}
