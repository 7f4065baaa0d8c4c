//! The sun: a disk of uniform radiance at infinity.
//!
//! A disk of the half angle θ and the radiance `L` gives a surface that faces it the irradiance
//! `E = ∫ L cos γ dω = π sin² θ L`, with γ the angle to the middle of the sun. Points that are
//! uniform on the disk of the radius `sin θ` across the sun's direction are projections of unit
//! vectors with the density `cos γ / (π sin² θ)`. So a surface at the cosine `c` to the sampled
//! direction gets `L c / density = E c / cos γ`, which is `E c` for a sun without an extent.

use std::f64::consts::PI;

use cyltrace::scene::Sun;
use glam::DVec3;

use super::LightSample;
use crate::disk::concentric_disk;
use crate::frame::Frame;

/// The least sine of a sun with an extent. Direct light is the same below it, and the radiance,
/// which grows with its inverse square, stays far from overflow.
const LEAST_SINE: f64 = 1e-7;

/// A sun that shines.
#[derive(Clone, Copy, Debug)]
pub struct SunLight {
    /// Unit vector towards the middle of the sun.
    pub direction: DVec3,
    /// Irradiance on a surface that faces the sun, linear RGB.
    pub irradiance: DVec3,
    /// The sine of half of the angle that the sun spans.
    sine: f64,
    /// About the direction.
    frame: Frame,
}

impl SunLight {
    /// The light of a sun, or `None` if it gives none.
    pub(super) fn new(sun: &Sun) -> Option<Self> {
        let irradiance = sun.color * sun.strength;
        let sine = libm::sin((0.5 * sun.angle_degrees).to_radians());
        let direction = sun.direction.normalize();
        (irradiance != DVec3::ZERO).then(|| Self {
            direction,
            frame: Frame::about(direction),
            irradiance,
            sine: if sine >= LEAST_SINE { sine } else { 0.0 },
        })
    }

    /// Whether the sun has an extent, so that numbers choose a point of it.
    pub(crate) fn has_extent(&self) -> bool {
        self.sine > 0.0
    }

    /// A direction towards the sun, and the irradiance of a surface that faces that direction
    /// over the probability density: `E / cos γ`.
    pub(crate) fn towards(&self, numbers: (f64, f64)) -> (DVec3, DVec3) {
        if !self.has_extent() {
            return (self.direction, self.irradiance);
        }
        let place = concentric_disk(numbers) * self.sine;
        let cosine = (1.0 - place.length_squared()).sqrt();
        let direction = self.frame.in_world(place.extend(cosine));
        (direction, self.irradiance / cosine)
    }

    /// A sample of the light.
    pub(super) fn sample(&self, numbers: (f64, f64)) -> LightSample {
        let (direction, arriving) = self.towards(numbers);
        LightSample {
            direction,
            distance: f64::INFINITY,
            arriving,
            density: self.has_extent().then(|| self.density(direction)),
        }
    }

    /// The radiance from a direction.
    pub(crate) fn radiance(&self, direction: DVec3) -> DVec3 {
        match self.covers(direction) {
            true => self.irradiance / (PI * self.sine * self.sine),
            false => DVec3::ZERO,
        }
    }

    /// The density of samples in a direction, per solid angle.
    pub(super) fn density(&self, direction: DVec3) -> f64 {
        match self.covers(direction) {
            true => self.direction.dot(direction) / (PI * self.sine * self.sine),
            false => 0.0,
        }
    }

    fn covers(&self, direction: DVec3) -> bool {
        // The sine distinguishes small angles, the cosine does not.
        let is_ahead = self.direction.dot(direction) > 0.0;
        let squared_sine = self.direction.cross(direction).length_squared();
        is_ahead && self.has_extent() && squared_sine <= self.sine * self.sine
    }
}
