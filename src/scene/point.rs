//! The points of lights and clip planes in a scene file.

use glam::DVec3;

use super::error::SceneError;
use super::source::Source;
use super::values::{Triple, vector};
use crate::solid::Cylinder;

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
