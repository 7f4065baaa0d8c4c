//! Ray against cuboid, by slabs.
//!
//! With the cuboid's axes `f_i` as they are stored, its half widths `h_i` and the
//! ray `center + x + t d`, the line is between the two planes of axis i where
//!
//! ```text
//! -h_i <= f_i·x + t f_i·d <= h_i                                           (1)
//! ```
//!
//! so for `t` between `-(h_i + f_i·x) / f_i·d` and `(h_i - f_i·x) / f_i·d`, the near and the
//! far plane in some order. The chord extends from the greatest near `t` to the least far one.
//! If `f_i·d` is zero, the line is either inside or outside of the slab as a whole.
//!
//! Each numerator and denominator is a height over a plane. `linear.rs` computes it with the
//! exact sign, and such that a `t` is within [`MARGIN`] of itself. Two values of `t` that
//! differ by more are in their order. For others, as at edges and corners, and for a line
//! within a face, the order of the planes is the sign of `N_i V_j - N_j V_i`, the difference of
//! two quotients `N / V` without their division, from exact numbers. So the result, hit or miss
//! and which faces, is always that of the exact numbers.
//!
//! In both cases a point on several faces belongs to that of the first axis.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Cuboid, FACES};
use crate::solid::Part;
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::exact::{Expression, Number, dot, sign, vector};
use crate::solid::linear::{self, MARGIN};
use crate::solid::offset::Offset;
use crate::solid::quick::{End, Quick, Range};

/// One of the two planes of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    axis: usize,
    /// Whether it is the plane at `+h`.
    is_upper: bool,
    /// Where the line crosses it.
    t: f64,
}

/// The position of the line relative to the two planes of an axis.
#[derive(Clone, Copy, Debug)]
enum Slab {
    /// It crosses both, the near one first.
    Crossed { near: Plane, far: Plane },
    /// It runs between them, parallel.
    Along,
    /// It lies within one of them.
    Within(Part),
}

/// The chord of the line `center + x + t d`.
#[inline]
pub(super) fn chord(cuboid: &Cuboid, x: impl Offset, d: DVec3) -> Option<Chord> {
    // Zero times infinity or NaN is NaN.
    if (x.rounded() + d).dot(DVec3::ZERO) != 0.0 {
        return None;
    }
    let slabs = [
        slab(cuboid, 0, x, d)?,
        slab(cuboid, 1, x, d)?,
        slab(cuboid, 2, x, d)?,
    ];
    let (mut enter, mut leave) = (None::<Plane>, None::<Plane>);
    let mut is_settled = true;
    for slab in slabs {
        match slab {
            Slab::Crossed { near, far } => {
                let (latest, soonest) = (enter.unwrap_or(near), leave.unwrap_or(far));
                is_settled &= enter.is_none() | are_apart(latest.t, near.t);
                is_settled &= leave.is_none() | are_apart(soonest.t, far.t);
                enter = Some(if near.t > latest.t { near } else { latest });
                leave = Some(if far.t < soonest.t { far } else { soonest });
            }
            Slab::Along => {}
            Slab::Within(_) => is_settled = false,
        }
    }
    let (enter, leave) = (enter?, leave?);
    if !are_apart(enter.t, leave.t) {
        is_settled = false;
    } else if enter.t > leave.t {
        return None;
    }
    if !is_settled {
        return exact_chord(*cuboid, x, d, slabs);
    }
    Some(Chord {
        enter: end(enter.t, enter.part()),
        leave: end(leave.t, leave.part()),
        lies_on: None,
    })
}

/// The first intersection of the line `center + x + t d`; see [`quick`](crate::solid::quick).
#[inline(always)]
pub(super) fn quick_first(cuboid: &Cuboid, x: DVec3, d: DVec3, range: &Range) -> Quick {
    let [mut enter, mut leave] = [f64::NEG_INFINITY, f64::INFINITY].map(|t| End { t, slack: 0.0 });
    let mut is_open = false;
    for axis in 0..3 {
        let f = cuboid.axis(axis);
        let slope = linear::rounded_product(f, d);
        let heights = linear::rounded_heights(f, x, cuboid.half_widths[axis]);
        let ts = planes_at(slope.value, heights.map(|height| height.value));
        let [lower, upper] = [0, 1].map(|side| End {
            t: ts[side],
            slack: heights[side].slack() / slope.value.abs(),
        });
        let is_rising = slope.value > 0.0;
        let (near, far) = if is_rising {
            (lower, upper)
        } else {
            (upper, lower)
        };
        if axis > 0 {
            is_open |= !enter.is_apart(&near, MARGIN) | !leave.is_apart(&far, MARGIN);
        }
        is_open |= slope.is_poor();
        enter = if near.t > enter.t { near } else { enter };
        leave = if far.t < leave.t { far } else { leave };
    }
    is_open |= !enter.is_apart(&leave, MARGIN);
    Quick::of_chord(is_open, enter.t < leave.t, [enter, leave], range)
}

/// Whether two parameters differ by more than their errors.
#[inline(always)]
fn are_apart(one: f64, other: f64) -> bool {
    (one - other).abs() > MARGIN * (one.abs() + other.abs())
}

/// `None` if the line is outside of the slab.
#[inline(always)]
fn slab(cuboid: &Cuboid, axis: usize, x: impl Offset, d: DVec3) -> Option<Slab> {
    let f = cuboid.axis(axis);
    let slope = linear::product(f, d);
    let [over_lower, under_upper] = linear::heights(f, x, cuboid.half_widths[axis]);
    if slope == 0.0 {
        return along(axis, over_lower, under_upper);
    }
    let plane = |is_upper, t| Plane { axis, is_upper, t };
    let [lower, upper] = planes_at(slope, [over_lower, under_upper]);
    let (lower, upper) = (plane(false, lower), plane(true, upper));
    Some(if slope > 0.0 {
        Slab::Crossed {
            near: lower,
            far: upper,
        }
    } else {
        Slab::Crossed {
            near: upper,
            far: lower,
        }
    })
}

/// The parameters at which a line crosses the planes of an axis.
#[inline(always)]
fn planes_at(slope: f64, [over_lower, under_upper]: [f64; 2]) -> [f64; 2] {
    [(0.0 - over_lower) / slope, under_upper / slope]
}

fn along(axis: usize, over_lower: f64, under_upper: f64) -> Option<Slab> {
    if over_lower < 0.0 || under_upper < 0.0 {
        None
    } else if over_lower == 0.0 {
        Some(Slab::Within(FACES[axis][0]))
    } else if under_upper == 0.0 {
        Some(Slab::Within(FACES[axis][1]))
    } else {
        Some(Slab::Along)
    }
}

impl Plane {
    fn part(self) -> Part {
        FACES[self.axis][usize::from(self.is_upper)]
    }
}

fn end(t: f64, part: Part) -> ChordEnd {
    ChordEnd {
        t,
        part,
        on_rim: false,
    }
}

/// As [`chord`], with every comparison from exact numbers.
#[cold]
#[inline(never)]
fn exact_chord<W: Offset>(cuboid: Cuboid, x: W, d: DVec3, slabs: [Slab; 3]) -> Option<Chord> {
    let line = Line { cuboid, x, d };
    let crossed = || {
        slabs.iter().filter_map(|slab| match *slab {
            Slab::Crossed { near, far } => Some((near, far)),
            Slab::Along | Slab::Within(_) => None,
        })
    };
    // The first axis wins ties.
    let enter = crossed().map(|(near, _)| near).reduce(|latest, near| {
        if line.compare(near, latest) == Ordering::Greater {
            near
        } else {
            latest
        }
    })?;
    let leave = crossed().map(|(_, far)| far).reduce(|soonest, far| {
        if line.compare(far, soonest) == Ordering::Less {
            far
        } else {
            soonest
        }
    })?;
    let order = line.compare(enter, leave);
    if order == Ordering::Greater {
        return None;
    }
    let part_at = |plane: Plane| {
        let containing = slabs.iter().find_map(|slab| match *slab {
            Slab::Crossed { near, far } => [near, far]
                .into_iter()
                .find(|other| line.compare(*other, plane) == Ordering::Equal)
                .map(Plane::part),
            Slab::Along => None,
            Slab::Within(part) => Some(part),
        });
        containing.unwrap_or(plane.part())
    };
    let lies_on = slabs.iter().find_map(|slab| match *slab {
        Slab::Within(part) => Some(part),
        Slab::Crossed { .. } | Slab::Along => None,
    });
    // The same from either side: the `t` of the first axis, or the middle of two neighbouring
    // values in the wrong order.
    let [t_enter, t_leave] = if order == Ordering::Equal {
        [if enter.axis < leave.axis {
            enter
        } else {
            leave
        }
        .t; 2]
    } else if enter.t > leave.t {
        [0.5 * (enter.t + leave.t); 2]
    } else {
        [enter.t, leave.t]
    };
    Some(Chord {
        enter: end(t_enter, part_at(enter)),
        leave: end(t_leave, part_at(leave)),
        lies_on,
    })
}

struct Line<W> {
    cuboid: Cuboid,
    x: W,
    d: DVec3,
}

impl<W: Offset> Line<W> {
    /// Compares the parameters at which the line crosses two planes.
    fn compare(&self, one: Plane, other: Plane) -> Ordering {
        if one == other {
            return Ordering::Equal;
        }
        let slope = |plane: Plane| linear::product(self.cuboid.axis(plane.axis), self.d);
        let order = sign(&Order {
            line: self,
            one,
            other,
        });
        if (slope(one) < 0.0) == (slope(other) < 0.0) {
            order
        } else {
            order.reverse()
        }
    }
}

/// `N_i V_j - N_j V_i` of two planes.
struct Order<'a, W> {
    line: &'a Line<W>,
    one: Plane,
    other: Plane,
}

impl<W: Offset> Expression for Order<'_, W> {
    fn value<N: Number>(&self) -> N {
        let (x, d) = (self.line.x.exactly::<N>(), vector(self.line.d));
        let cuboid = &self.line.cuboid;
        let quotient = |plane: Plane| {
            let f = vector(cuboid.axis(plane.axis));
            let half_width = cuboid.half_widths[plane.axis];
            let side = if plane.is_upper {
                half_width
            } else {
                -half_width
            };
            (N::of(side).minus(&dot(&f, &x)), dot(&f, &d))
        };
        let ((n_one, v_one), (n_other, v_other)) = (quotient(self.one), quotient(self.other));
        n_one.times(&v_other).minus(&n_other.times(&v_one))
    }
}
