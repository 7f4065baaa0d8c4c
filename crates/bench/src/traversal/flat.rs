//! A scene without nesting: the placements of each prototype in the world.
//!
//! Rivals have one level of instances and the oracle none, so paths of
//! placements are composed, in exact numbers.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine3;

use cyltrace::scene::{Prototype, PrototypeIndex, Scene};
use cyltrace::solid::{AnySolid, SolidKind};
use cyltrace_oracle::ExactAffine;

/// A prototype in the world.
pub struct Placed {
    /// The prototype, which has solids of its own.
    pub prototype: PrototypeIndex,
    /// The composed map, without rounding.
    pub exact: ExactAffine,
    /// Every entry is the f64 nearest to the exact one.
    pub world_from_object: DAffine3,
}

/// A scene and the places of its prototypes.
pub struct Flat {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The places of all prototypes with solids, those of the root first.
    pub placed: Vec<Placed>,
    numbers: HashMap<Vec<u32>, u32>,
}

impl Flat {
    /// Goes down every path.
    #[must_use]
    pub fn new(scene: Arc<Scene>) -> Self {
        let mut flat = Self {
            scene: Arc::clone(&scene),
            placed: Vec::new(),
            numbers: HashMap::new(),
        };
        let identity = ExactAffine::identity();
        flat.visit(&scene, PrototypeIndex::ROOT, &identity, &mut Vec::new());
        flat
    }

    fn visit(
        &mut self,
        scene: &Scene,
        prototype: PrototypeIndex,
        exact: &ExactAffine,
        path: &mut Vec<u32>,
    ) {
        let description = &scene.prototypes[prototype.0 as usize];
        if !description.solids.is_empty() {
            let number = self.placed.len() as u32;
            self.numbers.insert(path.clone(), number);
            self.placed.push(Placed {
                prototype,
                world_from_object: exact.rounded(),
                exact: exact.clone(),
            });
        }
        for (number, placement) in (0..).zip(&description.placements) {
            let inner = ExactAffine::new(&placement.parent_from_child);
            path.push(number);
            self.visit(scene, placement.of, &exact.after(&inner), path);
            path.pop();
        }
    }

    /// The position in `placed` of the prototype at the end of a path.
    ///
    /// # Panics
    /// When there is none with solids.
    #[must_use]
    pub fn number(&self, path: &[u32]) -> u32 {
        self.numbers[path]
    }

    /// Whether anything is placed.
    #[must_use]
    pub fn has_placements(&self) -> bool {
        !self.scene.prototypes[0].placements.is_empty()
    }

    /// What a prototype is.
    #[must_use]
    pub fn prototype(&self, index: PrototypeIndex) -> &Prototype {
        &self.scene.prototypes[index.0 as usize]
    }

    /// The solids of a prototype in an order of their own, which is that of rivals'
    /// primitives.
    pub fn solids(&self, prototype: PrototypeIndex) -> impl Iterator<Item = AnySolid> {
        self.prototype(prototype).singles().map(|(_, solid)| solid)
    }

    /// Whether the scene has set operations, which no rival represents.
    #[must_use]
    pub fn has_compositions(&self) -> bool {
        let prototypes = &self.scene.prototypes;
        prototypes
            .iter()
            .any(|one| !one.solids.compositions.is_empty())
    }

    /// The kinds of the placed solids, each once.
    #[must_use]
    pub fn kinds(&self) -> Vec<SolidKind> {
        let mut kinds = Vec::new();
        for prototype in self.prototypes() {
            let solids = &self.prototype(prototype).solids;
            let simple = SolidKind::SIMPLE.iter();
            kinds.extend(simple.filter(|&&kind| solids.len_of(kind) > 0));
        }
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }

    /// The placed prototypes, each once.
    #[must_use]
    pub fn prototypes(&self) -> Vec<PrototypeIndex> {
        let mut used: Vec<PrototypeIndex> = self.placed.iter().map(|one| one.prototype).collect();
        used.sort_unstable();
        used.dedup();
        used
    }

    /// Solids that are stored: those of a prototype count once.
    #[must_use]
    pub fn stored(&self) -> usize {
        let used = self.prototypes();
        let count = |one| self.prototype(one).solids.len();
        used.into_iter().map(count).sum()
    }
}
