//! Solids by themselves, which set operations combine.

use cyltrace::math::Orientation;
use cyltrace::solid::{AnySolid, Caps, Composition, Cone, Cuboid, Cylinder, RoundedCone, Sphere};
use glam::{DQuat, DVec3};
use pyo3::prelude::*;

use crate::arrays::value_error;

/// A closed solid, or what set operations make of some. Operations of one kind on each
/// other's results are one operation, so that chains of them are not deep.
#[pyclass(frozen, name = "Solid", module = "cyltrace._core", from_py_object)]
#[derive(Clone)]
pub struct PySolid(pub Composition);

fn solid<S: Into<AnySolid>, E: std::fmt::Display>(solid: Result<S, E>) -> PyResult<PySolid> {
    let solid = solid.map_err(|error| value_error(error.to_string()))?;
    Ok(PySolid(Composition::Solid(solid.into())))
}

/// The orientation of a quaternion of any length.
///
/// # Errors
/// When it is zero or not finite.
pub fn orientation(quaternion: DQuat) -> Result<Orientation, String> {
    let length = quaternion.length();
    if !(length.is_finite() && length > 0.0) {
        let [x, y, z, w] = quaternion.to_array();
        return Err(format!(
            "quaternion is ({x:?}, {y:?}, {z:?}, {w:?}): it must be finite and not zero"
        ));
    }
    let axis = DVec3::new(quaternion.x, quaternion.y, quaternion.z);
    if axis == DVec3::ZERO {
        return Ok(Orientation::IDENTITY);
    }
    let degrees = 2.0 * axis.length().atan2(quaternion.w).to_degrees();
    Ok(Orientation::IDENTITY.rotated(axis, degrees))
}

#[pymethods]
impl PySolid {
    #[staticmethod]
    fn cylinder(p0: [f64; 3], p1: [f64; 3], radius: f64) -> PyResult<Self> {
        solid(Cylinder::new(p0.into(), p1.into(), radius, Caps::Both))
    }

    #[staticmethod]
    fn cone(p0: [f64; 3], p1: [f64; 3], radius0: f64, radius1: f64) -> PyResult<Self> {
        solid(Cone::new(
            p0.into(),
            p1.into(),
            radius0,
            radius1,
            Caps::Both,
        ))
    }

    #[staticmethod]
    fn rounded_cone(p0: [f64; 3], p1: [f64; 3], radius0: f64, radius1: f64) -> PyResult<Self> {
        solid(RoundedCone::new(p0.into(), p1.into(), radius0, radius1))
    }

    #[staticmethod]
    fn sphere(center: [f64; 3], radius: f64) -> PyResult<Self> {
        solid(Sphere::new(center.into(), radius))
    }

    #[staticmethod]
    fn cuboid(center: [f64; 3], half_widths: [f64; 3], quaternion: [f64; 4]) -> PyResult<Self> {
        let orientation = orientation(DQuat::from_array(quaternion)).map_err(value_error)?;
        solid(Cuboid::new(center.into(), half_widths.into(), orientation))
    }

    #[staticmethod]
    fn union(parts: Vec<PySolid>) -> Self {
        let flat = parts.into_iter().flat_map(|part| match part.0 {
            Composition::Union(parts) => parts,
            part => vec![part],
        });
        Self(Composition::Union(flat.collect()))
    }

    #[staticmethod]
    fn intersection(parts: Vec<PySolid>) -> Self {
        let flat = parts.into_iter().flat_map(|part| match part.0 {
            Composition::Intersection(parts) => parts,
            part => vec![part],
        });
        Self(Composition::Intersection(flat.collect()))
    }

    #[staticmethod]
    fn difference(parts: Vec<PySolid>) -> Self {
        let flat = parts.into_iter().enumerate();
        let flat = flat.flat_map(|(position, part)| match part.0 {
            // `(a - b) - c` is `a - b - c`.
            Composition::Difference(parts) if position == 0 => parts,
            part => vec![part],
        });
        Self(Composition::Difference(flat.collect()))
    }

    /// Levels of operations within each other.
    fn depth(&self) -> usize {
        fn depth(composition: &Composition) -> usize {
            match composition {
                Composition::Solid(_) => 0,
                Composition::Union(parts)
                | Composition::Intersection(parts)
                | Composition::Difference(parts) => 1 + parts.iter().map(depth).max().unwrap_or(0),
            }
        }
        depth(&self.0)
    }

    fn contains(&self, point: [f64; 3]) -> bool {
        self.0.contains(point.into())
    }

    fn __repr__(&self) -> String {
        let kind = match &self.0 {
            Composition::Solid(solid) => solid.kind(),
            composed => composed.kind(),
        };
        match self.0.solids().len() {
            1 => format!("<cyltrace.Solid: {}>", kind.name()),
            count => format!("<cyltrace.Solid: {} of {count} solids>", kind.name()),
        }
    }
}
