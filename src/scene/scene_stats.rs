//! What a scene holds, counted without tracing it.

use rayon::prelude::*;

use super::{Placement, PrototypeIndex, Scene};
use crate::math::Bounds;

/// The counts of a scene. Prototypes that nobody places are left out, but for
/// `prototypes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneStats {
    /// Named prototypes, the root not counted, used or not.
    pub prototypes: u64,
    /// Those of them that the root places, itself or through others.
    pub prototypes_used: u64,
    /// Placements as they are stored: those within a prototype count once.
    pub placements: u64,
    /// Cylinders as they are stored.
    pub cylinders_unique: u64,
    /// Solids of other kinds as they are stored.
    pub other_solids_unique: u64,
    /// Placements with those within placed prototypes counted each time.
    pub instances: u128,
    /// Cylinders with every placement counted.
    pub cylinders_instanced: u128,
    /// Solids of other kinds with every placement counted.
    pub other_solids_instanced: u128,
    /// Levels of placements: 0 when the root places nothing.
    pub depth: u32,
    /// A box around everything. Boxes of placements are boxes of transformed
    /// boxes, so it may be larger than the least one.
    pub bounds: Bounds,
}

/// The part of the counts that a prototype adds each time it is placed.
#[derive(Clone, Copy)]
struct Whole {
    instances: u128,
    cylinders: u128,
    other_solids: u128,
    depth: u32,
    bounds: Bounds,
}

/// Fewer cylinders or placements than these are not worth a thread's while.
const LEAST_SHARE: usize = 4096;

impl Whole {
    const NOTHING: Self = Self {
        instances: 0,
        cylinders: 0,
        other_solids: 0,
        depth: 0,
        bounds: Bounds::EMPTY,
    };

    /// Both together; the order and the grouping of many do not show.
    fn and(self, other: Self) -> Self {
        Self {
            instances: self.instances.saturating_add(other.instances),
            cylinders: self.cylinders.saturating_add(other.cylinders),
            other_solids: self.other_solids.saturating_add(other.other_solids),
            depth: self.depth.max(other.depth),
            bounds: self.bounds.union(&other.bounds),
        }
    }
}

impl Scene {
    /// Counts what the scene holds. Time and memory grow with what is stored,
    /// not with what is placed. Runs on the rayon pool that this is called in.
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
            cylinders_unique: used().map(|p| p.cylinders.len() as u64).sum(),
            other_solids_unique: used().map(|p| p.solids.len() as u64).sum(),
            instances: root.instances,
            cylinders_instanced: root.cylinders,
            other_solids_instanced: root.other_solids,
            depth: root.depth,
            bounds: root.bounds,
        }
    }

    fn whole(&self, index: PrototypeIndex, wholes: &mut [Option<Whole>]) -> Whole {
        if let Some(whole) = wholes[index.0 as usize] {
            return whole;
        }
        let prototype = &self.prototypes[index.0 as usize];
        for placement in &prototype.placements {
            self.whole(placement.of, wholes);
        }
        let placed = |placement: &Placement| {
            let whole = wholes[placement.of.0 as usize].unwrap_or(Whole::NOTHING);
            Whole {
                instances: whole.instances.saturating_add(1),
                depth: whole.depth + 1,
                bounds: whole.bounds.transformed(&placement.parent_from_child),
                ..whole
            }
        };
        let cylinders = Whole {
            cylinders: prototype.cylinders.len() as u128,
            bounds: (0..prototype.cylinders.len())
                .into_par_iter()
                .with_min_len(LEAST_SHARE)
                .map(|position| prototype.cylinders.get(position).cylinder().bounds())
                .reduce(|| Bounds::EMPTY, |sum, bounds| sum.union(&bounds)),
            ..Whole::NOTHING
        };
        let others = Whole {
            other_solids: prototype.solids.len() as u128,
            bounds: prototype.solids.bounds(),
            ..Whole::NOTHING
        };
        let placements = prototype.placements.par_iter().with_min_len(LEAST_SHARE);
        let whole = placements
            .map(placed)
            .reduce(|| Whole::NOTHING, Whole::and)
            .and(cylinders)
            .and(others);
        wholes[index.0 as usize] = Some(whole);
        whole
    }
}
