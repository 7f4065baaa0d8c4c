//! First intersections without a branch, eight rays at once.
//!
//! A solid's quick solver consists of the pieces of its solver, without the exact numbers for
//! rare cases. It reports such a case as open, and the caller passes it to
//! [`first`](super::ConvexSolid::first). If it is not open, the quick solver has the bits of
//! `first`. A loop over its inlined calls becomes vector code.
//!
//! Most rays that enter a solid's box miss the solid widely, and [`rejects`](super::ConvexSolid::rejects)
//! detects that without a root or a division. So it runs first, and the row is solved if any
//! ray remains.

use crate::math::{LaneMask, Lanes};

/// The first intersection of a line and a solid in a range, from a quick solver.
#[derive(Clone, Copy, Debug)]
pub struct Quick {
    /// Whether the result needs exact numbers; then the rest has no meaning.
    pub is_open: bool,
    /// Whether there is an intersection.
    pub is_hit: bool,
    /// Its parameter on the whole ray; it has no meaning if there is no intersection.
    pub t: f64,
}

/// The range of an intersection's parameter.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// The position of the origin on the whole ray.
    pub shift: f64,
    /// The least parameter of the whole ray.
    pub t_min: f64,
    /// The greatest.
    pub t_max: f64,
}

/// The first intersections of eight rays.
#[derive(Clone, Copy, Debug)]
pub struct QuickLanes {
    /// The rays whose result needs exact numbers.
    pub open: LaneMask,
    /// The other rays that hit the solid.
    pub hit: LaneMask,
    /// The parameters of these hits, on the whole rays.
    pub t: Lanes,
}

impl QuickLanes {
    /// Leaves all active rays open.
    #[inline(always)]
    #[must_use]
    pub fn all_open(active: LaneMask) -> Self {
        Self {
            open: active,
            hit: LaneMask::splat(false),
            t: Lanes::splat(0.0),
        }
    }
}

impl Quick {
    /// An undecided result.
    pub const OPEN: Self = Self {
        is_open: true,
        is_hit: false,
        t: 0.0,
    };

    /// As [`Quick::of_ends`], for the ends of a line that `is_inside` somewhere. Otherwise the
    /// ends do not matter.
    #[inline(always)]
    pub(super) fn of_chord(is_open: bool, is_inside: bool, ends: [End; 2], range: &Range) -> Self {
        let quick = Self::of_ends(false, ends, range);
        Self {
            is_open: is_open | (quick.is_open & is_inside),
            is_hit: quick.is_hit & is_inside,
            ..quick
        }
    }

    /// The first of the two ends of a chord that is in the range.
    #[inline(always)]
    pub(super) fn of_ends(is_open: bool, [enter, leave]: [End; 2], range: &Range) -> Self {
        let is_entry = range.contains(&enter);
        let t = if is_entry { enter.t } else { leave.t };
        let is_leave_needed = !is_entry & !range.is_uncertain(&enter);
        Self {
            is_open: is_open
                | range.is_uncertain(&enter)
                | (is_leave_needed & range.is_uncertain(&leave)),
            is_hit: is_entry | range.contains(&leave),
            t: t + range.shift,
        }
    }
}

/// An end of a chord.
///
/// A ray that starts next to a solid's surface, as shadow rays do, has an end next to its
/// origin whose bits need exact numbers. That this end is before the range needs none.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// The parameter from the origin, equal to the solver's if `slack` is zero.
    pub t: f64,
    /// Bounds the difference from the solver's `t`.
    pub slack: f64,
}

impl End {
    /// The end if the surface has it, and otherwise one that is in no range.
    #[inline(always)]
    pub fn if_there(self, is_there: bool) -> Self {
        Self {
            t: if is_there { self.t } else { f64::NAN },
            slack: if is_there { self.slack } else { 0.0 },
        }
    }

    /// Whether it is certainly after another end.
    #[inline(always)]
    pub fn is_after(&self, other: &Self) -> bool {
        self.t - other.t > 2.0 * (self.slack + other.slack)
    }

    /// This end if `is_this`, else the other.
    #[inline(always)]
    pub fn or(self, other: Self, is_this: bool) -> Self {
        Self {
            t: if is_this { self.t } else { other.t },
            slack: if is_this { self.slack } else { other.slack },
        }
    }

    /// Whether the order of two ends is certain: they differ by more than a share `margin` of
    /// them and their slack.
    #[inline(always)]
    pub fn is_apart(&self, other: &Self, margin: f64) -> bool {
        let error = margin * (self.t.abs() + other.t.abs()) + 2.0 * (self.slack + other.slack);
        (self.t - other.t).abs() > error
    }
}

impl Range {
    #[inline(always)]
    fn contains(&self, end: &End) -> bool {
        let t = end.t + self.shift;
        (end.slack == 0.0) & (self.t_min <= t) & (t <= self.t_max)
    }

    /// Whether it is uncertain that an end is in the range. Sums round as those of the solver
    /// do, which preserves the order.
    #[inline(always)]
    fn is_uncertain(&self, end: &End) -> bool {
        let [least, most] = [end.t - end.slack, end.t + end.slack].map(|t| t + self.shift);
        (end.slack != 0.0) & !(most < self.t_min) & !(least > self.t_max)
    }
}
