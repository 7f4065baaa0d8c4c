//! The functions that Embree calls for a user geometry during a query.
//!
//! Each callback takes the state of the query from the context, turns lanes into rays, and
//! passes both to a method of [`UserGeometry`]. The callbacks are compiled once for each
//! instruction set that is worth a copy of the code. A geometry's methods become code for that
//! set if they are `#[inline(always)]`. The geometry gets one set of callbacks when it is
//! created.
//!
//! No body here is a closure: a closure is a function of its own, compiled for the baseline
//! unless the compiler chooses to inline it.

use super::abort::AbortOnPanic;
use super::callback_lanes::Lanes;
use super::isa::MaxIsa;
use super::query::Query;
use super::ray::Ray32;
use super::ray_set::GREATEST_PACKET;
use super::sys::{self, word};
use super::types::GeometryId;
use super::user::{Reached, Registered, UserGeometry};

/// The callbacks of one geometry type for one instruction set.
#[derive(Clone, Copy)]
pub(super) struct Callbacks {
    pub intersect: unsafe extern "C" fn(*const sys::RTCIntersectFunctionNArguments),
    pub occluded: unsafe extern "C" fn(*const sys::RTCOccludedFunctionNArguments),
}

impl Callbacks {
    /// The callbacks for the instruction set that Embree uses, which the processor supports.
    /// `None` is an unnamed set.
    pub fn of<G: UserGeometry>(isa: Option<MaxIsa>) -> Self {
        #[cfg(target_arch = "x86_64")]
        if isa >= Some(MaxIsa::Avx512) {
            return avx512::callbacks::<G>();
        } else if isa >= Some(MaxIsa::Avx2) {
            return avx2::callbacks::<G>();
        }
        baseline::callbacks::<G>()
    }
}

/// Defines a module with the callbacks, compiled with the given features.
macro_rules! callbacks {
    ($set:ident $(, $feature:meta)?) => {
        mod $set {
            use super::*;

            pub fn callbacks<G: UserGeometry>() -> Callbacks {
                Callbacks {
                    intersect: intersect::<G>,
                    occluded: occluded::<G>,
                }
            }

            $(#[$feature])?
            unsafe extern "C" fn intersect<G: UserGeometry>(
                args: *const sys::RTCIntersectFunctionNArguments,
            ) {
                // SAFETY: the caller promises what the callee requires.
                unsafe { super::intersect::<G>(args) }
            }

            $(#[$feature])?
            unsafe extern "C" fn occluded<G: UserGeometry>(
                args: *const sys::RTCOccludedFunctionNArguments,
            ) {
                // SAFETY: as in `intersect`.
                unsafe { super::occluded::<G>(args) }
            }
        }
    };
}

callbacks!(baseline);
#[cfg(target_arch = "x86_64")]
callbacks!(
    avx2,
    target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,f16c")
);
#[cfg(target_arch = "x86_64")]
callbacks!(
    avx512,
    target_feature(
        enable = "avx512f,avx512dq,avx512cd,avx512bw,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt,f16c"
    )
);

/// The primitive of a callback, and the instance that the context names.
#[inline(always)]
fn reached(primitive: u32, context: &sys::cyltrace_context) -> Reached {
    let instance = context.embree.instID[0];
    Reached {
        primitive,
        instance: (instance != sys::INVALID_ID).then_some(GeometryId(instance)),
    }
}

/// The ray of a callback of one lane.
///
/// # Safety
/// Invariant 7: there is one lane.
#[inline(always)]
unsafe fn ray32(words: *const u32) -> Ray32 {
    // SAFETY: the caller's promise; `sys::word` asserts the layout.
    let ray = unsafe { &*words.cast::<sys::RTCRay>() };
    Ray32 {
        origin: [ray.org_x, ray.org_y, ray.org_z],
        direction: [ray.dir_x, ray.dir_y, ray.dir_z],
        t_near: ray.tnear,
        t_far: ray.tfar,
    }
}

type Packet<G> = <<G as UserGeometry>::Query as Query>::Packet;

/// Embree's intersect callback.
///
/// # Safety
/// Invariants 2, 3, 4 and 7 apply to `args` and geometries of type `G`.
#[inline(always)]
unsafe fn intersect<G: UserGeometry>(args: *const sys::RTCIntersectFunctionNArguments) {
    // SAFETY: invariant 7.
    let args = unsafe { &*args };
    // SAFETY: invariants 2 and 3.
    let geometry = unsafe { &(*args.geometryUserPtr.cast::<Registered<G>>()).geometry };
    // SAFETY: invariant 4: the shim put this context there; Embree does not
    // write to it while the callback runs.
    let context = unsafe { &*args.context.cast::<sys::cyltrace_context>() };
    let words = args.rayhit.cast::<u32>();
    let at = reached(args.primID, context);
    if !context.is_packet {
        assert_eq!(args.N, 1, "a single ray has one lane");
        // SAFETY: invariant 7: one lane.
        let ray = unsafe { ray32(words) };
        let guard = AbortOnPanic::new("intersect");
        // SAFETY: invariant 4: the query follows Embree's part of the context.
        let query = unsafe { &mut *context.query.cast::<G::Query>() };
        let hit = geometry.intersect(at, &ray, query);
        guard.passed();
        // SAFETY: invariant 7: one mask a lane.
        unsafe { *args.valid = -i32::from(hit.is_some()) };
        let Some(t_far) = hit else { return };
        // SAFETY: invariant 7: the components are at the positions in `sys::word`, which are
        // asserted for one lane; every component is a 32-bit word, and any bits are valid as
        // f32 and as u32.
        unsafe {
            let end = words.add(word::RAY_T_FAR).cast::<f32>();
            *end = (*end).min(t_far);
            for component in word::HIT_NORMAL_X..=word::HIT_V {
                *words.add(component) = 0;
            }
            *words.add(word::HIT_PRIMITIVE) = args.primID;
            *words.add(word::HIT_GEOMETRY) = args.geomID;
            // The ray may have a hit in an instance from before.
            for (level, &instance) in context.embree.instID.iter().enumerate() {
                *words.add(word::HIT_INSTANCE + level) = instance;
            }
        }
        return;
    }
    // SAFETY: invariant 4: the query of a packet is the packet's state.
    let packet = unsafe { &mut *context.query.cast::<Packet<G>>() };
    let (valid, id) = (args.valid, args.geomID);
    // SAFETY: invariant 7: `N` lanes, whose numbers are from Embree.
    unsafe {
        match args.N {
            1 => intersect_lanes::<G, 1>(geometry, valid, words, at, id, packet),
            4 => intersect_lanes::<G, 4>(geometry, valid, words, at, id, packet),
            8 => intersect_lanes::<G, 8>(geometry, valid, words, at, id, packet),
            16 => intersect_lanes::<G, 16>(geometry, valid, words, at, id, packet),
            lanes => unknown_width("intersect_packet", lanes),
        }
    }
}

/// Intersects the part of a packet that Embree calls back for.
///
/// # Safety
/// Invariant 7: there are `N` masks and `N` lanes of rays and hits.
#[inline(always)]
unsafe fn intersect_lanes<G: UserGeometry, const N: usize>(
    geometry: &G,
    valid: *mut i32,
    words: *mut u32,
    at: Reached,
    geometry_id: u32,
    packet: &mut Packet<G>,
) {
    // SAFETY: the caller's promise.
    let lanes = unsafe { Lanes::<N>::read(valid, words) };
    let rays = lanes.rays();
    // SAFETY: the caller's promise.
    let rays32 = unsafe { lanes.rays32(words) };
    let mut t_far = [f32::NEG_INFINITY; GREATEST_PACKET];
    let guard = AbortOnPanic::new("intersect_packet");
    let hits = geometry.intersect_packet(at, rays, &rays32, &mut t_far, packet) & rays;
    guard.passed();

    // SAFETY: the caller's promise, here and below; the alignment is that of words.
    let valid = unsafe { &mut *valid.cast::<[i32; N]>() };
    *valid = [0; N];
    // SAFETY: as above; these are three different components.
    let (ends, primitives, geometries) = unsafe {
        (
            &mut *words.add(word::RAY_T_FAR * N).cast::<[f32; N]>(),
            &mut *words.add(word::HIT_PRIMITIVE * N).cast::<[u32; N]>(),
            &mut *words.add(word::HIT_GEOMETRY * N).cast::<[u32; N]>(),
        )
    };
    for ray in hits {
        let lane = lanes.lane(ray);
        valid[lane] = -1;
        ends[lane] = ends[lane].min(t_far[ray]);
        primitives[lane] = at.primitive;
        geometries[lane] = geometry_id;
    }
}

/// Embree's occluded callback.
///
/// # Safety
/// As [`intersect`].
#[inline(always)]
unsafe fn occluded<G: UserGeometry>(args: *const sys::RTCOccludedFunctionNArguments) {
    // SAFETY: invariant 7.
    let args = unsafe { &*args };
    // SAFETY: invariants 2 and 3.
    let geometry = unsafe { &(*args.geometryUserPtr.cast::<Registered<G>>()).geometry };
    // SAFETY: invariant 4, as in `intersect`.
    let context = unsafe { &*args.context.cast::<sys::cyltrace_context>() };
    let words = args.ray.cast::<u32>();
    let at = reached(args.primID, context);
    if !context.is_packet {
        assert_eq!(args.N, 1, "a single ray has one lane");
        // SAFETY: invariant 7: one lane.
        let ray = unsafe { ray32(words) };
        let guard = AbortOnPanic::new("occluded");
        // SAFETY: invariant 4, as in `intersect`.
        let query = unsafe { &mut *context.query.cast::<G::Query>() };
        let hit = geometry.occluded(at, &ray, query);
        guard.passed();
        // SAFETY: invariant 7: one mask a lane.
        unsafe { *args.valid = -i32::from(hit) };
        if hit {
            // SAFETY: invariant 7, as in `intersect`; minus infinity is how
            // Embree marks a ray that is blocked.
            unsafe { *words.add(word::RAY_T_FAR).cast::<f32>() = f32::NEG_INFINITY };
        }
        return;
    }
    // SAFETY: invariant 4, as in `intersect`.
    let packet = unsafe { &mut *context.query.cast::<Packet<G>>() };
    let valid = args.valid;
    // SAFETY: invariant 7, as in `intersect`.
    unsafe {
        match args.N {
            1 => occluded_lanes::<G, 1>(geometry, valid, words, at, packet),
            4 => occluded_lanes::<G, 4>(geometry, valid, words, at, packet),
            8 => occluded_lanes::<G, 8>(geometry, valid, words, at, packet),
            16 => occluded_lanes::<G, 16>(geometry, valid, words, at, packet),
            lanes => unknown_width("occluded_packet", lanes),
        }
    }
}

/// Tests the part of a packet that Embree calls back for, in a query for any hit.
///
/// # Safety
/// As [`intersect_lanes`], without hits.
#[inline(always)]
unsafe fn occluded_lanes<G: UserGeometry, const N: usize>(
    geometry: &G,
    valid: *mut i32,
    words: *mut u32,
    at: Reached,
    packet: &mut Packet<G>,
) {
    // SAFETY: the caller's promise.
    let lanes = unsafe { Lanes::<N>::read(valid, words) };
    let rays = lanes.rays();
    // SAFETY: the caller's promise.
    let rays32 = unsafe { lanes.rays32(words) };
    let guard = AbortOnPanic::new("occluded_packet");
    let hits = geometry.occluded_packet(at, rays, &rays32, packet) & rays;
    guard.passed();

    // SAFETY: the caller's promise, as in `intersect_lanes`.
    let valid = unsafe { &mut *valid.cast::<[i32; N]>() };
    *valid = [0; N];
    // SAFETY: as above.
    let ends = unsafe { &mut *words.add(word::RAY_T_FAR * N).cast::<[f32; N]>() };
    for ray in hits {
        let lane = lanes.lane(ray);
        valid[lane] = -1;
        ends[lane] = f32::NEG_INFINITY;
    }
}

/// Ends the process: no known version of Embree has packets of that width.
#[cold]
fn unknown_width(callback: &'static str, lanes: u32) -> ! {
    let _guard = AbortOnPanic::new(callback);
    panic!("Embree called back with {lanes} lanes");
}
