//! What a scene holds, counted without tracing it.

use super::{PrototypeIndex, Scene};
use crate::math::Bounds;

/// The counts of a scene. Prototypes that nobody places are left out, but for
/// `prototypes`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Census {
    /// Named prototypes, the root not counted, used or not.
    pub prototypes: u64,
    /// Those of them that the root places, itself or through others.
    pub prototypes_used: u64,
    /// Placements as they are stored: those within a prototype count once.
    pub placements: u64,
    /// Cylinders as they are stored.
    pub cylinders_unique: u64,
    /// Placements with those within placed prototypes counted each time.
    pub instances: u128,
    /// Cylinders with every placement counted.
    pub cylinders_instanced: u128,
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
    depth: u32,
    bounds: Bounds,
}

impl Scene {
    /// Counts what the scene holds. Time and memory grow with what is stored,
    /// not with what is placed.
    #[must_use]
    pub fn census(&self) -> Census {
        let mut wholes = vec![None; self.prototypes.len()];
        let root = self.whole(PrototypeIndex::ROOT, &mut wholes);
        let used = || {
            let all = wholes.iter().zip(&self.prototypes);
            all.filter_map(|(whole, prototype)| whole.map(|_| prototype))
        };
        Census {
            prototypes: self.prototypes.len() as u64 - 1,
            prototypes_used: used().count() as u64 - 1,
            placements: used().map(|p| p.placements.len() as u64).sum(),
            cylinders_unique: used().map(|p| p.cylinders.len() as u64).sum(),
            instances: root.instances,
            cylinders_instanced: root.cylinders,
            depth: root.depth,
            bounds: root.bounds,
        }
    }

    fn whole(&self, index: PrototypeIndex, wholes: &mut [Option<Whole>]) -> Whole {
        if let Some(whole) = wholes[index.0 as usize] {
            return whole;
        }
        let prototype = &self.prototypes[index.0 as usize];
        let cylinders = prototype.cylinders.iter();
        let mut whole = Whole {
            instances: 0,
            cylinders: prototype.cylinders.len() as u128,
            depth: 0,
            bounds: cylinders.fold(Bounds::EMPTY, |bounds, record| {
                bounds.union(&record.cylinder().bounds())
            }),
        };
        for placement in &prototype.placements {
            let placed = self.whole(placement.of, wholes);
            whole.instances = whole
                .instances
                .saturating_add(placed.instances)
                .saturating_add(1);
            whole.cylinders = whole.cylinders.saturating_add(placed.cylinders);
            whole.depth = whole.depth.max(placed.depth + 1);
            let bounds = placed.bounds.transformed(&placement.parent_from_child);
            whole.bounds = whole.bounds.union(&bounds);
        }
        wholes[index.0 as usize] = Some(whole);
        whole
    }
}
