//! What a scene file states of the picture: camera, film, lights and materials.

use std::io::Write;

use super::drawings;
use super::tables::Tables;
use super::text::{Entry, Text};
use super::{SaveError, check_names, check_unit};
use crate::scene::background::Background;
use crate::scene::defaults;
use crate::scene::description::{Camera, Frame, Projection, Scene};
use crate::scene::light::{Light, LightShape};
use crate::scene::material::Color;
use crate::scene::material_kinds::keys_of;

pub(super) fn state<W: Write>(
    text: &mut Text,
    tables: &mut Tables<W>,
    scene: &Scene,
) -> Result<(), SaveError> {
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
    render.text("sampler", scene.render.sampler.name());
    render.whole("max_depth", scene.render.max_depth);
    if scene.render.ao_distance.is_finite() {
        render.number("ao_distance", scene.render.ao_distance);
    }

    lights(text, scene)?;
    materials(text, tables, scene)?;
    drawings::state(text, scene)?;
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
        check_unit("the sun's direction", sun.direction)?;
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
    if let Some(sky) = scene.clear_sky {
        let mut entry = text.table("[sky]");
        entry.text("model", "clear");
        entry.number("turbidity", sky.turbidity);
        entry.vector("ground", sky.ground);
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

fn materials<W: Write>(
    text: &mut Text,
    tables: &mut Tables<W>,
    scene: &Scene,
) -> Result<(), SaveError> {
    let [first, named @ ..] = scene.materials.as_slice() else {
        return Err(SaveError::DefaultMaterial);
    };
    if *first != defaults::material() {
        return Err(SaveError::DefaultMaterial);
    }
    check_names("material", named.iter().map(|one| one.name.as_str()))?;
    for material in named {
        let image = match &material.color {
            Color::Image(image) => Some(tables.image(image)?),
            _ => None,
        };
        let mut entry = text.table("[[material]]");
        entry.text("name", &material.name);
        entry.text("kind", material.kind.name());
        color(&mut entry, &material.color, image.as_deref());
        for (key, number) in keys_of(material.kind) {
            entry.number(key, number);
        }
    }
    Ok(())
}

/// The color of a material, which may be an image of a name.
fn color(entry: &mut Entry, color: &Color, image: Option<&str>) {
    match color {
        Color::Constant(color) => entry.vector("color", *color),
        Color::Checker(checker) => entry.inline("color", |entry| {
            entry.vectors("checker", &checker.colors);
            entry.verbatim("count", &format!("{:?}", checker.count));
        }),
        Color::Stripes(stripes) => entry.inline("color", |entry| {
            entry.vectors("stripes", &stripes.colors);
            entry.whole("count", stripes.count);
            entry.text("along", stripes.along.name());
        }),
        Color::Image(_) => entry.inline("color", |entry| {
            entry.text("image", image.unwrap_or_default());
        }),
        Color::Data(data) => entry.inline("color", |entry| {
            entry.text("column", &data.column);
            entry.text("map", data.map.name());
            if !data.map.has_categories() {
                let [first, last] = data.range;
                entry.verbatim("range", &format!("[{first:?}, {last:?}]"));
            }
            if !data.labels.is_empty() {
                let labels = toml::Value::from(data.labels.clone());
                entry.verbatim("labels", &labels.to_string());
            }
            entry.vector("missing", data.missing);
        }),
    }
}
