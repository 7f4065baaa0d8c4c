//! Access to a prototype's solids in the description.

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

    /// The index of the prototype.
    #[inline(always)]
    pub fn index(&self) -> PrototypeIndex {
        self.index
    }

    /// The prototype.
    #[inline(always)]
    pub fn prototype(&self) -> &scene::Prototype {
        &self.scene.prototypes[self.index.0 as usize]
    }

    /// The number of a solid for the user.
    #[inline]
    pub fn primitive(&self, member: SolidSlot) -> u32 {
        let SolidSlot { kind, record } = member;
        self.prototype().solids.primitive(kind, record as usize)
    }

    /// The frame of the solids' Embree scene.
    #[inline(always)]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Calls `step` for each placement between the prototype `parent` and this one, for an
    /// instance in the parent's scene: with the number of the placement, the map into its
    /// child, and the frame of the child.
    #[inline(always)]
    pub fn along_instance(
        &self,
        parent: PrototypeIndex,
        instance: u32,
        mut step: impl FnMut(u32, &ChildFromParent, &Frame),
    ) {
        let prototypes = &self.scene.prototypes;
        let child_from_parent =
            |placement: &Placement| ChildFromParent::new(&placement.parent_from_child);
        let placements = &prototypes[parent.0 as usize].placements;
        let (number, placement) = match Through::of(instance, placements.len()) {
            Through::One(number) => (number, &placements[number as usize]),
            Through::Two { outer, inner } => {
                let placement = &placements[outer as usize];
                step(
                    outer,
                    &child_from_parent(placement),
                    self.opened_frames.of(placement.of),
                );
                let opened = &prototypes[placement.of.0 as usize];
                (inner, &opened.placements[inner as usize])
            }
        };
        step(number, &child_from_parent(placement), &self.frame);
    }

    /// A box in the frame of the Embree scene.
    pub fn grown_box(&self, bounds: &Bounds) -> Box32 {
        self.frame.grown_box(bounds)
    }
}
