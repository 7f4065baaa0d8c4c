//! Parts of a scene as lists of placed solids.
//!
//! A composition is listed by the solids that it is made of, its *leaves*, one
//! after the other: meshes are made of leaves, and the operations combine their bounds
//! (`verdict::composed`). A solid is identified by the
//! position of its first leaf, which for a single solid is the only one.

use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use cyltrace::math::{Bounds, ChildFromParent, PlacementErrors};
use cyltrace::scene::Placement;
use cyltrace::solid::{AnySolid, Composition, SolidKind};
use cyltrace_oracle::ExactAffine;

use crate::solids::shape;

/// The most distances from a window's middle in half widths of a solid at which
/// its prisms are worth tracing: 2^-24 of it is 2^-10 of the half width.
const RESOLVED: f64 = (1 << 14) as f64;

/// A placement of a prototype in the world.
#[derive(Debug)]
pub(crate) struct PlacedFrame {
    /// The placements from the root, outermost first.
    pub instance: Vec<u32>,
    /// The composed map, without rounding.
    pub exact: ExactAffine,
    /// Every entry is the f64 nearest to the exact one.
    pub world_from_object: DAffine3,
}

impl PlacedFrame {
    /// The placement of the scene itself.
    pub fn root() -> Self {
        Self::new(Vec::new(), ExactAffine::identity())
    }

    fn new(instance: Vec<u32>, exact: ExactAffine) -> Self {
        let world_from_object = exact.rounded();
        Self {
            instance,
            exact,
            world_from_object,
        }
    }

    /// The placement of a prototype within this one.
    pub fn within(&self, number: u32, placement: &Placement) -> Self {
        let mut instance = self.instance.clone();
        instance.push(number);
        let inner = ExactAffine::new(&placement.parent_from_child);
        Self::new(instance, self.exact.after(&inner))
    }
}

/// A placed solid, or a placed leaf of a composition.
#[derive(Clone, Debug)]
pub(crate) struct PlacedSolid {
    /// The solid in its prototype's space.
    pub solid: AnySolid,
    /// The placement of its prototype.
    pub frame: Arc<PlacedFrame>,
    /// The number within the prototype, of a leaf that of its composition.
    pub primitive: u32,
}

impl PlacedSolid {
    /// A box in the world that contains the solid.
    ///
    /// [`Bounds::transformed`] grows by 8 units where its own roundings need
    /// 6; the rounded entries of the map add one.
    pub fn bounds(&self) -> Bounds {
        let bounds = self.solid.bounds();
        bounds.transformed(&self.frame.world_from_object)
    }

    /// At most the distance from its middle to its surface, in the world; for a
    /// disk, to its rim.
    pub fn half_width(&self) -> f64 {
        let placement = &self.frame.world_from_object;
        let shrink = PlacementErrors::new(placement, &ChildFromParent::new(placement)).shrink;
        shrink * shape(&self.solid).get().half_width()
    }
}

/// A composition among the solids of a window.
#[derive(Clone, Debug)]
pub(crate) struct PlacedComposition {
    /// The positions of its leaves, in the order of [`Composition::operands`].
    pub leaves: Range<u32>,
    /// What it is.
    pub composition: Arc<Composition>,
}

/// A part of the scene that is checked at a time.
#[derive(Debug, Default)]
pub(crate) struct Window {
    /// Rays are clipped to this box; `None` is the whole scene.
    pub bounds: Option<Bounds>,
    /// All solids whose boxes overlap it, compositions as their leaves.
    pub solids: Vec<PlacedSolid>,
    /// The compositions among them, in the order of their leaves.
    pub compositions: Vec<PlacedComposition>,
}

impl Window {
    /// The composition that a leaf belongs to.
    pub fn composition_of(&self, leaf: u32) -> Option<&PlacedComposition> {
        let before = |one: &PlacedComposition| one.leaves.end <= leaf;
        let next = self.compositions.partition_point(before);
        let found = self.compositions.get(next)?;
        (found.leaves.start <= leaf).then_some(found)
    }

    /// The leaves of the solid that a leaf belongs to.
    pub fn leaves_with(&self, leaf: u32) -> Range<u32> {
        self.composition_of(leaf)
            .map_or(leaf..leaf + 1, |found| found.leaves.clone())
    }

    /// The kind of the solid that a leaf belongs to.
    pub fn kind(&self, leaf: u32) -> SolidKind {
        let composed = self.composition_of(leaf);
        composed.map_or_else(
            || self.solids[leaf as usize].solid.kind(),
            |found| found.composition.kind(),
        )
    }

    /// The leaves of each solid, in order.
    pub fn leaves(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        let mut next = 0;
        std::iter::from_fn(move || {
            let is_left = (next as usize) < self.solids.len();
            is_left.then(|| {
                let leaves = self.leaves_with(next);
                next = leaves.end;
                leaves
            })
        })
    }

    /// The number of solids; a composition counts as one.
    pub fn count(&self) -> usize {
        let leaves = self.compositions.iter().map(|one| one.leaves.len() - 1);
        self.solids.len() - leaves.sum::<usize>()
    }

    /// The box about which meshes are centered: the window's own, or that of all
    /// its solids.
    pub fn extent(&self) -> Bounds {
        let all = || {
            let solids = self.solids.iter();
            solids.fold(Bounds::EMPTY, |all, solid| all.union(&solid.bounds()))
        };
        self.bounds.unwrap_or_else(all)
    }

    /// Whether f32 resolves half of the solids.
    pub fn is_resolved(&self) -> bool {
        let center = self.extent().center();
        let resolved = self.solids.iter().filter(|solid| {
            let bounds = solid.bounds();
            let farthest = (bounds.upper - center).max(center - bounds.lower);
            farthest.length() <= RESOLVED * solid.half_width()
        });
        2 * resolved.count() >= self.solids.len()
    }
}
