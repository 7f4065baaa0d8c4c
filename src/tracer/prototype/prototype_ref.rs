//! Where a prototype's solids are kept: in the description.

use std::sync::Arc;

use super::opened::{OpenedFrames, Through};
use crate::embree::Box32;
use crate::math::{Bounds, ChildFromParent};
use crate::scene::{self, Placement, PrototypeIndex, Scene};
use crate::tracer::frame::Frame;
use crate::tracer::query::SolidSlot;

/// A prototype in the description, and the frame of a group of it.
#[derive(Clone)]
pub(crate) struct PrototypeRef {
    scene: Arc<Scene>,
    index: PrototypeIndex,
    frame: Frame,
    opened_frames: OpenedFrames,
}

impl PrototypeRef {
    pub fn new(
        scene: &Arc<Scene>,
        index: PrototypeIndex,
        frame: &Frame,
        opened_frames: &OpenedFrames,
    ) -> Self {
        Self {
            scene: Arc::clone(scene),
            index,
            frame: frame.clone(),
            opened_frames: opened_frames.clone(),
        }
    }

    /// Which one.
    #[inline(always)]
    pub fn index(&self) -> PrototypeIndex {
        self.index
    }

    /// The prototype.
    #[inline(always)]
    pub fn prototype(&self) -> &scene::Prototype {
        &self.scene.prototypes[self.index.0 as usize]
    }

    /// The number that the user knows a solid by.
    #[inline]
    pub fn primitive(&self, member: SolidSlot) -> u32 {
        let SolidSlot { kind, record } = member;
        self.prototype().solids.primitive(kind, record as usize)
    }

    /// Where the solids' Embree scene is.
    #[inline(always)]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Takes a step through each placement on the way into the solids' prototype, which an instance
    /// in another one leads through: the number of the placement, the way through it, and
    /// the frame of what it places.
    #[inline(always)]
    pub fn along_instance(
        &self,
        parent: PrototypeIndex,
        instance: u32,
        mut step: impl FnMut(u32, &ChildFromParent, &Frame),
    ) {
        let prototypes = &self.scene.prototypes;
        let way = |placement: &Placement| ChildFromParent::new(&placement.parent_from_child);
        let placements = &prototypes[parent.0 as usize].placements;
        let (number, placement) = match Through::of(instance, placements.len()) {
            Through::One(number) => (number, &placements[number as usize]),
            Through::Two { outer, inner } => {
                let placement = &placements[outer as usize];
                step(outer, &way(placement), self.opened_frames.of(placement.of));
                let opened = &prototypes[placement.of.0 as usize];
                (inner, &opened.placements[inner as usize])
            }
        };
        step(number, &way(placement), &self.frame);
    }

    /// A box in the frame of the Embree scene.
    pub fn grown_box(&self, bounds: &Bounds) -> Box32 {
        self.frame.grown_box(bounds)
    }
}
