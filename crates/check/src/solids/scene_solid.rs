//! The solid of a hit, by its path in the scene.

use glam::DAffine3;

use cyltrace::scene::{PrototypeIndex, Scene};
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
