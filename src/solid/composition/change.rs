//! What set operations make of what happens to a line at one point of it.
//!
//! Before and behind the point the line is outside, within the surface or inside of a
//! solid. An intersection has the least of its operands on either side, the complement
//! of a solid has inside and outside swapped, a union is the complement of the
//! intersection of complements, and a difference the intersection of the first with
//! the complements of the others. Of operands that change at the same point, the first
//! that decides is the one that is met. A touch in a point remains one if it is not
//! hidden: seen from outside, if all others have the point; from inside, if it is
//! within all others.

use super::Composition;
use crate::solid::Location;

/// What of a solid the line is in before and behind a station, and the leaf that the
/// change is made by. With a mark and no change, the leaf is touched in a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Change {
    pub before: Location,
    pub after: Location,
    pub mark: Option<u32>,
}

impl Change {
    /// Outside.
    pub const NONE: Self = Self {
        before: Location::Outside,
        after: Location::Outside,
        mark: None,
    };

    /// That of a tree of operations; `leaf` answers with those of its leaves, one after
    /// the other.
    pub fn of(part: &Composition, leaf: &mut impl FnMut() -> Self) -> Self {
        let mut of = |part: &Composition| Self::of(part, leaf);
        match part {
            Composition::Solid(_) => leaf(),
            Composition::Union(parts) => {
                let parts = parts.iter().map(|part| of(part).complement());
                parts
                    .reduce(Self::intersect)
                    .map_or(Self::NONE, Self::complement)
            }
            Composition::Intersection(parts) => {
                let parts = parts.iter().map(of);
                parts.reduce(Self::intersect).unwrap_or(Self::NONE)
            }
            Composition::Difference(parts) => {
                let Some((first, others)) = parts.split_first() else {
                    return Self::NONE;
                };
                let first = of(first);
                let others = others.iter().map(|part| of(part).complement());
                others.fold(first, Self::intersect)
            }
        }
    }

    /// The same for all that is not the solid.
    fn complement(self) -> Self {
        Self {
            before: self.before.of_complement(),
            after: self.after.of_complement(),
            mark: self.mark,
        }
    }

    /// Whether the line touches the surface in a point.
    pub fn is_touched(self) -> bool {
        self.before == self.after && self.mark.is_some()
    }

    /// For the intersection of two.
    fn intersect(self, other: Self) -> Self {
        let (before, after) = (self.before.min(other.before), self.after.min(other.after));
        let mark = if before != after {
            // Who is the lesser where the less is: that one changes here.
            let has_least = if before < after {
                self.before == before
            } else {
                self.after == after
            };
            if has_least { self.mark } else { other.mark }
        } else {
            let touched = [self, other]
                .into_iter()
                .filter(|one| one.is_touched() && one.before == before);
            match before {
                // Touched from outside, in a point that the other has too.
                Location::Outside if self == Self::NONE || other == Self::NONE => None,
                // A line within the surface is on it anyway.
                Location::Boundary => None,
                Location::Outside | Location::Inside => {
                    touched.into_iter().find_map(|one| one.mark)
                }
            }
        };
        Self {
            before,
            after,
            mark,
        }
    }
}
