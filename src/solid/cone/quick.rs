//! A cone's wall and a line without exact numbers or branches, for [`quick`](crate::solid::quick).
//!
//! Roots and heights have the formulas, and so the bits, of `wall.rs` and `heights.rs`. A line
//! is open where (6) of `rounded.rs` does not decide it, where its slope is poor, or where
//! a root's height is too near to that of an end.
//!
//! **Slack.** The solver takes `C` and the height of an origin from exact numbers where
//! rounded ones have lost too much, as for rays that start on the surface. Then an end is
//! known within
//!
//! ```text
//! 2 δC / |q|  for a root,      2^-48 S / |s|  for a disk
//! ```
//!
//! with `δC` of (5), `S` the sizes of the terms of a height, which round by less than 8 u
//! of them (the dot product by 3 u; by u each the sum, the difference `x - a`, and `x` and
//! `a` themselves) and `s` the slope: either is twice what follows from the error, for the
//! roundings of the quotients.
//!
//! **Heights.** `heights.rs` decides by rounded heights beyond [`NEAR`] of their terms, and
//! exactly within; either is the exact sign. So the side is certain where a rounded height here
//! is beyond `2 NEAR (S + |t s|) + 2 |s| slack`. The second `NEAR`, 2^-28, has room for
//! what `S` is above 2^-49 of itself, for `x` and `a` as rounded differences, which
//! displace heights by 4 u of their terms and roots by less than the errors of (6)
//! do, and for heights above the ends from exact numbers.
//!
//! `S` is computed with `|x| + |y| + |z|` in place of a length, so that it has no root. It
//! is above the solver's, and the squared test of the slope is above that of the
//! solver by half: what the solver computes exactly is poor here.

use glam::DVec3;

use super::Cone;
use super::heights::{CANCELS, NEAR, Rounded as Heights, plane_at, terms};
use super::rounded::Rounded;
use super::wall::{Fit, Inside, Taper};
use crate::math::power_of_two;
use crate::solid::quick::{End, Quick, Range};

/// The first intersection of the line `p0 + x + t d`. A cone with equal radii is the
/// triple-product solver's, and open.
#[inline(always)]
pub(super) fn first(cone: &Cone, x: DVec3, d: DVec3, range: &Range) -> Quick {
    let ends = &cone.ends;
    let wall = QuickWall::new(&ends.taper(Fit::Disks), x, d);
    let (enter, leave) = (wall.side(&wall.enter), wall.side(&wall.leave));
    // The line comes to a root outside of the disks through the disk on that side.
    let [disk0, disk1] = [wall.plane(0), wall.plane(1)];
    let end = |root: End, side: &Side| root.or(disk0.or(disk1, side.is_before), side.is_between());
    let (first, last) = (end(wall.enter, &enter), end(wall.leave, &leave));
    let is_there =
        |side: &Side| (!side.is_before | cone.caps.at_p0()) & (!side.is_beyond | cone.caps.at_p1());
    let is_inside = !(enter.is_before & leave.is_before) & !(enter.is_beyond & leave.is_beyond);
    let is_open = wall.is_open
        | (ends.radius0 == ends.radius1)
        | !(enter.is_certain & leave.is_certain)
        | (is_inside & !last.is_after(&first));
    let ends = [
        first.if_there(is_there(&enter)),
        last.if_there(is_there(&leave)),
    ];
    Quick::of_chord(is_open, is_inside, ends, range)
}

/// A wall and a line.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct QuickWall {
    /// Whether it takes exact numbers; the rest has no meaning then.
    pub is_open: bool,
    /// Where the line comes in, at infinity if it always was.
    pub enter: End,
    /// Where it goes out.
    pub leave: End,
    heights: Heights,
    /// `S`.
    terms: f64,
}

/// Where a root is as seen along the axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Side {
    pub is_before: bool,
    pub is_beyond: bool,
    pub is_certain: bool,
}

impl Side {
    /// Whether it is of the solid.
    #[inline(always)]
    pub fn is_between(&self) -> bool {
        !(self.is_before | self.is_beyond)
    }
}

impl QuickWall {
    #[inline(always)]
    pub fn new(taper: &Taper, x: DVec3, d: DVec3) -> Self {
        let (beta, is_beta_good) = taper.rounded_beta();
        let rounded = Rounded::new(taper, x, d, beta);
        let (roots, c) = (rounded.roots, rounded.constant_term());
        let Inside { enter, leave } = roots.inside(rounded.h > 0.0, || c);
        let displaced = 2.0 * rounded.error_of_constant_term() / roots.noncancelling().abs();
        let [of_enter, of_leave] = roots
            .sums()
            .map(|sum| if roots.cancels(sum) { displaced } else { 0.0 });
        let heights = Heights::new(taper, x, d);
        let squared = heights.slope * heights.slope;
        let is_slope_poor = squared < 1.5 * CANCELS * CANCELS * (d.dot(d) * taper.a.dot(taper.a));
        let sizes = x.abs();
        Self {
            is_open: !is_beta_good | !rounded.is_plain() | is_slope_poor,
            enter: End {
                t: enter,
                slack: of_enter,
            },
            leave: End {
                t: leave,
                slack: of_leave,
            },
            heights,
            terms: terms(taper, sizes.x + sizes.y + sizes.z),
        }
    }

    /// Where a root is.
    #[inline(always)]
    pub fn side(&self, root: &End) -> Side {
        let Heights { slope, above } = self.heights;
        let way = root.t * slope;
        let error = 2.0 * (NEAR * (self.terms + way.abs()) + root.slack * slope.abs());
        let [over0, over1] = above.map(|above| above + way);
        let is_certain = (over0.abs() > error) & (over1.abs() > error);
        Side {
            is_before: over0 < 0.0,
            is_beyond: over1 > 0.0,
            is_certain: is_certain | (way.abs() == f64::INFINITY),
        }
    }

    /// Where the line comes through the plane across the axis at an end.
    #[inline(always)]
    fn plane(&self, end: usize) -> End {
        let Heights { slope, above } = self.heights;
        let is_poor = above[end].abs() < 2.0 * CANCELS * self.terms;
        End {
            t: plane_at(above[end], slope),
            slack: if is_poor {
                power_of_two(-48) * self.terms / slope.abs()
            } else {
                0.0
            },
        }
    }
}
