//! Geometry whose primitives are bounded and intersected in Rust.
//!
//! Embree calls the functions that are registered here with a pointer to the user
//! data: `bounds` of `attach_user` while a scene is built, those of [`callback`](super::callback)
//! while a ray or a packet of rays is traced.

use std::sync::atomic::{AtomicU32, Ordering};

use super::geometry::UserData;
use super::packet::Rays32;
use super::query::Query;
use super::ray::{Box32, Ray32};
use super::ray_set::{GREATEST_PACKET, RaySet};
use super::types::GeometryId;

/// What Embree calls back for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reached {
    /// The number of the primitive.
    pub primitive: u32,
    /// The instance that the geometry's scene is reached in.
    pub instance: Option<GeometryId>,
}

/// Primitives that Rust code bounds and intersects.
///
/// All methods may be called on any thread and at the same time. A panic in
/// one of them ends the process with a message that names it.
///
/// The four methods that answer rays are called from code that is compiled for
/// the processor's instruction set. What they do becomes part of it as far as it
/// is `#[inline(always)]`, and not in a closure.
pub trait UserGeometry: Send + Sync + 'static {
    /// The state of a query, which callbacks read and write: the ray in full
    /// precision, and the best hit so far.
    type Query: Query;

    /// How many primitives there are. Asked once.
    fn primitive_count(&self) -> u32;

    /// A box around a primitive, conservative for the rays that will be
    /// traced. Embree may ask several times, on its own threads, while the
    /// scene is committed.
    fn bounds(&self, primitive: u32) -> Box32;

    /// Intersects the query's ray with a primitive whose box it may meet. `ray` is
    /// Embree's own, in the space of the scene that the geometry is attached to; it ends
    /// where the hits so far have left it.
    /// `Some(t_far)` accepts a hit and shortens Embree's ray, so that boxes
    /// beyond it are left out; a greater or NaN `t_far` does not change the
    /// ray. `None` is no hit. The query may be passed on to another scene.
    fn intersect(&self, at: Reached, ray: &Ray32, query: &mut Self::Query) -> Option<f32>;

    /// Whether a primitive ends the query, in [`Scene::any`](super::Scene::any).
    fn occluded(&self, at: Reached, ray: &Ray32, query: &mut Self::Query) -> bool;

    /// Intersects rays of a packet with a primitive, each as
    /// [`intersect`](Self::intersect) does. A hit is accepted for the rays that
    /// are in the answer, for which `t_far` then has their ends, by their
    /// numbers; what it has before, and for other rays, has no meaning.
    ///
    /// `rays32` has Embree's own rays by their numbers, as the `ray` of
    /// [`intersect`](Self::intersect) is; the numbers of other rays have no meaning.
    ///
    /// `rays` may be any part of the packet. It need not contain all rays that may
    /// meet the box: for the others this is called again. And it may contain rays
    /// that do not meet the box, or end before it: Embree calls for all when one
    /// does.
    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut <Self::Query as Query>::Packet,
    ) -> RaySet;

    /// For which of `rays` a primitive ends the query, in
    /// [`Scene::any_packet`](super::Scene::any_packet). Here `rays` commonly
    /// contains all rays of the packet that have not ended yet, wherever they go.
    fn occluded_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        packet: &mut <Self::Query as Query>::Packet,
    ) -> RaySet;
}

/// What the data pointer of a geometry points to.
pub(super) struct Registered<G> {
    pub geometry: G,
    /// The least refused primitive; `u32::MAX`, which is none, if there is none.
    pub refused: AtomicU32,
}

impl<G: UserGeometry> UserData for Registered<G> {
    fn refused(&self) -> Option<u32> {
        Some(self.refused.load(Ordering::Relaxed)).filter(|&primitive| primitive != u32::MAX)
    }
}
