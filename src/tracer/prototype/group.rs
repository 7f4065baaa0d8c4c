//! A group: solids and placements of a prototype that share a frame and an Embree scene.
//!
//! A group has a user geometry for each kind of solid in it, and for its placements. Its frame
//! is computed at the start. Its Embree scene is built when first needed, possibly when the
//! first ray arrives: threads that need it then build it together, and others continue.

use std::borrow::Borrow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use super::attach::{Attaching, kept_blocks_bytes};
use super::members::Members;
use super::outline::Outline;
use super::parts::Parts;
use super::placements::Placements;
use super::prototype_ref::PrototypeRef;
use super::{BuildContext, Children, Prototype, stays_packet};
use crate::embree::{self, Coherence, GREATEST_PACKET, JointCommit, RaySet, SceneBuilder};
use crate::math::Bounds;
use crate::scene::{Listed, PrototypeIndex, Scene, SolidList};
use crate::tracer::frame::{Frame, LocalRay, PacketEntry};
use crate::tracer::kinds::attach_all;
use crate::tracer::query::{Packet, Query};
use crate::with_solid_kind;

/// A group that can be traced.
pub(crate) struct Group {
    /// Contains every point that a query may report as a hit: the box of its members, grown by
    /// the roundings in placements.
    pub reach: Bounds,
    /// Boxes whose union contains its members.
    pub parts: Parts,
    pub frame: Frame,
    prototype: PrototypeIndex,
    /// The members of the prototype that it contains.
    pub members: Members,
    prototype_ref: PrototypeRef,
    /// The placements, one geometry for each group of the placed prototypes.
    placements: Vec<Arc<Placements>>,
    context: BuildContext,
    scene: OnceLock<Result<JointCommit<Query>, embree::Error>>,
    /// Whether its placements are in the scene of a parent.
    is_opened: AtomicBool,
}

impl Group {
    /// Creates a group of a prototype.
    pub fn new(
        context: &BuildContext,
        description: &Arc<Scene>,
        index: PrototypeIndex,
        outline: Outline,
        children: &Children<Prototype>,
    ) -> Self {
        let prototype = &description.prototypes[index.0 as usize];
        // Only the root has the caller's rays.
        let view = context.view.filter(|_| index == PrototypeIndex::ROOT);
        let placement_margin = outline.placement_margin;
        let placements = outline.members.placements().filter_map(|(group, all)| {
            let children = children.groups(group);
            (!children.is_empty()).then(|| {
                let in_view = view.map(|view| {
                    all.filtered(|number| {
                        let placement = &prototype.placements[number as usize];
                        children.of(placement.of).is_some_and(|child| {
                            view.may_reach(
                                &placement_margin.placement_reach(placement, &child.reach),
                            )
                        })
                    })
                });
                let reached = outline.divide(in_view.as_ref().unwrap_or(all));
                Arc::new(Placements {
                    all: all.clone(),
                    reached,
                    description: Arc::clone(description),
                    prototype: index,
                    frame: outline.frame.clone(),
                    placement_margin,
                    children,
                })
            })
        });
        let placements = placements.collect();
        let prototype_ref =
            PrototypeRef::new(description, index, &outline.frame, &outline.opened_frames);
        Self {
            reach: outline.reach,
            parts: outline.parts,
            prototype_ref,
            frame: outline.frame,
            prototype: index,
            placements,
            members: outline.members,
            context: context.clone(),
            scene: OnceLock::new(),
            is_opened: AtomicBool::new(false),
        }
    }

    /// The placements that rays may reach.
    pub fn placements_in_view(&self) -> impl Iterator<Item = u32> {
        let placements = self.placements.iter();
        placements.flat_map(|one| one.reached.iter())
    }

    /// The placements, for each group of the placed prototypes.
    pub(super) fn placements(&self) -> &[Arc<Placements>] {
        &self.placements
    }

    /// Records that its placements are in the scene of a parent.
    pub fn open(&self) {
        self.is_opened.store(true, Ordering::Relaxed);
    }

    /// Builds the Embree scene, unless it is built.
    pub fn build(&self) -> Result<(), embree::Error> {
        self.joined().map(|_| ())
    }

    /// Whether the Embree scene, or that of a parent with these placements, is built or being
    /// built.
    pub fn is_touched(&self) -> bool {
        self.is_begun() || self.is_opened.load(Ordering::Relaxed)
    }

    fn is_begun(&self) -> bool {
        self.scene.get().is_some()
    }

    /// The Embree scene, built on first use.
    ///
    /// # Panics
    /// When Embree runs out of memory, the only possible failure: the frame makes boxes legal.
    /// A query cannot return an error; build everything beforehand to get one.
    #[inline]
    fn scene(&self) -> &embree::Scene<Query> {
        match self.joined() {
            Ok(scene) => scene,
            Err(error) => panic!("a prototype cannot be built when a ray reaches it: {error}"),
        }
    }

    #[inline]
    pub fn joined(&self) -> Result<&Arc<embree::Scene<Query>>, embree::Error> {
        let scene = self.scene.get();
        let scene = scene.unwrap_or_else(|| self.ready());
        scene.as_ref().map_err(Clone::clone)?.join()
    }

    /// Embree's scene, ready to be built. The scenes that it has instances of are built first,
    /// by all threads that arrive here.
    #[cold]
    fn ready(&self) -> &Result<JointCommit<Query>, embree::Error> {
        for placements in &self.placements {
            placements.build_instanced();
        }
        self.scene.get_or_init(|| self.begin())
    }

    /// Prepares Embree's scene for building.
    #[cold]
    fn begin(&self) -> Result<JointCommit<Query>, embree::Error> {
        let mut builder = SceneBuilder::new(&self.context.device)?;
        for placements in &self.placements {
            placements.attach_instances(&mut builder)?;
        }
        let mut to = Attaching {
            prototype_ref: &self.prototype_ref,
            layout: self.context.layout,
            threads: self.context.threads,
            builder: &mut builder,
        };
        attach_all(&self.members, &mut to)?;
        for placements in &self.placements {
            if placements.reached.called_back.len() > 0 {
                builder.attach_user(Arc::clone(placements))?;
            }
        }
        Ok(builder.into_joint())
    }

    /// The coherence that Embree may assume. Its traversal of coherent packets never ends in
    /// some scenes with instances (Embree 3.13.5 of Debian 12, with AVX-512), and it relies on
    /// the signs of small components of directions, which the frame controls but an instance
    /// does not.
    fn coherence(&self) -> Coherence {
        let mut placements = self.placements.iter();
        let has_instances = placements.any(|one| one.has_instances());
        if has_instances {
            Coherence::Incoherent
        } else {
            Coherence::Coherent
        }
    }

    /// The number of instances in the Embree scene.
    pub fn instances(&self) -> u64 {
        let placements = self.placements.iter().filter(|_| self.is_begun());
        placements.map(|one| one.instance_count()).sum()
    }

    /// The bytes stored for the members, in addition to the description and Embree's tree.
    pub fn kept_bytes(&self) -> usize {
        let blocks = if self.is_begun() {
            kept_blocks_bytes(&self.members, self.context.layout)
        } else {
            0
        };
        self.members.bytes() + blocks
    }

    /// Traces a ray for the hits that `query` keeps.
    pub fn search(&self, ray: &LocalRay, query: &mut Query) {
        if let Some((level, ray32)) = query.enter(&self.frame, ray) {
            query.within(self.prototype, level, |query| {
                self.scene().closest(&ray32, query);
            });
        }
    }

    /// Whether anything is hit.
    pub fn occluded(&self, ray: &LocalRay, query: &mut Query) -> bool {
        let Some((level, ray32)) = query.enter(&self.frame, ray) else {
            return false;
        };
        query.within(self.prototype, level, |query| {
            self.scene().any(&ray32, query)
        })
    }

    /// Traces rays of a packet that was brought here for their first hits. Returns the rays
    /// with a nearer first hit.
    pub fn search_packet(&self, rays: RaySet, packet: &mut Packet) -> RaySet {
        let PacketEntry { rays32, entered } = packet.enter(&self.frame, rays);
        let before: [f64; GREATEST_PACKET] = std::array::from_fn(|ray| packet.bound(ray));
        if stays_packet(entered, packet) {
            packet.within(self.prototype, |packet| {
                let (scene, width) = (self.scene(), self.context.packet_width());
                scene.closest_packet(&rays32, entered, width, self.coherence(), packet);
            });
        } else {
            self.for_each_alone(entered, packet, |scene, ray, query| {
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

    /// The rays of a packet that hit anything.
    pub fn occluded_packet(&self, rays: RaySet, packet: &mut Packet) -> RaySet {
        let PacketEntry { rays32, entered } = packet.enter(&self.frame, rays);
        if stays_packet(entered, packet) {
            return packet.within(self.prototype, |packet| {
                let (scene, width) = (self.scene(), self.context.packet_width());
                scene.any_packet(&rays32, entered, width, self.coherence(), packet)
            });
        }
        let mut blocked = RaySet::EMPTY;
        self.for_each_alone(entered, packet, |scene, ray, query| {
            if scene.any(&rays32.ray(ray), query) {
                blocked.insert(ray);
            }
        });
        blocked
    }

    /// Traces rays of a packet one by one.
    fn for_each_alone(
        &self,
        rays: RaySet,
        packet: &mut Packet,
        mut trace: impl FnMut(&embree::Scene<Query>, usize, &mut Query),
    ) {
        for ray in rays {
            packet.alone(self.prototype, ray, |query| {
                trace(self.scene(), ray, query);
            });
        }
    }

    /// As [`Group::search`], but visits every primitive for any ray: it tests neither boxes nor
    /// spheres.
    pub fn search_exhaustively(&self, ray: &LocalRay, query: &mut Query) {
        let level = self.frame.enter_unseen(ray);
        query.within(self.prototype, level, |query| self.visit_all(query));
    }

    /// Visits every primitive.
    fn visit_all(&self, query: &mut Query) {
        let solids = &self.prototype_ref.prototype().solids;
        for (kind, numbers) in self.members.solids() {
            with_solid_kind!(kind, S => for record in numbers.iter() {
                let solid = S::list(solids).solid(record as usize);
                query.visit::<S>(solid.borrow(), &self.prototype_ref, record);
            });
        }
        for placements in &self.placements {
            for number in placements.all.iter() {
                placements.visit(number, query, Self::search_exhaustively);
            }
        }
    }
}
