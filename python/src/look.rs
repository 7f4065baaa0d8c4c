//! Materials, lights, cameras and integrators.

use cyltrace::scene::{
    Camera, Color, Frame, Integrator, Lens, Light, LightShape, Material, MaterialKind, Projection,
};
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

/// The viewpoint, which is automatic without a position and a point to look at.
pub fn frame(position: Option<[f64; 3]>, look_at: Option<[f64; 3]>, up: [f64; 3]) -> Frame {
    match (position, look_at) {
        (Some(position), Some(look_at)) => Frame::LookAt {
            position: position.into(),
            look_at: look_at.into(),
            up: up.into(),
        },
        _ => Frame::Auto,
    }
}

/// The camera. `lens` is the aperture and the distance of what is sharp.
pub fn camera(
    frame: Frame,
    orthographic: bool,
    fov_degrees: f64,
    height: Option<f64>,
    lens: Option<(f64, Option<f64>)>,
) -> Camera {
    let projection = match orthographic {
        true => Projection::Orthographic { height },
        false => Projection::Perspective { fov_degrees },
    };
    Camera {
        projection,
        frame,
        lens: lens.map(|(aperture, focus)| Lens { aperture, focus }),
    }
}

/// The integrator of a name.
///
/// # Errors
/// When there is none.
pub fn integrator_of(name: &str) -> PyResult<Integrator> {
    let mut all = Integrator::ALL.into_iter();
    all.find(|one| one.name() == name).ok_or_else(|| {
        let names = Integrator::ALL.map(Integrator::name).join(", ");
        value_error(format!(
            "integrator is \"{name}\": it must be one of {names}"
        ))
    })
}
