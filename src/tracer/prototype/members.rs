//! The members of the groups of a prototype.
//!
//! A prototype has a list for each kind of solid, and its placements. A placed prototype may
//! have several groups itself. Then a placement is one primitive for each of them, and these
//! may be in different groups of the parent. So a far solid in a placed prototype does not
//! enlarge the boxes of the others there, at any depth.

use std::borrow::Borrow;

use rayon::prelude::*;

use super::grouping::{Boxed, Cube, cubes};
use super::numbers::Numbers;
use crate::math::Bounds;
use crate::scene::{self, Listed, PrototypeIndex, SolidList};
use crate::solid::SolidKind;
use crate::tracer::traced::TracedSolid;
use crate::with_solid_kind;

/// A list of a prototype.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum List {
    /// The solids of a kind; all set operations share one list.
    Solids(SolidKind),
    /// The placements, for one group of the placed prototypes.
    Placements {
        /// The number of the group.
        group: usize,
    },
}

/// The kinds of the lists of solids.
const KINDS: &[SolidKind] = SolidKind::LISTS;

impl List {
    fn position(self) -> usize {
        match self {
            // All set operations are in the last list.
            Self::Solids(kind) => (kind as usize).min(KINDS.len() - 1),
            Self::Placements { group } => KINDS.len() + group,
        }
    }

    fn at(position: usize) -> Self {
        let solids = KINDS.get(position).copied().map(Self::Solids);
        solids.unwrap_or(Self::Placements {
            group: position.saturating_sub(KINDS.len()),
        })
    }
}

/// The members of a group, by list.
#[derive(Clone, Debug)]
pub(crate) struct Members {
    lists: Vec<Numbers>,
}

impl Members {
    /// The members in a list.
    pub fn of(&self, list: List) -> &Numbers {
        &self.lists[list.position()]
    }

    /// The lists of solids with at least one member.
    pub fn solids(&self) -> impl Iterator<Item = (SolidKind, &Numbers)> {
        let lists = KINDS.iter().copied().zip(&self.lists);
        lists.filter(|(_, numbers)| numbers.len() > 0)
    }

    /// The lists of placements with at least one member, each with the number of the child's
    /// group.
    pub fn placements(&self) -> impl Iterator<Item = (usize, &Numbers)> {
        let lists = self.lists[KINDS.len()..].iter().enumerate();
        lists.filter(|(_, numbers)| numbers.len() > 0)
    }

    /// The number of solids of each kind, without set operations.
    pub fn single_counts(&self) -> impl Iterator<Item = u32> {
        let kinds = SolidKind::SIMPLE.iter();
        kinds.map(|&kind| self.of(List::Solids(kind)).len())
    }

    /// All members.
    pub fn iter(&self) -> impl Iterator<Item = (List, u32)> {
        let lists = self.lists.iter().enumerate();
        lists.flat_map(|(position, numbers)| {
            let list = List::at(position);
            numbers.iter().map(move |number| (list, number))
        })
    }

    /// The number of members.
    pub fn len(&self) -> u64 {
        self.lists
            .iter()
            .map(|numbers| u64::from(numbers.len()))
            .sum()
    }

    /// The memory of the numbers.
    pub fn bytes(&self) -> usize {
        self.lists.iter().map(Numbers::bytes).sum()
    }
}

/// The boxes of the groups of a prototype; none if it is empty.
pub(crate) type BoxesOf<'a> = dyn Fn(PrototypeIndex) -> &'a [Bounds] + Sync + 'a;

/// The boxes of everything in a prototype.
pub(crate) struct Boxes<'a> {
    prototype: &'a scene::Prototype,
    children: &'a BoxesOf<'a>,
    /// The lengths of the lists.
    lens: Vec<u32>,
}

impl<'a> Boxes<'a> {
    /// The boxes of a prototype, given those of its children.
    pub fn new(prototype: &'a scene::Prototype, children: &'a BoxesOf<'a>) -> Self {
        let (mut groups, mut last) = (1, None);
        for placement in &prototype.placements {
            if last.replace(placement.of) != Some(placement.of) {
                groups = groups.max(children(placement.of).len());
            }
        }
        let lens = KINDS.iter().map(|&kind| prototype.solids.len_of(kind));
        let placements = std::iter::repeat_n(prototype.placements.len(), groups);
        Self {
            prototype,
            children,
            lens: lens.chain(placements).map(|len| len as u32).collect(),
        }
    }

    /// The box of an entry of a list; empty if the entry is.
    pub fn entry(&self, list: List, number: u32) -> Bounds {
        let (prototype, number) = (self.prototype, number as usize);
        match list {
            List::Solids(kind) => with_solid_kind!(kind, S => {
                let solid = S::list(&prototype.solids).solid(number);
                TracedSolid::bounds(solid.borrow() as &S)
            }),
            List::Placements { group } => {
                let placement = &prototype.placements[number];
                let child = (self.children)(placement.of).get(group);
                child.map_or(Bounds::EMPTY, |child| {
                    child.transformed(&placement.parent_from_child)
                })
            }
        }
    }

    /// The box around a group.
    pub fn around(&self, members: &Members) -> Bounds {
        let lists = members.lists.iter().enumerate();
        let boxes = lists.map(|(position, numbers)| {
            let list = List::at(position);
            numbers
                .par_iter()
                .map(|number| self.entry(list, number))
                .reduce(|| Bounds::EMPTY, |one, other| one.union(&other))
        });
        boxes.fold(Bounds::EMPTY, |one, other| one.union(&other))
    }

    /// The groups with their boxes: nearly always one, with everything; none if the prototype
    /// is empty.
    pub fn groups(&self) -> Vec<(Members, Bounds)> {
        let everything = Members {
            lists: self.lens.iter().copied().map(Numbers::All).collect(),
        };
        let whole = self.around(&everything);
        if whole.is_empty() {
            return Vec::new();
        }
        let cubes = cubes(
            self,
            &whole,
            &self.without_further_groups(&everything, &whole),
        );
        if cubes.is_empty() {
            return vec![(everything, whole)];
        }
        let mut groups = self.divided(&cubes);
        groups.retain(|(_, bounds)| !bounds.is_empty());
        groups
    }

    /// The box around everything except the further groups of placed prototypes.
    fn without_further_groups(&self, everything: &Members, whole: &Bounds) -> Bounds {
        let mut lists = everything.lists.clone();
        if lists.len() == KINDS.len() + 1 {
            return *whole;
        }
        lists.truncate(KINDS.len() + 1);
        self.around(&Members { lists })
    }

    /// The groups of the cubes, from one pass over all boxes.
    fn divided(&self, cubes: &[Cube]) -> Vec<(Members, Bounds)> {
        let nothing = Members { lists: Vec::new() };
        let mut groups = vec![(nothing, Bounds::EMPTY); cubes.len() + 1];
        for (position, &len) in self.lens.iter().enumerate() {
            let parts = self.divided_list(List::at(position), len, cubes);
            for ((members, bounds), part) in groups.iter_mut().zip(parts) {
                members.lists.push(match part.numbers.len() as u32 {
                    all if all == len => Numbers::All(len),
                    _ => Numbers::These(part.numbers.into()),
                });
                *bounds = bounds.union(&part.bounds);
            }
        }
        groups
    }

    /// The members of each group in a list.
    fn divided_list(&self, list: List, len: u32, cubes: &[Cube]) -> Vec<Part> {
        let nothing = || vec![Part::default(); cubes.len() + 1];
        let numbers = (0..len).into_par_iter().with_min_len(1 << 10);
        let parts = numbers.fold(nothing, |mut parts, number| {
            let bounds = self.entry(list, number);
            let cube = cubes.iter().position(|cube| cube.contains(&bounds));
            let part = &mut parts[cube.unwrap_or(cubes.len())];
            part.numbers.push(number);
            part.bounds = part.bounds.union(&bounds);
            parts
        });
        parts.reduce(nothing, |mut parts, next| {
            for (part, next) in parts.iter_mut().zip(next) {
                part.numbers.extend(next.numbers);
                part.bounds = part.bounds.union(&next.bounds);
            }
            parts
        })
    }
}

/// The members of a group in a list.
#[derive(Clone)]
struct Part {
    /// In ascending order.
    numbers: Vec<u32>,
    bounds: Bounds,
}

impl Default for Part {
    fn default() -> Self {
        Self {
            numbers: Vec::new(),
            bounds: Bounds::EMPTY,
        }
    }
}

impl Boxed for Boxes<'_> {
    fn len(&self) -> usize {
        self.lens.iter().map(|&len| len as usize).sum()
    }

    fn bounds(&self, number: usize) -> Bounds {
        let mut number = number;
        for (position, &len) in self.lens.iter().enumerate() {
            match number.checked_sub(len as usize) {
                None => return self.entry(List::at(position), number as u32),
                Some(rest) => number = rest,
            }
        }
        Bounds::EMPTY
    }
}
