//! A prototype's Embree scene and what its callbacks do.
//!
//! A prototype has a user geometry for each kind of solid that it has, and one for
//! its placements if it has any. Where it is and how far
//! it reaches is known from the start. Its Embree scene is built when it is
//! asked for, which may be when a first ray gets there: threads that need it
//! then build it together, and others go on.

mod attach;
mod blocks;
mod clusters;
mod cylinders;
mod described;
mod ends;
mod placements;
mod sight;

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

pub(crate) use blocks::{CylinderBlock, block_bytes};
pub(crate) use cylinders::Cylinders;
pub(crate) use described::{Described, SolidList};
pub(crate) use ends::Ends;

use super::frame::{Frame, LocalRay, PacketEntry, PacketLevel, PacketRays};
use super::options::Layout;
use super::query::{Packet, Query};
use super::traced::TracedSolid;
use crate::embree::{
    self, Coherence, Device, GREATEST_PACKET, Instructions, JointCommit, PacketWidth, RaySet,
    SceneBuilder,
};
use crate::math::Bounds;
use crate::scene::{Placement, PrototypeIndex, Scene, ViewVolume};
use crate::solid::{Composition, Cone, Cuboid, Disk, RoundedCone, Sphere};
use attach::{attach_cylinders, attach_solids};
use placements::Placements;
use sight::Sight;

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
pub(super) struct Workshop {
    pub device: Device,
    pub layout: Layout,
    /// Threads that a prototype's blocks are made on.
    pub threads: usize,
    /// The part of space that all rays will be in, if it is known.
    pub view: Option<ViewVolume>,
    /// What packets are computed with.
    pub instructions: Instructions,
    /// How many rays Embree takes together; `None` if it takes no packets.
    pub packet_width: Option<PacketWidth>,
}

impl Workshop {
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
    entered.len() >= LEAST_PACKET && packet.path.len() < GREATEST_PACKET_DEPTH
}

/// A prototype that can be traced.
pub(crate) struct Prototype {
    /// Holds all its solids.
    pub bounds: Bounds,
    /// Holds every point at which a query may place a hit: `bounds`, and what
    /// roundings on the way through placements can add to it.
    reach: Bounds,
    pub frame: Frame,
    cylinders: Cylinders,
    placements: Arc<Placements>,
    workshop: Workshop,
    scene: OnceLock<Result<JointCommit<Query>, embree::Error>>,
}

/// The prototypes that another one places, without those that hold nothing, in
/// the order of their indices.
pub(super) struct Children(Vec<(PrototypeIndex, Arc<Prototype>)>);

impl Children {
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

    /// The prototype of an index, if it holds anything.
    #[inline]
    pub fn of(&self, index: PrototypeIndex) -> Option<&Arc<Prototype>> {
        let position = self.0.partition_point(|(known, _)| *known < index);
        let (known, prototype) = self.0.get(position)?;
        (*known == index).then_some(prototype)
    }
}

impl Prototype {
    /// Makes a prototype whose children are made. `made` answers with the child
    /// of an index; `None` for one that holds nothing.
    ///
    /// Answers `None` if the prototype itself holds nothing.
    pub fn new(
        workshop: &Workshop,
        description: &Arc<Scene>,
        index: PrototypeIndex,
        made: &[Option<Arc<Self>>],
    ) -> Option<Arc<Self>> {
        let prototype = &description.prototypes[index.0 as usize];
        let union = |one: Bounds, other: Bounds| one.union(&other);
        let cylinders = (0..prototype.cylinders.len()).into_par_iter();
        let cylinders = cylinders
            .with_min_len(1 << 10)
            .map(|record| prototype.cylinders.get(record).cylinder().bounds())
            .reduce(|| Bounds::EMPTY, union);
        let solids = cylinders.union(&prototype.solids.bounds());
        let child = |placement: &Placement| made[placement.of.0 as usize].as_ref();
        let placed = || {
            let placements = prototype.placements.par_iter().with_min_len(1 << 10);
            placements.filter_map(|placement| Some((placement, child(placement)?)))
        };
        let bounds = placed()
            .map(|(placement, child)| child.bounds.transformed(&placement.parent_from_child))
            .reduce(|| solids, union);
        if bounds.is_empty() {
            return None;
        }
        let sight = Sight::new(&bounds, placed().map(|(placement, _)| placement));
        let reach = placed()
            .map(|(placement, child)| sight.placement_reach(placement, &child.reach))
            .reduce(|| solids, union);
        let frame = Frame::new(&reach);

        let may_reach = |view: &ViewVolume| {
            let placements = prototype.placements.par_iter().with_min_len(1 << 10);
            let numbered = placements.enumerate().filter(|(_, placement)| {
                child(placement).is_some_and(|child| {
                    view.may_reach(&sight.placement_reach(placement, &child.reach))
                })
            });
            numbered.map(|(number, _)| number as u32).collect()
        };
        // Only in the root the rays are those of the caller.
        let view = workshop.view.filter(|_| index == PrototypeIndex::ROOT);
        let placements = Placements {
            in_view: view.as_ref().map(may_reach),
            description: Arc::clone(description),
            prototype: index,
            frame: frame.clone(),
            sight,
            children: Children::new(&prototype.placements, made),
            instructions: workshop.instructions,
        };
        Some(Arc::new(Self {
            bounds,
            reach,
            cylinders: Cylinders::new(&Described::new(description, index, &frame)),
            frame,
            placements: Arc::new(placements),
            workshop: workshop.clone(),
            scene: OnceLock::new(),
        }))
    }

    /// Builds the Embree scene, unless it is built.
    pub fn build(&self) -> Result<(), embree::Error> {
        self.joined().map(|_| ())
    }

    /// How many placements no ray will reach.
    pub fn placements_out_of_view(&self) -> usize {
        self.placements.out_of_view()
    }

    /// Whether the Embree scene is built or being built.
    pub fn is_touched(&self) -> bool {
        self.scene.get().is_some()
    }

    /// The Embree scene, which is built if this is the first time it is needed.
    ///
    /// # Panics
    /// When Embree refuses, which is for want of memory: boxes are legal by the
    /// frame's making, and a query has no way to answer with an error. Whoever
    /// wants one builds everything beforehand.
    #[inline]
    fn scene(&self) -> &embree::Scene<Query> {
        match self.joined() {
            Ok(scene) => scene,
            Err(error) => panic!("a prototype cannot be built when a ray reaches it: {error}"),
        }
    }

    #[inline]
    fn joined(&self) -> Result<&embree::Scene<Query>, embree::Error> {
        let scene = self.scene.get_or_init(|| self.begin());
        scene.as_ref().map_err(Clone::clone)?.join()
    }

    /// Makes Embree's scene ready to be built.
    #[cold]
    fn begin(&self) -> Result<JointCommit<Query>, embree::Error> {
        let mut builder = SceneBuilder::new(&self.workshop.device)?;
        let layout = self.workshop.layout;
        attach_cylinders(&self.cylinders, layout, self.workshop.threads, &mut builder)?;
        attach_solids(self.cylinders.described(), &mut builder)?;
        if !self.placements.children.0.is_empty() {
            builder.attach_user(Arc::clone(&self.placements))?;
        }
        Ok(builder.into_joint())
    }

    /// The bytes that are kept for the cylinders beside the description and
    /// Embree's tree.
    pub fn kept_bytes(&self) -> usize {
        match self.workshop.layout {
            Layout::Block if self.is_touched() => {
                let records = self.cylinders.records().records();
                block_bytes(u64::from(self.cylinders.len()), records) as usize
            }
            Layout::Block | Layout::Single => 0,
        }
    }

    /// A placement and the prototype it places, which is there because a hit
    /// lies in it.
    pub fn placement(&self, index: u32) -> (&Placement, &Arc<Self>) {
        let placed = self.placements.get(index);
        placed.expect("a hit lies in a prototype that holds something")
    }

    /// Traces for the hits that `query` keeps.
    pub fn search(&self, ray: &LocalRay, query: &mut Query) {
        if let Some((level, ray32)) = query.enter(&self.frame, ray) {
            let outer = query.level.replace(level);
            self.scene().closest(&ray32, query);
            query.level = outer;
        }
    }

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &LocalRay, query: &mut Query) -> bool {
        let Some((level, ray32)) = query.enter(&self.frame, ray) else {
            return false;
        };
        let outer = query.level.replace(level);
        let hit = self.scene().any(&ray32, query);
        query.level = outer;
        hit
    }

    /// Traces rays of a packet for their first hits. Answers with those whose
    /// first hit is nearer now.
    pub fn search_packet(&self, rays: RaySet, local: &PacketRays, packet: &mut Packet) -> RaySet {
        let PacketEntry {
            level,
            rays32,
            entered,
        } = packet.enter(&self.frame, rays, local, self.workshop.instructions);
        let before: [f64; GREATEST_PACKET] = std::array::from_fn(|ray| packet.bound(ray));
        if stays_packet(entered, packet) {
            packet.within(level, |packet| {
                let (scene, width) = (self.scene(), self.workshop.packet_width());
                scene.closest_packet(&rays32, entered, width, Coherence::Coherent, packet);
            });
        } else {
            self.each_alone(entered, &level, packet, |scene, ray, query| {
                scene.closest(&rays32.ray(ray), query);
            });
        }
        let mut nearer = RaySet::EMPTY;
        for ray in entered {
            if packet.bound(ray) < before[ray] {
                nearer.insert(ray);
            }
        }
        nearer
    }

    /// Those rays of a packet for which anything is hit.
    pub fn occluded_packet(&self, rays: RaySet, local: &PacketRays, packet: &mut Packet) -> RaySet {
        let PacketEntry {
            level,
            rays32,
            entered,
        } = packet.enter(&self.frame, rays, local, self.workshop.instructions);
        if stays_packet(entered, packet) {
            return packet.within(level, |packet| {
                let (scene, width) = (self.scene(), self.workshop.packet_width());
                scene.any_packet(&rays32, entered, width, Coherence::Coherent, packet)
            });
        }
        let mut blocked = RaySet::EMPTY;
        self.each_alone(entered, &level, packet, |scene, ray, query| {
            if scene.any(&rays32.ray(ray), query) {
                blocked.insert(ray);
            }
        });
        blocked
    }

    /// Traces rays of a packet one by one.
    fn each_alone(
        &self,
        rays: RaySet,
        level: &PacketLevel,
        packet: &mut Packet,
        mut trace: impl FnMut(&embree::Scene<Query>, usize, &mut Query),
    ) {
        for ray in rays {
            packet.alone(ray, level.of_ray(ray), |query| {
                trace(self.scene(), ray, query);
            });
        }
    }

    /// As [`Prototype::search`], but visits every primitive, also where the ray
    /// is nowhere near: neither boxes nor spheres have a say.
    pub fn search_exhaustively(&self, ray: &LocalRay, query: &mut Query) {
        let outer = query.level.replace(self.frame.enter_unseen(ray));
        for record in 0..self.cylinders.len() {
            query.visit(&self.cylinders.cylinder(record), &self.cylinders, record);
        }
        self.visit_list::<Sphere>(query);
        self.visit_list::<Cuboid>(query);
        self.visit_list::<Cone>(query);
        self.visit_list::<RoundedCone>(query);
        self.visit_list::<Disk>(query);
        self.visit_list::<Composition>(query);
        for placement in 0..self.placements.len() {
            self.placements
                .visit(placement, query, Self::search_exhaustively);
        }
        query.level = outer;
    }
    /// Visits every solid of one kind.
    fn visit_list<S: TracedSolid>(&self, query: &mut Query) {
        let list = SolidList::<S>::new(self.cylinders.described());
        for record in 0..list.records().len() as u32 {
            query.visit_solid(&list, record);
        }
    }
}
