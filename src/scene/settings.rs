//! The picture's settings in a scene file: film, lights and what `render` computes.

use glam::DVec3;
use toml::Spanned;

use super::clear_sky::clear_sky;
use super::defaults;
use super::description::{Film, Integrator, RenderSettings, Sampler};
use super::document::{FilmKeys, RenderKeys, SkyKeys, SunKeys};
use super::error::SceneError;
use super::light::{ClearSky, Sky, Sun};
use super::light_values::{color, strength};
use super::limits::{GREATEST_PIXELS, GREATEST_SAMPLES};
use super::source::Source;
use super::values::{Number, Whole, vector};
use crate::math::{sin_cos_degrees, unit_or_same};

/// Most rays of a path. Russian roulette ends nearly all paths long before.
const GREATEST_DEPTH_OF_PATHS: u32 = 1 << 16;

/// Most pixels across and down.
const GREATEST_SIDE: u32 = 65_536;

const DEFAULT_SUN_COLOR: DVec3 = DVec3::new(1.0, 0.95, 0.9);
const DEFAULT_SUN_STRENGTH: f64 = 3.0;
const DEFAULT_SUN_DEGREES: (f64, f64) = (40.0, 135.0);
/// The greatest angle of the sun's disk.
const GREATEST_SUN_DEGREES: f64 = 90.0;
const DEFAULT_SKY: Sky = Sky {
    color: DVec3::new(0.5, 0.7, 1.0),
    strength: 1.0,
};

/// The lights of a scene.
pub(super) struct Lights {
    pub sun: Option<Sun>,
    pub sky: Option<Sky>,
    pub clear_sky: Option<ClearSky>,
}

/// The lights of the scene file. The renderer chooses lights for a scene without any.
pub(super) fn lights(
    source: &Source,
    sun: Option<&SunKeys>,
    sky_keys: Option<&SkyKeys>,
) -> Result<Lights, SceneError> {
    let clear_sky = sky_keys.map(|keys| clear_sky(source, keys));
    let clear_sky = clear_sky.transpose()?.flatten();
    let default = SunKeys::default();
    // A clear sky has a sun.
    let sun = sun.or(clear_sky.as_ref().map(|_| &default));
    let sun = sun.map(|keys| self::sun(source, keys, clear_sky.as_ref()));
    let sun = sun.transpose()?;
    if let (Some(sun), Some(_)) = (sun, clear_sky)
        && sun.direction.z < 0.0
        && let Some(model) = sky_keys.and_then(|keys| keys.model.as_ref())
    {
        return Err(source.error_with_help(
            model.span(),
            "the sun is below the horizon: the model of the clear sky is of the day",
            "state an elevation_degrees of [sun] from 0 to 90",
        ));
    }
    let sky = |keys: &SkyKeys| {
        Ok(Sky {
            color: color(source, keys.color.as_ref(), DEFAULT_SKY.color)?,
            strength: strength(source, keys.strength.as_ref(), DEFAULT_SKY.strength)?,
        })
    };
    Ok(Lights {
        sun,
        sky: sky_keys
            .filter(|_| clear_sky.is_none())
            .map(sky)
            .transpose()?,
        clear_sky,
    })
}

/// The sun; under a clear sky its color and strength follow from that by default.
fn sun(source: &Source, keys: &SunKeys, clear: Option<&ClearSky>) -> Result<Sun, SceneError> {
    let direction = match &keys.direction {
        Some(direction) => {
            if keys.elevation_degrees.is_some() || keys.azimuth_degrees.is_some() {
                return Err(source.error(
                    direction.span(),
                    "direction excludes elevation_degrees and azimuth_degrees: use one or the others",
                ));
            }
            unit_or_same(vector(direction)).ok_or_else(|| {
                source.error(
                    direction.span(),
                    "the sun's direction is zero: it must point towards the sun",
                )
            })?
        }
        None => {
            let elevation = number(keys.elevation_degrees.as_ref(), DEFAULT_SUN_DEGREES.0);
            if let Some(key) = &keys.elevation_degrees
                && elevation.abs() > 90.0
            {
                return Err(source.error(
                    key.span(),
                    format!("elevation_degrees is {elevation}: it must be between -90 and 90"),
                ));
            }
            let azimuth = number(keys.azimuth_degrees.as_ref(), DEFAULT_SUN_DEGREES.1);
            let (up, level) = sin_cos_degrees(elevation);
            let (y, x) = sin_cos_degrees(azimuth);
            DVec3::new(level * x, level * y, up)
        }
    };
    let (default_color, default_strength) = match clear {
        None => (DEFAULT_SUN_COLOR, DEFAULT_SUN_STRENGTH),
        Some(sky) => {
            let irradiance = sky.sun_irradiance(direction);
            let greatest = irradiance.max_element();
            (irradiance / greatest.max(f64::MIN_POSITIVE), greatest)
        }
    };
    Ok(Sun {
        direction,
        color: color(source, keys.color.as_ref(), default_color)?,
        strength: strength(source, keys.strength.as_ref(), default_strength)?,
        angle_degrees: angle_degrees(source, keys.angle_degrees.as_ref())?,
    })
}

/// The angle of the sun's disk.
fn angle_degrees(source: &Source, key: Option<&Spanned<Number>>) -> Result<f64, SceneError> {
    let angle = number(key, Sun::ANGLE_DEGREES);
    match key {
        Some(key) if !(0.0..=GREATEST_SUN_DEGREES).contains(&angle) => Err(source.error(
            key.span(),
            format!("angle_degrees is {angle}: it must be between 0 and {GREATEST_SUN_DEGREES}"),
        )),
        _ => Ok(angle),
    }
}

/// The picture's size.
pub(super) fn film(source: &Source, keys: &FilmKeys) -> Result<Film, SceneError> {
    let side = |name, key| count(source, name, key, GREATEST_SIDE);
    let width = side("width", keys.width.as_ref())?.unwrap_or(defaults::FILM.width);
    let height = side("height", keys.height.as_ref())?.unwrap_or(defaults::FILM.height);
    let key = keys.width.as_ref().or(keys.height.as_ref());
    if let Some(key) = key
        && u64::from(width) * u64::from(height) > GREATEST_PIXELS
    {
        return Err(source.error(
            key.span(),
            format!("the film is {width} x {height}: a picture can have at most {GREATEST_PIXELS} pixels (2^28)"),
        ));
    }
    Ok(Film { width, height })
}

/// The settings of `render`.
///
/// `default` is the integrator of a file that states none.
pub(super) fn render(
    source: &Source,
    keys: &RenderKeys,
    default: Integrator,
) -> Result<RenderSettings, SceneError> {
    Ok(RenderSettings {
        integrator: match &keys.integrator {
            Some(word) => {
                let names = Integrator::ALL.map(|integrator| (integrator.name(), integrator));
                source.choose("integrator", word, &names)?
            }
            None => default,
        },
        spp: count(source, "spp", keys.spp.as_ref(), GREATEST_SAMPLES)?
            .unwrap_or(defaults::RENDER.spp),
        sampler: match &keys.sampler {
            Some(word) => {
                let names = Sampler::ALL.map(|sampler| (sampler.name(), sampler));
                source.choose("sampler", word, &names)?
            }
            None => defaults::RENDER.sampler,
        },
        max_depth: count(
            source,
            "max_depth",
            keys.max_depth.as_ref(),
            GREATEST_DEPTH_OF_PATHS,
        )?
        .unwrap_or(defaults::RENDER.max_depth),
        ao_distance: distance(source, keys.ao_distance.as_ref())?,
    })
}

/// The distance beyond which surfaces do not occlude.
fn distance(source: &Source, key: Option<&Spanned<Number>>) -> Result<f64, SceneError> {
    let distance = number(key, defaults::RENDER.ao_distance);
    match key {
        Some(key) if distance <= 0.0 => Err(source.error(
            key.span(),
            format!("ao_distance is {distance}: it must be a positive length"),
        )),
        _ => Ok(distance),
    }
}

/// An optional whole number from 1 to `most`.
fn count(
    source: &Source,
    name: &str,
    key: Option<&Spanned<Whole>>,
    most: u32,
) -> Result<Option<u32>, SceneError> {
    let Some(key) = key else {
        return Ok(None);
    };
    let value = key.get_ref().0;
    match u32::try_from(value) {
        Ok(value) if (1..=most).contains(&value) => Ok(Some(value)),
        _ => Err(source.error(
            key.span(),
            format!("{name} is {value}: it must be between 1 and {most}"),
        )),
    }
}

fn number(key: Option<&Spanned<Number>>, default: f64) -> f64 {
    key.map_or(default, |key| key.get_ref().0)
}
