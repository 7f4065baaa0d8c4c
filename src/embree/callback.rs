//! The functions that Embree calls for a user geometry during a query.
//!
//! They find the state of the query in the context, turn lanes into rays, and
//! hand both to the methods of [`UserGeometry`]. Each is compiled once for every
//! set of instructions that there is reason to tell apart, so that a geometry's
//! methods, if they are `#[inline(always)]`, become code for that set; which one
//! Embree calls is settled when the geometry is made.
//!
//! A closure would not do for a body here: it is a function of its own, compiled
//! for the least set unless the compiler chooses to inline it.

use super::abort::AbortOnPanic;
use super::isa::MaxIsa;
use super::query::Query;
use super::ray_set::{GREATEST_PACKET, RaySet};
use super::sys::{self, word};
use super::user::{Registered, UserGeometry};

/// The callbacks of one geometry type for one instruction set.
#[derive(Clone, Copy)]
pub(super) struct Callbacks {
    pub intersect: unsafe extern "C" fn(*const sys::RTCIntersectFunctionNArguments),
    pub occluded: unsafe extern "C" fn(*const sys::RTCOccludedFunctionNArguments),
}

impl Callbacks {
    /// The callbacks for the instruction set that Embree uses, which the
    /// processor has; `None` is one that goes by no name.
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

/// A module with the callbacks, compiled with the features that it names.
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
                // SAFETY: the caller's promises are those that are asked for.
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

type Packet<G> = <<G as UserGeometry>::Query as Query>::Packet;

/// Embree's intersect callback.
///
/// # Safety
/// Invariants 2, 3, 4 and 7 hold for `args` and geometries of type `G`.
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
    if !context.is_packet {
        assert_eq!(args.N, 1, "a single ray has one lane");
        let guard = AbortOnPanic::new("intersect");
        // SAFETY: invariant 4: behind Embree's part of the context is the query.
        let query = unsafe { &mut *context.query.cast::<G::Query>() };
        let hit = geometry.intersect(args.primID, query);
        guard.passed();
        // SAFETY: invariant 7: one mask a lane.
        unsafe { *args.valid = -i32::from(hit.is_some()) };
        let Some(t_far) = hit else { return };
        // SAFETY: invariant 7: the components stand where `sys::word` says, which
        // is asserted there for one lane; every component is a 32-bit word, all
        // bits of which are allowed in f32 as in u32.
        unsafe {
            let end = words.add(word::RAY_T_FAR).cast::<f32>();
            *end = (*end).min(t_far);
            for component in word::HIT_NORMAL_X..=word::HIT_V {
                *words.add(component) = 0;
            }
            *words.add(word::HIT_PRIMITIVE) = args.primID;
            *words.add(word::HIT_GEOMETRY) = args.geomID;
            // A hit in an instance may have been there before.
            for (level, &instance) in context.embree.instID.iter().enumerate() {
                *words.add(word::HIT_INSTANCE + level) = instance;
            }
        }
        return;
    }
    // SAFETY: invariant 4: the query of a packet is the packet's state.
    let packet = unsafe { &mut *context.query.cast::<Packet<G>>() };
    let (valid, primitive, id) = (args.valid, args.primID, args.geomID);
    // SAFETY: invariant 7: `N` lanes, of which Embree has these numbers.
    unsafe {
        match args.N {
            1 => intersect_lanes::<G, 1>(geometry, valid, words, primitive, id, packet),
            4 => intersect_lanes::<G, 4>(geometry, valid, words, primitive, id, packet),
            8 => intersect_lanes::<G, 8>(geometry, valid, words, primitive, id, packet),
            16 => intersect_lanes::<G, 16>(geometry, valid, words, primitive, id, packet),
            lanes => unknown_width("intersect_packet", lanes),
        }
    }
}

/// The part of a packet that Embree calls back for, intersected.
///
/// # Safety
/// Invariant 7: there are `N` masks and `N` lanes of rays and hits.
#[inline(always)]
unsafe fn intersect_lanes<G: UserGeometry, const N: usize>(
    geometry: &G,
    valid: *mut i32,
    words: *mut u32,
    primitive: u32,
    geometry_id: u32,
    packet: &mut Packet<G>,
) {
    // SAFETY: the caller's promise.
    let lanes = unsafe { Lanes::<N>::read(valid, words) };
    let rays = lanes.rays();
    let mut t_far = lanes.t_far_of_rays();
    let guard = AbortOnPanic::new("intersect_packet");
    let hits = geometry.intersect_packet(primitive, rays, &mut t_far, packet) & rays;
    guard.passed();

    // SAFETY: the caller's promise, here and below; alignment is that of words.
    let valid = unsafe { &mut *valid.cast::<[i32; N]>() };
    if hits.is_empty() {
        *valid = [0; N];
        return;
    }
    let hit = lanes.masks(hits);
    let found = lanes.t_far_of_lanes(&t_far);
    *valid = hit;
    // SAFETY: as above; these are three different components.
    let (ends, primitives, geometries) = unsafe {
        (
            &mut *words.add(word::RAY_T_FAR * N).cast::<[f32; N]>(),
            &mut *words.add(word::HIT_PRIMITIVE * N).cast::<[u32; N]>(),
            &mut *words.add(word::HIT_GEOMETRY * N).cast::<[u32; N]>(),
        )
    };
    for lane in 0..N {
        let is_hit = hit[lane] != 0;
        let is_nearer = is_hit & (found[lane] < ends[lane]);
        ends[lane] = if is_nearer { found[lane] } else { ends[lane] };
        primitives[lane] = if is_hit { primitive } else { primitives[lane] };
        geometries[lane] = if is_hit {
            geometry_id
        } else {
            geometries[lane]
        };
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
    if !context.is_packet {
        assert_eq!(args.N, 1, "a single ray has one lane");
        let guard = AbortOnPanic::new("occluded");
        // SAFETY: invariant 4, as in `intersect`.
        let query = unsafe { &mut *context.query.cast::<G::Query>() };
        let hit = geometry.occluded(args.primID, query);
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
    let (valid, primitive) = (args.valid, args.primID);
    // SAFETY: invariant 7, as in `intersect`.
    unsafe {
        match args.N {
            1 => occluded_lanes::<G, 1>(geometry, valid, words, primitive, packet),
            4 => occluded_lanes::<G, 4>(geometry, valid, words, primitive, packet),
            8 => occluded_lanes::<G, 8>(geometry, valid, words, primitive, packet),
            16 => occluded_lanes::<G, 16>(geometry, valid, words, primitive, packet),
            lanes => unknown_width("occluded_packet", lanes),
        }
    }
}

/// The part of a packet that Embree calls back for, asked for any hit.
///
/// # Safety
/// As [`intersect_lanes`], without hits.
#[inline(always)]
unsafe fn occluded_lanes<G: UserGeometry, const N: usize>(
    geometry: &G,
    valid: *mut i32,
    words: *mut u32,
    primitive: u32,
    packet: &mut Packet<G>,
) {
    // SAFETY: the caller's promise.
    let lanes = unsafe { Lanes::<N>::read(valid, words) };
    let rays = lanes.rays();
    let guard = AbortOnPanic::new("occluded_packet");
    let hits = geometry.occluded_packet(primitive, rays, packet) & rays;
    guard.passed();

    let hit = lanes.masks(hits);
    // SAFETY: the caller's promise, as in `intersect_lanes`.
    unsafe { *valid.cast::<[i32; N]>() = hit };
    // SAFETY: as above.
    let ends = unsafe { &mut *words.add(word::RAY_T_FAR * N).cast::<[f32; N]>() };
    for lane in 0..N {
        let is_hit = hit[lane] != 0;
        ends[lane] = if is_hit {
            f32::NEG_INFINITY
        } else {
            ends[lane]
        };
    }
}

/// Ends the process: no Embree that is known has packets of that width.
#[cold]
fn unknown_width(callback: &'static str, lanes: u32) -> ! {
    let _guard = AbortOnPanic::new(callback);
    panic!("Embree called back with {lanes} lanes");
}

/// The lanes of a callback, and which rays they are of.
struct Lanes<const N: usize> {
    /// Bit `i` tells whether lane `i` is active.
    active: u32,
    id: [u32; N],
    t_far: [f32; N],
    /// Where the lanes are rays in a row, the number of the first one. Embree's
    /// widest code leaves them so, and then there is nothing to move.
    first: Option<usize>,
}

impl<const N: usize> Lanes<N> {
    /// # Safety
    /// Invariant 7: there are `N` masks and `N` lanes of rays.
    #[inline(always)]
    unsafe fn read(valid: *const i32, words: *const u32) -> Self {
        // SAFETY: the caller's promise; alignment is that of words.
        let (valid, t_near, t_far, id) = unsafe {
            (
                *valid.cast::<[i32; N]>(),
                *words.add(word::RAY_T_NEAR * N).cast::<[f32; N]>(),
                *words.add(word::RAY_T_FAR * N).cast::<[f32; N]>(),
                *words.add(word::RAY_ID * N).cast::<[u32; N]>(),
            )
        };
        let (mut active, mut in_a_row) = (0, true);
        for lane in 0..N {
            let is_active = (valid[lane] == -1) & (t_far[lane] >= t_near[lane]);
            active |= u32::from(is_active) << lane;
            in_a_row &= id[lane] == id[0].wrapping_add(lane as u32);
        }
        let first = id[0] as usize;
        Self {
            active,
            id,
            t_far,
            first: (in_a_row && first <= GREATEST_PACKET - N).then_some(first),
        }
    }

    /// The ray of a lane; the query that made the lanes numbered them.
    #[inline(always)]
    fn ray(&self, lane: usize) -> usize {
        self.id[lane] as usize % GREATEST_PACKET
    }

    #[inline(always)]
    fn is_active(&self, lane: usize) -> bool {
        self.active >> lane & 1 != 0
    }

    /// The rays of the active lanes.
    #[inline(always)]
    fn rays(&self) -> RaySet {
        if let Some(first) = self.first {
            return RaySet::from_bits((self.active << first) as u16);
        }
        let of_lane = |lane| u16::from(self.is_active(lane)) << self.ray(lane);
        RaySet::from_bits((0..N).fold(0, |bits, lane| bits | of_lane(lane)))
    }

    /// The ends of the rays, minus infinity for those without an active lane.
    #[inline(always)]
    fn t_far_of_rays(&self) -> [f32; GREATEST_PACKET] {
        let mut t_far = [f32::NEG_INFINITY; GREATEST_PACKET];
        if let Some(first) = self.first {
            t_far[first..first + N].copy_from_slice(&self.t_far);
            return t_far;
        }
        for lane in (0..N).filter(|&lane| self.is_active(lane)) {
            t_far[self.ray(lane)] = self.t_far[lane];
        }
        t_far
    }

    /// The ends of the lanes' rays.
    #[inline(always)]
    fn t_far_of_lanes(&self, of_rays: &[f32; GREATEST_PACKET]) -> [f32; N] {
        let mut t_far = [f32::NEG_INFINITY; N];
        if let Some(first) = self.first {
            t_far.copy_from_slice(&of_rays[first..first + N]);
            return t_far;
        }
        for lane in 0..N {
            t_far[lane] = of_rays[self.ray(lane)];
        }
        t_far
    }

    /// Embree's masks of the active lanes whose rays are in `hits`.
    #[inline(always)]
    fn masks(&self, hits: RaySet) -> [i32; N] {
        let bits = u32::from(hits.bits());
        let mut masks = [0; N];
        for (lane, mask) in masks.iter_mut().enumerate() {
            let ray = match self.first {
                Some(first) => first + lane,
                None => self.ray(lane),
            };
            let is_hit = self.active >> lane & bits >> ray & 1;
            *mask = -(is_hit as i32);
        }
        masks
    }
}
