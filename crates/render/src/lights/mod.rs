//! The lights of a scene, and the default lights.
//!
//! A light is *sampled* if a surface chooses a direction towards it. The sun and lights with a
//! place and environments are; a sky of the same radiance everywhere is not, because the directions in which a
//! surface scatters light reach it just as well. If there are several, one is chosen with a
//! probability that grows with its power; that of a sun is what crosses the scene.

mod choice;
mod emitters;
mod shapes;
mod sun;

use std::f64::consts::PI;

use cyltrace::math::{Bounds, Ray};
use cyltrace::scene::{Integrator, Scene, Sky, Sun};
use cyltrace::tracer::PartialHit;
use glam::DVec3;

use crate::environment::EnvironmentMap;
use choice::Choice;
use emitters::Emitters;
use shapes::ShapeLight;
pub use sun::SunLight;

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
#[derive(Clone, Debug, Default)]
pub struct Lights {
    sun: Option<SunLight>,
    sky: Option<DVec3>,
    environment: Option<EnvironmentMap>,
    /// What a camera ray sees that leaves, in place of a sky or an environment.
    miss: Option<DVec3>,
    shapes: Vec<ShapeLight>,
    emitters: Emitters,
    /// Between the sun, the environment, the shapes and the emitters, in this order.
    choice: Choice,
}

/// A direction towards a light that reaches a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSample {
    /// The unit direction.
    pub direction: DVec3,
    /// The distance to the light.
    pub distance: f64,
    /// The radiance over the density; of a light that has only one direction, the irradiance of a
    /// surface that faces it.
    pub arriving: DVec3,
    /// The density of the direction, or `None` for a light that has only one.
    pub density: Option<f64>,
}

/// A sampled light.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Towards {
    /// Light that arrives if nothing is in between. A light with a place has a number.
    Open(LightSample, Option<usize>),
    /// Light that arrives if the first hit is on the solid with this number. `arriving` is over
    /// the radiance there.
    Solid(LightSample, usize),
}

impl Towards {
    /// The direction.
    pub fn sample(&self) -> &LightSample {
        match self {
            Self::Open(sample, _) | Self::Solid(sample, _) => sample,
        }
    }
}

/// Light at the end of a ray.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Arriving {
    /// The radiance that sampling cannot find.
    pub unsampled: DVec3,
    /// The radiance of a sampled light, and the density with which its direction is sampled.
    pub sampled: DVec3,
    pub density: f64,
}

impl Lights {
    /// The lights of `scene`, which is in `bounds`, that an integrator sees. If there are none,
    /// the picture would be black, so there are a default sun and sky; the background is still
    /// what a camera ray sees that misses everything.
    #[must_use]
    pub fn of(scene: &Scene, bounds: &Bounds, integrator: Integrator) -> Self {
        let emitters = Emitters::new(scene);
        let has_place = !scene.lights.is_empty() || emitters.are_any();
        let unlit = scene.sun.is_none()
            && scene.sky.is_none()
            && scene.clear_sky.is_none()
            && scene.environment.is_none()
            && !(integrator == Integrator::Path && has_place);
        let (sun, sky) = if unlit {
            (Some(default_sun()), Some(default_sky()))
        } else {
            (scene.sun, scene.sky)
        };
        let radiance = sky.map(|sky| sky.color * sky.strength);
        let has_sky = scene.sky.is_some() || scene.clear_sky.is_some();
        let has_background = unlit || !(has_sky || scene.environment.is_some());
        let environment = EnvironmentMap::of(scene).filter(|map| map.power() > 0.0);
        let sun = sun.as_ref().and_then(SunLight::new);
        let mut shapes: Vec<_> = scene.lights.iter().filter_map(ShapeLight::new).collect();
        // A scene file has a list for each shape, so their order says nothing.
        shapes.sort_by_key(ShapeLight::rank);
        let radius = match bounds.is_empty() {
            true => 1.0,
            false => 0.5 * bounds.extent().length(),
        };
        let of_sun = sun.map(|sun| sun.irradiance * (PI * radius * radius));
        let across = 4.0 * PI * PI * radius * radius;
        let of_environment = environment.as_ref().map(|map| map.mean_radiance() * across);
        let of_shapes = shapes.iter().map(ShapeLight::power);
        let of_emitters = emitters.list.iter().map(emitters::Emitter::power);
        let powers = of_sun
            .into_iter()
            .chain(of_environment)
            .chain(of_shapes)
            .chain(of_emitters);
        let powers: Vec<f64> = powers.map(|power| power.element_sum()).collect();
        Self {
            sun,
            sky: radiance.filter(|&radiance| radiance != DVec3::ZERO),
            environment,
            miss: has_background.then(|| scene.background.color()),
            choice: Choice::new(&powers),
            shapes,
            emitters,
        }
    }

    /// The sun, where it gives light.
    #[must_use]
    pub fn sun(&self) -> Option<SunLight> {
        self.sun
    }

    /// The radiance of the sky or the environment in a unit direction; `None` if there is none.
    #[must_use]
    pub fn sky(&self, direction: DVec3) -> Option<DVec3> {
        let of_environment = self.environment.as_ref().map(|map| map.radiance(direction));
        of_environment.or(self.sky)
    }

    /// Whether there is a sky or an environment that gives light.
    #[must_use]
    pub fn has_sky(&self) -> bool {
        self.sky.is_some() || self.environment.is_some()
    }

    /// The radiance of a camera ray that hits nothing.
    #[must_use]
    pub fn miss(&self, direction: DVec3) -> DVec3 {
        let background = || self.sky(direction).unwrap_or_default();
        self.miss.unwrap_or_else(background)
    }

    /// Whether there are solids that are sampled as lights, so that a hit's path matters.
    pub(crate) fn has_emitters(&self) -> bool {
        !self.emitters.list.is_empty()
    }

    /// Whether solids emit light that are too many to be sampled.
    pub(crate) fn has_too_many_emitters(&self) -> bool {
        self.emitters.are_too_many
    }

    /// Whether some light is sampled.
    pub(crate) fn is_sampled(&self) -> bool {
        !self.choice.is_empty()
    }

    /// A direction from a point towards one of the sampled lights: `choice` is for the light, the
    /// other numbers for a place on it. `None` if it does not shine on the point.
    pub(crate) fn sample(&self, point: DVec3, choice: f64, numbers: (f64, f64)) -> Option<Towards> {
        let (chosen, probability) = self.choice.choose(choice);
        let scaled = |sample: LightSample| LightSample {
            arriving: sample.arriving / probability,
            density: sample.density.map(|density| density * probability),
            ..sample
        };
        let suns = usize::from(self.sun.is_some());
        let shapes = self.lights_at_infinity();
        match (&self.sun, &self.environment) {
            (Some(sun), _) if chosen == 0 => {
                return Some(Towards::Open(scaled(sun.sample(numbers)), None));
            }
            (_, Some(environment)) if chosen == suns => {
                let (direction, density) = environment.sample(numbers);
                let sample = LightSample {
                    direction,
                    distance: f64::INFINITY,
                    arriving: environment.radiance(direction) / density,
                    density: Some(density),
                };
                // Roundings may lead to where the environment is black.
                let is_lit = density > 0.0;
                return is_lit.then(|| Towards::Open(scaled(sample), None));
            }
            _ => {}
        }
        let number = chosen - shapes;
        if let Some(shape) = self.shapes.get(number) {
            let sample = shape.sample(point, numbers)?;
            return Some(Towards::Open(scaled(sample), Some(number)));
        }
        let number = number - self.shapes.len();
        let emitter = &self.emitters.list[number];
        let (direction, density) = emitter.sample(point, numbers)?;
        let sample = LightSample {
            direction,
            distance: f64::INFINITY,
            arriving: DVec3::splat(1.0 / density),
            density: Some(density),
        };
        Some(Towards::Solid(scaled(sample), number))
    }

    /// The number of lights at infinity that are sampled.
    fn lights_at_infinity(&self) -> usize {
        usize::from(self.sun.is_some()) + usize::from(self.environment.is_some())
    }

    /// The light from the sun in a unit direction, where nothing is.
    pub(crate) fn sunlight(&self, direction: DVec3) -> Arriving {
        match self.sun.filter(SunLight::has_extent) {
            Some(sun) => Arriving {
                unsampled: DVec3::ZERO,
                sampled: sun.radiance(direction),
                density: sun.density(direction) * self.choice.probability(0),
            },
            None => Arriving::default(),
        }
    }

    /// The light from the sky or the environment in a unit direction, where nothing is.
    pub(crate) fn skylight(&self, direction: DVec3) -> Arriving {
        match &self.environment {
            Some(environment) => {
                let chosen = usize::from(self.sun.is_some());
                Arriving {
                    unsampled: DVec3::ZERO,
                    sampled: environment.radiance(direction),
                    density: environment.density(direction) * self.choice.probability(chosen),
                }
            }
            None => Arriving {
                unsampled: self.sky.unwrap_or_default(),
                ..Arriving::default()
            },
        }
    }

    /// Whether a light with a place is between the start of a ray and the light that it is
    /// towards.
    pub(crate) fn are_between(&self, ray: &Ray, towards: &Towards) -> bool {
        let own = match towards {
            Towards::Open(_, number) => *number,
            // The end of the ray is not known yet.
            Towards::Solid(..) => return false,
        };
        let mut shapes = self.shapes.iter().enumerate();
        shapes.any(|(number, shape)| own != Some(number) && shape.distance(ray).is_some())
    }

    /// Whether a light with a place is on a ray.
    pub(crate) fn is_on(&self, ray: &Ray) -> bool {
        let mut shapes = self.shapes.iter();
        shapes.any(|shape| shape.distance(ray).is_some())
    }

    /// The light of the first light with a place on a ray up to `t_max`. The ray's direction was
    /// sampled at `point`.
    pub(crate) fn on(&self, ray: &Ray, t_max: f64, point: DVec3) -> Option<Arriving> {
        let mut nearest = Ray { t_max, ..*ray };
        let mut found = None;
        for (number, shape) in self.shapes.iter().enumerate() {
            if let Some(t) = shape.distance(&nearest) {
                nearest.t_max = t;
                found = Some((number, shape));
            }
        }
        let (number, shape) = found?;
        let to_light = ray.at(nearest.t_max) - point;
        let distance = to_light.length();
        let chosen = self.lights_at_infinity() + number;
        let density = shape.density(point, to_light / distance, distance);
        Some(Arriving {
            unsampled: DVec3::ZERO,
            sampled: shape.radiance(),
            density: density * self.choice.probability(chosen),
        })
    }

    /// The density with which the direction of a hit on an emitting solid is sampled at a point.
    pub(crate) fn density_of(&self, hit: &PartialHit, point: DVec3, direction: DVec3) -> f64 {
        self.emitters.number(hit).map_or(0.0, |number| {
            let chosen = self.lights_at_infinity() + self.shapes.len() + number;
            let density = self.emitters.list[number].density(point, direction);
            density * self.choice.probability(chosen)
        })
    }

    /// The number of the emitting solid of a hit.
    pub(crate) fn number_of(&self, hit: &PartialHit) -> Option<usize> {
        self.emitters.number(hit)
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
    use cyltrace::scene::Background;

    fn scene(sun: Option<Sun>, sky: Option<Sky>) -> Scene {
        Scene {
            sun,
            sky,
            background: Background::Color(DVec3::new(0.1, 0.2, 0.3)),
            ..Scene::new(Vec::new())
        }
    }

    fn lights_of(scene: &Scene) -> Lights {
        Lights::of(scene, &Bounds::EMPTY, Integrator::Path)
    }

    #[test]
    fn lights_none_stated_defaults_shine_and_background_shows() {
        let lights = lights_of(&scene(None, None));
        let sun = lights.sun().expect("a default sun");
        assert!((sun.direction.length() - 1.0).abs() < 1e-15);
        assert!(lights.has_sky());
        assert_eq!(lights.miss(DVec3::Z), DVec3::new(0.1, 0.2, 0.3));
    }

    #[test]
    fn lights_without_strength_left_out() {
        let mut sun = default_sun();
        sun.strength = 0.0;
        let lights = lights_of(&scene(Some(sun), None));
        assert!(lights.sun().is_none() && !lights.has_sky());
        assert_eq!(lights.miss(DVec3::Z), DVec3::new(0.1, 0.2, 0.3));
    }

    #[test]
    fn lights_sky_stated_seen_where_nothing_is() {
        let sky = Sky {
            color: DVec3::new(0.5, 0.25, 1.0),
            strength: 2.0,
        };
        let lights = lights_of(&scene(None, Some(sky)));
        assert!(lights.sun().is_none());
        assert_eq!(lights.miss(DVec3::Z), DVec3::new(1.0, 0.5, 2.0));
        assert_eq!(lights.sky(DVec3::Z), Some(lights.miss(DVec3::Z)));
    }
}
