//! Reads the `[camera]` table of a scene file.

use glam::DVec3;
use toml::Spanned;

use super::defaults;
use super::description::{Camera, Frame, Lens, Projection};
use super::document::CameraKeys;
use super::error::SceneError;
use super::source::Source;
use super::values::{Number, Triple, vector};
use crate::math::unit;
use crate::solid::Cylinder;

/// The least sine of the angle between `up` and the view: below it, rounding
/// errors would determine the orientation of the picture.
const LEAST_UP_SINE: f64 = 1e-6;

/// The camera of `[camera]`.
pub(super) fn camera(source: &Source, keys: &CameraKeys) -> Result<Camera, SceneError> {
    let projection = projection(source, keys)?;
    Ok(Camera {
        projection,
        frame: frame(source, keys)?,
        lens: lens(source, keys, projection)?,
    })
}

fn projection(source: &Source, keys: &CameraKeys) -> Result<Projection, SceneError> {
    let perspective = Projection::Perspective {
        fov_degrees: defaults::FOV_DEGREES,
    };
    let types = [
        ("perspective", perspective),
        ("orthographic", Projection::Orthographic { height: None }),
        ("panorama", Projection::Panorama),
    ];
    let mut projection = match &keys.r#type {
        None => perspective,
        Some(word) => source.choose("type", word, &types)?,
    };
    if let Some(key) = &keys.fov_degrees {
        let Projection::Perspective { fov_degrees } = &mut projection else {
            let message = match projection {
                Projection::Panorama => {
                    "fov_degrees is for the perspective camera: a panorama shows all directions"
                }
                _ => "fov_degrees is for the perspective camera: an orthographic one has a height",
            };
            return Err(source.error(key.span(), message));
        };
        *fov_degrees = key.get_ref().0;
        if !(*fov_degrees > 0.0 && *fov_degrees < 180.0) {
            return Err(source.error(
                key.span(),
                format!(
                    "fov_degrees is {fov_degrees}: it must be between 0 and 180, excluding both"
                ),
            ));
        }
    }
    if let Some(key) = &keys.height {
        let Projection::Orthographic { height } = &mut projection else {
            return Err(source.error_with_help(
                key.span(),
                match projection {
                    Projection::Panorama => {
                        "height is for the orthographic camera: a panorama shows all directions"
                    }
                    _ => "height is for the orthographic camera: a perspective one has fov_degrees",
                },
                "the picture's height in pixels belongs to [film]",
            ));
        };
        let stated = key.get_ref().0;
        if !(stated > 0.0 && stated <= Cylinder::GREATEST) {
            return Err(source.error(
                key.span(),
                format!("height is {stated}: it must be a positive number of scene units"),
            ));
        }
        *height = Some(stated);
    }
    Ok(projection)
}

/// The lens, if its diameter is not zero.
fn lens(
    source: &Source,
    keys: &CameraKeys,
    projection: Projection,
) -> Result<Option<Lens>, SceneError> {
    let Some(key) = keys.aperture.as_ref().or(keys.focus.as_ref()) else {
        return Ok(None);
    };
    if projection == Projection::Panorama {
        return Err(source.error(
            key.span(),
            "aperture and focus are for the perspective and the orthographic camera: a panorama has no lens",
        ));
    }
    let number = |key: &Spanned<Number>| key.get_ref().0;
    let aperture = keys.aperture.as_ref().map_or(0.0, number);
    if !(0.0..=Cylinder::GREATEST).contains(&aperture) {
        return Err(source.error(
            key.span(),
            format!("aperture is {aperture}: it must be the diameter of the lens in scene units, or 0 for no lens"),
        ));
    }
    let focus = keys.focus.as_ref().map(number);
    if let Some(key) = &keys.focus
        && !(Cylinder::LEAST..=Cylinder::GREATEST).contains(&number(key))
    {
        return Err(source.error(
            key.span(),
            format!(
                "focus is {}: it must be a distance, a positive number of scene units",
                number(key)
            ),
        ));
    }
    Ok((aperture > 0.0).then_some(Lens { aperture, focus }))
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
