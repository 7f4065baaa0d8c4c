//! Intersections that are empty by the boxes of their operands.
//!
//! Ends of chords in one station count as one point (`line.rs`), also those of solids whose gap
//! is thinner than their displacements. An intersection of such solids could have a point
//! there, although its box is empty ([`Composition::bounds`]). Queries reject by boxes first,
//! so the result would depend on the query. An empty box means that the intersection is empty
//! everywhere. So the chords of its leaves are removed, and the line continues without them.

use super::leaf::Leaf;
use super::{Composition, common_box};

impl Composition {
    /// Removes the chords of intersections whose boxes have no common point. `leaves` begins
    /// with those of this composition; returns their number.
    pub(super) fn forget_disjoint(&self, leaves: &mut [Leaf]) -> usize {
        let parts = match self {
            Self::Solid(_) => return 1,
            Self::Intersection(parts) => parts,
            Self::Union(parts) | Self::Difference(parts) => {
                let rest = |count, part: &Self| count + part.forget_disjoint(&mut leaves[count..]);
                return parts.iter().fold(0, rest);
            }
        };
        let mut count = 0;
        let mut are_all_hit = true;
        for part in parts {
            let start = count;
            count += part.forget_disjoint(&mut leaves[start..]);
            are_all_hit &= leaves[start..count].iter().any(|leaf| leaf.chord.is_some());
        }
        // Boxes take longer than finding that an operand is missed, which is the usual case.
        if are_all_hit && common_box(parts).is_empty() {
            for leaf in &mut leaves[..count] {
                leaf.chord = None;
            }
        }
        count
    }
}
