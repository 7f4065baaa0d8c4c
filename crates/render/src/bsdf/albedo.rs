//! What part of the light a rough surface reflects at once.
//!
//! `E(cos o) = ∫ f(o, i) |cos i| d i` is the mean of `F G2 / G1` over the visible facets. The
//! integral over the two numbers of a sample is approximated at midpoints. The integrand is
//! periodic in the first number. In the second it changes where `1 - second` is about α, the tail
//! of the distribution, so that midpoints of the square root of that are used. The error is below
//! 2 10^-4 at a roughness of 0.3, and less of rougher surfaces. Between the 65 cosines of the
//! table, `E` is interpolated linearly, with an error below 10^-3, at the horizon. A surface
//! remains reciprocal with an inexact `E`; the light it reflects in all is off by as much.

use glam::DVec3;

use super::microfacet::{Facets, reflected};

/// Steps between the cosines of the table.
const STEPS: usize = 64;

/// Midpoints of the integral: half of the circle, as it is symmetric, and the second number.
const AROUND: u32 = 32;
const UPWARD: u32 = 128;

/// `E` as a function of the cosine.
#[derive(Clone, Debug)]
pub(super) struct Albedo {
    values: [f64; STEPS + 1],
    /// `∫ 2 cos E d cos`.
    mean: f64,
}

impl Albedo {
    /// The albedo of facets that reflect as `fresnel` says of the cosine to their normal.
    pub fn new(facets: Facets, fresnel: impl Fn(f64) -> f64) -> Self {
        let mut values = [0.0; STEPS + 1];
        for (step, value) in values.iter_mut().enumerate() {
            // The limit at the horizon is approached from above.
            let cosine = (step as f64 / STEPS as f64).max(1e-6);
            *value = albedo(facets, &fresnel, cosine);
        }
        // Simpson's rule, as the table is smooth.
        let weighted = |step: usize| step as f64 / STEPS as f64 * values[step];
        let inner: f64 = (1..STEPS)
            .map(|step| weighted(step) * if step % 2 == 1 { 4.0 } else { 2.0 })
            .sum();
        let mean = 2.0 * (inner + weighted(STEPS)) / (3.0 * STEPS as f64);
        Self { values, mean }
    }

    /// The albedo at a cosine from 0 to 1.
    pub fn at(&self, cosine: f64) -> f64 {
        let place = cosine.clamp(0.0, 1.0) * STEPS as f64;
        let step = (place as usize).min(STEPS - 1);
        let part = place - step as f64;
        self.values[step] * (1.0 - part) + self.values[step + 1] * part
    }

    /// The mean over the hemisphere, weighted by the cosine.
    pub fn mean(&self) -> f64 {
        self.mean
    }
}

fn albedo(facets: Facets, fresnel: impl Fn(f64) -> f64, cosine: f64) -> f64 {
    let outgoing = DVec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let mut sum = 0.0;
    for around in 0..AROUND {
        // The other half of the circle gives the same.
        let first = (f64::from(around) + 0.5) / f64::from(AROUND) * 0.5;
        for upward in 0..UPWARD {
            let root = (f64::from(upward) + 0.5) / f64::from(UPWARD);
            let facet = facets.sample(outgoing, (first, 1.0 - root * root));
            let incoming = reflected(outgoing, facet);
            if incoming.z > 0.0 {
                let hidden =
                    facets.visible_from_both(outgoing, incoming) / facets.visible(outgoing);
                sum += 2.0 * root * fresnel(outgoing.dot(facet)) * hidden;
            }
        }
    }
    sum / f64::from(AROUND * UPWARD)
}
