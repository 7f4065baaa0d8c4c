//! The ball without exact numbers: which rays it decides, and how far their roots may be off.

use glam::DVec3;

use super::{Roots, RoundedDiscriminant, rounded_constant_term};
use crate::math::UNIT_ROUNDOFF;
use crate::solid::quick::{End, Quick, Range};

/// The first intersection of the line `center + x + t d`; see [`quick`](crate::solid::quick).
#[inline(always)]
pub fn quick_first(x: DVec3, d: DVec3, radius: f64, range: &Range) -> Quick {
    let quick = QuickBall::new(x, d, radius, 0.0);
    let [enter, leave] = quick.ends;
    // From afar no terms of the roots cancel, but the roots may be in the wrong order.
    let is_good_from_afar = quick.is_good & (enter.slack == 0.0) & (leave.slack == 0.0);
    let leave = End {
        t: leave.t.max(enter.t),
        ..leave
    };
    let is_open = !(quick.is_plain | is_good_from_afar);
    Quick::of_ends(is_open, [enter, leave], range)
}

/// A ball and a line without exact numbers.
#[derive(Clone, Copy, Debug)]
pub struct QuickBall {
    /// Whether the discriminant is plain; if not, the rest has no meaning.
    pub is_plain: bool,
    /// Whether the discriminant is accurate enough for the roots.
    is_good: bool,
    /// Whether the line intersects the ball.
    pub is_hit: bool,
    /// The ends of the chord; NaN if there is none.
    pub ends: [End; 2],
}

impl QuickBall {
    /// The components of `x` are off by u of their own sizes and of vectors of at most the
    /// length `anchors`.
    ///
    /// This displaces the line by at most `δ = 2 u (|x| + anchors)`, and `D` by
    /// `2 √Q δ |d| + δ² |d|²`. With `S = (|x|² + 4 anchors²) |d|²` in (3) that is below
    /// `2^-37 |D|`, since `δ² |d|² <= 8 u² S`.
    ///
    /// The roots are in order if `D` is plain: by (3) `s >= 2^-32 |x·d|`, so two sums that do
    /// not cancel differ by 2^-31 of themselves. If one cancels, its root is at most little
    /// more than half of `|x·d| / |d|²`, and the other root is greater than all of it.
    #[inline(always)]
    pub fn new(x: DVec3, d: DVec3, radius: f64, anchors: f64) -> Self {
        let (dd, b) = (d.dot(d), x.dot(d));
        let mut discriminant = RoundedDiscriminant::new(x, d, dd, radius);
        discriminant.spread += 4.0 * (anchors * anchors) * dd;
        let (c, is_good) = rounded_constant_term(x, radius);
        let roots = Roots::new(dd, b, discriminant.value);
        // Where `C` cancels, `|x|` is nearly the radius: its products round by 5 u of that
        // square and are displaced by `2 |x| δ`, at most 4 u (2 r² + anchors²); the quotient
        // rounds by less than that.
        let sizes = radius * radius + anchors * anchors;
        let displaced = 16.0 * UNIT_ROUNDOFF * sizes / (b.abs() + roots.s);
        let [first, second] = roots.sums();
        let end = |sum, other| End {
            t: roots.root(sum, other, || c),
            slack: if roots.cancels(sum) & !is_good {
                displaced
            } else {
                0.0
            },
        };
        Self {
            is_plain: discriminant.is_plain(),
            is_good: discriminant.is_good(b),
            is_hit: discriminant.value >= 0.0,
            ends: [end(first, second), end(second, first)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn lanes_leave_few_rays_from_afar_open() {
        let range = Range {
            shift: 0.0,
            t_min: 0.0,
            t_max: f64::INFINITY,
        };
        let mut random = Random::new(15, 0);
        let mut count_open = |distance: f64| {
            let is_open = |_: &u32| {
                let origin = random.direction() * distance;
                let target = random.direction() * random.uniform(0.0, 1.0);
                quick_first(origin, target - origin, 1.0, &range).is_open
            };
            (0..10_000).filter(is_open).count()
        };
        // Only rays that graze the sphere need exact numbers.
        let found = [1.0, 1e3, 1e6, 1e9].map(|distance| count_open(2.0 * distance));
        assert_eq!(found, [0; 4]);
    }
}
