//! The counts and bounds of a scene, without tracing it.

use rayon::prelude::*;

use super::{PlacedCount, PrototypeIndex, Scene};
use crate::math::Bounds;
use crate::solid::SolidCounts;

/// The counts and bounds of a scene. Except in `prototypes`, unused prototypes do not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneStats {
    /// Named prototypes, without the root, used or not.
    pub prototypes: u64,
    /// Named prototypes that the root places, directly or through others.
    pub prototypes_used: u64,
    /// Stored placements: those within a prototype count once.
    pub placements: u64,
    /// Stored solids: those within a prototype count once.
    pub unique: SolidCounts,
    /// Placements, where those within a prototype count each time it is placed.
    pub instances: u128,
    /// Solids, where those within a prototype count each time it is placed.
    pub instanced: SolidCounts,
    /// Levels of placements: 0 if the root places nothing.
    pub depth: u32,
    /// A box around everything. It may be larger than the smallest such box, because
    /// the box of a placement is the box of a transformed box.
    pub bounds: Bounds,
}

/// The part of the counts that a prototype adds each time it is placed.
#[derive(Clone, Copy)]
struct Whole {
    instances: u128,
    solids: SolidCounts,
    depth: u32,
    bounds: Bounds,
}

/// The least number of placements that is worth a thread.
const LEAST_SHARE: usize = 4096;

impl Scene {
    /// Counts the contents of the scene. Time and memory grow with the stored
    /// contents, not with the placed ones. Runs on the caller's rayon pool.
    #[must_use]
    pub fn scene_stats(&self) -> SceneStats {
        let mut wholes = vec![None; self.prototypes.len()];
        let root = self.whole(PrototypeIndex::ROOT, &mut wholes);
        let used = || {
            let all = wholes.iter().zip(&self.prototypes);
            all.filter_map(|(whole, prototype)| whole.map(|_| prototype))
        };
        SceneStats {
            prototypes: self.prototypes.len() as u64 - 1,
            prototypes_used: used().count() as u64 - 1,
            placements: used().map(|p| p.placements.len() as u64).sum(),
            unique: used().fold(SolidCounts::default(), |sum, prototype| {
                sum.plus(&prototype.solids.counts())
            }),
            instances: root.instances,
            instanced: root.solids,
            depth: root.depth,
            bounds: root.bounds,
        }
    }

    fn whole(&self, index: PrototypeIndex, wholes: &mut [Option<Whole>]) -> Whole {
        if let Some(whole) = wholes[index.0 as usize] {
            return whole;
        }
        let prototype = &self.prototypes[index.0 as usize];
        let mut whole = Whole {
            instances: 0,
            solids: prototype.solids.counts(),
            depth: 0,
            bounds: prototype.solids.bounds(),
        };
        for PlacedCount { of, count } in prototype.placed() {
            let child = self.whole(of, wholes);
            let instances = child.instances.saturating_add(1);
            let more = instances.saturating_mul(count.into());
            whole.instances = whole.instances.saturating_add(more);
            whole.solids = whole.solids.plus(&child.solids.times(count.into()));
            whole.depth = whole.depth.max(child.depth + 1);
        }
        let placements = prototype.placements.par_iter().with_min_len(LEAST_SHARE);
        let boxes = placements.filter_map(|placement| {
            let child = wholes[placement.of.0 as usize]?;
            Some(child.bounds.transformed(&placement.parent_from_child))
        });
        let placed = boxes.reduce(|| Bounds::EMPTY, |sum, bounds| sum.union(&bounds));
        whole.bounds = whole.bounds.union(&placed);
        wholes[index.0 as usize] = Some(whole);
        whole
    }
}
