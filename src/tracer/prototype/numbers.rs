//! The entries of a list that a group contains.

use std::sync::Arc;

use rayon::prelude::*;

/// The numbers of some entries of a list.
#[derive(Clone, Debug)]
pub(crate) enum Numbers {
    /// All of a list of this length.
    All(u32),
    /// These, in ascending order.
    These(Arc<[u32]>),
}

impl Numbers {
    /// The number of entries.
    #[inline]
    pub fn len(&self) -> u32 {
        match self {
            Self::All(len) => *len,
            Self::These(numbers) => numbers.len() as u32,
        }
    }

    /// The number at a position, which is Embree's primitive.
    #[inline(always)]
    pub fn number(&self, position: u32) -> u32 {
        match self {
            Self::All(_) => position,
            Self::These(numbers) => numbers[position as usize],
        }
    }

    /// All numbers in order.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        (0..self.len()).map(|position| self.number(position))
    }

    /// All numbers in order, on several threads.
    pub fn par_iter(&self) -> impl IndexedParallelIterator<Item = u32> {
        let positions = (0..self.len()).into_par_iter().with_min_len(1 << 10);
        positions.map(|position| self.number(position))
    }

    /// Whether a number is among them.
    pub fn contains(&self, number: u32) -> bool {
        match self {
            Self::All(len) => number < *len,
            Self::These(numbers) => numbers.binary_search(&number).is_ok(),
        }
    }

    /// The numbers for which `keep` is true.
    pub fn filtered(&self, keep: impl Fn(u32) -> bool + Sync) -> Self {
        Self::These(self.par_iter().filter(|&number| keep(number)).collect())
    }

    /// The memory of the numbers.
    pub fn bytes(&self) -> usize {
        match self {
            Self::All(_) => 0,
            Self::These(numbers) => size_of_val(&**numbers),
        }
    }
}
