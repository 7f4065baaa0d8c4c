//! Geometry whose primitives are bounded and intersected in Rust.
//!
//! Embree calls the registered functions with a pointer to the user data: `bounds` of
//! `attach_user` while a scene is built, those of [`callback`](super::callback) while a ray or
//! a packet is traced.

use std::sync::atomic::{AtomicU32, Ordering};

use super::geometry::UserData;
use super::packet::Rays32;
use super::query::Query;
use super::ray::{Box32, Ray32};
use super::ray_set::{GREATEST_PACKET, RaySet};
use super::types::GeometryId;

/// The primitive that Embree calls back for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reached {
    /// The number of the primitive.
    pub primitive: u32,
    /// The instance through which the geometry's scene is reached.
    pub instance: Option<GeometryId>,
}

/// Primitives that Rust code bounds and intersects.
///
/// All methods may be called on any thread, concurrently. A panic in one of them ends the
/// process with a message that names it.
///
/// The four methods for rays are called from code that is compiled for the processor's
/// instruction set. Their code is compiled for it too if it is `#[inline(always)]` and not in a
/// closure.
pub trait UserGeometry: Send + Sync + 'static {
    /// The state of a query, which callbacks read and write: the ray in full
    /// precision, and the best hit so far.
    type Query: Query;

    /// The number of primitives. Called once.
    fn primitive_count(&self) -> u32;

    /// A box around a primitive, conservative for the rays that will be traced. Embree may call
    /// this several times, on its own threads, while the scene is committed.
    fn bounds(&self, primitive: u32) -> Box32;

    /// Intersects the query's ray with a primitive whose box it may intersect. `ray` is
    /// Embree's own, in the space of the scene that the geometry is attached to; it ends at the
    /// closest hit so far.
    ///
    /// `Some(t_far)` accepts a hit and shortens Embree's ray, so that boxes beyond it are
    /// skipped. A greater or NaN `t_far` does not change the ray. `None` is no hit. The query
    /// may be passed on to another scene.
    fn intersect(&self, at: Reached, ray: &Ray32, query: &mut Self::Query) -> Option<f32>;

    /// Whether a primitive blocks the query's ray, in [`Scene::any`](super::Scene::any).
    fn occluded(&self, at: Reached, ray: &Ray32, query: &mut Self::Query) -> bool;

    /// Intersects rays of a packet with a primitive, each as [`intersect`](Self::intersect)
    /// does. Returns the rays with an accepted hit, and sets their ends in `t_far`, indexed by
    /// ray number. The other entries of `t_far` have no meaning, before and after.
    ///
    /// `rays32` contains Embree's own rays, indexed by ray number; they correspond to the `ray`
    /// of [`intersect`](Self::intersect). Entries of other rays have no meaning.
    ///
    /// `rays` may be any subset of the packet. It need not contain all rays that may intersect
    /// the box: this is called again for the others. And it may contain rays that do not
    /// intersect the box, or end before it: Embree calls this for all rays if one does.
    fn intersect_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        t_far: &mut [f32; GREATEST_PACKET],
        packet: &mut <Self::Query as Query>::Packet,
    ) -> RaySet;

    /// The rays that a primitive blocks, in [`Scene::any_packet`](super::Scene::any_packet).
    /// Here `rays` commonly contains all rays of the packet that are not blocked yet, wherever
    /// they are.
    fn occluded_packet(
        &self,
        at: Reached,
        rays: RaySet,
        rays32: &Rays32,
        packet: &mut <Self::Query as Query>::Packet,
    ) -> RaySet;
}

/// The user data of a geometry.
pub(super) struct Registered<G> {
    pub geometry: G,
    /// The least primitive with illegal bounds; `u32::MAX` if there is none.
    pub refused: AtomicU32,
}

impl<G: UserGeometry> UserData for Registered<G> {
    fn refused(&self) -> Option<u32> {
        Some(self.refused.load(Ordering::Relaxed)).filter(|&primitive| primitive != u32::MAX)
    }
}
