//! The lights with a place in a scene file: points, spheres and rectangles.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;

use super::document::{PointLightKeys, RectangleLightKeys, SphereLightKeys};
use super::error::SceneError;
use super::light::{Light, LightShape};
use super::light_values::{color, strength};
use super::point::point;
use super::source::Source;
use super::values::{Keys, List, Number, Triple, vector};
use crate::math::unit;
use crate::solid::Cylinder;

/// The least sine of the angle between the edges of a rectangle: below it, rounding errors
/// would determine its normal.
const LEAST_SINE: f64 = 1e-6;

const DEFAULT_COLOR: DVec3 = DVec3::ONE;
const DEFAULT_STRENGTH: f64 = 1.0;

/// Two edges with their places.
type Edges = Spanned<List<Triple, 2>>;

/// The lights of the three lists, one list after the other.
pub(super) fn placed_lights(
    source: &Source,
    points: &[Keys<PointLightKeys>],
    spheres: &[Keys<SphereLightKeys>],
    rectangles: &[Keys<RectangleLightKeys>],
) -> Result<Vec<Light>, SceneError> {
    let light = |shape, color_key: &Option<Triple>, strength_key: &Option<Spanned<Number>>| {
        Ok(Light {
            shape,
            color: color(source, color_key.as_ref(), DEFAULT_COLOR)?,
            strength: strength(source, strength_key.as_ref(), DEFAULT_STRENGTH)?,
        })
    };
    let mut lights = Vec::with_capacity(points.len() + spheres.len() + rectangles.len());
    for Keys(keys) in points {
        let position = point(source, "position", &keys.position)?;
        let shape = LightShape::Point { position };
        lights.push(light(shape, &keys.color, &keys.strength)?);
    }
    for Keys(keys) in spheres {
        let shape = LightShape::Sphere {
            center: point(source, "center", &keys.center)?,
            radius: length(
                source,
                "radius",
                keys.radius.span(),
                keys.radius.get_ref().0,
            )?,
        };
        lights.push(light(shape, &keys.color, &keys.strength)?);
    }
    for Keys(keys) in rectangles {
        let shape = LightShape::Rectangle {
            corner: point(source, "corner", &keys.corner)?,
            edges: edges(source, &keys.edges)?,
        };
        lights.push(light(shape, &keys.color, &keys.strength)?);
    }
    Ok(lights)
}

/// A length in the range of the sizes of solids.
fn length(
    source: &Source,
    name: &str,
    place: Range<usize>,
    length: f64,
) -> Result<f64, SceneError> {
    if (Cylinder::LEAST..=Cylinder::GREATEST).contains(&length) {
        return Ok(length);
    }
    let message = match length > 0.0 {
        false => format!("{name} is {length}: it must be positive"),
        true => format!(
            "{name} is {length:e}: it must be between {:.1e} and {:.1e}",
            Cylinder::LEAST,
            Cylinder::GREATEST
        ),
    };
    Err(source.error(place, message))
}

/// The edges of a rectangle, which span a plane.
fn edges(source: &Source, key: &Edges) -> Result<[DVec3; 2], SceneError> {
    let List(edges) = key.get_ref();
    let mut directions = [DVec3::ZERO; 2];
    for (edge, direction) in edges.iter().zip(&mut directions) {
        let size = vector(edge).abs().max_element();
        length(source, "the length of an edge", edge.span(), size)?;
        *direction = unit(vector(edge)).unwrap_or_default();
    }
    let [first, second] = directions;
    if first.cross(second).length() < LEAST_SINE {
        return Err(source.error_with_help(
            key.span(),
            "the edges are parallel: they must span the rectangle",
            "edges = [[2, 0, 0], [0, 1, 0]] is 2 wide along x and 1 along y",
        ));
    }
    Ok([vector(&edges[0]), vector(&edges[1])])
}
