//! The intersection of the wall's interval of `t` with the slab between the disks.
//!
//! A solver computes the interval of a line inside the infinite wall; the solid is the part of
//! that wall between the planes of the disks. The axial position of a point of the line is
//! `y = position + t * slope`, counted from `p0` in any unit, and the point is inside the slab
//! iff `0 <= y <= height`. Both ends of the overlap are decided by `y` at the wall's roots:
//! wall and disks are selected by the same numbers, so that no ray passes between them at a
//! rim.
//!
//! If the line is so nearly across the axis that `t * slope` rounds away between the roots, `y`
//! does not determine where it crosses a plane: an error of an ulp of the height is an error of
//! an ulp over the slope in `t`, which may be any number. So the `t` of a disk is clamped
//! between the roots of the wall, where it is without rounding.
//!
//! At a rim, `y` equals a plane's up to its rounding, and its sign determines neither the part
//! nor hit or miss. The wall bounds the rounding. An end at which `y` is nearer to a plane than
//! that is *open*, and comes from exact arithmetic. So does the end at which the line leaves if
//! the one at which it enters is open. Whether an end is open depends on the line alone, so all
//! queries of the line have the same ends.

mod question;

use super::Part;
use super::chord::{Chord, ChordEnd};
use crate::math::Real;

pub use question::{FirstIntersection, Question, WholeChord};

/// A line as seen along the axis.
#[derive(Clone, Copy, Debug)]
pub struct Slab<S> {
    /// The axial position of the disk at `p1`; that at `p0` is at 0.
    pub height: S,
    /// The axial position at `t = 0`.
    pub position: S,
    /// The change of the position per unit of `t`.
    pub slope: S,
}

/// The interval of a line inside the infinite wall. Either end is computed on request.
pub trait Wall<S: Real> {
    /// The `t` at which it enters.
    fn enter(&self) -> S;
    /// The `t` at which it leaves.
    fn leave(&self) -> S;

    /// Whether the wall decides at rims. If not, no end is open, and a point is on a rim if the
    /// rounded `y` equals that of a plane.
    const DECIDES_RIMS: bool = false;

    /// The square of an error bound of `y` at either end.
    #[inline(always)]
    fn squared_rounding(&self, _slab: &Slab<S>) -> S {
        S::ZERO
    }

    /// The chord by exact arithmetic.
    #[inline(always)]
    fn exact_chord(&self) -> Option<Chord<S>> {
        None
    }
}

/// A slab and a wall: a chord whose ends are computed on request.
pub struct Overlap<S, W> {
    slab: Slab<S>,
    wall: W,
}

/// The end at which a line enters, from rounded numbers.
pub(super) struct RoundedEnd<S> {
    /// The end.
    pub end: ChordEnd<S>,
    /// Whether exact arithmetic has to decide its part and `t`.
    pub is_open: bool,
}

/// The disks in the order in which a line that is not across the axis crosses their planes.
///
/// The order depends on the sign of the slope, which no processor predicts. So nothing branches
/// on it: the planes are numbers computed from the sign.
pub(super) struct Disks<S> {
    sign: S,
    near: S,
    far: S,
}

impl<S: Real> Disks<S> {
    #[inline(always)]
    pub fn of(slab: &Slab<S>) -> Self {
        // The planes are exactly at 0 and at `height`, or at `height` and at 0.
        let sign = S::from_f64(1.0).copysign(slab.slope);
        let half = S::from_f64(-0.5) * slab.height;
        Self {
            sign,
            near: (sign - S::from_f64(1.0)) * half,
            far: (S::from_f64(-1.0) - sign) * half,
        }
    }

    #[inline(always)]
    fn near_part(&self) -> Part {
        if self.sign > S::ZERO {
            Part::Cap0
        } else {
            Part::Cap1
        }
    }

    #[inline(always)]
    fn far_part(&self) -> Part {
        if self.sign > S::ZERO {
            Part::Cap1
        } else {
            Part::Cap0
        }
    }
}

impl<S: Real, W: Wall<S>> Overlap<S, W> {
    /// The chord of a line across the axis.
    #[cold]
    fn across(&self) -> Option<Chord<S>> {
        if self.is_near_plane(self.slab.position) {
            return self.wall.exact_chord();
        }
        self.slab.across(self.wall.enter(), self.wall.leave())
    }

    /// The slab.
    #[inline(always)]
    pub fn slab(&self) -> &Slab<S> {
        &self.slab
    }

    /// Whether the line is across the axis.
    #[inline(always)]
    pub fn is_across(&self) -> bool {
        self.slab.slope == S::ZERO
    }

    /// Whether a height equals that of a plane, for a wall that does not decide at rims.
    #[inline(always)]
    fn is_rim(&self, height: S, plane: S) -> bool {
        !W::DECIDES_RIMS && height == plane
    }

    /// Whether a height may be on the other side of either plane.
    #[inline(always)]
    fn is_near_plane(&self, height: S) -> bool {
        if !W::DECIDES_RIMS {
            return false;
        }
        let other = height - self.slab.height;
        at_most(height * height, other * other) < self.wall.squared_rounding(&self.slab)
    }

    /// Whether the line enters the solid, and where.
    #[inline(always)]
    pub(super) fn enter(&self, disks: &Disks<S>) -> (bool, RoundedEnd<S>) {
        let slab = &self.slab;
        let t = self.wall.enter();
        let height = slab.beyond_near(disks, t);
        let is_open = self.is_near_plane(height);
        if height > S::ZERO {
            // At the far disk's height the chord is a single point, where the wall ends.
            let on_rim = self.is_rim(height, slab.height);
            let part = if on_rim { disks.far_part() } else { Part::Side };
            let end = ChordEnd { t, part, on_rim };
            (height <= slab.height, RoundedEnd { end, is_open })
        } else {
            let leave = self.wall.leave();
            let (to_leave, at_disk) = (slab.beyond_near(disks, leave), slab.at(disks.near));
            let end = ChordEnd {
                t: at_most(if at_disk < t { t } else { at_disk }, leave),
                part: disks.near_part(),
                // A line that leaves where it enters only touches the rim.
                on_rim: self.is_rim(height, S::ZERO) | self.is_rim(to_leave, S::ZERO),
            };
            let is_open = is_open | self.is_near_plane(to_leave);
            (to_leave >= S::ZERO, RoundedEnd { end, is_open })
        }
    }

    /// The end at which the line leaves the solid, if it enters at `enter`, an end that is not
    /// open.
    #[inline(always)]
    fn decided_leave(&self, disks: &Disks<S>, enter: S) -> ChordEnd<S> {
        let leave = self.leave(disks, enter);
        if self.is_leave_open(disks)
            && let Some(chord) = self.wall.exact_chord()
        {
            return chord.leave.not_before(enter);
        }
        leave
    }

    /// Whether the end at which the line leaves is open.
    #[inline(always)]
    pub(super) fn is_leave_open(&self, disks: &Disks<S>) -> bool {
        W::DECIDES_RIMS && self.is_near_plane(self.slab.beyond_near(disks, self.wall.leave()))
    }

    /// The end at which the line leaves, from rounded numbers.
    #[inline(always)]
    pub(super) fn leave(&self, disks: &Disks<S>, enter: S) -> ChordEnd<S> {
        let slab = &self.slab;
        let t = self.wall.leave();
        let height = slab.beyond_near(disks, t);
        let end = if height < slab.height {
            let on_rim = self.is_rim(height, S::ZERO);
            let part = if on_rim {
                disks.near_part()
            } else {
                Part::Side
            };
            ChordEnd { t, part, on_rim }
        } else {
            // A line that enters the wall at the far disk's height only touches the rim. The
            // chord's own entry is no substitute: at the near disk of a solid that is flatter
            // than the rounding of heights, it has any height.
            let to_enter = slab.beyond_near(disks, self.wall.enter());
            ChordEnd {
                t: at_most(slab.at(disks.far), t),
                part: disks.far_part(),
                on_rim: self.is_rim(height, slab.height) | self.is_rim(to_enter, slab.height),
            }
        };
        // At an edge, rounding may put the two in the wrong order; for a line almost across the
        // axis, by any amount.
        end.not_before(enter)
    }
}

/// The lesser number.
#[inline(always)]
fn at_most<S: Real>(t: S, greatest: S) -> S {
    if t > greatest { greatest } else { t }
}

impl<S: Real> Slab<S> {
    /// The distance of the line at `t` beyond the near disk's plane, in its own direction.
    #[inline(always)]
    fn beyond_near(&self, disks: &Disks<S>, t: S) -> S {
        disks.near + disks.sign * (self.position + t * self.slope)
    }

    /// The parameter at which the line crosses a plane.
    #[inline(always)]
    fn at(&self, plane: S) -> S {
        (plane - self.position) / self.slope
    }

    /// The part of a wall between the disks.
    #[inline(always)]
    pub fn overlap<W: Wall<S>>(self, wall: W) -> Overlap<S, W> {
        Overlap { slab: self, wall }
    }

    /// The chord of a line along the axis that is inside the wall, or on it.
    #[cold]
    pub fn along(&self, on_wall: bool) -> Option<Chord<S>> {
        if self.slope == S::ZERO {
            return None;
        }
        let (cap0, cap1) = (self.cap0(on_wall), self.cap1(on_wall));
        let (enter, leave) = if self.slope > S::ZERO {
            (cap0, cap1)
        } else {
            (cap1, cap0)
        };
        Some(Chord {
            enter,
            leave,
            lies_on: on_wall.then_some(Part::Side),
        })
    }

    /// The chord of a line across the axis: from wall to wall at one height, which may be that
    /// of a disk.
    #[cold]
    fn across(&self, t0: S, t1: S) -> Option<Chord<S>> {
        let y = self.position;
        if !(S::ZERO <= y && y <= self.height) {
            return None;
        }
        let disk = if y == S::ZERO {
            Some(Part::Cap0)
        } else if y == self.height {
            Some(Part::Cap1)
        } else {
            None
        };
        Some(Chord::across([t0, t1], disk))
    }

    #[inline]
    fn cap0(&self, on_rim: bool) -> ChordEnd<S> {
        ChordEnd {
            t: -self.position / self.slope,
            part: Part::Cap0,
            on_rim,
        }
    }

    #[inline]
    fn cap1(&self, on_rim: bool) -> ChordEnd<S> {
        ChordEnd {
            t: (self.height - self.position) / self.slope,
            part: Part::Cap1,
            on_rim,
        }
    }
}
