//! A diffuse surface under a clear coat.
//!
//! The coat reflects like facets of a dielectric, with the albedo `E`. The rest enters, is
//! scattered by the base and leaves: `ρ' (1 - E(o)) (1 - E(i)) / (π (1 - Ē))` with the mean albedo
//! `Ē`. It is reciprocal, and with `ρ' = 1` all light is reflected (the form of Kulla and Conty's
//! function, see `metal`). The coat also reflects a part `R` of the light from the base back to
//! it, so that of a base of the reflectance ρ `ρ' = ρ (1 - R) / (1 - ρ R)` leaves. As many rays
//! pass an interface one way as the other, `η² (1 - R) = 1 - Ē` with the coat's index of
//! refraction η.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::albedo::Albedo;
use super::fresnel::dielectric;
use super::microfacet::{Facets, reflected};
use super::{Bsdf, Local, Numbers, Scattered, cosine_direction};

/// A coated diffuse surface of the reflectance `color`.
pub(crate) struct Plastic {
    ior: f64,
    /// `None` for a smooth coat.
    facets: Option<Facets>,
    coat: Albedo,
    /// `R`.
    returned: f64,
}

impl Plastic {
    pub fn new(roughness: f64, ior: f64) -> Self {
        let facets = Facets::new(roughness);
        let fresnel = |cosine| dielectric(cosine, ior).0;
        // The narrowest facets stand for a smooth coat: their albedo is that of the interface
        // within the error of the table.
        let of_coat = facets.unwrap_or_else(Facets::narrowest);
        let coat = Albedo::new(of_coat, fresnel);
        let returned = 1.0 - (1.0 - coat.mean()) / (ior * ior);
        Self {
            ior,
            facets,
            coat,
            returned,
        }
    }

    /// `ρ'`.
    fn base(&self, color: DVec3) -> DVec3 {
        color * (1.0 - self.returned) / (DVec3::ONE - color * self.returned)
    }

    /// The part of samples that the coat reflects.
    fn of_coat(&self, local: &Local, outgoing: DVec3) -> f64 {
        let coat = self.coat.at(outgoing.z);
        let base = (1.0 - coat) * self.base(local.color).max_element();
        coat / (coat + base)
    }
}

impl Bsdf for Plastic {
    fn evaluate(&self, local: &Local, outgoing: DVec3, incoming: DVec3) -> DVec3 {
        if incoming.z <= 0.0 {
            return DVec3::ZERO;
        }
        let enters = |direction: DVec3| 1.0 - self.coat.at(direction.z);
        let both = enters(outgoing) * enters(incoming) / (1.0 - self.coat.mean());
        let base = self.base(local.color) * (both * incoming.z * FRAC_1_PI);
        let Some(facets) = self.facets else {
            return base;
        };
        let facet = (outgoing + incoming).normalize();
        let (fresnel, _) = dielectric(outgoing.dot(facet), self.ior);
        let hidden = facets.visible_from_both(outgoing, incoming);
        base + DVec3::splat(fresnel * facets.distribution(facet) * hidden / (4.0 * outgoing.z))
    }

    fn density(&self, local: &Local, outgoing: DVec3, incoming: DVec3) -> f64 {
        if incoming.z <= 0.0 {
            return 0.0;
        }
        let of_coat = self.of_coat(local, outgoing);
        let base = (1.0 - of_coat) * incoming.z * FRAC_1_PI;
        let Some(facets) = self.facets else {
            return base;
        };
        let facet = (outgoing + incoming).normalize();
        base + of_coat * facets.density(outgoing, facet) / (4.0 * outgoing.dot(facet))
    }

    fn sample(&self, local: &Local, outgoing: DVec3, numbers: Numbers) -> Option<Scattered> {
        let of_coat = self.of_coat(local, outgoing);
        let incoming = match (numbers.choice < of_coat, self.facets) {
            (true, None) => {
                let (fresnel, _) = dielectric(outgoing.z, self.ior);
                return Some(Scattered {
                    incoming: DVec3::new(-outgoing.x, -outgoing.y, outgoing.z),
                    weight: DVec3::splat(fresnel / of_coat),
                    density: None,
                });
            }
            (true, Some(facets)) => reflected(outgoing, facets.sample(outgoing, numbers.direction)),
            (false, _) => cosine_direction(numbers.direction),
        };
        super::weighted(self, local, outgoing, incoming)
    }
}
