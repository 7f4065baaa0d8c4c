//! A prototype that can be traced: what it contains, in groups.
//!
//! Nearly every prototype is one group: a frame, and an Embree scene with a callback for
//! each primitive (`group`). Innermost placements are instances of Embree's where that is
//! proven to lose nothing (`instances`), others are primitives (`placements`). A prototype of nothing
//! but a few innermost placements is opened into its parent, which then has the instances (`opened`). Where one solid is so far away or so large that its
//! box alone would set the frame of all others, there are several (`grouping` has the rule,
//! `members` what they contain). A ray enters them one after another,
//! each with the range that the hits so far have left. Which groups there are is known
//! from the start; what each needs is built when a first ray gets there.

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
pub(crate) use group_solids::{InPrototype, Records};
pub(crate) use instances::MOST_INSTANCES;
pub(crate) use members::{Boxes, List};
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

/// With fewer rays than this a packet is given up for single rays: what they
/// share no longer pays for what Embree does for all lanes.
const LEAST_PACKET: usize = 4;

/// Below this many placements a packet is given up for single rays, for a level
/// of a packet takes up to 65 kB of the stack, and one of a ray 12 kB (Embree
/// 3.13.5 with AVX-512; less with others). So the 64 levels of the deepest scene
/// that loads take 8 · 65 + 56 · 12 = 1192 kB, and fit the 2 MB of a thread as
/// Rust makes them. Packets alone would take 4.2 MB.
const GREATEST_PACKET_DEPTH: usize = 8;

/// How prototypes are built.
#[derive(Clone)]
pub(super) struct BuildContext {
    pub device: Device,
    pub layout: Layout,
    /// Threads that a prototype's blocks are made on.
    pub threads: usize,
    /// The part of space that all rays will be in, if it is known.
    pub view: Option<ViewVolume>,
    /// How many rays Embree takes together; `None` if it takes no packets.
    pub packet_width: Option<PacketWidth>,
}

impl BuildContext {
    /// The width of packets, which are only made where there is one.
    #[inline]
    fn packet_width(&self) -> PacketWidth {
        self.packet_width
            .expect("packets are traced where Embree takes them")
    }
}

/// Whether rays that got into a prototype go on as a packet.
#[inline]
fn stays_packet(entered: RaySet, packet: &Packet) -> bool {
    packet.is_together && entered.len() >= LEAST_PACKET && packet.path.len() < GREATEST_PACKET_DEPTH
}

/// A prototype that can be traced.
pub(crate) struct Prototype {
    /// Contains all its solids.
    pub bounds: Bounds,
    /// At least one. The first has most of what rays are after, as a rule.
    pub groups: Vec<Arc<Group>>,
    description: Arc<Scene>,
    index: PrototypeIndex,
    children: Children<Self>,
    /// Whether it, or a prototype in it, has more than one group.
    has_several_groups: bool,
    /// Whether placements out of view were left out.
    is_viewed: bool,
}

/// Steps from the root to a place. Scenes are rarely nested deeper than what is kept
/// without the heap.
type Way<'a, T> = SmallVec<[(T, Option<&'a Placement>); 4]>;

/// The prototypes that another one places, or a group of each, without those that
/// contain nothing, in the order of their indices.
pub(super) struct Children<T>(Vec<(PrototypeIndex, Arc<T>)>);

impl<T> Children<T> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The one of an index, if it contains anything.
    #[inline]
    pub fn of(&self, index: PrototypeIndex) -> Option<&Arc<T>> {
        let position = self.0.partition_point(|(known, _)| *known < index);
        let (known, child) = self.0.get(position)?;
        (*known == index).then_some(child)
    }
}

impl Children<Prototype> {
    /// Those that any of the placements place, of all that are made.
    fn new(placements: &[Placement], made: &[Option<Arc<Prototype>>]) -> Self {
        let mut indices: Vec<PrototypeIndex> = Vec::new();
        for placement in placements {
            // Runs of the same prototype are what scattered placements come in.
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
    /// Makes a prototype of the outlines of its groups, when its children are made. `made`
    /// has the child of each index; `None` for one that contains nothing.
    ///
    /// Returns `None` if the prototype itself contains nothing.
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

    /// How many placements no ray will reach.
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

    /// How many instances Embree has in it.
    pub fn instances(&self) -> u64 {
        self.groups.iter().map(|group| group.instances()).sum()
    }

    /// The bytes that are kept beside the description and Embree's trees.
    pub fn kept_bytes(&self) -> usize {
        self.groups.iter().map(|group| group.kept_bytes()).sum()
    }

    fn placements(&self) -> &[Placement] {
        &self.description.prototypes[self.index.0 as usize].placements
    }

    /// A placement and the prototype it places, which is there because a hit
    /// lies in it.
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

    /// Takes a step for each group on the way from the root to a place, with the placement
    /// that led there; the root has none.
    #[inline]
    pub fn along_way<'a>(
        root: &'a Arc<Self>,
        place: &SolidRef,
        mut step: impl FnMut(&'a Group, Option<&'a Placement>),
    ) {
        if root.has_several_groups {
            for (group, placement) in Self::way_through_groups(root, place) {
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

    /// The way of [`Prototype::along_way`] where a prototype has several groups.
    #[cold]
    fn way_through_groups<'a>(root: &'a Arc<Self>, place: &SolidRef) -> Way<'a, &'a Group> {
        let mut prototypes = Way::new();
        prototypes.push((root, None));
        let mut last = root;
        for &index in &place.path {
            let (placement, child) = last.placement(index);
            prototypes.push((child, Some(placement)));
            last = child;
        }
        // A group of a child is a primitive in a group of its parent: so the groups
        // follow from the last one on.
        let mut list = List::Solids(place.member.kind);
        let mut number = place.member.record;
        let numbers = place.path.iter().rev().copied().chain([0]);
        let mut way = Way::new();
        for ((prototype, placement), above) in prototypes.into_iter().rev().zip(numbers) {
            let group = prototype.group_with(list, number);
            way.push((&*prototype.groups[group], placement));
            (list, number) = (List::Placements { group }, above);
        }
        way.reverse();
        way
    }

    /// Traces for the hits that `query` keeps.
    pub fn search(&self, ray: &LocalRay, query: &mut Query) {
        for group in &self.groups {
            group.search(ray, query);
        }
    }

    /// As [`Prototype::search`], but visits every primitive, wherever the ray is.
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

    /// Those rays of a packet for which anything is hit.
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
