//! A prototype that can be traced: its contents, in groups.
//!
//! Nearly every prototype is one group: a frame, and an Embree scene with a callback for each
//! primitive (`group`). Innermost placements are instances of Embree's if that provably loses
//! nothing (`instances`), others are primitives (`placements`). A prototype of a few innermost
//! placements only is opened into its parent, which then has the instances (`opened`). If one
//! solid is so far away or so large that its box alone would determine the frame of all others,
//! there are several groups (`grouping` has the rule, `members` the lists). A ray enters them
//! one after another, each with the range that the hits so far have left. The groups are
//! determined at the start; what each needs is built when the first ray arrives there.

mod attach;
mod blocks;
mod clusters;
mod group;
mod group_solids;
mod grouping;
mod instances;
mod members;
mod numbers;
mod opened;
mod outline;
mod parts;
mod placement_margin;
mod placements;
mod prototype_ref;

use std::sync::Arc;

use smallvec::SmallVec;

pub(crate) use attach::Attaching;
pub(crate) use blocks::block_bytes;
pub(crate) use group::Group;
pub(crate) use group_solids::{GroupSolids, InPrototype, Records, Single};
pub(crate) use instances::MOST_INSTANCES;
pub(crate) use members::{Boxes, List, Members};
pub(crate) use numbers::Numbers;
pub(crate) use opened::{MOST_INNER, MOST_OUTER};
pub(crate) use outline::{Outline, Outlines};
pub(crate) use prototype_ref::PrototypeRef;

use super::frame::{LocalRay, PacketRays};
use super::options::Layout;
use super::query::{Packet, Query, SolidRef};
use crate::embree::{self, Device, PacketWidth, RaySet};
use crate::math::Bounds;
use crate::scene::{Placement, PrototypeIndex, Scene, ViewVolume};

/// With fewer rays than this a packet is split into single rays: what they share no longer pays
/// for Embree's work on all lanes.
const LEAST_PACKET: usize = 4;

/// Below this number of placements a packet is split into single rays: a level of a packet
/// takes up to 65 kB of the stack, and one of a ray 12 kB (Embree 3.13.5 with AVX-512; less
/// with others). So the 64 levels of the deepest scene that loads take 8 · 65 + 56 · 12 = 1192
/// kB, and fit the 2 MB of a default Rust thread. Packets alone would take 4.2 MB.
const GREATEST_PACKET_DEPTH: usize = 8;

/// How prototypes are built.
#[derive(Clone)]
pub(super) struct BuildContext {
    pub device: Device,
    pub layout: Layout,
    /// The number of threads that make a prototype's blocks.
    pub threads: usize,
    /// The part of space that contains all rays, if known.
    pub view: Option<ViewVolume>,
    /// The width of Embree's packets; `None` if it supports none.
    pub packet_width: Option<PacketWidth>,
}

impl BuildContext {
    /// The width of packets, which are traced only if Embree supports them.
    #[inline]
    fn packet_width(&self) -> PacketWidth {
        self.packet_width
            .expect("packets are traced where Embree takes them")
    }
}

/// Whether rays that entered a prototype continue as a packet.
#[inline]
fn stays_packet(entered: RaySet, packet: &Packet) -> bool {
    packet.is_together
        && entered.len() >= LEAST_PACKET
        && packet.position.path.len() < GREATEST_PACKET_DEPTH
}

/// A prototype that can be traced.
pub(crate) struct Prototype {
    /// Contains all its solids.
    pub bounds: Bounds,
    /// At least one. The first usually has most of what rays hit.
    pub groups: Vec<Arc<Group>>,
    description: Arc<Scene>,
    index: PrototypeIndex,
    children: Children<Self>,
    /// Whether it, or a prototype in it, has more than one group.
    has_several_groups: bool,
    /// Whether placements out of view were left out.
    is_viewed: bool,
}

/// The steps from the root to a place. Scenes are rarely nested deeper than what is stored
/// without the heap.
type Steps<'a, T> = SmallVec<[(T, Option<&'a Placement>); 4]>;

/// The prototypes that another one places, or a group of each, without empty ones, in the order
/// of their indices.
pub(super) struct Children<T>(Vec<(PrototypeIndex, Arc<T>)>);

impl<T> Children<T> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The child with an index, if it is not empty.
    #[inline]
    pub fn of(&self, index: PrototypeIndex) -> Option<&Arc<T>> {
        let position = self.0.partition_point(|(known, _)| *known < index);
        let (known, child) = self.0.get(position)?;
        (*known == index).then_some(child)
    }
}

impl Children<Prototype> {
    /// The children of these placements, among all created prototypes.
    fn new(placements: &[Placement], made: &[Option<Arc<Prototype>>]) -> Self {
        let mut indices: Vec<PrototypeIndex> = Vec::new();
        for placement in placements {
            // Scattered placements usually form runs of one prototype.
            if indices.last() != Some(&placement.of) {
                indices.push(placement.of);
            }
        }
        indices.sort_unstable();
        indices.dedup();
        let children = indices.into_iter();
        Self(
            children
                .filter_map(|index| Some((index, made[index.0 as usize].clone()?)))
                .collect(),
        )
    }

    /// The groups with this number, of the prototypes that have one.
    fn groups(&self, group: usize) -> Children<Group> {
        let groups = self.0.iter().filter_map(|(index, child)| {
            let group = child.groups.get(group)?;
            Some((*index, Arc::clone(group)))
        });
        Children(groups.collect())
    }
}

impl Prototype {
    /// Creates a prototype from the outlines of its groups, after its children. `made` has the
    /// child of each index; `None` for an empty one.
    ///
    /// Returns `None` if the prototype itself is empty.
    pub fn new(
        context: &BuildContext,
        description: &Arc<Scene>,
        (index, outlines): (PrototypeIndex, Vec<Outline>),
        made: &[Option<Arc<Self>>],
    ) -> Option<Arc<Self>> {
        let prototype = &description.prototypes[index.0 as usize];
        let children = Children::new(&prototype.placements, made);
        let boxes = outlines.iter().map(|outline| outline.bounds);
        let bounds = boxes.reduce(|one, other| one.union(&other))?;
        let has_several_groups = outlines.len() > 1;
        let groups = outlines.into_iter();
        let groups =
            groups.map(|group| Arc::new(Group::new(context, description, index, group, &children)));
        let mut placed = children.0.iter();
        Some(Arc::new(Self {
            has_several_groups: has_several_groups
                || placed.any(|(_, child)| child.has_several_groups),
            bounds,
            groups: groups.collect(),
            description: Arc::clone(description),
            index,
            children,
            is_viewed: context.view.is_some() && index == PrototypeIndex::ROOT,
        }))
    }

    /// Builds the Embree scenes, unless they are built.
    pub fn build(&self) -> Result<(), embree::Error> {
        self.groups.iter().try_for_each(|group| group.build())
    }

    /// Whether an Embree scene is built or being built.
    pub fn is_touched(&self) -> bool {
        self.groups.iter().any(|group| group.is_touched())
    }

    /// The number of placements that no ray will reach.
    pub fn placements_out_of_view(&self) -> usize {
        if !self.is_viewed {
            return 0;
        }
        let groups = self.groups.iter();
        let mut in_view: Vec<u32> = groups
            .flat_map(|group| group.placements_in_view())
            .collect();
        in_view.sort_unstable();
        in_view.dedup();
        self.placements().len() - in_view.len()
    }

    /// The number of Embree's instances in it.
    pub fn instances(&self) -> u64 {
        self.groups.iter().map(|group| group.instances()).sum()
    }

    /// The bytes stored in addition to the description and Embree's trees.
    pub fn kept_bytes(&self) -> usize {
        self.groups.iter().map(|group| group.kept_bytes()).sum()
    }

    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.index.0 as usize].placements
    }

    /// A placement and the prototype that it places, which exists because it contains a hit.
    pub fn placement(&self, index: u32) -> (&Placement, &Arc<Self>) {
        let placement = &self.placements()[index as usize];
        let child = self.children.of(placement.of);
        (
            placement,
            child.expect("a hit lies in a prototype that contains something"),
        )
    }

    /// The number of the group with an entry of a list.
    fn group_with(&self, list: List, number: u32) -> usize {
        let mut groups = self.groups.iter();
        let group = groups.position(|group| group.members.of(list).contains(number));
        group.expect("what is hit is in a group")
    }

    /// Calls `step` for each group from the root to a place, with the placement that leads
    /// there; the root has none.
    #[inline]
    pub fn for_each_step<'a>(
        root: &'a Arc<Self>,
        place: &SolidRef,
        mut step: impl FnMut(&'a Group, Option<&'a Placement>),
    ) {
        if root.has_several_groups {
            for (group, placement) in Self::steps_through_groups(root, place) {
                step(group, placement);
            }
            return;
        }
        step(&root.groups[0], None);
        let mut last = root;
        for &index in &place.path {
            let (placement, child) = last.placement(index);
            step(&child.groups[0], Some(placement));
            last = child;
        }
    }

    /// The steps of [`Prototype::for_each_step`] if a prototype has several groups.
    #[cold]
    fn steps_through_groups<'a>(root: &'a Arc<Self>, place: &SolidRef) -> Steps<'a, &'a Group> {
        let mut prototypes = Steps::new();
        prototypes.push((root, None));
        let mut last = root;
        for &index in &place.path {
            let (placement, child) = last.placement(index);
            prototypes.push((child, Some(placement)));
            last = child;
        }
        // A group of a child is a primitive in a group of its parent. So the groups follow from
        // the last one.
        let mut list = List::Solids(place.member.kind);
        let mut number = place.member.record;
        let numbers = place.path.iter().rev().copied().chain([0]);
        let mut steps = Steps::new();
        for ((prototype, placement), above) in prototypes.into_iter().rev().zip(numbers) {
            let group = prototype.group_with(list, number);
            steps.push((&*prototype.groups[group], placement));
            (list, number) = (List::Placements { group }, above);
        }
        steps.reverse();
        steps
    }

    /// Traces a ray for the hits that `query` keeps.
    pub fn search(&self, ray: &LocalRay, query: &mut Query) {
        for group in &self.groups {
            group.search(ray, query);
        }
    }

    /// As [`Prototype::search`], but visits every primitive for any ray.
    pub fn search_exhaustively(&self, ray: &LocalRay, query: &mut Query) {
        for group in &self.groups {
            group.search_exhaustively(ray, query);
        }
    }

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &LocalRay, query: &mut Query) -> bool {
        self.groups.iter().any(|group| group.occluded(ray, query))
    }

    /// Traces rays of a packet for their first hits.
    pub fn search_packet(&self, rays: RaySet, local: &PacketRays, packet: &mut Packet) {
        for group in &self.groups {
            packet.arrive(local);
            group.search_packet(rays, packet);
        }
    }

    /// The rays of a packet that hit anything.
    pub fn occluded_packet(&self, rays: RaySet, local: &PacketRays, packet: &mut Packet) -> RaySet {
        let mut blocked = RaySet::EMPTY;
        for group in &self.groups {
            if blocked != rays {
                packet.arrive(local);
                blocked = blocked | group.occluded_packet(rays - blocked, packet);
            }
        }
        blocked
    }
}
