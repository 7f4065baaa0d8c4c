//! The color, the strength and the place of a light in a scene file.

use glam::DVec3;
use toml::Spanned;

use super::error::SceneError;
use super::source::Source;
use super::values::{Number, Triple, vector};
use crate::solid::Cylinder;

/// The linear RGB of a light, which must not be negative.
pub(super) fn color(
    source: &Source,
    key: Option<&Triple>,
    default: DVec3,
) -> Result<DVec3, SceneError> {
    let Some(key) = key else {
        return Ok(default);
    };
    let color = vector(key);
    if color.cmplt(DVec3::ZERO).any() {
        return Err(source.error(
            key.span(),
            format!(
                "the color is [{}, {}, {}]: a light's components must not be negative",
                color.x, color.y, color.z
            ),
        ));
    }
    Ok(color)
}

/// The factor on a light's color, which must not be negative.
pub(super) fn strength(
    source: &Source,
    key: Option<&Spanned<Number>>,
    default: f64,
) -> Result<f64, SceneError> {
    let strength = key.map_or(default, |key| key.get_ref().0);
    match key {
        Some(key) if strength < 0.0 => Err(source.error(
            key.span(),
            format!("strength is {strength}: it must not be negative"),
        )),
        _ => Ok(strength),
    }
}

/// A point whose coordinates are not too large.
pub(super) fn point(source: &Source, name: &str, key: &Triple) -> Result<DVec3, SceneError> {
    let point = vector(key);
    let size = point.abs().max_element();
    if size <= Cylinder::GREATEST {
        return Ok(point);
    }
    let greatest = Cylinder::GREATEST;
    let message = format!(
        "{name} has a coordinate of the size {size:.1e}: it must be at most {greatest:.1e}"
    );
    Err(source.error(key.span(), message))
}
