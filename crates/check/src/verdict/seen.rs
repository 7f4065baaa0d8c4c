//! The bounds of every solid's first hit from the crossings of its meshes.

use cyltrace::embree::Ray32;

use super::composed::composed_bounds;
use super::sandwich::{SolidBounds, sheet_bounds, solid_bounds};
use crate::bounding_meshes::crossings::LeafCrossings;
use crate::bounding_meshes::hull::wide;
use crate::bounding_meshes::meshes::{Meshes, Traversal};

/// A solid whose meshes a ray crosses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// The position in the window of the solid's only or first leaf.
    pub solid: u32,
    /// The bounds of its first hit.
    pub bounds: SolidBounds,
}

/// The buffers of a thread that judges answers.
#[derive(Default)]
pub(crate) struct Scratch {
    traversal: Traversal,
    /// The solids whose meshes the last ray crosses.
    pub seen: Vec<Seen>,
}

/// Finds the solids whose meshes Embree's traversal crosses up to a parameter, which may be
/// infinite.
pub(super) fn look(meshes: &Meshes, ray: &Ray32, up_to: f32, scratch: &mut Scratch) {
    let Scratch { traversal, seen } = scratch;
    seen.clear();
    meshes.for_each_solid(ray, up_to, traversal, |solid, leaves| {
        let bounds = bounds(meshes, solid, ray, leaves);
        seen.push(Seen { solid, bounds });
    });
}

/// The bounds from the crossings of the meshes of a solid's leaves.
pub(super) fn bounds(
    meshes: &Meshes,
    solid: u32,
    ray: &Ray32,
    leaves: &[LeafCrossings],
) -> SolidBounds {
    let t_min = f64::from(ray.t_near);
    if let Some(found) = meshes.window.composition_of(solid) {
        return composed_bounds(&found.composition, leaves, t_min);
    }
    let LeafCrossings { outer, inner } = &leaves[0];
    if meshes.is_disk(solid) {
        return sheet_bounds(outer, inner, t_min);
    }
    let ends = &meshes.open_ends[solid as usize];
    let (origin, direction) = (wide(ray.origin), wide(ray.direction));
    solid_bounds(outer, inner, t_min, |t| {
        ends.are_passed(origin, direction, t)
    })
}
