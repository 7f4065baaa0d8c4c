//! The numbers of solids and placements in prototypes, before or after the files that a
//! scene names are read.

use std::collections::HashMap;

use rayon::prelude::*;

use super::description::{Prototype, PrototypeIndex, Scene};
use super::record::Records;
use super::solid_lists::{SolidList, Stored};
use crate::solid::{Composition, SolidCounts, SolidKind};
use crate::with_solid_kind;

/// The numbers of solids and placements in a prototype.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpectedCounts {
    /// The name in the scene file; empty for the root.
    pub name: String,
    /// Its own solids.
    pub solids: ExpectedSolids,
    /// Its own placements, by placed prototype.
    pub placed: Vec<PlacedCount>,
    /// The bytes of the values for data colors, and in the root those of images.
    pub values_bytes: u64,
    /// Whether it is the root, or the root places it directly or through others.
    pub is_used: bool,
}

/// The numbers of solids in a prototype.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExpectedSolids {
    /// The number of solids of each kind.
    pub counts: SolidCounts,
    /// The bytes of their records, including the operands of compositions.
    pub bytes: u64,
}

impl ExpectedSolids {
    /// Adds solids of a kind; `records` is the storage of cylinders. The operands of set
    /// operations are not included.
    pub fn add(&mut self, kind: SolidKind, more: u64, records: Records) {
        let bytes = with_solid_kind!(kind, S => <S as Stored>::List::record_bytes(records));
        self.counts.add(kind, more.into());
        self.bytes = self.bytes.saturating_add(more.saturating_mul(bytes as u64));
    }

    /// Adds the operands of set operations.
    pub(super) fn add_operands(&mut self, more: u64) {
        let bytes = more.saturating_mul(size_of::<Composition>() as u64);
        self.bytes = self.bytes.saturating_add(bytes);
    }
}

/// The number of placements of a prototype.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlacedCount {
    /// The placed prototype.
    pub of: PrototypeIndex,
    /// The number of placements.
    pub count: u64,
}

/// Adds up the counts of each prototype.
pub(super) fn placed_counts(
    counts: impl IntoIterator<Item = (PrototypeIndex, u64)>,
) -> Vec<PlacedCount> {
    let mut sums: HashMap<PrototypeIndex, u64> = HashMap::new();
    for (of, count) in counts {
        let sum = sums.entry(of).or_default();
        *sum = sum.saturating_add(count);
    }
    let placed = sums.into_iter();
    let mut placed: Vec<_> = placed
        .map(|(of, count)| PlacedCount { of, count })
        .collect();
    placed.sort_unstable_by_key(|placed| placed.of);
    placed
}

impl Prototype {
    /// The number of its placements of each other prototype, in the order of the prototypes.
    /// Runs on the caller's rayon pool.
    #[must_use]
    pub fn placed(&self) -> Vec<PlacedCount> {
        /// The number of placements that a thread counts at a time.
        const SHARE: usize = 1 << 16;
        let shares = self.placements.par_chunks(SHARE).map(|share| {
            let runs = share.chunk_by(|one, next| one.of == next.of);
            placed_counts(runs.map(|run| (run[0].of, run.len() as u64)))
        });
        let shares: Vec<_> = shares.collect();
        let counts = shares.iter().flatten();
        placed_counts(counts.map(|placed| (placed.of, placed.count)))
    }
}

impl ExpectedCounts {
    /// The number of its own placements.
    #[must_use]
    pub fn placements(&self) -> u64 {
        self.placed
            .iter()
            .fold(0, |sum, placed| sum.saturating_add(placed.count))
    }
}

/// Marks the prototypes that the root, the first one, uses. Cycles are allowed.
pub(super) fn mark_used(contents: &mut [ExpectedCounts]) {
    let mut open = vec![PrototypeIndex::ROOT];
    while let Some(index) = open.pop() {
        let prototype = &mut contents[index.0 as usize];
        if !prototype.is_used {
            prototype.is_used = true;
            open.extend(prototype.placed.iter().map(|placed| placed.of));
        }
    }
}

impl Scene {
    /// The numbers of solids and placements in the prototypes, in their order. Runs on the
    /// caller's rayon pool.
    #[must_use]
    pub fn contents(&self) -> Vec<ExpectedCounts> {
        let prototypes = self.prototypes.iter();
        let images = self.images_bytes() as u64;
        let images = std::iter::once(images).chain(std::iter::repeat(0));
        let contents = prototypes
            .zip(images)
            .map(|(prototype, images)| ExpectedCounts {
                name: prototype.name.clone(),
                solids: ExpectedSolids {
                    counts: prototype.solids.counts(),
                    bytes: prototype.solids.records_bytes() as u64,
                },
                placed: prototype.placed(),
                values_bytes: prototype.values_bytes() as u64 + images,
                is_used: false,
            });
        let mut contents: Vec<_> = contents.collect();
        mark_used(&mut contents);
        contents
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_joined_and_marked_from_the_root() {
        let at = PrototypeIndex;
        let containing = |name: &str, placed: &[(PrototypeIndex, u64)]| ExpectedCounts {
            name: name.to_owned(),
            solids: ExpectedSolids::default(),
            placed: placed_counts(placed.iter().copied()),
            values_bytes: 0,
            is_used: false,
        };
        let mut contents = [
            containing("", &[(at(2), 3), (at(1), 5), (at(2), 4)]),
            containing("a", &[]),
            containing("b", &[(at(2), 1)]),
            containing("c", &[(at(1), u64::MAX), (at(2), 1)]),
        ];
        mark_used(&mut contents);
        assert_eq!(contents[0].placements(), 12);
        let counts: Vec<_> = contents[0]
            .placed
            .iter()
            .map(|p| (p.of.0, p.count))
            .collect();
        assert_eq!(counts, [(1, 5), (2, 7)]);
        assert_eq!(contents[3].placements(), u64::MAX);
        assert_eq!(contents.map(|c| c.is_used), [true, true, true, false]);
    }
}
