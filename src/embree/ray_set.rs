//! A set of rays of a packet, as bits.

use std::ops::{BitAnd, BitOr, Sub};

/// The greatest number of rays of a packet.
pub const GREATEST_PACKET: usize = 16;

/// A set of rays of a packet. A ray is identified by the number that the caller of the query
/// gave it, from 0 to [`GREATEST_PACKET`] - 1, whatever its lane in Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct RaySet(u16);

impl RaySet {
    /// No ray.
    pub const EMPTY: Self = Self(0);
    /// Every ray.
    pub const ALL: Self = Self(u16::MAX);

    /// The rays whose bits are set.
    #[inline(always)]
    #[must_use]
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }

    /// The bits: bit `i` is set if ray `i` is in the set.
    #[inline(always)]
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The rays whose entries are true.
    #[inline(always)]
    #[must_use]
    pub fn of(truths: &[bool; GREATEST_PACKET]) -> Self {
        let mut bits = 0;
        for (ray, &truth) in truths.iter().enumerate() {
            bits |= u16::from(truth) << ray;
        }
        Self(bits)
    }

    /// Rays 0 to `count` - 1.
    ///
    /// # Panics
    /// When `count` is above [`GREATEST_PACKET`].
    #[inline]
    #[must_use]
    pub const fn first(count: usize) -> Self {
        assert!(count <= GREATEST_PACKET, "a packet has no more rays");
        Self(((1_u32 << count) - 1) as u16)
    }

    /// Whether the set is empty.
    #[inline(always)]
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The number of rays in the set.
    #[inline(always)]
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether a ray is in the set.
    #[inline(always)]
    #[must_use]
    pub const fn contains(self, ray: usize) -> bool {
        ray < GREATEST_PACKET && self.0 >> ray & 1 != 0
    }

    /// Adds a ray.
    ///
    /// # Panics
    /// When `ray` is not below [`GREATEST_PACKET`].
    #[inline(always)]
    pub const fn insert(&mut self, ray: usize) {
        assert!(ray < GREATEST_PACKET, "a packet has no such ray");
        self.0 |= 1 << ray;
    }
}

impl BitAnd for RaySet {
    type Output = Self;

    /// The rays that are in both.
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for RaySet {
    type Output = Self;

    /// The rays that are in either.
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Sub for RaySet {
    type Output = Self;

    /// The rays that are not in `other`.
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl FromIterator<usize> for RaySet {
    /// # Panics
    /// As [`RaySet::insert`].
    #[inline]
    fn from_iter<I: IntoIterator<Item = usize>>(rays: I) -> Self {
        let mut set = Self::EMPTY;
        rays.into_iter().for_each(|ray| set.insert(ray));
        set
    }
}

impl IntoIterator for RaySet {
    type Item = usize;
    type IntoIter = RayNumbers;

    #[inline(always)]
    fn into_iter(self) -> RayNumbers {
        RayNumbers(self.0)
    }
}

/// An iterator over the numbers of a set's rays, the least first.
#[derive(Clone, Debug)]
pub struct RayNumbers(u16);

impl Iterator for RayNumbers {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let ray = self.0.trailing_zeros() as usize;
        if self.0 == 0 {
            return None;
        }
        self.0 &= self.0 - 1;
        Some(ray)
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.0.count_ones() as usize;
        (left, Some(left))
    }
}

impl ExactSizeIterator for RayNumbers {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ray_set_numbers_come_back_sorted_and_counted() {
        let set: RaySet = [15, 3, 0, 3].into_iter().collect();
        assert_eq!(set.into_iter().collect::<Vec<_>>(), [0, 3, 15]);
        assert_eq!((set.len(), set.into_iter().len()), (3, 3));
        assert!(set.contains(3) && !set.contains(4) && !set.contains(16));
        assert_eq!(RaySet::first(16), RaySet::ALL);
        assert_eq!(RaySet::first(0), RaySet::EMPTY);
        assert!(RaySet::EMPTY.is_empty() && !set.is_empty());
    }

    #[test]
    fn ray_set_operations_are_those_of_sets() {
        let (a, b) = (RaySet::from_bits(0b0110), RaySet::from_bits(0b0011));
        assert_eq!((a & b).bits(), 0b0010);
        assert_eq!((a | b).bits(), 0b0111);
        assert_eq!((a - b).bits(), 0b0100);
    }
}
