//! What a scene file states of the picture: camera, film, lights and materials.

use super::text::Text;
use super::{SaveError, check_names};
use crate::scene::background::Background;
use crate::scene::defaults;
use crate::scene::description::{Camera, Frame, Projection, Scene};
use crate::scene::light::{Light, LightShape};
use crate::scene::material_kinds::keys_of;
use crate::scene::settings::is_unit;

pub(super) fn state(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    match scene.background {
        Background::Color(color) => text.top().vector("background", color),
        Background::Transparent => text.top().text("background", Background::TRANSPARENT),
    }
    camera(text, &scene.camera);

    let mut film = text.table("[film]");
    film.whole("width", scene.film.width);
    film.whole("height", scene.film.height);

    let mut render = text.table("[render]");
    render.text("integrator", scene.render.integrator.name());
    render.whole("spp", scene.render.spp);
    render.whole("max_depth", scene.render.max_depth);
    if scene.render.ao_distance.is_finite() {
        render.number("ao_distance", scene.render.ao_distance);
    }

    lights(text, scene)?;
    materials(text, scene)?;
    text.check()
}

fn camera(text: &mut Text, camera: &Camera) {
    let mut entry = text.table("[camera]");
    match camera.projection {
        Projection::Perspective { fov_degrees } => {
            entry.text("type", "perspective");
            entry.number("fov_degrees", fov_degrees);
        }
        Projection::Orthographic { height } => {
            entry.text("type", "orthographic");
            if let Some(height) = height {
                entry.number("height", height);
            }
        }
        Projection::Panorama => entry.text("type", "panorama"),
    }
    if let Some(lens) = camera.lens {
        entry.number("aperture", lens.aperture);
        if let Some(focus) = lens.focus {
            entry.number("focus", focus);
        }
    }
    match camera.frame {
        Frame::Auto => entry.text("frame", "auto"),
        Frame::LookAt {
            position,
            look_at,
            up,
        } => {
            entry.vector("position", position);
            entry.vector("look_at", look_at);
            entry.vector("up", up);
        }
    }
}

fn lights(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    if let Some(sun) = scene.sun {
        if !is_unit(sun.direction) {
            return Err(SaveError::SunDirection {
                length: sun.direction.length(),
            });
        }
        let mut entry = text.table("[sun]");
        entry.vector("direction", sun.direction);
        entry.vector("color", sun.color);
        entry.number("strength", sun.strength);
        entry.number("angle_degrees", sun.angle_degrees);
    }
    if let Some(sky) = scene.sky {
        let mut entry = text.table("[sky]");
        entry.vector("color", sky.color);
        entry.number("strength", sky.strength);
    }
    for light in &scene.lights {
        placed_light(text, light);
    }
    Ok(())
}

fn placed_light(text: &mut Text, light: &Light) {
    let mut entry = match light.shape {
        LightShape::Point { position } => {
            let mut entry = text.table("[[point_light]]");
            entry.vector("position", position);
            entry
        }
        LightShape::Sphere { center, radius } => {
            let mut entry = text.table("[[sphere_light]]");
            entry.vector("center", center);
            entry.number("radius", radius);
            entry
        }
        LightShape::Rectangle { corner, edges } => {
            let mut entry = text.table("[[rectangle_light]]");
            entry.vector("corner", corner);
            entry.rows("edges", edges.map(|edge| edge.to_array()));
            entry
        }
    };
    entry.vector("color", light.color);
    entry.number("strength", light.strength);
}

fn materials(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    let [first, named @ ..] = scene.materials.as_slice() else {
        return Err(SaveError::DefaultMaterial);
    };
    if *first != defaults::material() {
        return Err(SaveError::DefaultMaterial);
    }
    check_names("material", named.iter().map(|one| one.name.as_str()))?;
    for material in named {
        let mut entry = text.table("[[material]]");
        entry.text("name", &material.name);
        entry.text("kind", material.kind.name());
        entry.vector("color", material.color.average());
        for (key, number) in keys_of(material.kind) {
            entry.number(key, number);
        }
    }
    Ok(())
}
