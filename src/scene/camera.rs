//! Reads the `[camera]` table of a scene file.

use glam::DVec3;

use super::defaults;
use super::description::{Camera, Frame, Projection};
use super::document::CameraKeys;
use super::error::SceneError;
use super::source::Source;
use super::values::{Triple, vector};
use crate::math::unit;
use crate::solid::Cylinder;

/// The least sine of the angle between `up` and the view: below it, rounding
/// errors would determine the orientation of the picture.
const LEAST_UP_SINE: f64 = 1e-6;

/// The camera of `[camera]`.
pub(super) fn camera(source: &Source, keys: &CameraKeys) -> Result<Camera, SceneError> {
    Ok(Camera {
        projection: projection(source, keys)?,
        frame: frame(source, keys)?,
    })
}

fn projection(source: &Source, keys: &CameraKeys) -> Result<Projection, SceneError> {
    let orthographic = match &keys.r#type {
        None => false,
        Some(word) => source.choose(
            "type",
            word,
            &[("perspective", false), ("orthographic", true)],
        )?,
    };
    match (orthographic, &keys.fov_degrees, &keys.height) {
        (true, Some(fov), _) => Err(source.error(
            fov.span(),
            "fov_degrees is for the perspective camera: an orthographic one has a height",
        )),
        (true, None, None) => Ok(Projection::Orthographic { height: None }),
        (true, None, Some(key)) => {
            let height = key.get_ref().0;
            if height > 0.0 && height <= Cylinder::GREATEST {
                return Ok(Projection::Orthographic {
                    height: Some(height),
                });
            }
            Err(source.error(
                key.span(),
                format!("height is {height}: it must be a positive number of scene units"),
            ))
        }
        (false, _, Some(height)) => Err(source.error_with_help(
            height.span(),
            "height is for the orthographic camera: a perspective one has fov_degrees",
            "the picture's height in pixels belongs to [film]",
        )),
        (false, None, None) => Ok(Projection::Perspective {
            fov_degrees: defaults::FOV_DEGREES,
        }),
        (false, Some(key), None) => {
            let fov_degrees = key.get_ref().0;
            if fov_degrees > 0.0 && fov_degrees < 180.0 {
                return Ok(Projection::Perspective { fov_degrees });
            }
            Err(source.error(
                key.span(),
                format!(
                    "fov_degrees is {fov_degrees}: it must be between 0 and 180, excluding both"
                ),
            ))
        }
    }
}

fn frame(source: &Source, keys: &CameraKeys) -> Result<Frame, SceneError> {
    if let Some(word) = &keys.frame {
        source.choose("frame", word, &[("auto", ())])?;
        if keys.position.is_some() || keys.look_at.is_some() || keys.up.is_some() {
            return Err(source.error(
                word.span(),
                "frame = \"auto\" excludes position, look_at and up: use one or the others",
            ));
        }
    }
    let (position, look_at) = match (&keys.position, &keys.look_at, &keys.up) {
        (Some(position), Some(look_at), _) => (position, look_at),
        (None, None, None) => return Ok(Frame::Auto),
        (Some(one), None, _) | (None, Some(one), _) | (None, None, Some(one)) => {
            return Err(source.error(
                one.span(),
                "the camera needs both position and look_at, or neither for frame = \"auto\"",
            ));
        }
    };
    for key in [position, look_at] {
        let size = vector(key).abs().max_element();
        if size > Cylinder::GREATEST {
            return Err(source.error(
                key.span(),
                format!(
                    "a coordinate has the size {size:.1e}: it must be at most {:.1e}",
                    Cylinder::GREATEST
                ),
            ));
        }
    }
    let view = unit(vector(look_at) - vector(position)).ok_or_else(|| {
        source.error(
            look_at.span(),
            "look_at is the same point as position: the two must differ",
        )
    })?;
    Ok(Frame::LookAt {
        position: vector(position),
        look_at: vector(look_at),
        up: up(source, keys.up.as_ref(), look_at, view)?,
    })
}

/// The upward direction, `z` by default.
fn up(
    source: &Source,
    key: Option<&Triple>,
    look_at: &Triple,
    view: DVec3,
) -> Result<DVec3, SceneError> {
    let up = key.map_or(DVec3::Z, vector);
    let place = key.unwrap_or(look_at).span();
    let Some(direction) = unit(up) else {
        return Err(source.error(place, "up is zero: it must be a direction, of any length"));
    };
    if view.cross(direction).length() < LEAST_UP_SINE {
        return Err(source.error_with_help(
            place,
            format!(
                "the camera looks along up, which is [{}, {}, {}]: up must not be parallel to the view",
                up.x, up.y, up.z
            ),
            "choose another up, such as up = [0, 1, 0] for a view along z",
        ));
    }
    Ok(up)
}
