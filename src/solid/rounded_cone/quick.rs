//! The intersection of a line and a rounded cone without exact numbers or branches, for
//! [`quick`](crate::solid::quick).
//!
//! A root of the wall that is not between the seams is cut off by the ball on its side: from
//! there, inside of the infinite wall, the line reaches the part between the seams through that
//! ball alone. So one ball is enough for each end. The solver takes the first entry into either
//! ball, which is the same one if the rounded parameters are in the exact order. A point of the
//! one sphere beyond its seam is outside of the other ball: with `p` relative to the center of
//! the one, of radius r, and heights `p·a <= -r Δ`,
//!
//! ```text
//! |p - a|² - r'² >= β                                                      (1)
//! ```
//!
//! so the distance from there to the other ball is at least `β / (|a| + r + r')`. Either
//! parameter is within 2^-36 `(|x| + |a| + R) / |d|` of itself, R the greater radius, by (3) of
//! `ball` or the solver's own rule. With `Z = |a|² + R²`, `(|a| + 2 R)² <= 8 Z` and
//! `(|x| + |a| + R)² <= 3 (|x|² + Z)`, they are in order if
//!
//! ```text
//! 2^-60 (|x|² + Z) Z < β²                                                  (2)
//! ```
//!
//! since `8 · 3 · 2^-70` is less than that. This excludes only solids from afar. If one ball
//! contains the other, `β` is not good and the line is open.

use glam::DVec3;

use super::RoundedCone;
use crate::math::power_of_two;
use crate::solid::ball::QuickBall;
use crate::solid::cone::quick::{QuickWall, Side};
use crate::solid::cone::taper::{Fit, Taper};
use crate::solid::quick::{End, Quick, Range};

/// The first intersection of the line `p0 + x + t d`.
#[inline(always)]
pub(super) fn first(solid: &RoundedCone, x: DVec3, d: DVec3, range: &Range) -> Quick {
    let taper = solid.ends.taper(Fit::Balls);
    let wall = QuickWall::new(&taper, x, d);
    let (enter, leave) = (wall.side(&wall.enter), wall.side(&wall.leave));
    let (of_enter, of_leave) = (ball(&taper, x, d, &enter), ball(&taper, x, d, &leave));
    let is_settled = |side: &Side, ball: &QuickBall| side.is_between() | ball.is_plain;
    let is_hit = |side: &Side, ball: &QuickBall| side.is_between() | ball.is_hit;
    let end = |root: End, side: &Side, of_ball: End| root.or(of_ball, side.is_between());
    let first = end(wall.enter, &enter, of_enter.ends[0]);
    let last = end(wall.leave, &leave, of_leave.ends[1]);
    let is_inside = is_hit(&enter, &of_enter) & is_hit(&leave, &of_leave);
    let is_open = wall.is_open
        | !(enter.is_certain & leave.is_certain)
        | !(is_settled(&enter, &of_enter) & is_settled(&leave, &of_leave))
        | !is_near(&taper, x)
        | (is_inside & !last.is_after(&first));
    Quick::of_chord(is_open, is_inside, [first, last], range)
}

/// The ball on a side: that at `p1` if the side is beyond the second seam. A function, because
/// closures are not always inlined.
#[inline(always)]
fn ball(taper: &Taper, x: DVec3, d: DVec3, side: &Side) -> QuickBall {
    let (center, radius) = if side.is_beyond {
        (taper.a, taper.radius1)
    } else {
        (DVec3::ZERO, taper.radius0)
    };
    QuickBall::new(x - center, d, radius, taper.a.length())
}

/// Whether the parameters of the balls are in order, by (2).
#[inline(always)]
fn is_near(taper: &Taper, x: DVec3) -> bool {
    let (beta, _) = taper.rounded_beta();
    let radius = taper.radius0.max(taper.radius1);
    let size = taper.a.dot(taper.a) + radius * radius;
    power_of_two(-60) * (x.dot(x) + size) * size < beta * beta
}
