//! How near a point comes to any surface of a scene.
//!
//! The surface of a solid that is composed of others is part of theirs, which count as
//! closed: what is far from those is far from it. What is near one of them may be near
//! it, or not.

use glam::{DAffine3, DVec3};

use super::nearness::{Frame, PlacedSolid, ROUNDING};
use crate::math::Bounds;
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::AnySolid;

/// All surfaces of a scene.
pub(super) struct Surfaces<'a> {
    scene: &'a Scene,
    /// The box of each prototype, as far as the root holds it.
    boxes: Vec<Option<Bounds>>,
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let mut surfaces = Self {
            scene,
            boxes: vec![None; scene.prototypes.len()],
        };
        surfaces.find_box(PrototypeIndex::ROOT);
        surfaces
    }

    fn find_box(&mut self, index: PrototypeIndex) -> Bounds {
        let number = index.0 as usize;
        if let Some(known) = self.boxes[number] {
            return known;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[number];
        let own = prototype.cylinders.iter();
        let own = own.fold(prototype.solids.bounds(), |all, one| {
            all.union(&one.cylinder().bounds())
        });
        let whole = prototype.placements.iter().fold(own, |all, placement| {
            let child = self.find_box(placement.of);
            if child.is_empty() {
                return all;
            }
            all.union(&child.transformed(&placement.parent_from_child))
        });
        self.boxes[number] = Some(whole);
        whole
    }

    /// Whether some surface may be within `distance` of a point.
    pub fn may_be_near(&self, point: DVec3, distance: f64) -> bool {
        self.may_be_near_in(
            PrototypeIndex::ROOT,
            &DAffine3::IDENTITY,
            point,
            1.001 * distance,
        )
    }

    fn may_be_near_in(
        &self,
        index: PrototypeIndex,
        world_from_here: &DAffine3,
        point: DVec3,
        distance: f64,
    ) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        let frame = Frame::new(world_from_here);
        let placed = |solid: AnySolid| PlacedSolid {
            solid,
            frame: &frame,
        };
        let is_near = prototype
            .singles()
            .any(|(_, solid)| !placed(solid).is_far(point, distance))
            || prototype
                .solids
                .compositions
                .iter()
                .flat_map(|record| record.solid.solids())
                .any(|leaf| !placed(leaf).is_far_from_closed(point, distance));
        is_near
            || prototype.placements.iter().any(|placement| {
                let world_from_child = *world_from_here * placement.parent_from_child;
                let Some(bounds) = self.boxes[placement.of.0 as usize] else {
                    return false;
                };
                let reach = distance + ROUNDING * point.length();
                !bounds.is_empty()
                    && bounds
                        .transformed(&world_from_child)
                        .grown(reach)
                        .meets(&Bounds::at(point))
                    && self.may_be_near_in(placement.of, &world_from_child, point, distance)
            })
    }
}
