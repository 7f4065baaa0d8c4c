//! Ray against rounded cone: two balls and the cone that touches both.
//!
//! With `a = p1 - p0` and `Δ = r1 - r0`, the wall of the touching cone (`cone/wall.rs`, with
//! `β = |a|² - Δ²`) touches the balls in two circles, the seams, and belongs to the hull
//! between them (`cone/heights.rs`). If `β <= 0`, one ball contains the other and is the hull.
//!
//! A line enters the hull where it enters the wall, if that is between the seams; otherwise it
//! enters on a sphere, at the first entry into a ball. The same applies where it leaves. The
//! disks at the seams are within the balls and never tested.
//!
//! **No gap at a seam.** Whether the line hits a ball or the infinite wall, and on which side
//! of a seam, is decided exactly, from the same numbers. So a line that grazes the hull at a
//! seam hits the one part or the other. A seam belongs to its sphere.

use std::cmp::Ordering::{Greater, Less};

use glam::DVec3;

use super::RoundedCone;
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::cone::heights::{End, Heights, Root};
use crate::solid::cone::solver::along;
use crate::solid::cone::taper::{Fit, Taper};
use crate::solid::cone::wall::WallIntersection;
use crate::solid::offset::Offset;
use crate::solid::{Part, ball};

/// The interval in which the line `p0 + x + t d` is inside the hull of balls neither of which
/// contains the other; `from_p1` is its origin relative to the other end.
pub(super) fn chord<A: Offset>(
    taper: &Taper<A>,
    x: impl Offset,
    from_p1: impl Offset,
    d: DVec3,
) -> Option<Chord> {
    let (radius0, radius1) = (taper.radius0, taper.radius1);
    let ball0 = || ball::chord(x, d, radius0, Part::Cap0);
    let ball1 = || ball::chord(from_p1, d, radius1, Part::Cap1);
    let [mut enter, mut leave] = [None, None];
    if let Some(hit) = taper.intersect(x, d) {
        let heights = Heights::new(taper, x, d);
        let inside = match hit {
            WallIntersection::Along => return Some(along(&heights, Part::Side)),
            WallIntersection::Inside(inside) => inside,
        };
        enter = between_seams(&heights, Root::Enter, inside.enter);
        leave = between_seams(&heights, Root::Leave, inside.leave);
    }
    if enter.is_none() || leave.is_none() {
        let balls = [ball0(), ball1()];
        let [enters, leaves] = [
            balls.map(|ball| ball.map(|ball| ball.enter)),
            balls.map(|ball| ball.map(|ball| ball.leave)),
        ];
        enter = enter.or_else(|| first(enters, |one, other| one.t <= other.t));
        leave = leave.or_else(|| first(leaves, |one, other| one.t >= other.t));
    }
    // Either both exist or neither.
    let (enter, leave) = (enter?, leave?);
    Some(Chord {
        enter,
        // Next to a tangent, rounding may put the two in the wrong order.
        leave: ChordEnd {
            t: leave.t.max(enter.t),
            ..leave
        },
        lies_on: None,
    })
}

/// The first of up to two ends in the given order.
fn first(
    ends: [Option<ChordEnd>; 2],
    is_before: fn(&ChordEnd, &ChordEnd) -> bool,
) -> Option<ChordEnd> {
    match ends {
        [Some(one), Some(other)] if is_before(&one, &other) => Some(one),
        [one, other] => other.or(one),
    }
}

/// The end at a root of the wall, if it is between the seams.
fn between_seams(
    heights: &Heights<impl Offset, impl Offset>,
    root: Root,
    t: f64,
) -> Option<ChordEnd> {
    let is_between = if heights.slope == 0.0 {
        heights.above[0] > 0.0 && heights.above[1] < 0.0
    } else {
        heights.compare(root, t, End::First) == Greater
            && heights.compare(root, t, End::Second) == Less
    };
    is_between.then_some(ChordEnd {
        t,
        part: Part::Side,
        on_rim: false,
    })
}

impl RoundedCone {
    /// The cone that touches both balls; `None` if one contains the other.
    pub(in crate::solid) fn taper(&self) -> Option<Taper> {
        let taper = self.ends.taper(Fit::Balls);
        (taper.beta() > 0.0).then_some(taper)
    }
}
