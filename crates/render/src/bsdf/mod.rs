//! How a surface scatters light: the interface between materials and integrators.
//!
//! A material implements [`Bsdf`]. Directions are unit vectors in the frame of the surface,
//! whose `z` axis is the normal on the side of the `outgoing` direction. Both directions point
//! away from the surface: `outgoing` to where the light goes and `incoming` to where it comes
//! from. An incoming direction below the surface is transmitted.
//!
//! With `f` the bidirectional scattering distribution function, the radiance that leaves is
//! `∫ f(outgoing, incoming) L(incoming) |cos incoming| d incoming`. An integrator estimates it
//! by `f |cos| L / density` for a sampled direction. [`Bsdf::evaluate`] is `f |cos|`,
//! [`Scattered::weight`] is `f |cos| / density`.
//!
//! A smooth mirror or interface scatters into single directions, for which a density does not
//! exist. Such a part of a function is in [`Bsdf::sample`] alone, and the sample has no density.

mod albedo;
mod diffuse;
mod fresnel;
mod glass;
mod metal;
mod microfacet;
mod plastic;

use cyltrace::scene::{Material, MaterialKind};
use glam::DVec3;

pub(crate) use diffuse::Diffuse;
pub(crate) use glass::Glass;
pub(crate) use metal::Metal;
pub(crate) use plastic::Plastic;

/// The properties of a surface that differ from hit to hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    /// The material's color there.
    pub color: DVec3,
    /// The index of refraction of the far side over that of the side of `outgoing`.
    pub relative_ior: f64,
}

/// The numbers that choose a direction, uniform in [0, 1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers {
    /// Chooses between parts of the function.
    pub choice: f64,
    /// Choose a direction.
    pub direction: (f64, f64),
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scattered {
    /// The incoming direction.
    pub incoming: DVec3,
    /// `f |cos| / density`.
    pub weight: DVec3,
    /// The density per solid angle with which [`Bsdf::sample`] returns the direction, or `None`
    /// for a direction that no other sampling can find.
    pub density: Option<f64>,
}

/// How a surface scatters light.
pub(crate) trait Bsdf: Send + Sync {
    /// `f |cos|` for two directions.
    fn evaluate(&self, local: &Local, outgoing: DVec3, incoming: DVec3) -> DVec3;

    /// The density with which [`Bsdf::sample`] returns `incoming`.
    fn density(&self, local: &Local, outgoing: DVec3, incoming: DVec3) -> f64;

    /// A direction, or `None` if the light is absorbed.
    fn sample(&self, local: &Local, outgoing: DVec3, numbers: Numbers) -> Option<Scattered>;

    /// Whether [`Bsdf::evaluate`] is zero everywhere, so that sampling a light is useless.
    fn is_smooth(&self) -> bool {
        false
    }

    /// Whether light passes to the far side.
    fn transmits(&self) -> bool {
        false
    }
}

/// The function of a material; `None` for one that emits light and scatters none.
pub(crate) fn of(material: &Material) -> Option<Box<dyn Bsdf>> {
    Some(match material.kind {
        MaterialKind::Diffuse => Box::new(Diffuse),
        MaterialKind::Metal { roughness } => Box::new(Metal::new(roughness)),
        MaterialKind::Plastic { roughness, ior } => Box::new(Plastic::new(roughness, ior)),
        MaterialKind::Glass { roughness, .. } => Box::new(Glass::new(roughness)),
        MaterialKind::Light { .. } => return None,
    })
}

/// The sample of a direction that was chosen by the density of a function; `None` if no light
/// comes from there.
fn weighted(
    bsdf: &impl Bsdf,
    local: &Local,
    outgoing: DVec3,
    incoming: DVec3,
) -> Option<Scattered> {
    let density = bsdf.density(local, outgoing, incoming);
    (density > 0.0).then(|| Scattered {
        incoming,
        weight: bsdf.evaluate(local, outgoing, incoming) / density,
        density: Some(density),
    })
}

/// A direction about `z` whose density is the cosine over π.
pub(crate) fn cosine_direction((first, second): (f64, f64)) -> DVec3 {
    let radius = first.sqrt();
    let (sine, cosine) = libm::sincos(second * std::f64::consts::TAU);
    DVec3::new(radius * cosine, radius * sine, (1.0 - first).sqrt())
}

#[cfg(test)]
mod tests;
