//! Eight f64 values computed side by side.
//!
//! Each quantity is an array of eight numbers, so a loop over the lanes reads
//! and writes contiguous memory. Such a loop computes for each lane what scalar
//! code computes, bit for bit. If its body branches to no function call, the
//! compiler vectorizes it with the instructions of the function into which it is
//! inlined: eight lanes at once with AVX-512, two with baseline x86-64.

use std::array::from_fn;
use std::ops::Sub;

use glam::DVec3;

/// The number of lanes.
pub const LANES: usize = 8;

/// Eight numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

/// A flag for each lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(8))]
pub struct LaneMask(pub [bool; LANES]);

/// Eight vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneVectors {
    /// The first coordinates.
    pub x: Lanes,
    /// The second.
    pub y: Lanes,
    /// The third.
    pub z: Lanes,
}

impl Lanes {
    /// The same number in every lane.
    #[inline(always)]
    #[must_use]
    pub fn splat(x: f64) -> Self {
        Self([x; LANES])
    }
}

impl LaneMask {
    /// The same flag in every lane.
    #[inline(always)]
    #[must_use]
    pub fn splat(flag: bool) -> Self {
        Self([flag; LANES])
    }

    /// The lanes whose bits are set, lane 0 the lowest.
    #[inline(always)]
    #[must_use]
    pub fn from_bits(bits: u8) -> Self {
        Self(from_fn(|lane| bits >> lane & 1 == 1))
    }

    /// A bit for every lane, lane 0 the lowest.
    #[inline(always)]
    #[must_use]
    pub fn bits(self) -> u8 {
        // The product moves byte i, which is 0 or 1, to bit 56 + i, and puts
        // nothing else there.
        const TO_HIGH_BYTE: u64 = 0x0102_0408_1020_4080;
        (self.bytes().wrapping_mul(TO_HIGH_BYTE) >> 56) as u8
    }

    /// Whether the flag of any lane is set.
    #[inline(always)]
    #[must_use]
    pub fn any(self) -> bool {
        self.bytes() != 0
    }

    /// A byte for every lane, lane 0 the lowest.
    #[inline(always)]
    fn bytes(self) -> u64 {
        u64::from_le_bytes(self.0.map(u8::from))
    }
}

impl LaneVectors {
    /// The same vector in every lane.
    #[inline(always)]
    #[must_use]
    pub fn splat(v: DVec3) -> Self {
        Self {
            x: Lanes::splat(v.x),
            y: Lanes::splat(v.y),
            z: Lanes::splat(v.z),
        }
    }

    /// One vector for each lane.
    #[inline(always)]
    #[must_use]
    pub fn of(vectors: &[DVec3; LANES]) -> Self {
        Self {
            x: Lanes(from_fn(|lane| vectors[lane].x)),
            y: Lanes(from_fn(|lane| vectors[lane].y)),
            z: Lanes(from_fn(|lane| vectors[lane].z)),
        }
    }

    /// The vector of a lane.
    ///
    /// # Panics
    /// If `lane` is not below [`LANES`].
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x.0[lane], self.y.0[lane], self.z.0[lane])
    }

    /// Sets the vector of a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: DVec3) {
        self.x.0[lane] = v.x;
        self.y.0[lane] = v.y;
        self.z.0[lane] = v.z;
    }
}

impl Sub for LaneVectors {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let mut difference = Self::splat(DVec3::ZERO);
        for lane in 0..LANES {
            difference.set(lane, self.lane(lane) - other.lane(lane));
        }
        difference
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mask_of_bits_has_these_bits() {
        for bits in 0..=u8::MAX {
            let mask = LaneMask::from_bits(bits);
            assert_eq!(mask.bits(), bits);
            assert_eq!(mask.any(), bits != 0);
            for lane in 0..LANES {
                assert_eq!(mask.0[lane], bits & (1 << lane) != 0, "{bits:#b}, {lane}");
            }
        }
    }

    #[test]
    fn vectors_are_subtracted_lane_by_lane() {
        let vectors = from_fn(|lane| DVec3::new(lane as f64, 0.1, -3.0));
        let difference = LaneVectors::of(&vectors) - LaneVectors::splat(DVec3::ONE);
        for (lane, vector) in vectors.into_iter().enumerate() {
            assert_eq!(difference.lane(lane), vector - DVec3::ONE);
        }
    }
}
