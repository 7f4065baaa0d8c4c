//! The wall's interval of `t` overlapped with the slab between the discs.
//!
//! A solver finds where a line is inside the infinite wall; the solid is the
//! part of that between the planes of the discs. The axial position of a point
//! of the line is `y = position + t * slope`, counted from `p0` in any unit,
//! and the point is inside the slab iff `0 <= y <= height`. Both ends of the
//! overlap are judged by `y` at the wall's roots: wall and discs are chosen
//! from the same numbers, so that no ray slips between them at a rim.

use super::Part;
use super::chord::{Chord, ChordEnd};
use crate::math::Real;

/// A line as seen along the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slab<S> {
    /// The axial position of the disc at `p1`; that at `p0` is at 0.
    pub height: S,
    /// The axial position at `t = 0`.
    pub position: S,
    /// What `t = 1` adds to the position.
    pub slope: S,
}

impl<S: Real> Slab<S> {
    /// The chord of a line that is inside the infinite wall from `t0` to `t1`.
    ///
    /// Which disc comes first depends on the sign of the slope, which no
    /// processor predicts. So nothing branches on it: the planes are numbers
    /// that are computed from the sign, and both ends are choices between two
    /// computed values.
    #[inline(always)]
    pub fn overlap(&self, t0: S, t1: S) -> Option<Chord<S>> {
        if self.slope == S::ZERO {
            return self.across(t0, t1);
        }
        // The planes at which the line goes into the slab and out of it: at
        // 0 and at `height`, or the other way round, exactly. The zero is -0.0,
        // from which anything can be taken away without a change but of sign.
        let sign = S::from_f64(1.0).copysign(self.slope);
        let half = S::from_f64(-0.5) * self.height;
        let near = (sign - S::from_f64(1.0)) * half;
        let far = (S::from_f64(-1.0) - sign) * half;

        // How far beyond the near plane the roots are, in the ray's direction.
        let (y0, y1) = (
            self.position + t0 * self.slope,
            self.position + t1 * self.slope,
        );
        let (y_enter, y_leave) = (near + sign * y0, near + sign * y1);
        if !((y_enter <= self.height) & (y_leave >= S::ZERO)) {
            return None;
        }

        let (near_part, far_part) = if self.slope > S::ZERO {
            (Part::Cap0, Part::Cap1)
        } else {
            (Part::Cap1, Part::Cap0)
        };
        let end = |is_side: bool, t: S, y: S, plane: S, cap: Part| ChordEnd {
            t: if is_side {
                t
            } else {
                (plane - self.position) / self.slope
            },
            part: if is_side { Part::Side } else { cap },
            on_rim: !is_side & (y == plane),
        };
        let enter = end(y_enter > S::ZERO, t0, y0, near, near_part);
        let leave = end(y_leave < self.height, t1, y1, far, far_part);
        // At an edge the two may come out in the wrong order by a rounding.
        let leave = ChordEnd {
            t: if leave.t < enter.t { enter.t } else { leave.t },
            ..leave
        };
        Some(Chord {
            enter,
            leave,
            lies_on: None,
        })
    }

    /// The chord of a line along the axis that is inside the wall, or on it
    /// all the way.
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

    /// The chord of a line across the axis: from wall to wall at one height,
    /// which may be that of a disc.
    #[cold]
    fn across(&self, t0: S, t1: S) -> Option<Chord<S>> {
        let y = self.position;
        if !(S::ZERO <= y && y <= self.height) {
            return None;
        }
        let disc = if y == S::ZERO {
            Some(Part::Cap0)
        } else if y == self.height {
            Some(Part::Cap1)
        } else {
            None
        };
        let end = |t| ChordEnd {
            t,
            part: disc.unwrap_or(Part::Side),
            on_rim: disc.is_some(),
        };
        Some(Chord {
            enter: end(t0),
            leave: end(t1),
            lies_on: disc,
        })
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
