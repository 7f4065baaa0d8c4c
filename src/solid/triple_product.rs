//! The triple-product solver ("Qr"): ray against cylinder in f64.
//!
//! With the axis `a = p1 - p0`, the ray `o + t d` and `x = o - p0`, let
//! `n = a × d` and `m = a × x`. A point of the line is at distance `radius`
//! from the axis where `|m + t n|² = radius² |a|²`:
//!
//! ```text
//! |n|² t² + 2 (m·n) t + |m|² - radius² |a|² = 0                            (1)
//! ```
//!
//! Since `m × n = (a × x) × (a × d) = a (x·n)`, Lagrange's identity gives
//! `|m|² |n|² - (m·n)² = |a|² w²` with the triple product `w = x·n`, and the
//! quarter discriminant of (1) is `|a|² D` with
//!
//! ```text
//! D = radius² |n|² - w²,   t = (-(m·n) ∓ |a| √D) / |n|²                    (2)
//! ```
//!
//! `|w| / |n|` is the distance between the two lines. Why this form: `w` does
//! not change when the origin slides along the ray or along the axis, so no
//! square of the distance or of the length enters `D` and is taken off again;
//! the relative error of `D` is a few units of 2^-53 times `1 + |x| / radius`.
//! `|a|` and `√D` are rooted apart, which halves the exponents in play.
//!
//! `w` is that only if `n` is perpendicular to `a`. Rounded products leave an
//! error along `a` of some 2^-53 `|a| |d|`, which `x·n` multiplies with the
//! whole axial way to the origin: for a ray nearly along a long cylinder it
//! would exceed all else. So where the angle is below 30 degrees the products
//! of `n` are exact.
//!
//! Where the two terms of a root of (2) cancel, the root is `C / q`, `C` the
//! constant term of (1) and `q = -(m·n) ± |a| √D` the sum that does not cancel.
//!
//! The axial position of a point is `y = x·a + t d·a`, inside the slab between
//! the discs iff `0 <= y <= |a|²`. The solid is the wall's interval of `t`
//! overlapped with the slab's, and both ends of the overlap are judged by `y`
//! at the roots of (2): wall and discs are chosen from the same numbers, so
//! that no ray slips between them at a rim.
//!
//! A derivation of the error bounds is in `docs/derivations.md`, section 2.

use glam::DVec3;

use super::chord::{Chord, ChordEnd};
use super::{Cylinder, Part};
use crate::math::{DoubleDouble, power_of_two};

/// Below this (2^-700), `radius² |n|²` could lose bits to underflow and the ray
/// is taken as parallel to the axis. `|a| |d|` is at least 2^-250 (the least
/// length of a cylinder times the least direction), so the angle is then below
/// 2^-100: along any chord of a cylinder in range the ray leaves the parallel
/// by far less than an ulp of its origin.
const PARALLEL_BELOW: f64 = power_of_two(-700);

/// The square of the sine between ray and axis below which the products of
/// `a × d` have to be exact: `docs/derivations.md`, section 2.
const LEAST_SQUARED_SINE: f64 = 0.25;

/// The interval in which the line `p0 + from_p0 + t * direction` is inside the
/// closed solid, or `None` where it is not.
///
/// `from_p0` is the ray's origin as seen from the cylinder's `p0`. `direction` has a largest component between 2^-100 and 2^100 in size; with
/// the range of [`Cylinder`] nothing then overflows. A non-finite argument is
/// a miss.
#[inline]
#[must_use]
pub fn chord(cylinder: &Cylinder, from_p0: DVec3, direction: DVec3) -> Option<Chord> {
    let (x, d, r) = (from_p0, direction, cylinder.radius());
    let a = cylinder.p1() - cylinder.p0();
    let aa = a.dot(a);
    let mut n = a.cross(d);
    let mut nn = n.dot(n);
    if nn < LEAST_SQUARED_SINE * (aa * d.dot(d)) {
        n = cross_of_exact_products(a, d);
        nn = n.dot(n);
    }
    if nn < PARALLEL_BELOW {
        return parallel_chord(a, x, d, r);
    }

    // Does the line reach the infinite wall? Written so that NaN is a miss.
    let w = x.dot(n);
    let rr = r * r;
    let discriminant = rr * nn - w * w;
    if !(discriminant >= 0.0) {
        return None;
    }
    let (ya, yd) = (x.dot(a), d.dot(a));

    // The roots of the wall.
    let m = a.cross(x);
    let mn = m.dot(n);
    let s = aa.sqrt() * discriminant.sqrt();
    let (t0, t1) = if (s - mn.abs()).abs() < 0.5 * mn.abs() {
        let c = m.dot(m) - rr * aa;
        let q = if mn < 0.0 { s - mn } else { -mn - s };
        if mn < 0.0 {
            (c / q, q / nn)
        } else {
            (q / nn, c / q)
        }
    } else {
        ((-mn - s) / nn, (s - mn) / nn)
    };

    // Overlap with the slab between the discs, seen in the ray's direction.
    if yd == 0.0 {
        return perpendicular_chord(t0, t1, aa, ya);
    }
    let (y0, y1) = (ya + t0 * yd, ya + t1 * yd);
    let forward = yd > 0.0;
    let (y_enter, y_leave) = if forward {
        (y0, y1)
    } else {
        (aa - y0, aa - y1)
    };
    if !(y_enter <= aa && y_leave >= 0.0) {
        return None;
    }
    let cap0 = |y: f64| ChordEnd {
        t: -ya / yd,
        part: Part::Cap0,
        on_rim: y == 0.0,
    };
    let cap1 = |y: f64| ChordEnd {
        t: (aa - ya) / yd,
        part: Part::Cap1,
        on_rim: y == aa,
    };
    let side = |t: f64| ChordEnd {
        t,
        part: Part::Side,
        on_rim: false,
    };
    let enter = if y_enter > 0.0 {
        side(t0)
    } else if forward {
        cap0(y0)
    } else {
        cap1(y0)
    };
    let leave = if y_leave < aa {
        side(t1)
    } else if forward {
        cap1(y1)
    } else {
        cap0(y1)
    };
    Some(Chord {
        enter,
        leave,
        lies_on: None,
    })
}

/// `a × d` with a relative error of 2^-53 in every component, whatever the
/// angle. Products below 2^-960 are not exact, but then they are nothing
/// against a vector that is not taken for zero.
#[cold]
fn cross_of_exact_products(a: DVec3, d: DVec3) -> DVec3 {
    let difference = |i: usize, j: usize| {
        let sum = DoubleDouble::product(a[i], d[j]).plus(DoubleDouble::product(-a[j], d[i]));
        sum.high
    };
    DVec3::new(difference(1, 2), difference(2, 0), difference(0, 1))
}

/// The chord of a line along the axis: from disc to disc, if it is not farther
/// from the axis than the wall. Its squared distance is `|m|² / |a|²`.
#[cold]
fn parallel_chord(a: DVec3, x: DVec3, d: DVec3, r: f64) -> Option<Chord> {
    let m = a.cross(x);
    let (aa, ya, yd) = (a.dot(a), x.dot(a), d.dot(a));
    let (mm, rr_aa) = (m.dot(m), r * r * aa);
    if !(mm <= rr_aa) || yd == 0.0 {
        return None;
    }
    let on_rim = mm == rr_aa;
    let cap0 = ChordEnd {
        t: -ya / yd,
        part: Part::Cap0,
        on_rim,
    };
    let cap1 = ChordEnd {
        t: (aa - ya) / yd,
        part: Part::Cap1,
        on_rim,
    };
    let (enter, leave) = if yd > 0.0 { (cap0, cap1) } else { (cap1, cap0) };
    Some(Chord {
        enter,
        leave,
        lies_on: on_rim.then_some(Part::Side),
    })
}

/// The chord of a line across the axis: from wall to wall at one height, which
/// may be that of a disc.
#[cold]
fn perpendicular_chord(t0: f64, t1: f64, aa: f64, ya: f64) -> Option<Chord> {
    if !(0.0 <= ya && ya <= aa) {
        return None;
    }
    let disc = if ya == 0.0 {
        Some(Part::Cap0)
    } else if ya == aa {
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
