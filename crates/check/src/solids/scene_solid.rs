//! A solid of a scene, by its path or by its position in its prototype.

use glam::DAffine3;

use cyltrace::scene::{Prototype, PrototypeIndex, Scene};
use cyltrace::solid::{AnySolid, Composition};

/// A solid of a scene.
pub(crate) enum SceneSolid<'a> {
    Single(AnySolid),
    Composed(&'a Composition),
}

/// The placements of a solid, outermost first, and the solid itself.
///
/// # Panics
/// If the scene has no such solid.
pub(crate) fn find<'a>(
    scene: &'a Scene,
    instance: &[u32],
    primitive: u32,
) -> (Vec<&'a DAffine3>, SceneSolid<'a>) {
    let mut prototype = &scene.prototypes[PrototypeIndex::ROOT.0 as usize];
    let mut placements = Vec::new();
    for &number in instance {
        let placement = &prototype.placements[number as usize];
        placements.push(&placement.parent_from_child);
        prototype = &scene.prototypes[placement.of.0 as usize];
    }
    if let Some(solid) = prototype.single(primitive) {
        return (placements, SceneSolid::Single(solid));
    }
    let composed = &prototype.solids.compositions;
    let position = composed.binary_search_by_key(&primitive, |record| record.primitive);
    let position = position.expect("the hit's solid is in the scene");
    (placements, SceneSolid::Composed(&composed[position].solid))
}

/// The solid at a position in a prototype, compositions last, and its number.
pub(crate) fn nth(prototype: &Prototype, position: usize) -> (u32, SceneSolid<'_>) {
    let solids = &prototype.solids;
    if let Some((primitive, solid)) = solids.nth_simple(position) {
        return (primitive, SceneSolid::Single(solid));
    }
    let simple = solids.len() - solids.compositions.len();
    let record = &solids.compositions[position - simple];
    (record.primitive, SceneSolid::Composed(&record.solid))
}
