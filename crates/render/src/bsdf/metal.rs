//! A metal: facets that reflect and absorb.
//!
//! One reflection at facets of the reflectance `F` gives `f = F D G2 / (4 o_z i_z)`. Light that
//! another facet blocks is reflected again, and a model of one reflection loses it: up to half
//! of the light at a roughness of 1. What is missing comes back as the reciprocal function
//! `(1 - E(o)) (1 - E(i)) / (π (1 - Ē))` of the albedo `E` without absorption and its mean `Ē`,
//! colored by `F̄² Ē / (1 - F̄ (1 - Ē))` with the mean reflectance `F̄` (C. Kulla, A. Conty,
//! "Revisiting Physically Based Shading at Imageworks", SIGGRAPH courses, 2017). A surface with
//! `F = 1` reflects all light.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::albedo::Albedo;
use super::fresnel::{schlick, schlick_mean};
use super::microfacet::{Facets, reflected};
use super::{Bsdf, Local, Numbers, Scattered, cosine_direction};

/// A metal of the reflectance `color` for vertical light.
pub(crate) struct Metal {
    /// The facets and their albedo without absorption; `None` for a mirror.
    rough: Option<(Facets, Albedo)>,
}

impl Metal {
    pub fn new(roughness: f64) -> Self {
        let facets = Facets::new(roughness);
        Self {
            rough: facets.map(|facets| (facets, Albedo::new(facets, |_| 1.0))),
        }
    }
}

impl Bsdf for Metal {
    fn evaluate(&self, local: &Local, outgoing: DVec3, incoming: DVec3) -> DVec3 {
        let Some((facets, albedo)) = &self.rough else {
            return DVec3::ZERO;
        };
        if incoming.z <= 0.0 {
            return DVec3::ZERO;
        }
        let facet = (outgoing + incoming).normalize();
        let fresnel = schlick(local.color, outgoing.dot(facet));
        let hidden = facets.visible_from_both(outgoing, incoming);
        let once = fresnel * (facets.distribution(facet) * hidden / (4.0 * outgoing.z));

        let missing = |direction: DVec3| 1.0 - albedo.at(direction.z);
        let (mean, mean_fresnel) = (albedo.mean(), schlick_mean(local.color));
        let tint = mean_fresnel * mean_fresnel * mean / (DVec3::ONE - mean_fresnel * (1.0 - mean));
        let more = missing(outgoing) * missing(incoming) * FRAC_1_PI / (1.0 - mean);
        once + tint * (more * incoming.z)
    }

    fn density(&self, _: &Local, outgoing: DVec3, incoming: DVec3) -> f64 {
        let Some((facets, albedo)) = &self.rough else {
            return 0.0;
        };
        if incoming.z <= 0.0 {
            return 0.0;
        }
        let facet = (outgoing + incoming).normalize();
        // A reflection turns twice as far as the facet.
        let once = facets.density(outgoing, facet) / (4.0 * outgoing.dot(facet));
        let part = albedo.at(outgoing.z).min(1.0);
        part * once + (1.0 - part) * incoming.z * FRAC_1_PI
    }

    fn sample(&self, local: &Local, outgoing: DVec3, numbers: Numbers) -> Option<Scattered> {
        let Some((facets, albedo)) = &self.rough else {
            return Some(Scattered {
                incoming: DVec3::new(-outgoing.x, -outgoing.y, outgoing.z),
                weight: schlick(local.color, outgoing.z),
                density: None,
            });
        };
        let incoming = match numbers.choice < albedo.at(outgoing.z) {
            true => reflected(outgoing, facets.sample(outgoing, numbers.direction)),
            false => cosine_direction(numbers.direction),
        };
        super::weighted(self, local, outgoing, incoming)
    }

    fn is_smooth(&self) -> bool {
        self.rough.is_none()
    }
}
