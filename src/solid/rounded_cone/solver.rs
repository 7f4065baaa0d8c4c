//! Ray against rounded cone: two balls and the cone that touches both.
//!
//! With `a = p1 - p0`, `Δ = r1 - r0` and the height `y = x·a`, the touching cone's
//! wall (`cone/wall.rs`, with `β = |a|² - Δ²`) meets the balls in circles at `y = -r0
//! Δ` and `y = |a|² - r1 Δ`, the seams. Counted from the first, `z = y + r0 Δ`, the
//! wall belongs to the hull for `0 <= z <= β`. If `β <= 0` one ball holds the
//! other and is the hull.
//!
//! A line enters the hull where it enters the wall, if that is between the seams;
//! otherwise it enters on a sphere, and the first entry into a ball is that. It
//! leaves alike. The discs at the seams are within the balls and never asked for.
//!
//! **No gap at a seam.** Rounding may put a point of the wall on the wrong side of
//! a seam, and a line that grazes the wall there misses the ball. So the wall
//! counts as far as [`SEAM`] of the terms of `z` beyond the seams: more than their
//! error and that of `t` (2^-37, see `wall.rs`). It leaves the sphere with the square
//! of that way, so that what is added is below 2^-60 of the radius. Within that
//! distance of a seam the point is the sphere's, if the line meets it: a seam
//! belongs to its sphere.

use std::cmp::Ordering;

use glam::DVec3;

use super::RoundedCone;
use crate::math::power_of_two;
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::cone::wall::{Fit, Meets, Taper};
use crate::solid::slab::Slab;
use crate::solid::{Part, ball};

/// How near to a seam a point of the wall is taken to be at it, relative to the
/// terms of `z`.
const SEAM: f64 = power_of_two(-34);

/// The interval in which the line `p0 + x + t d` is inside the hull.
pub(super) fn chord(solid: &RoundedCone, x: DVec3, d: DVec3) -> Option<Chord> {
    let a = solid.p1 - solid.p0;
    let ball0 = || ball::chord(x, d, solid.radius0, Part::Cap0);
    let ball1 = || ball::chord(x - a, d, solid.radius1, Part::Cap1);
    let Some(taper) = solid.taper() else {
        return if solid.radius0 >= solid.radius1 {
            ball0()
        } else {
            ball1()
        };
    };
    let balls = [ball0(), ball1()];
    let seams = Seams::new(&taper, x, d);
    let inside = match taper.meets(x, d) {
        Some(Meets::Along) => return seams.slab.along(true),
        Some(Meets::Inside(inside)) => Some(inside),
        None => None,
    };
    let enters = balls.map(|ball| ball.map(|ball| ball.enter));
    let leaves = balls.map(|ball| ball.map(|ball| ball.leave));
    let enter = inside
        .and_then(|inside| seams.wall(inside.enter, enters))
        .or_else(|| least(enters, |one, other| one.t <= other.t));
    let leave = inside
        .and_then(|inside| seams.wall(inside.leave, leaves))
        .or_else(|| least(leaves, |one, other| one.t >= other.t));
    // Where only one is known by a rounding, the line grazes the hull there.
    let (enter, leave) = (enter.or(leave)?, leave.or(enter)?);
    Some(Chord {
        enter,
        leave: ChordEnd {
            t: leave.t.max(enter.t),
            ..leave
        },
        lies_on: None,
    })
}

/// Of two ends that may be there, the one that is before the other.
fn least(
    ends: [Option<ChordEnd>; 2],
    before: fn(&ChordEnd, &ChordEnd) -> bool,
) -> Option<ChordEnd> {
    match ends {
        [Some(one), Some(other)] => Some(if before(&one, &other) { one } else { other }),
        [one, other] => one.or(other),
    }
}

/// The line's heights above the seam at `p0`.
struct Seams {
    slab: Slab<f64>,
    /// The size of the terms of which `position` is the sum.
    terms: f64,
}

impl Seams {
    fn new(taper: &Taper, x: DVec3, d: DVec3) -> Self {
        let axial = taper.slab(x, d);
        let first = taper.radius0 * (taper.radius1 - taper.radius0);
        Self {
            slab: Slab {
                height: taper.beta(),
                position: axial.position + first,
                slope: axial.slope,
            },
            terms: x.length() * axial.height.sqrt() + first.abs(),
        }
    }

    /// The end that a root of the wall is, if it is between the seams. `balls` are
    /// the ends at the balls.
    fn wall(&self, t: f64, balls: [Option<ChordEnd>; 2]) -> Option<ChordEnd> {
        let Slab {
            height,
            position,
            slope,
        } = self.slab;
        let z = position + t * slope;
        let near = SEAM * (self.terms + (t * slope).abs());
        if !t.is_finite() || z < -near || z > height + near {
            return None;
        }
        let at_seam = if z <= near {
            balls[0]
        } else if z >= height - near {
            balls[1]
        } else {
            None
        };
        let on_wall = ChordEnd {
            t,
            part: Part::Side,
            on_rim: false,
        };
        Some(at_seam.unwrap_or(on_wall))
    }
}

impl RoundedCone {
    /// The cone that touches both balls; `None` if one holds the other.
    pub(super) fn taper(&self) -> Option<Taper> {
        let taper = Taper {
            a: self.p1 - self.p0,
            radius0: self.radius0,
            radius1: self.radius1,
            fit: Fit::Balls,
        };
        (taper.beta().partial_cmp(&0.0) == Some(Ordering::Greater)).then_some(taper)
    }
}
