//! What prototypes hold, counted: before the files that a scene names are
//! read, or after.

use std::array::from_fn;
use std::collections::HashMap;

use rayon::prelude::*;

use super::cylinder_list::Records;
use super::description::{Placement, PrototypeIndex, Scene};
use super::solid_lists::{Listed, SolidRecord};
use crate::solid::{Composition, ConvexSolid, SolidKind};

/// What a prototype holds, counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpectedCounts {
    /// The name in the scene file; empty for the root.
    pub name: String,
    /// Its own cylinders.
    pub cylinders: u64,
    /// How they are kept.
    pub records: Records,
    /// Its own solids of other kinds.
    pub others: OtherSolids,
    /// Its own placements, by what is placed.
    pub placed: Vec<PlacedCount>,
    /// Whether the root places it, itself or through others, or is it.
    pub is_used: bool,
}

/// The solids of a prototype that are no cylinders, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OtherSolids {
    /// How many.
    pub count: u64,
    /// How many of each kind: spheres, cuboids, cones, rounded cones and disks, which
    /// leaves the set operations.
    pub singles: [u64; 5],
    /// The bytes of their records, with what compositions are made of.
    pub bytes: u64,
}

impl OtherSolids {
    /// How many are set operations.
    #[must_use]
    pub fn composed(&self) -> u64 {
        let singles = self.singles.iter().copied().fold(0, u64::saturating_add);
        self.count.saturating_sub(singles)
    }

    /// These and `count` of one kind more.
    pub(super) fn and<S: Listed + ConvexSolid>(self, count: u64) -> Self {
        let mut these = self.and_records::<S>(count);
        let position = match S::KIND {
            SolidKind::Sphere => 0,
            SolidKind::Cuboid => 1,
            SolidKind::Cone => 2,
            SolidKind::RoundedCone => 3,
            SolidKind::Disk => 4,
            SolidKind::Cylinder
            | SolidKind::Union
            | SolidKind::Intersection
            | SolidKind::Difference => return these,
        };
        these.singles[position] = these.singles[position].saturating_add(count);
        these
    }

    /// These and so many set operations with so many operands in all.
    pub(super) fn and_composed(self, count: u64, operands: u64) -> Self {
        let operands = operands.saturating_mul(size_of::<Composition>() as u64);
        let these = self.and_records::<Composition>(count);
        Self {
            bytes: these.bytes.saturating_add(operands),
            ..these
        }
    }

    fn and_records<S>(self, count: u64) -> Self {
        let bytes = count.saturating_mul(size_of::<SolidRecord<S>>() as u64);
        Self {
            count: self.count.saturating_add(count),
            bytes: self.bytes.saturating_add(bytes),
            ..self
        }
    }

    /// These and others.
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            count: self.count.saturating_add(other.count),
            singles: from_fn(|kind| self.singles[kind].saturating_add(other.singles[kind])),
            bytes: self.bytes.saturating_add(other.bytes),
        }
    }
}

/// How often a prototype is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlacedCount {
    /// What is placed.
    pub of: PrototypeIndex,
    /// How often.
    pub count: u64,
}

impl ExpectedCounts {
    /// What a prototype with these placements holds; equal `of` are joined.
    pub(super) fn new(
        name: &str,
        cylinders: u64,
        records: Records,
        others: OtherSolids,
        placed: impl IntoIterator<Item = (PrototypeIndex, u64)>,
    ) -> Self {
        let mut counts: HashMap<PrototypeIndex, u64> = HashMap::new();
        for (of, count) in placed {
            let sum = counts.entry(of).or_default();
            *sum = sum.saturating_add(count);
        }
        let mut placed: Vec<_> = counts
            .into_iter()
            .map(|(of, count)| PlacedCount { of, count })
            .collect();
        placed.sort_unstable_by_key(|placed| placed.of);
        Self {
            name: name.to_owned(),
            cylinders,
            records,
            others,
            placed,
            is_used: false,
        }
    }

    /// Its own placements.
    #[must_use]
    pub fn placements(&self) -> u64 {
        self.placed
            .iter()
            .fold(0, |sum, placed| sum.saturating_add(placed.count))
    }
}

/// Marks what the root, the first, needs; cycles do no harm.
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
    /// What the prototypes hold, in their order. Runs on the rayon pool that
    /// this is called in.
    #[must_use]
    pub fn contents(&self) -> Vec<ExpectedCounts> {
        let mut contents: Vec<_> = self
            .prototypes
            .iter()
            .map(|prototype| {
                ExpectedCounts::new(
                    &prototype.name,
                    prototype.cylinders.len() as u64,
                    prototype.cylinders.records(),
                    OtherSolids {
                        count: prototype.solids.len() as u64,
                        singles: prototype.solids.single_counts(),
                        bytes: prototype.solids.records_bytes() as u64,
                    },
                    counted(&prototype.placements),
                )
            })
            .collect();
        mark_used(&mut contents);
        contents
    }
}

/// How often each prototype is placed, in parts.
fn counted(placements: &[Placement]) -> Vec<(PrototypeIndex, u64)> {
    /// Placements that a thread counts at a time.
    const SHARE: usize = 1 << 16;
    let shares = placements.par_chunks(SHARE).flat_map_iter(|share| {
        share
            .chunk_by(|one, next| one.of == next.of)
            .map(|alike| (alike[0].of, alike.len() as u64))
    });
    shares.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contents_joined_and_marked_from_the_root() {
        let at = PrototypeIndex;
        let holding = |name, placed: &[(PrototypeIndex, u64)]| {
            let others = OtherSolids::default();
            ExpectedCounts::new(name, 1, Records::F64, others, placed.iter().copied())
        };
        let mut contents = [
            holding("", &[(at(2), 3), (at(1), 5), (at(2), 4)]),
            holding("a", &[]),
            holding("b", &[(at(2), 1)]),
            holding("c", &[(at(1), u64::MAX), (at(2), 1)]),
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
