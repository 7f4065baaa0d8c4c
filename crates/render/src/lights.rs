//! The lights of a scene, and the default lights.

use glam::DVec3;

use cyltrace::scene::{Scene, Sky, Sun};

/// The sun of a scene that states no light: from the left of an automatic
/// frame, behind the viewer, 45 degrees high, slightly warm. With the sky
/// below, a surface of reflectance 0.8 that faces it comes out just at white,
/// and the default material, 0.5, is visible against a light background.
const DEFAULT_SUN: (DVec3, DVec3, f64) = (
    DVec3::new(-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2),
    DVec3::new(1.0, 0.92, 0.8),
    3.0,
);

/// The sky of a scene that states no light: a clear one, far weaker than the
/// sun, so that shadows show.
const DEFAULT_SKY: (DVec3, f64) = (DVec3::new(0.65, 0.8, 1.0), 0.3);

/// What shines on a scene; lights without effect are left out.
#[derive(Clone, Debug)]
pub struct Lights {
    sun: Option<SunLight>,
    sky: Option<DVec3>,
    miss: DVec3,
}

/// A sun that shines.
#[derive(Clone, Copy, Debug)]
pub struct SunLight {
    /// Unit vector towards the sun.
    pub direction: DVec3,
    /// Irradiance on a surface that faces the sun, linear RGB.
    pub irradiance: DVec3,
}

impl Lights {
    /// The lights of `scene`. A scene that states neither a sun nor a sky
    /// would be black, so it gets a default sun and sky; its background is
    /// still what a camera ray sees that misses everything.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let unlit = scene.sun.is_none() && scene.sky.is_none();
        let (sun, sky) = if unlit {
            (Some(default_sun()), Some(default_sky()))
        } else {
            (scene.sun, scene.sky)
        };
        let radiance = sky.map(|sky| sky.color * sky.strength);
        let miss = if unlit { None } else { radiance };
        Self {
            sun: sun
                .map(|sun| SunLight {
                    direction: sun.direction.normalize(),
                    irradiance: sun.color * sun.strength,
                })
                .filter(|sun| sun.irradiance != DVec3::ZERO),
            sky: radiance.filter(|&radiance| radiance != DVec3::ZERO),
            miss: miss.unwrap_or(scene.background),
        }
    }

    /// The sun, where it gives light.
    #[must_use]
    pub fn sun(&self) -> Option<SunLight> {
        self.sun
    }

    /// The sky's radiance, the same in every direction, where there is any.
    #[must_use]
    pub fn sky(&self) -> Option<DVec3> {
        self.sky
    }

    /// The radiance of a camera ray that hits nothing.
    #[must_use]
    pub fn miss(&self) -> DVec3 {
        self.miss
    }
}

fn default_sun() -> Sun {
    let (direction, color, strength) = DEFAULT_SUN;
    Sun {
        direction,
        color,
        strength,
        angle_degrees: Sun::ANGLE_DEGREES,
    }
}

fn default_sky() -> Sky {
    let (color, strength) = DEFAULT_SKY;
    Sky { color, strength }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(sun: Option<Sun>, sky: Option<Sky>) -> Scene {
        Scene {
            sun,
            sky,
            background: DVec3::new(0.1, 0.2, 0.3),
            ..Scene::new(Vec::new())
        }
    }

    #[test]
    fn lights_none_stated_defaults_shine_and_background_shows() {
        let lights = Lights::of(&scene(None, None));
        let sun = lights.sun().expect("a default sun");
        assert!((sun.direction.length() - 1.0).abs() < 1e-15);
        assert!(lights.sky().is_some());
        assert_eq!(lights.miss(), DVec3::new(0.1, 0.2, 0.3));
    }

    #[test]
    fn lights_without_strength_left_out() {
        let mut sun = default_sun();
        sun.strength = 0.0;
        let lights = Lights::of(&scene(Some(sun), None));
        assert!(lights.sun().is_none() && lights.sky().is_none());
        assert_eq!(lights.miss(), DVec3::new(0.1, 0.2, 0.3));
    }

    #[test]
    fn lights_sky_stated_seen_where_nothing_is() {
        let sky = Sky {
            color: DVec3::new(0.5, 0.25, 1.0),
            strength: 2.0,
        };
        let lights = Lights::of(&scene(None, Some(sky)));
        assert!(lights.sun().is_none());
        assert_eq!(lights.miss(), DVec3::new(1.0, 0.5, 2.0));
        assert_eq!(lights.sky(), Some(lights.miss()));
    }
}
