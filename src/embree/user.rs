//! Geometry whose primitives are bounded and intersected in Rust.
//!
//! Embree calls the three functions below with a pointer to the user data;
//! they find the query in the context and hand both to the trait's methods.
//! They are written for any number of lanes but accept one, until packets are
//! traced.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::abort::AbortOnPanic;
use super::device::Device;
use super::error::Error;
use super::float_mode::with_default_float_mode;
use super::ray::Box32;
use super::scene::GeometryHandle;
use super::sys::{self, word};

/// Primitives that Rust code bounds and intersects.
///
/// All methods may be called on any thread and at the same time. A panic in
/// one of them ends the process with a message that names it.
pub trait UserGeometry: Send + Sync + 'static {
    /// The state of a query, which callbacks read and write: the ray in full
    /// precision, and the best hit so far.
    type Query: 'static;

    /// How many primitives there are. Asked once.
    fn primitive_count(&self) -> u32;

    /// A box around a primitive, conservative for the rays that will be
    /// traced. Embree may ask several times, on its own threads, while the
    /// scene is committed.
    fn bounds(&self, primitive: u32) -> Box32;

    /// Intersects the query's ray with a primitive whose box it may meet.
    /// `Some(t_far)` accepts a hit and shortens Embree's ray, so that boxes
    /// beyond it are left out; a greater or NaN `t_far` does not change the
    /// ray. `None` is no hit. The query may be passed on to another scene.
    fn intersect(&self, primitive: u32, query: &mut Self::Query) -> Option<f32>;

    /// Whether a primitive ends the query, in [`Scene::any`](super::Scene::any).
    fn occluded(&self, primitive: u32, query: &mut Self::Query) -> bool;
}

/// What a scene holds of a user geometry, whatever its type.
pub(super) trait UserData: Send + Sync {
    /// The least primitive whose bounds were not legal.
    fn refused(&self) -> Option<u32>;
}

/// What the data pointer of a geometry points to.
struct Registered<G> {
    geometry: G,
    /// The least refused primitive; `u32::MAX`, which is none, if there is none.
    refused: AtomicU32,
}

impl<G: UserGeometry> UserData for Registered<G> {
    fn refused(&self) -> Option<u32> {
        Some(self.refused.load(Ordering::Relaxed)).filter(|&primitive| primitive != u32::MAX)
    }
}

/// Makes an Embree geometry that calls `geometry`. The data has to outlive the
/// handle and the scene that it is attached to.
pub(super) fn new_user_geometry<G: UserGeometry>(
    device: &Device,
    geometry: G,
) -> Result<(Arc<dyn UserData>, GeometryHandle), Error> {
    let primitives = geometry.primitive_count();
    let data = Arc::new(Registered {
        geometry,
        refused: AtomicU32::new(u32::MAX),
    });
    let handle = GeometryHandle::new(device, sys::RTC_GEOMETRY_TYPE_USER)?;
    let raw = handle.raw();
    // SAFETY: invariants 1, 3 and 5: the pointer and the callbacks are set for
    // the same `G`.
    unsafe {
        sys::rtcSetGeometryUserPrimitiveCount(raw, primitives);
        sys::rtcSetGeometryUserData(raw, Arc::as_ptr(&data).cast_mut().cast());
        sys::rtcSetGeometryBoundsFunction(raw, Some(bounds::<G>), std::ptr::null_mut());
        sys::rtcSetGeometryIntersectFunction(raw, Some(intersect::<G>));
        sys::rtcSetGeometryOccludedFunction(raw, Some(occluded::<G>));
    }
    device.check("set up a user geometry")?;
    Ok((data, handle))
}

unsafe extern "C" fn bounds<G: UserGeometry>(args: *const sys::RTCBoundsFunctionArguments) {
    AbortOnPanic::run("bounds", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        // SAFETY: invariants 2 and 3.
        let data = unsafe { &*args.geometryUserPtr.cast::<Registered<G>>() };
        let mut bounds = with_default_float_mode(|| data.geometry.bounds(args.primID));
        if !bounds.is_legal() {
            // The commit fails for it; until then Embree gets a box it knows
            // how to handle.
            data.refused.fetch_min(args.primID, Ordering::Relaxed);
            bounds = Box32 {
                lower: [0.0; 3],
                upper: [0.0; 3],
            };
        }
        // SAFETY: invariant 7: Embree waits for the box there.
        unsafe { *args.bounds_o = bounds.to_embree() };
    });
}

unsafe extern "C" fn intersect<G: UserGeometry>(args: *const sys::RTCIntersectFunctionNArguments) {
    AbortOnPanic::run("intersect", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        let lanes = args.N as usize;
        assert_eq!(lanes, 1, "only single rays are traced");
        // SAFETY: invariants 2 and 3.
        let data = unsafe { &*args.geometryUserPtr.cast::<Registered<G>>() };
        // SAFETY: invariant 4: the shim put this context there; Embree does not
        // write to it while the callback runs.
        let context = unsafe { &*args.context.cast::<sys::cyltrace_context>() };
        // SAFETY: invariant 4: behind Embree's part of the context is the query.
        let query = unsafe { &mut *context.query.cast() };
        let hit = data.geometry.intersect(args.primID, query);

        let lane = 0;
        // SAFETY: invariant 7: one mask a lane.
        unsafe { *args.valid.add(lane) = if hit.is_some() { -1 } else { 0 } };
        let Some(t_far) = hit else { return };
        let words = args.rayhit.cast::<u32>();
        let slot = |component: usize| {
            // SAFETY: invariant 7: the components stand where `sys::word` says,
            // which is asserted there for one lane.
            unsafe { words.add(component * lanes + lane) }
        };
        // SAFETY: invariant 7; every component is a 32-bit word, all bits of
        // which are allowed in f32 as in u32.
        unsafe {
            let end = slot(word::RAY_T_FAR).cast::<f32>();
            *end = (*end).min(t_far);
            for component in word::HIT_NORMAL_X..=word::HIT_V {
                *slot(component) = 0;
            }
            *slot(word::HIT_PRIMITIVE) = args.primID;
            *slot(word::HIT_GEOMETRY) = args.geomID;
            // A hit in an instance may have been there before.
            for (level, &instance) in context.embree.instID.iter().enumerate() {
                *slot(word::HIT_INSTANCE + level) = instance;
            }
        }
    });
}

unsafe extern "C" fn occluded<G: UserGeometry>(args: *const sys::RTCOccludedFunctionNArguments) {
    AbortOnPanic::run("occluded", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        let lanes = args.N as usize;
        assert_eq!(lanes, 1, "only single rays are traced");
        // SAFETY: invariants 2 and 3.
        let data = unsafe { &*args.geometryUserPtr.cast::<Registered<G>>() };
        // SAFETY: invariant 4, as in `intersect`.
        let query = unsafe { &mut *(*args.context.cast::<sys::cyltrace_context>()).query.cast() };
        let hit = data.geometry.occluded(args.primID, query);

        let lane = 0;
        // SAFETY: invariant 7: one mask a lane.
        unsafe { *args.valid.add(lane) = if hit { -1 } else { 0 } };
        if hit {
            let words = args.ray.cast::<f32>();
            // SAFETY: invariant 7, as in `intersect`; minus infinity is how
            // Embree marks a ray that is blocked.
            unsafe { *words.add(word::RAY_T_FAR * lanes + lane) = f32::NEG_INFINITY };
        }
    });
}
