//! A rough surface as small smooth facets.
//!
//! The normals `m` of the facets follow the distribution of Trowbridge and Reitz (GGX) of the
//! width α, `D(m) = α² / (π ((α² - 1) m_z² + 1)²)`. Facets hide each other. With
//! `Λ(w) = (√(1 + α² tan² w) - 1) / 2`, the part that is visible from `w` is
//! `G1 = 1 / (1 + Λ(w))`, and from two directions on the same side
//! `G2 = 1 / (1 + Λ(o) + Λ(i))` (E. Heitz, "Understanding the Masking-Shadowing Function in
//! Microfacet-Based BRDFs", JCGT 3(2), 2014).
//!
//! Facets are sampled as they are seen from `o`: with the density `G1(o) D(m) |o·m| / o_z`
//! (J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", CGF 42(8), 2023).
//! Then a reflection has the weight `F G2 / G1(o)`, which is at most 1.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

/// The least α: slopes of 10^-4, 0.006 degrees. Narrower lobes are narrower than any pixel, and
/// their densities would grow towards the square of the greatest f64.
const LEAST_WIDTH: f64 = 1e-4;

/// The facets of a rough surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facets {
    width: f64,
}

impl Facets {
    /// The facets of a surface of a roughness in [0, 1], or `None` for a smooth one. α is the
    /// square of the roughness, so that equal steps look alike.
    /// Below [`LEAST_WIDTH`] the surface is smooth.
    pub fn new(roughness: f64) -> Option<Self> {
        let width = roughness * roughness;
        (width >= LEAST_WIDTH).then_some(Self { width })
    }

    /// The facets of the least width.
    pub fn narrowest() -> Self {
        Self { width: LEAST_WIDTH }
    }

    /// `D(m)`, for `m` above the surface.
    pub fn distribution(self, facet: DVec3) -> f64 {
        let square = self.width * self.width;
        // (α² - 1) m_z² + 1 without cancellation: α² m_z² + sin² m.
        let sum = square * facet.z * facet.z + facet.x * facet.x + facet.y * facet.y;
        square * FRAC_1_PI / (sum * sum)
    }

    /// `Λ(w)`.
    fn hidden(self, direction: DVec3) -> f64 {
        let square = self.width * self.width;
        let sine = direction.x * direction.x + direction.y * direction.y;
        let slope = square * sine / (direction.z * direction.z);
        0.5 * ((1.0 + slope).sqrt() - 1.0)
    }

    /// `G1(o)`.
    pub fn visible(self, direction: DVec3) -> f64 {
        1.0 / (1.0 + self.hidden(direction))
    }

    /// `G2(o, i)`, for directions on the same side or on different ones.
    pub fn visible_from_both(self, outgoing: DVec3, incoming: DVec3) -> f64 {
        1.0 / (1.0 + self.hidden(outgoing) + self.hidden(incoming))
    }

    /// The density of the normals of [`Facets::sample`].
    pub fn density(self, outgoing: DVec3, facet: DVec3) -> f64 {
        let cosine = outgoing.dot(facet).max(0.0);
        self.visible(outgoing) * self.distribution(facet) * cosine / outgoing.z
    }

    /// The normal of a facet that is visible from `outgoing`, which is above the surface.
    pub fn sample(self, outgoing: DVec3, (first, second): (f64, f64)) -> DVec3 {
        let stretch = DVec3::new(self.width, self.width, 1.0);
        let seen = (outgoing * stretch).normalize();
        let z = (1.0 - second) * (1.0 + seen.z) - seen.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (sine, cosine) = libm::sincos(first * TAU);
        let half = DVec3::new(radius * cosine, radius * sine, z) + seen;
        (half * stretch).normalize()
    }
}

/// The mirror image of a direction at a facet.
pub(super) fn reflected(direction: DVec3, facet: DVec3) -> DVec3 {
    facet * (2.0 * direction.dot(facet)) - direction
}
