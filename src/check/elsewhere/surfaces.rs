//! How near a point comes to any surface of a scene.
//!
//! The surface of a solid that is composed of others is part of theirs, which count as
//! closed: what is far from those is far from it. What is near one of them may be near
//! it, or not.

use glam::{DAffine3, DVec3};

use super::nearness::{Frame, PlacedSolid, ROUNDING};
use super::tolerance::{Allowance, farthest, least_radius};
use crate::math::Bounds;
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::AnySolid;

/// All surfaces of a scene.
pub(super) struct Surfaces<'a> {
    scene: &'a Scene,
    /// The box and the least radius of each prototype that the root contains.
    reached: Vec<Option<(Bounds, f64)>>,
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let mut surfaces = Self {
            scene,
            reached: vec![None; scene.prototypes.len()],
        };
        surfaces.reach(PrototypeIndex::ROOT);
        surfaces
    }

    /// At most the least radius of a solid in the world; infinite where there are none.
    pub fn least_radius(&self) -> f64 {
        self.root().1
    }

    /// The distance of the farthest corner of the scene's box from the origin.
    pub fn greatest_coordinate(&self) -> f64 {
        farthest(&self.root().0)
    }

    fn root(&self) -> (Bounds, f64) {
        self.reached[PrototypeIndex::ROOT.0 as usize].unwrap_or((Bounds::EMPTY, f64::INFINITY))
    }

    fn reach(&mut self, index: PrototypeIndex) -> (Bounds, f64) {
        let number = index.0 as usize;
        if let Some(known) = self.reached[number] {
            return known;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[number];
        let cylinders = prototype.cylinders.iter();
        let own = cylinders.fold(prototype.solids.bounds(), |all, one| {
            all.union(&one.cylinder().bounds())
        });
        // The numbers of a composition are those of its leaves, which may reach farther.
        let composed = prototype.solids.compositions.iter();
        let leaves: Vec<AnySolid> = composed.flat_map(|record| record.solid.solids()).collect();
        let own = leaves
            .iter()
            .fold(own, |all, leaf| all.union(&leaf.bounds()));
        let singles = prototype.singles().map(|(_, solid)| solid);
        let mut whole = (own, least_radius(singles.chain(leaves)));
        for placement in &prototype.placements {
            let (child, radius) = self.reach(placement.of);
            if !child.is_empty() {
                let map = &placement.parent_from_child;
                let radius = Frame::new(map).least_length(radius);
                whole = (whole.0.union(&child.transformed(map)), whole.1.min(radius));
            }
        }
        self.reached[number] = Some(whole);
        whole
    }

    /// Whether some surface may be within the allowance, for its solid, of a point.
    pub fn may_be_near(&self, point: DVec3, allowance: &Allowance) -> bool {
        self.may_be_near_in(PrototypeIndex::ROOT, &DAffine3::IDENTITY, point, allowance)
    }

    fn may_be_near_in(
        &self,
        index: PrototypeIndex,
        world_from_here: &DAffine3,
        point: DVec3,
        allowance: &Allowance,
    ) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        let frame = &Frame::new(world_from_here);
        // A little more than the allowance, for what is rounded on the way here.
        let distance = |bounds: &Bounds| {
            let placed = bounds.transformed(world_from_here);
            1.001 * allowance.of(farthest(&placed))
        };
        // At least that of every solid: most are farther than even this.
        let greatest = self.reached[index.0 as usize].map_or(0.0, |(whole, _)| distance(&whole));
        let is_near = |solid: AnySolid| {
            let placed = PlacedSolid { solid, frame };
            !placed.is_far(point, greatest) && !placed.is_far(point, distance(&solid.bounds()))
        };
        let is_near_closed = |solid: AnySolid| {
            let placed = PlacedSolid { solid, frame };
            !placed.is_far_from_closed(point, greatest)
                && !placed.is_far_from_closed(point, distance(&solid.bounds()))
        };
        let composed = prototype.solids.compositions.iter();
        let mut leaves = composed.flat_map(|record| record.solid.solids());
        prototype.singles().any(|(_, solid)| is_near(solid))
            || leaves.any(is_near_closed)
            || prototype.placements.iter().any(|placement| {
                let world_from_child = *world_from_here * placement.parent_from_child;
                let Some((bounds, _)) = self.reached[placement.of.0 as usize] else {
                    return false;
                };
                let placed = bounds.transformed(&world_from_child);
                let reach = 1.001 * allowance.of(farthest(&placed)) + ROUNDING * point.length();
                !bounds.is_empty()
                    && placed.grown(reach).meets(&Bounds::at(point))
                    && self.may_be_near_in(placement.of, &world_from_child, point, allowance)
            })
    }
}
