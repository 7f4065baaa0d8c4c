//! What a path carries from one surface to the next.

use cyltrace::math::Ray;
use glam::DVec3;

use crate::lights::Arriving;

/// A path up to a ray.
#[derive(Clone, Copy)]
pub(super) struct Path {
    /// The position in the batch.
    pub sample: usize,
    pub ray: Ray,
    pub throughput: DVec3,
    /// Where the ray's direction was chosen, and its density; `None` if no light could have been
    /// sampled in its place.
    pub point: DVec3,
    pub density: Option<f64>,
    /// The index of refraction around the ray.
    pub ior: f64,
    /// The surfaces that scattered it.
    pub depth: u32,
    /// Whether they were smooth, so that the viewer sees through or in a mirror.
    pub is_direct: bool,
}

impl Path {
    /// The light at the end of the ray that counts.
    pub fn weighted(&self, light: Arriving) -> DVec3 {
        let weight = self
            .density
            .map_or(1.0, |density| weight(density, light.density));
        self.throughput * (light.unsampled + light.sampled * weight)
    }
}

/// The power heuristic: the weight of a direction of a density that another way to sample finds
/// with the density `other`.
pub(super) fn weight(density: f64, other: f64) -> f64 {
    let ratio = other / density;
    1.0 / (1.0 + ratio * ratio)
}
