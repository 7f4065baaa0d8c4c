//! The intersection of a line and a cone's wall without exact numbers or branches, for
//! [`quick`](crate::solid::quick).
//!
//! Roots and heights have the formulas, and so the bits, of `wall.rs` and `heights.rs`. A line
//! is open if (6) of `rounded.rs` does not decide it, if its slope is poor, or if a root's
//! height is too near to that of an end.
//!
//! **Slack.** The solver computes `C` and the height of an origin from exact numbers if rounded
//! ones have lost too much, as for rays that start on the surface. Then an end is known within
//!
//! ```text
//! 2 δC / |q|  for a root,      2^-48 S / |s|  for a disk
//! ```
//!
//! with `δC` of (5), `s` the slope, and `S` the sum of the sizes of a height's terms, which
//! round by less than 8 u of it (the dot product by 3 u; the sum, the difference `x - a`, and
//! `x` and `a` themselves by u each). Both are twice the propagated error, for the roundings of
//! the quotients.
//!
//! **Heights.** `heights.rs` decides by rounded heights beyond [`NEAR`] of their terms, and
//! exactly within; both give the exact sign. So the side is certain if a rounded height here is
//! beyond `2 NEAR (S + |t s|) + 2 |s| slack`. The second `NEAR`, 2^-28, has room for the excess
//! of `S`, 2^-49 of itself, for `x` and `a` as rounded differences, which displace heights by 4
//! u of their terms and roots by less than the errors of (6), and for exact heights above the
//! ends.
//!
//! `S` is computed with `|x| + |y| + |z|` in place of a length, without a root. It is above the
//! solver's, and the squared test of the slope is above that of the solver by half: what the
//! solver computes exactly is poor here.

use glam::DVec3;

use super::Cone;
use super::heights::{CANCELS, NEAR, Rounded as Heights, plane_at, terms};
use super::roots::Inside;
use super::rounded::Rounded;
use super::taper::{Fit, Taper};
use crate::math::power_of_two;
use crate::solid::linear::sum_of_sizes;
use crate::solid::quick::{End, Quick, Range};

/// The first intersection of the line `p0 + x + t d`. A cone with equal radii is solved as a
/// cylinder, and open here.
#[inline(always)]
pub(super) fn first(cone: &Cone, x: DVec3, d: DVec3, range: &Range) -> Quick {
    let ends = &cone.ends;
    let wall = QuickWall::new(&ends.taper(Fit::Disks), x, d);
    let (enter, leave) = (wall.side(&wall.enter), wall.side(&wall.leave));
    // A root outside of the disks is replaced by the disk on that side, through which the line
    // passes.
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
    /// Whether it needs exact numbers; then the rest has no meaning.
    pub is_open: bool,
    /// Where the line enters; minus infinity if it is inside from the start.
    pub enter: End,
    /// Where the line leaves.
    pub leave: End,
    heights: Heights,
    /// `S`.
    terms: f64,
}

/// The position of a root along the axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Side {
    pub is_before: bool,
    pub is_beyond: bool,
    pub is_certain: bool,
}

impl Side {
    /// Whether it is between the ends.
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
            terms: terms(taper, sum_of_sizes(x)),
        }
    }

    /// The position of a root.
    #[inline(always)]
    pub fn side(&self, root: &End) -> Side {
        let Heights { slope, above } = self.heights;
        let rise = root.t * slope;
        let error = 2.0 * (NEAR * (self.terms + rise.abs()) + root.slack * slope.abs());
        let [over0, over1] = above.map(|above| above + rise);
        let is_certain = (over0.abs() > error) & (over1.abs() > error);
        Side {
            is_before: over0 < 0.0,
            is_beyond: over1 > 0.0,
            is_certain: is_certain | (rise.abs() == f64::INFINITY),
        }
    }

    /// The parameter at which the line crosses the plane across the axis at an end.
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
