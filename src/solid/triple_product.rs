//! The triple-product solver ("Qr"): ray against cylinder.
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
//! the discs iff `0 <= y <= |a|²`; `slab.rs` overlaps wall and slab.
//!
//! A derivation of the error bounds is in `docs/derivations.md`, section 2. It
//! is for f64, in which the tracer solves; f32 exists for comparison.

use glam::DVec3;

use super::Cylinder;
use super::chord::Chord;
use super::slab::Slab;
use crate::math::{Real, RealVector, power_of_two};

/// Below this (2^-700), `radius² |n|²` could lose bits to underflow and the ray
/// is taken as parallel to the axis. `|a| |d|` is at least 2^-250 (the least
/// length of a cylinder times the least direction), so the angle is then below
/// 2^-100: along any chord of a cylinder in range the ray leaves the parallel
/// by far less than an ulp of its origin. f32 does not reach that far, and
/// there the limit is its least normal number.
const PARALLEL_BELOW: f64 = power_of_two(-700);

/// The square of the sine between ray and axis below which the products of
/// `a × d` have to be exact: `docs/derivations.md`, section 2.
const LEAST_SQUARED_SINE: f64 = 0.25;

/// What the solver reads of a cylinder: its axis `a`, its radius, and products
/// of them that may be kept or computed when asked for.
pub(super) trait Axis<S: Real>: Copy {
    /// `a = p1 - p0`.
    fn a(&self) -> S::Vector;
    /// `radius²`.
    fn rr(&self) -> S;
    /// `|a|²`.
    fn aa(&self) -> S;
    /// `|a|`.
    fn length(&self) -> S;
    /// `radius² |a|²`.
    fn rr_aa(&self) -> S;
}

/// An axis of which nothing is kept that can be computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct StatedAxis<S: Real> {
    /// `p1 - p0`.
    pub a: S::Vector,
    /// The radius.
    pub radius: S,
}

impl<S: Real> Axis<S> for StatedAxis<S> {
    #[inline]
    fn a(&self) -> S::Vector {
        self.a
    }

    #[inline]
    fn rr(&self) -> S {
        self.radius * self.radius
    }

    #[inline]
    fn aa(&self) -> S {
        self.a.dot(self.a)
    }

    #[inline]
    fn length(&self) -> S {
        self.aa().sqrt()
    }

    #[inline]
    fn rr_aa(&self) -> S {
        self.rr() * self.aa()
    }
}

/// The interval in which the line `p0 + from_p0 + t * direction` is inside the
/// closed solid, or `None` where it is not.
///
/// `from_p0` is the ray's origin as seen from the cylinder's `p0`. `direction`
/// has a largest component between 2^-100 and 2^100 in size; with the range of
/// [`Cylinder`] nothing then overflows. A non-finite argument is a miss.
#[inline]
#[must_use]
pub fn chord(cylinder: &Cylinder, from_p0: DVec3, direction: DVec3) -> Option<Chord> {
    let axis = StatedAxis {
        a: cylinder.p1() - cylinder.p0(),
        radius: cylinder.radius(),
    };
    axis_chord(&axis, from_p0, direction)
}

/// The same for any form of the cylinder and either precision.
#[inline(always)]
pub(super) fn axis_chord<S: Real>(
    axis: &impl Axis<S>,
    from_p0: S::Vector,
    direction: S::Vector,
) -> Option<Chord<S>> {
    let (a, x, d) = (axis.a(), from_p0, direction);
    let mut n = a.cross(d);
    let mut nn = n.dot(n);
    if nn < S::from_f64(LEAST_SQUARED_SINE) * (axis.aa() * d.dot(d)) {
        n = exact_normal::<S>(a, d);
        nn = n.dot(n);
    }
    if nn < parallel_below() {
        return parallel_chord(axis, x, d);
    }

    // Does the line reach the infinite wall? Written so that NaN is a miss.
    let w = x.dot(n);
    let discriminant = axis.rr() * nn - w * w;
    if !(discriminant >= S::ZERO) {
        return None;
    }

    // The roots of the wall.
    let m = a.cross(x);
    let mn = m.dot(n);
    let s = axis.length() * discriminant.sqrt();
    let (t0, t1) = if (s - mn.abs()).abs() < S::from_f64(0.5) * mn.abs() {
        let c = m.dot(m) - axis.rr_aa();
        let q = if mn < S::ZERO { s - mn } else { -mn - s };
        if mn < S::ZERO {
            (c / q, q / nn)
        } else {
            (q / nn, c / q)
        }
    } else {
        ((-mn - s) / nn, (s - mn) / nn)
    };
    slab(axis, x, d).overlap(t0, t1)
}

/// `a × d` from exact products. Those below 2^-960 are not exact in f64, but
/// then they are nothing against a vector that is not taken for zero.
#[cold]
fn exact_normal<S: Real>(a: S::Vector, d: S::Vector) -> S::Vector {
    a.cross_of_exact_products(d)
}

/// The chord of a line along the axis: from disc to disc, if it is not farther
/// from the axis than the wall. Its squared distance is `|m|² / |a|²`.
#[cold]
fn parallel_chord<S: Real>(axis: &impl Axis<S>, x: S::Vector, d: S::Vector) -> Option<Chord<S>> {
    let m = axis.a().cross(x);
    let (mm, rr_aa) = (m.dot(m), axis.rr_aa());
    if !(mm <= rr_aa) {
        return None;
    }
    slab(axis, x, d).along(mm == rr_aa)
}

#[inline]
fn slab<S: Real>(axis: &impl Axis<S>, x: S::Vector, d: S::Vector) -> Slab<S> {
    Slab {
        height: axis.aa(),
        position: x.dot(axis.a()),
        slope: d.dot(axis.a()),
    }
}

#[inline]
fn parallel_below<S: Real>() -> S {
    let limit = S::from_f64(PARALLEL_BELOW);
    if limit > S::MIN_POSITIVE {
        limit
    } else {
        S::MIN_POSITIVE
    }
}
