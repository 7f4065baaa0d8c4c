//! Visits every placed solid of a scene.

use glam::{DAffine3, DVec3};

use super::MeshFileError;
use crate::scene::{Prototype, PrototypeIndex, Scene};
use crate::solid::AnySolid;
use crate::solid::tessellation::{Fit, mesh_of};

/// A prototype with solids of its own, in one of its placements in the scene.
pub(super) struct Instance<'a> {
    /// The placed prototype.
    pub prototype: &'a Prototype,
    /// The placements from the root to it, outermost first.
    pub path: &'a [u32],
    /// The maps of these placements.
    parent_from_child: &'a [DAffine3],
    /// Whether the placements together mirror the prototype.
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

    /// Orders the corners of a triangle counter-clockwise in the world, seen from outside.
    pub fn outward(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.is_mirrored {
            [a, c, b]
        } else {
            [a, b, c]
        }
    }
}

/// Calls `action` with every placed prototype that has solids: the root first, then
/// each placement, followed by the placements inside it.
pub(super) fn instances(
    scene: &Scene,
    action: &mut dyn FnMut(&Instance) -> Result<(), MeshFileError>,
) -> Result<(), MeshFileError> {
    let mut walk = Walk {
        path: Vec::new(),
        parent_from_child: Vec::new(),
    };
    walk.visit(scene, PrototypeIndex::ROOT, false, action)
}

/// The placements from the root to the current prototype.
struct Walk {
    path: Vec<u32>,
    parent_from_child: Vec<DAffine3>,
}

impl Walk {
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
            // The determinants of valid scenes are far above their rounding errors.
            let mirrors = map.matrix3.determinant() < 0.0;
            self.visit(scene, placement.of, is_mirrored != mirrors, action)?;
            self.path.pop();
            self.parent_from_child.pop();
        }
        Ok(())
    }
}
