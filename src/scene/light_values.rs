//! The color and the strength of a light in a scene file.

use glam::DVec3;
use toml::Spanned;

use super::error::SceneError;
use super::source::Source;
use super::values::{Number, Triple, vector};

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
