//! Visits every solid of a scene, where it is placed.

use glam::{DAffine3, DVec3};

use super::MeshFileError;
use crate::scene::{Prototype, PrototypeIndex, Scene};
use crate::solid::AnySolid;
use crate::solid::tessellation::{Fit, mesh_of};

/// A prototype with solids of its own, at one of the places that it has in the
/// scene.
pub(super) struct Instance<'a> {
    /// What is placed.
    pub prototype: &'a Prototype,
    /// The placements from the root to it, outermost first.
    pub path: &'a [u32],
    /// The same as maps.
    parent_from_child: &'a [DAffine3],
    /// Whether left and right are exchanged.
    is_mirrored: bool,
}

impl Instance<'_> {
    /// The vertices of a solid's mesh in the world.
    pub fn vertices(&self, solid: &AnySolid, segments: u32, fit: Fit) -> Vec<DVec3> {
        let mut vertices = mesh_of(solid, segments, fit).vertices;
        for map in self.parent_from_child.iter().rev() {
            for vertex in &mut vertices {
                *vertex = map.transform_point3(*vertex);
            }
        }
        vertices
    }

    /// The corners of a triangle such that its outward side is
    /// counter-clockwise in the world.
    pub fn outward(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.is_mirrored {
            [a, c, b]
        } else {
            [a, b, c]
        }
    }
}

/// Calls `action` with every placed prototype that has solids: the root first,
/// then each placement with what it places.
pub(super) fn instances(
    scene: &Scene,
    action: &mut dyn FnMut(&Instance) -> Result<(), MeshFileError>,
) -> Result<(), MeshFileError> {
    let mut way = Way {
        path: Vec::new(),
        parent_from_child: Vec::new(),
    };
    way.visit(scene, PrototypeIndex::ROOT, false, action)
}

/// The placements on the way to a prototype.
struct Way {
    path: Vec<u32>,
    parent_from_child: Vec<DAffine3>,
}

impl Way {
    fn visit(
        &mut self,
        scene: &Scene,
        index: PrototypeIndex,
        is_mirrored: bool,
        action: &mut dyn FnMut(&Instance) -> Result<(), MeshFileError>,
    ) -> Result<(), MeshFileError> {
        let prototype = &scene.prototypes[index.0 as usize];
        if !prototype.solids.is_empty() {
            action(&Instance {
                prototype,
                path: &self.path,
                parent_from_child: &self.parent_from_child,
                is_mirrored,
            })?;
        }
        for (number, placement) in prototype.placements.iter().enumerate() {
            let map = placement.parent_from_child;
            self.path.push(number as u32);
            self.parent_from_child.push(map);
            // Scenes keep determinants far above the rounding of this one.
            let mirrors = map.matrix3.determinant() < 0.0;
            self.visit(scene, placement.of, is_mirrored != mirrors, action)?;
            self.path.pop();
            self.parent_from_child.pop();
        }
        Ok(())
    }
}
