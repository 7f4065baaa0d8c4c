//! Where a prototype's solids are kept: in the description.

use std::marker::PhantomData;
use std::sync::Arc;

use smallvec::SmallVec;

use super::members::Members;
use super::numbers::Numbers;
use super::opened::{OpenedFrames, Through};
use super::solids::{Filtered, Solids};
use crate::embree::{Box32, GREATEST_PACKET, RaySet, prefetch};
use crate::math::{Bounds, ChildFromParent, LANES};
use crate::scene::{self, Placement, PrototypeIndex, Scene};
use crate::tracer::filter::HasFilter;
use crate::tracer::frame::Frame;
use crate::tracer::query::{Packet, Query, SolidSlot};
use crate::tracer::traced::TracedSolid;

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
        self.prototype().primitive(kind, record as usize)
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

/// The solids of one kind in a group, that are no cylinders.
pub(crate) struct SolidList<S> {
    prototype_ref: PrototypeRef,
    /// The positions of their records.
    numbers: Numbers,
    kind: PhantomData<fn() -> S>,
}

impl<S: TracedSolid> SolidList<S> {
    pub fn new(prototype_ref: &PrototypeRef, members: &Members) -> Self {
        Self {
            prototype_ref: prototype_ref.clone(),
            numbers: members.of(S::LIST).clone(),
            kind: PhantomData,
        }
    }

    /// The solid of a record.
    #[inline(always)]
    pub fn solid(&self, record: u32) -> &S {
        let records = S::list(&self.prototype_ref.prototype().solids);
        &records[record as usize].solid
    }

    /// Whose they are.
    #[inline(always)]
    pub fn prototype_ref(&self) -> &PrototypeRef {
        &self.prototype_ref
    }
}

impl<S: TracedSolid> Solids for SolidList<S> {
    #[inline(always)]
    fn prototype_ref(&self) -> &PrototypeRef {
        &self.prototype_ref
    }

    fn len(&self) -> u32 {
        self.numbers.len()
    }

    #[inline(always)]
    fn record(&self, position: u32) -> u32 {
        self.numbers.number(position)
    }

    fn grown_box(&self, record: u32) -> Box32 {
        let bounds = self.solid(record).bounds();
        if bounds.is_empty() {
            // What set operations leave nothing of; Embree wants a box all the same.
            return Box32 {
                lower: [0.0; 3],
                upper: [0.0; 3],
            };
        }
        self.prototype_ref.grown_box(&bounds)
    }

    #[inline(always)]
    fn prefetch(&self, record: u32) {
        prefetch(self.solid(record));
    }

    // A call, for a solver with its branches gains nothing from being compiled for each
    // instruction set.
    fn visit(&self, record: u32, query: &mut Query) {
        query.visit_solid(self, record);
    }

    fn meets(&self, record: u32, query: &Query) -> bool {
        query.meets_solid(self.solid(record))
    }

    // Inlined for the rows of lanes within, as `embree::callback` says.
    #[inline(always)]
    fn visit_packet(
        &self,
        record: u32,
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut Packet,
    ) -> RaySet {
        packet.visit_solid(self, record, rays, t_far)
    }

    #[inline(always)]
    fn meets_packet(&self, record: u32, rays: RaySet, packet: &Packet) -> RaySet {
        packet.meets_solid(self.solid(record), rays)
    }
}

impl<S: TracedSolid + HasFilter> Filtered for SolidList<S> {
    type Filter = S::Filter;

    fn filter(&self, records: &[u32]) -> S::Filter {
        let solids: SmallVec<[S; LANES]> = records.iter().map(|&one| *self.solid(one)).collect();
        S::filter(&solids, self.prototype_ref.frame())
    }
}
