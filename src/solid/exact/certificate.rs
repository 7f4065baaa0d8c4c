//! When the f64 solver is certainly right.
//!
//! The quantities of `triple_product` and bounds of how far they are off, with
//! u = 2^-53, `A = |a|`, `X = |x|`, `K = |a| |d|`, `N = |n|`. `a` and `x` are rounded
//! differences, relative error u each:
//!
//! | quantity | bound | from |
//! |---|---|---|
//! | `n` | `5 u K` | two products and a difference a component, `2√2 + 1`, and a |
//! | `\|n\|²` | `13 u K N'`, `N' = N + 5 u K` | `2 N · 5 u K`, three roundings |
//! | `w = x·n` | `9 u X K` | `X · 5 u K`, x, three roundings |
//! | `D` | `u (20 r² K N' + 21 X K \|w\|) + (10 u X K)²` | `r² \|n\|²`, `w²` and their roundings |
//! | `m` | `6 u A X` | as n, and x |
//! | `m·n` | `14 u A X K` | `6 + 5 + 3` |
//! | `s = A √D` | `s (0.54 E_D / D + 6 u)` for `D > 4 E_D` | root of a sum |
//! | `C = \|m\|² - r² A²` | `17 u A² X² + 8 u r² A²` | `2 A X · 6 u A X`, roundings |
//! | `x·a`, `d·a`, `a·a` | `5 u A X`, `4 u K`, `5 u A²` | products, sums, a and x |
//!
//! A quotient `p / q` with `E_q <= |q| / 4` is off by at most
//! `4/3 (E_p + |p/q| E_q) / |q| + u |p/q|`. All bounds are taken once more for the
//! roundings of the bounds themselves, by the factor [`MARGIN`].

use glam::DVec3;

use super::ExactHit;
use super::decide::{At, Decision};
use crate::math::{Ray, UNIT_ROUNDOFF as U};
use crate::solid::{Chord, Crossing, Cylinder, Part};

/// Room for the roundings of the bounds, some 30 operations of positive
/// numbers each: 1 + 2^-40 would do.
const MARGIN: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A number and the bound of its error.
#[derive(Clone, Copy)]
struct Near {
    value: f64,
    error: f64,
}

/// Where a height is between the discs, in the ray's direction.
#[derive(Clone, Copy, PartialEq)]
enum Height {
    Before,
    Inside,
    Beyond,
}

impl Near {
    /// Whether the number is certainly above the limit.
    fn above(&self, limit: f64) -> bool {
        self.value - self.error * MARGIN > limit
    }

    /// Whether the number is certainly below the limit.
    fn below(&self, limit: f64) -> bool {
        self.value + self.error * MARGIN < limit
    }

    /// A quotient that was computed as `value`.
    fn quotient(value: f64, numerator_error: f64, denominator: Near) -> Option<Self> {
        let size = denominator.value.abs();
        (denominator.error * MARGIN <= 0.25 * size).then(|| Self {
            value,
            error: (4.0 / 3.0) * (numerator_error + value.abs() * denominator.error) / size
                + U * value.abs(),
        })
    }
}

/// The exact answer, if the chord that the f64 solver found (or that it found
/// none) is certainly right.
pub(super) fn certify(
    cylinder: &Cylinder,
    ray: &Ray,
    x: DVec3,
    chord: Option<&Chord>,
) -> Option<Option<ExactHit>> {
    let (d, r) = (ray.direction, cylinder.radius());
    let a = cylinder.p1() - cylinder.p0();
    let n = a.cross(d);
    let nn = n.dot(n);
    let (w, rr) = (x.dot(n), r * r);
    let discriminant = rr * nn - w * w;
    let aa = a.dot(a);
    let (a_size, x_size) = (aa.sqrt(), x.length());
    let k = a_size * d.length();
    let n_size = nn.sqrt() + 5.0 * U * k;

    let off = 10.0 * U * x_size * k;
    let discriminant_error = U * k * (20.0 * rr * n_size + 21.0 * x_size * w.abs()) + off * off;
    if discriminant + discriminant_error * MARGIN < 0.0 {
        return Some(None);
    }
    if !(discriminant > 4.0 * discriminant_error * MARGIN) {
        return None;
    }

    // The roots of the wall, as the solver computes them.
    let m = a.cross(x);
    let mn = m.dot(n);
    let s = a_size * discriminant.sqrt();
    let s_error = s * (0.54 * discriminant_error / discriminant + 6.0 * U);
    let numerator_error = 14.0 * U * a_size * x_size * k + s_error + U * (mn.abs() + s);
    let nn = Near {
        value: nn,
        error: 13.0 * U * k * n_size,
    };
    let direct = |q: f64| Near::quotient(q / nn.value, numerator_error, nn);
    let (t0, t1) = if (s - mn.abs()).abs() < 0.5 * mn.abs() {
        let c = m.dot(m) - rr * aa;
        let c_error = U * aa * (17.0 * x_size * x_size + 8.0 * rr);
        let q = if mn < 0.0 { s - mn } else { -mn - s };
        let sum = Near {
            value: q,
            error: numerator_error,
        };
        let indirect = Near::quotient(c / q, c_error, sum)?;
        if mn < 0.0 {
            (indirect, direct(q)?)
        } else {
            (direct(q)?, indirect)
        }
    } else {
        (direct(-mn - s)?, direct(s - mn)?)
    };

    // The heights of the roots, and whether discs are met.
    let ya = x.dot(a);
    let yd = Near {
        value: d.dot(a),
        error: 4.0 * U * k,
    };
    let height_error = |t: &Near| {
        let along = (t.value * yd.value).abs();
        5.0 * U * a_size * x_size
            + t.value.abs() * yd.error
            + yd.value.abs() * t.error
            + 3.0 * U * (along + ya.abs())
            + 6.0 * U * aa
    };
    let forward = yd.value >= 0.0;
    let height = |t: &Near| {
        let y = ya + t.value * yd.value;
        let from_first = Near {
            value: if forward { y } else { aa - y },
            error: height_error(t),
        };
        if from_first.below(0.0) {
            Some(Height::Before)
        } else if from_first.above(aa) {
            Some(Height::Beyond)
        } else if from_first.above(0.0) && from_first.below(aa) {
            Some(Height::Inside)
        } else {
            None
        }
    };
    let heights = (height(&t0)?, height(&t1)?);
    if heights != (Height::Inside, Height::Inside) && !(yd.value.abs() > 4.0 * yd.error * MARGIN) {
        // Which disc is met first depends on the sign of d·a.
        return None;
    }
    if heights.0 == Height::Beyond || heights.1 == Height::Before {
        return Some(None);
    }

    // The first end on the surface and in range.
    let chord = chord?;
    let plane = |part: Part| {
        let numerator_error = 6.0 * U * (a_size * x_size + aa);
        let (value, at) = match part {
            Part::Cap1 => ((aa - ya) / yd.value, At::Plane1),
            _ => (-ya / yd.value, At::Plane0),
        };
        Some((Near::quotient(value, numerator_error, yd)?, at, part))
    };
    let (first_disc, last_disc) = if forward {
        (Part::Cap0, Part::Cap1)
    } else {
        (Part::Cap1, Part::Cap0)
    };
    let enter = match heights.0 {
        Height::Inside => (t0, At::FirstRoot, Part::Side),
        _ => plane(first_disc)?,
    };
    let leave = match heights.1 {
        Height::Inside => (t1, At::SecondRoot, Part::Side),
        _ => plane(last_disc)?,
    };
    for ((t, at, part), crossing, end) in [
        (enter, Crossing::Enter, chord.enter),
        (leave, Crossing::Leave, chord.leave),
    ] {
        let is_there = match part {
            Part::Side => true,
            Part::Cap0 => cylinder.caps().at_p0(),
            Part::Cap1 => cylinder.caps().at_p1(),
        };
        if !is_there || t.below(ray.t_min) || t.above(ray.t_max) {
            continue;
        }
        if !(t.above(ray.t_min) && t.below(ray.t_max)) {
            return None;
        }
        return Some(Some(ExactHit {
            // The solver's own t, which may have been put in order with the
            // other end's; it is then within the error of this one as well.
            t: end.t,
            t_error: (t.error * MARGIN).max((end.t - t.value).abs() + t.error),
            part,
            crossing,
            decision: Decision { at, part, crossing },
        }));
    }
    Some(None)
}
