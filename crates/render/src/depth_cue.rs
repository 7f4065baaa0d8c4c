//! Surfaces that fade with their distance.
//!
//! A sample whose camera ray hits at the depth `d` shows `(1 - f) c + f q` in place of its color
//! `c`, with the color `q` of the cue and
//!
//! ```text
//! f = strength · clamp((d - start) / (end - start), 0, 1)
//! ```

use cyltrace::math::Bounds;
use cyltrace::scene::{AimedCamera, Integrator, Scene};
use glam::DVec3;

use super::Lights;

/// A depth cue with all its values known.
pub(super) struct DepthCue {
    color: DVec3,
    start: f64,
    end: f64,
    strength: f64,
}

impl DepthCue {
    /// The cue of a picture, if the scene has one and the integrator shows light.
    pub fn of(
        scene: &Scene,
        camera: &AimedCamera,
        bounds: &Bounds,
        lights: &Lights,
        integrator: Integrator,
    ) -> Option<Self> {
        let cue = scene.illustration.depth_cue?;
        let is_constant = scene.environment.is_none()
            && scene.clear_sky.is_none()
            && !scene.background.is_transparent();
        let background = match integrator {
            Integrator::Normal => return None,
            Integrator::Sun | Integrator::Path if is_constant => lights.miss(DVec3::Z),
            Integrator::Sun | Integrator::Path | Integrator::Ao => DVec3::ONE,
        };
        let [nearest, farthest] = camera.depth_range(bounds);
        Some(Self {
            color: cue.color.unwrap_or(background),
            start: cue.start.unwrap_or(nearest),
            end: cue.end.unwrap_or(farthest),
            strength: cue.strength,
        })
    }

    /// The color of a surface at a depth.
    pub fn faded(&self, color: DVec3, depth: f64) -> DVec3 {
        let length = self.end - self.start;
        let share = match length > 0.0 {
            true => ((depth - self.start) / length).clamp(0.0, 1.0),
            // The default of one end is not beyond the other.
            false => f64::from(u8::from(depth > self.start)),
        };
        color.lerp(self.color, self.strength * share)
    }
}
