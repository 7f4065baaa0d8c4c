//! Packets: up to sixteen rays that Embree traverses together.
//!
//! A packet's rays are stored by component, and go to Embree in groups of 4, 8 or 16 *lanes*. A
//! lane is not always its ray: on a processor without Embree's wide code, Embree splits a group
//! or gathers its lanes anew, and some of those paths test only a ray's range. So each lane
//! carries the number of its ray, and a lane without a ray has an empty range.

use std::array;
use std::mem::offset_of;
use std::ptr;

use super::query::Query;
use super::ray::{NativeHit, Ray32};
use super::ray_set::{GREATEST_PACKET, RaySet};
use super::scene::Scene;
use super::sys::{self, word};
use super::types::{GeometryId, PacketWidth};

/// What Embree assumes about the rays of a packet. It affects speed alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coherence {
    /// The rays may have any directions.
    Incoherent,
    /// The rays are coherent: they start near each other and have similar directions.
    Coherent,
}

/// The rays of a packet by component, under the conditions of [`Ray32`]. They start at `t = 0`.
/// The values of inactive rays do not matter.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Rays32 {
    /// The points at `t = 0`, x, y and z.
    pub origin: [[f32; GREATEST_PACKET]; 3],
    /// The directions, x, y and z.
    pub direction: [[f32; GREATEST_PACKET]; 3],
    /// Where the rays end.
    pub t_far: [f32; GREATEST_PACKET],
}

impl Rays32 {
    /// One of the rays.
    #[must_use]
    pub fn ray(&self, number: usize) -> Ray32 {
        Ray32 {
            origin: array::from_fn(|axis| self.origin[axis][number]),
            direction: array::from_fn(|axis| self.direction[axis][number]),
            t_near: 0.0,
            t_far: self.t_far[number],
        }
    }

    /// The rays of a set whose range is not empty.
    #[inline]
    fn not_empty(&self, rays: RaySet) -> RaySet {
        let bits = (0..GREATEST_PACKET).fold(0, |bits, number| {
            bits | u16::from(self.t_far[number] >= 0.0) << number
        });
        rays & RaySet::from_bits(bits)
    }
}

/// One mask per lane, aligned for every width.
#[repr(C, align(64))]
struct Valid<const N: usize>([i32; N]);

/// Embree's `RTCRay4`, `RTCRay8` or `RTCRay16`, aligned for the widest.
#[repr(C, align(64))]
struct RayLanes<const N: usize> {
    origin: [[f32; N]; 3],
    t_near: [f32; N],
    direction: [[f32; N]; 3],
    time: [f32; N],
    t_far: [f32; N],
    mask: [u32; N],
    id: [u32; N],
    flags: [u32; N],
}

impl<const N: usize> RayLanes<N> {
    /// Fills a lane with a valid ray of an empty range.
    #[inline]
    fn make_empty(&mut self, lane: usize) {
        for axis in 0..3 {
            self.origin[axis][lane] = 0.0;
            self.direction[axis][lane] = 1.0;
        }
        self.t_far[lane] = f32::NEG_INFINITY;
    }
}

/// The number of instance words of a hit, which depends on how Embree was configured. The other
/// seven words are fixed.
const INSTANCE_WORDS: usize = size_of::<sys::RTCHit4>() / size_of::<[u32; 4]>() - 7;

/// Embree's `RTCRayHit4`, `RTCRayHit8` or `RTCRayHit16`.
#[repr(C)]
struct RayHitLanes<const N: usize> {
    rays: RayLanes<N>,
    normal: [[f32; N]; 3],
    u: [f32; N],
    v: [f32; N],
    primitive: [u32; N],
    geometry: [u32; N],
    instance: [[u32; N]; INSTANCE_WORDS],
}

impl<const N: usize> RayHitLanes<N> {
    /// The hit of a lane with a hit.
    #[inline]
    fn hit(&self, lane: usize) -> NativeHit {
        let instance = self.instance[0][lane];
        NativeHit {
            t: self.rays.t_far[lane],
            normal: array::from_fn(|axis| self.normal[axis][lane]),
            u: self.u[lane],
            v: self.v[lane],
            primitive: self.primitive[lane],
            geometry: GeometryId(self.geometry[lane]),
            instance: (instance != sys::INVALID_ID).then_some(GeometryId(instance)),
        }
    }
}

/// Asserts at compile time that the layouts of a width are Embree's.
macro_rules! assert_layout {
    ($lanes:literal, $ray:ident, $hit:ident, $rayhit:ident) => {
        const _: () = {
            type Ours = RayHitLanes<$lanes>;
            const LANE: usize = 4 * $lanes;
            let hit = offset_of!(sys::$rayhit, hit);
            assert!(size_of::<RayLanes<$lanes>>() == size_of::<sys::$ray>());
            assert!(size_of::<Ours>() >= size_of::<sys::$rayhit>());
            assert!(align_of::<Ours>() % align_of::<sys::$rayhit>() == 0);
            assert!(offset_of!(sys::$ray, tnear) == word::RAY_T_NEAR * LANE);
            assert!(offset_of!(sys::$ray, tfar) == word::RAY_T_FAR * LANE);
            assert!(offset_of!(sys::$ray, id) == word::RAY_ID * LANE);
            assert!(hit + offset_of!(sys::$hit, primID) == word::HIT_PRIMITIVE * LANE);
            assert!(hit + offset_of!(sys::$hit, geomID) == word::HIT_GEOMETRY * LANE);
            assert!(hit + offset_of!(sys::$hit, instID) == word::HIT_INSTANCE * LANE);
            assert!(offset_of!(Ours, rays.direction) == offset_of!(sys::$ray, dir_x));
            assert!(offset_of!(Ours, rays.t_near) == word::RAY_T_NEAR * LANE);
            assert!(offset_of!(Ours, rays.t_far) == word::RAY_T_FAR * LANE);
            assert!(offset_of!(Ours, rays.mask) == offset_of!(sys::$ray, mask));
            assert!(offset_of!(Ours, rays.id) == word::RAY_ID * LANE);
            assert!(offset_of!(Ours, geometry) == word::HIT_GEOMETRY * LANE);
            assert!(offset_of!(Ours, instance) == word::HIT_INSTANCE * LANE);
        };
    };
}

assert_layout!(4, RTCRay4, RTCHit4, RTCRayHit4);
assert_layout!(8, RTCRay8, RTCHit8, RTCRayHit8);
assert_layout!(16, RTCRay16, RTCHit16, RTCRayHit16);

/// The rays `first` to `first + N - 1` of a packet, and which of them are active.
struct Group<const N: usize> {
    first: usize,
    active: RaySet,
}

impl<const N: usize> Group<N> {
    /// The groups of a packet that have active rays.
    #[inline]
    fn all(active: RaySet) -> impl Iterator<Item = Self> {
        (0..GREATEST_PACKET)
            .step_by(N)
            .map(move |first| Self {
                first,
                active: active & RaySet::from_bits(RaySet::first(N).bits() << first),
            })
            .filter(|group| !group.active.is_empty())
    }

    #[inline]
    fn is_active(&self, lane: usize) -> bool {
        self.active.bits() >> (self.first + lane) & 1 != 0
    }

    /// A component of the lanes.
    #[inline]
    fn component(&self, rays: &[f32; GREATEST_PACKET]) -> [f32; N] {
        let mut lanes = [0.0; N];
        lanes.copy_from_slice(&rays[self.first..self.first + N]);
        lanes
    }

    #[inline]
    fn valid(&self) -> Valid<N> {
        Valid(array::from_fn(|lane| -i32::from(self.is_active(lane))))
    }

    /// The lanes. Inactive lanes have a valid ray of an empty range.
    #[inline]
    fn ray_lanes(&self, rays: &Rays32) -> RayLanes<N> {
        debug_assert!(
            self.active
                .into_iter()
                .all(|number| rays.ray(number).is_legal()),
            "Embree would abort on one of {rays:?}"
        );
        let [x, y, z] = &rays.origin;
        let [along_x, along_y, along_z] = &rays.direction;
        let mut lanes = RayLanes {
            origin: [self.component(x), self.component(y), self.component(z)],
            t_near: [0.0; N],
            direction: [
                self.component(along_x),
                self.component(along_y),
                self.component(along_z),
            ],
            time: [0.0; N],
            t_far: self.component(&rays.t_far),
            mask: [u32::MAX; N],
            id: [0; N],
            flags: [0; N],
        };
        for lane in 0..N {
            lanes.id[lane] = (self.first + lane) as u32;
            if !self.is_active(lane) {
                lanes.make_empty(lane);
            }
        }
        lanes
    }

    #[inline]
    fn ray_hit_lanes(&self, rays: &Rays32) -> RayHitLanes<N> {
        RayHitLanes {
            rays: self.ray_lanes(rays),
            normal: [[0.0; N]; 3],
            u: [0.0; N],
            v: [0.0; N],
            primitive: [sys::INVALID_ID; N],
            geometry: [sys::INVALID_ID; N],
            instance: [[sys::INVALID_ID; N]; INSTANCE_WORDS],
        }
    }
}

impl<Q: Query> Scene<Q> {
    /// Traverses the scene for the closest hits of the `active` rays of a packet. User
    /// geometries store their results in `packet`; hits that Embree finds itself are not
    /// reported. A ray with an empty range is a miss.
    ///
    /// The result does not depend on `width` and `coherence`;
    /// [`Device::packet_width`](super::Device::packet_width) is the greatest width that Embree
    /// does not split.
    ///
    /// # Panics
    /// When the installed Embree was built without packets (`packet_width` is `None`).
    #[inline]
    pub fn closest_packet(
        &self,
        rays: &Rays32,
        active: RaySet,
        width: PacketWidth,
        coherence: Coherence,
        packet: &mut Q::Packet,
    ) {
        self.closest_native_packet(rays, active, width, coherence, packet, |_, _| {});
    }

    /// The closest hits as Embree reports them, each passed to `report` with the
    /// number of its ray.
    ///
    /// # Panics
    /// As [`closest_packet`](Self::closest_packet).
    #[inline]
    pub fn closest_native_packet(
        &self,
        rays: &Rays32,
        active: RaySet,
        width: PacketWidth,
        coherence: Coherence,
        packet: &mut Q::Packet,
        report: impl FnMut(usize, NativeHit),
    ) {
        match width {
            PacketWidth::Four => self.intersect::<4>(rays, active, coherence, packet, report),
            PacketWidth::Eight => self.intersect::<8>(rays, active, coherence, packet, report),
            PacketWidth::Sixteen => self.intersect::<16>(rays, active, coherence, packet, report),
        }
    }

    /// Traverses the scene until each of the `active` rays of a packet has hit anything.
    /// Returns the rays with a hit.
    ///
    /// # Panics
    /// As [`closest_packet`](Self::closest_packet).
    #[inline]
    pub fn any_packet(
        &self,
        rays: &Rays32,
        active: RaySet,
        width: PacketWidth,
        coherence: Coherence,
        packet: &mut Q::Packet,
    ) -> RaySet {
        match width {
            PacketWidth::Four => self.occluded::<4>(rays, active, coherence, packet),
            PacketWidth::Eight => self.occluded::<8>(rays, active, coherence, packet),
            PacketWidth::Sixteen => self.occluded::<16>(rays, active, coherence, packet),
        }
    }

    fn intersect<const N: usize>(
        &self,
        rays: &Rays32,
        active: RaySet,
        coherence: Coherence,
        packet: &mut Q::Packet,
        mut report: impl FnMut(usize, NativeHit),
    ) {
        self.assert_packets();
        for group in Group::<N>::all(rays.not_empty(active)) {
            let valid = group.valid();
            let mut lanes = group.ray_hit_lanes(rays);
            // SAFETY: invariants 1, 4, 5 and 6; the lanes and masks are `N`.
            unsafe {
                sys::cyltrace_intersect_packet(
                    N as u32,
                    valid.0.as_ptr(),
                    self.raw(),
                    (&raw mut lanes).cast(),
                    ptr::from_mut(packet).cast(),
                    coherence == Coherence::Coherent,
                );
            }
            for lane in 0..N {
                if group.is_active(lane) && lanes.geometry[lane] != sys::INVALID_ID {
                    report(group.first + lane, lanes.hit(lane));
                }
            }
        }
    }

    fn occluded<const N: usize>(
        &self,
        rays: &Rays32,
        active: RaySet,
        coherence: Coherence,
        packet: &mut Q::Packet,
    ) -> RaySet {
        self.assert_packets();
        let mut blocked = RaySet::EMPTY;
        for group in Group::<N>::all(rays.not_empty(active)) {
            let valid = group.valid();
            let mut lanes = group.ray_lanes(rays);
            // SAFETY: as in `intersect`.
            unsafe {
                sys::cyltrace_occluded_packet(
                    N as u32,
                    valid.0.as_ptr(),
                    self.raw(),
                    (&raw mut lanes).cast(),
                    ptr::from_mut(packet).cast(),
                    coherence == Coherence::Coherent,
                );
            }
            let ended = (0..N).fold(0, |bits, lane| {
                bits | u16::from(lanes.t_far[lane] == f32::NEG_INFINITY) << lane
            });
            blocked = blocked | (group.active & RaySet::from_bits(ended << group.first));
        }
        blocked
    }

    #[inline]
    fn assert_packets(&self) {
        assert!(
            self.device().packet_width().is_some(),
            "the installed Embree traces no packets"
        );
    }
}
