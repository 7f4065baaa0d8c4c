//! The lanes in which Embree passes the rays of a packet to a callback.
//!
//! A lane is not always its ray ([`packet`](super::packet)), so the rays are placed by their
//! numbers before a geometry receives them.

use super::packet::Rays32;
use super::ray_set::{GREATEST_PACKET, RaySet};
use super::sys::word;
use crate::math::{LANES, LaneMask};

/// The lanes of a callback, and the numbers of their rays.
pub(super) struct Lanes<const N: usize> {
    /// Bit `i` says whether lane `i` is active.
    active: u32,
    id: [u32; N],
    /// The number of the first ray if the rays are consecutive. Embree's widest code keeps them
    /// so, and then nothing has to be moved.
    first: Option<usize>,
}

impl<const N: usize> Lanes<N> {
    /// The lanes that Embree passes to a callback.
    ///
    /// # Safety
    /// Invariant 7: there are `N` masks and `N` lanes of rays.
    #[inline(always)]
    pub unsafe fn read(valid: *const i32, words: *const u32) -> Self {
        // SAFETY: the caller's promise; the alignment is that of words.
        let (valid, t_near, t_far, id) = unsafe {
            (
                &*valid.cast::<[i32; N]>(),
                &*words.add(word::RAY_T_NEAR * N).cast::<[f32; N]>(),
                &*words.add(word::RAY_T_FAR * N).cast::<[f32; N]>(),
                &*words.add(word::RAY_ID * N).cast::<[u32; N]>(),
            )
        };
        let mut is_active = [LaneMask::splat(false); GREATEST_PACKET / LANES];
        for lane in 0..N {
            is_active[lane / LANES].0[lane % LANES] =
                (valid[lane] == -1) & (t_far[lane] >= t_near[lane]);
        }
        let bits = is_active.map(|mask| u32::from(mask.bits()));
        let active = bits[0] | bits[1] << LANES;
        let mut mismatch = 0;
        for lane in 0..N {
            mismatch |= id[lane] ^ id[0].wrapping_add(lane as u32);
        }
        let first = id[0] as usize;
        Self {
            active,
            id: *id,
            first: (mismatch == 0 && first <= GREATEST_PACKET - N).then_some(first),
        }
    }

    /// The number of a lane's ray, as the query assigned it.
    #[inline(always)]
    fn ray(&self, lane: usize) -> usize {
        self.id[lane] as usize % GREATEST_PACKET
    }

    /// The rays of the active lanes.
    #[inline(always)]
    pub fn rays(&self) -> RaySet {
        if let Some(first) = self.first {
            return RaySet::from_bits((self.active << first) as u16);
        }
        let of_lane = |lane| ((self.active >> lane & 1) as u16) << self.ray(lane);
        RaySet::from_bits((0..N).fold(0, |bits, lane| bits | of_lane(lane)))
    }

    /// Embree's rays, indexed by ray number. Entries of other rays have no meaning.
    ///
    /// # Safety
    /// Invariant 7: there are `N` lanes of rays.
    #[inline(always)]
    pub unsafe fn rays32(&self, words: *const u32) -> Rays32 {
        let mut rays = Rays32 {
            origin: [[0.0; GREATEST_PACKET]; 3],
            direction: [[0.0; GREATEST_PACKET]; 3],
            t_far: [0.0; GREATEST_PACKET],
        };
        // SAFETY: the caller's promise.
        unsafe {
            for axis in 0..3 {
                self.place(words, word::RAY_ORIGIN + axis, &mut rays.origin[axis]);
                self.place(words, word::RAY_DIRECTION + axis, &mut rays.direction[axis]);
            }
            self.place(words, word::RAY_T_FAR, &mut rays.t_far);
        }
        rays
    }

    /// Scatters a component of the lanes to the positions of their rays.
    ///
    /// # Safety
    /// As [`Lanes::rays32`].
    #[inline(always)]
    unsafe fn place(
        &self,
        words: *const u32,
        component: usize,
        of_rays: &mut [f32; GREATEST_PACKET],
    ) {
        // SAFETY: the caller's promise; the alignment is that of words, and any bits are valid
        // as f32.
        let lanes = unsafe { &*words.add(component * N).cast::<[f32; N]>() };
        if let Some(first) = self.first {
            of_rays[first..][..N].copy_from_slice(lanes);
            return;
        }
        for lane in 0..N {
            if self.active >> lane & 1 != 0 {
                of_rays[self.ray(lane)] = lanes[lane];
            }
        }
    }

    /// The lane of a ray with an active lane.
    #[inline(always)]
    pub fn lane(&self, ray: usize) -> usize {
        if let Some(first) = self.first {
            return ray - first;
        }
        let mut found = 0;
        for lane in 0..N {
            if self.active >> lane & 1 != 0 && self.ray(lane) == ray {
                found = lane;
            }
        }
        found
    }
}
