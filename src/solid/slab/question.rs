//! What a query computes from the overlap of a wall and a slab: the first intersection with a
//! range, or the whole chord.

use super::{Disks, Overlap, Wall};
use crate::math::Real;
use crate::solid::chord::{Chord, ChordEnd, Intersection};
use crate::solid::{Caps, Crossing};

/// A function of a chord. A type, not a closure: its methods are inlined, so that nothing of
/// the chord has to be kept in memory.
pub trait Question<S: Real> {
    /// The result if there is a chord.
    type Answer;

    /// The result for a known chord.
    fn of_chord(self, chord: Chord<S>) -> Option<Self::Answer>;

    /// The result for wall and slab, which may have no common chord.
    fn of_overlap(self, overlap: &Overlap<S, impl Wall<S>>) -> Option<Self::Answer>;
}

/// [`Chord::first`]. The end at which the line leaves is computed only if the one at which it
/// enters is no hit.
pub struct FirstIntersection<S> {
    /// The closed ends.
    pub caps: Caps,
    /// The `t` of the whole ray at the line's `t = 0`.
    pub shift: S,
    /// The least `t` of the whole ray.
    pub t_min: S,
    /// The greatest `t` of the whole ray.
    pub t_max: S,
}

impl<S: Real> Question<S> for FirstIntersection<S> {
    type Answer = Intersection<S>;

    #[inline]
    fn of_chord(self, chord: Chord<S>) -> Option<Intersection<S>> {
        chord.first(self.caps, self.shift, self.t_min, self.t_max)
    }

    #[inline(always)]
    fn of_overlap(self, overlap: &Overlap<S, impl Wall<S>>) -> Option<Intersection<S>> {
        if overlap.is_across() {
            return self.of_chord(overlap.across()?);
        }
        let disks = Disks::of(&overlap.slab);
        let intersection = |end: ChordEnd<S>, crossing| {
            end.intersection(crossing, self.caps, self.shift, self.t_min, self.t_max)
        };
        let (is_there, enter) = overlap.enter(&disks);
        if enter.is_open {
            return self.of_chord(overlap.wall.exact_chord()?);
        }
        if !is_there {
            return None;
        }
        if let Some(entry) = intersection(enter.end, Crossing::Enter) {
            return Some(entry);
        }
        intersection(overlap.decided_leave(&disks, enter.end.t), Crossing::Leave)
    }
}

/// The chord itself.
pub struct WholeChord;

impl<S: Real> Question<S> for WholeChord {
    type Answer = Chord<S>;

    #[inline]
    fn of_chord(self, chord: Chord<S>) -> Option<Chord<S>> {
        Some(chord)
    }

    #[inline(always)]
    fn of_overlap(self, overlap: &Overlap<S, impl Wall<S>>) -> Option<Chord<S>> {
        if overlap.is_across() {
            return overlap.across();
        }
        let disks = Disks::of(&overlap.slab);
        let (is_there, enter) = overlap.enter(&disks);
        if enter.is_open {
            return overlap.wall.exact_chord();
        }
        if !is_there {
            return None;
        }
        Some(Chord {
            enter: enter.end,
            leave: overlap.decided_leave(&disks, enter.end.t),
            lies_on: None,
        })
    }
}
