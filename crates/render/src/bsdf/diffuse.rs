//! A surface that looks equally bright from all sides: `f = ρ / π`, by Lambert.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::{Bsdf, Local, Numbers, Scattered, cosine_direction};

/// A diffuse surface of the reflectance `color`. Directions are sampled by their cosine, so
/// that the weight is the reflectance.
pub(crate) struct Diffuse;

impl Bsdf for Diffuse {
    fn evaluate(&self, local: &Local, _: DVec3, incoming: DVec3) -> DVec3 {
        local.color * (incoming.z.max(0.0) * FRAC_1_PI)
    }

    fn density(&self, _: &Local, _: DVec3, incoming: DVec3) -> f64 {
        incoming.z.max(0.0) * FRAC_1_PI
    }

    fn sample(&self, local: &Local, _: DVec3, numbers: Numbers) -> Option<Scattered> {
        let incoming = cosine_direction(numbers.direction);
        Some(Scattered {
            incoming,
            weight: local.color,
            density: Some(incoming.z * FRAC_1_PI),
        })
    }
}
