//! Materials and lights.

use cyltrace::scene::{Color, Light, LightShape, Material, MaterialKind};
use pyo3::prelude::*;

use crate::arrays::value_error;

/// A material of a kind with the numbers that are stated: roughness, index of refraction and
/// strength.
///
/// # Errors
/// If there is no such kind, or it does not have a number, or not of that value.
pub fn material(
    name: String,
    color: [f64; 3],
    kind: &str,
    numbers: [Option<f64>; 3],
) -> PyResult<Material> {
    let of_name = MaterialKind::named(kind).ok_or_else(|| {
        let names = MaterialKind::NAMES.join(", ");
        value_error(format!("kind is \"{kind}\": it must be one of {names}"))
    })?;
    let kind = of_name.with_numbers(numbers);
    Ok(Material {
        name,
        color: Color::Constant(color.into()),
        kind: kind.map_err(|error| value_error(error.to_string()))?,
    })
}

/// A light with a place: a rectangle if there are edges, a sphere if there is a radius, or a
/// point.
pub fn light(
    place: [f64; 3],
    radius: Option<f64>,
    edges: Option<[[f64; 3]; 2]>,
    color: [f64; 3],
    strength: f64,
) -> Light {
    let place = place.into();
    let shape = match (edges, radius) {
        (Some(edges), _) => LightShape::Rectangle {
            corner: place,
            edges: edges.map(Into::into),
        },
        (None, Some(radius)) => LightShape::Sphere {
            center: place,
            radius,
        },
        (None, None) => LightShape::Point { position: place },
    };
    Light {
        shape,
        color: color.into(),
        strength,
    }
}
