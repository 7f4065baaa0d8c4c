//! The terms of a line and a cone's wall from rounded products, and when they are accurate
//! enough.
//!
//! Each of `A`, `B`, `C` and `E` of `wall.rs` is a difference. The bounds of [`Bounds::new`]
//! follow from `|δn| <= 3 u |a| |d|`, `|δm| <= 3 u |a| |x|`, `|δ(x × d)| <= 3 u |x| |d|` and
//! `|δ(d·a)| <= 3 u |a| |d|`, u = 2^-53. If an error is too large for the use of the value,
//! which is rare except for lines that graze the wall or are nearly along it, all terms are
//! computed from exact numbers. Then their signs are exact, and their relative errors at most
//! some ten u.
//!
//! The rule is: the error of `A` is below [`GOOD`] of its value, and that of `B` below [`GOOD`]
//! of the sum `|B| + s`, `s = |a|² √(E/β)`, that does not cancel. `E` contributes its sign, and
//! the root `s` to that sum: for an origin `k` sizes away the relative error of `E` is about
//! `k u`, but `s` is a k-th of `|B|`. So an error of `E` that leaves the sign certain is small
//! enough if it displaces the sum by less than [`GOOD_FROM_AFAR`] of it. For a line that
//! certainly misses, any error is.
//!
//! `x` and `a` may be rounded differences ([`Offset`]). That adds u to the first, third and
//! fourth of these bounds and 2 u to the second, so that errors are below twice the bounds.
//! Exact numbers are then those of the differences.
//!
//! One of the two roots has no cancellation in its sum `q`. If the terms of the other cancel,
//! that root is `C / q`, with an error of `C` below [`GOOD_CONSTANT_TERM`].
//!
//! # Without roots
//!
//! The bounds take five roots. Simpler ones, which are above them, decide nearly all lines, and
//! are the only ones in lanes. With `R` = [`ROUNDINGS`] = 1.5 · 2^-49, `σ = Δ²/β`,
//! `τ = (β + Δ²) / |a|²`, `X = |x|²`, `P = |a|² |d|²`, `F = |k|² + τ w²`,
//! `M = |d| (r0 |a| + |Δ| |x|)` and `T = |x| |a| |d|`, the bounds are
//!
//! ```text
//! |δA| <= R (2 + σ) P
//! |δB| <= R √P |a| ((1 + σ) |x| + r0 |a| |Δ| / β)
//! |δC| <= R |a|² ((2 + 2σ) X + 2 r0² |a|² / β)                             (5)
//! |δE| <= R (|k| M + τ |w| T + F + 3 u (M² + τ T²))
//! ```
//!
//! since `|n|` and `|d·a|` are at most `√P`, `|m|` at most `|x| |a|`, and `|g|` at most
//! `r0 |a|² + |Δ| |x| |a|`, except for some u of them. Since
//! `(p + q)² <= (1 + η) p² + (1 + 1/η) q²` for any `η > 0`, `M²` is at most `2 K` with
//! `K = |d|² (r0² |a|² + Δ² X)`, and
//!
//! ```text
//! (|k| M + τ |w| T)² <= H = 10 |k|² K + 5/4 τ² w² T²
//! (√H + F)² <= L² = 17/16 H + 17 F²,     G = 2 K + τ T²
//! |δE| <= R (L + 3 u G)
//! ```
//!
//! with the lesser factors for the terms that are greater for slender solids from afar. So all
//! errors are below what the rule requires if
//!
//! ```text
//! (2 + σ) P < 2^12 |A|                                                     (6)
//! 2 P |a|² ((1 + σ)² X + r0² |a|² σ/β) < 2^24 (|B| + s)²
//! 3 u G < E,    L² < 5376² E²    or    L² < 2^80 E²  and  L² < 20² (β/|a|⁴) E (|B| + s)²
//! ```
//!
//! The factors are `2^12 R`, which is 3/4 of [`GOOD`]; `5377 R` for `E`, 0.985 of that; and for
//! the last alternative `21 R`, 0.985 of [`GOOD_FROM_AFAR`], since `s² = |a|⁴ E/β`. The
//! remainder exceeds the roundings of (6). Comparisons are strict, so that overflow and NaN are
//! not plain. `E` is above [`LEAST`], so `L²` loses nothing that matters to underflow.
//!
//! **Rounded differences.** `x = o - p0` and `a = p1 - p0` may be off by u of each component,
//! and `Δ` is off by u. That adds u to each of the errors of `n`, `m`, `x × d` and `d·a` above
//! (3 u becomes 4 u; 5 u and 6 u for `k` and `w` become 7 u and 8 u), and up to 4 u to that of
//! `β`. `|δE|` is then at most `14 u |k| M + 16 u τ |w| T + 15 u F`, still below (5). In `A`
//! and `C` the parts with `β` are off by at most 34 u, half as much again as `R`: (6) leaves
//! the sign of `A` certain by a factor of 2^36. So the signs of `A` and `E` that (6) decides
//! are those of the numbers that `o`, `p0` and `p1` give without rounding.

use glam::DVec3;

use super::roots::Roots;
use super::taper::Taper;
use crate::math::{UNIT_ROUNDOFF, power_of_two};
use crate::solid::offset::Offset;

/// The relative error up to which rounded products are used: a root then has less than 2^-11 of
/// an ulp of f32.
const GOOD: f64 = power_of_two(-36);

/// The greatest share of the noncancelling sum that the error of `√E` may be: the hit point is
/// then within 2^-44 of its distance from the origin.
const GOOD_FROM_AFAR: f64 = power_of_two(-44);

/// The relative error of `C`, and so of a `t` near zero, up to which rounded products are used:
/// as for the triple product's constant term, 30 bits are left, more than an f32 has.
const GOOD_CONSTANT_TERM: f64 = power_of_two(-30);

/// The factor of all bounds: the roundings named above, those of further products and sums, at
/// most 13 u, and those of `β`, at most 10 u.
const ROUNDINGS: f64 = 24.0 * UNIT_ROUNDOFF;

/// The factor by which errors may exceed the bounds if `x` and `a` are rounded. It matters only
/// for the sign of `E`, which may be decided close to its bound.
const INPUTS: f64 = 2.0;

/// An `E` up to this is not plain: products of it may have been lost to underflow.
const LEAST: f64 = power_of_two(-400);

/// A rounded difference and its error bound.
#[derive(Clone, Copy, Debug)]
struct Difference {
    value: f64,
    error: f64,
}

impl Difference {
    /// Whether the error is at most a share of the value, or NaN.
    fn is_within(&self, share: f64) -> bool {
        !(share * self.value.abs() < self.error)
    }
}

/// The terms of (2) and (4) from rounded products.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    radius0: f64,
    delta: f64,
    pub aa: f64,
    pub beta: f64,
    dd: f64,
    xx: f64,
    slope: f64,
    pub h: f64,
    g: f64,
    n: DVec3,
    m: DVec3,
    k: DVec3,
    w: f64,
    /// `τ`.
    tilt: f64,
    kk: f64,
    ww: f64,
    pub e: f64,
    /// `A`, `B` and `s`.
    pub roots: Roots,
}

impl Rounded {
    /// `beta` is `β` of the taper.
    #[inline(always)]
    pub fn new(taper: &Taper<impl Offset>, x: DVec3, d: DVec3, beta: f64) -> Self {
        let (axis, radius0) = (taper.axis(), taper.radius0);
        let delta = taper.radius1 - radius0;
        let (aa, dd, xx) = (axis.dot(axis), d.dot(d), x.dot(x));
        let (n, m, l) = (axis.cross(d), axis.cross(x), x.cross(d));
        let (w, slope) = (x.dot(n), d.dot(axis));
        let (k, h) = (n * radius0 + l * delta, delta * slope);
        let (kk, ww, tilt) = (k.dot(k), w * w, (beta + delta * delta) / aa);
        let g = radius0 * aa + delta * x.dot(axis);
        let e = kk - ww * tilt;
        let (a, b) = (n.dot(n) - h * h / beta, m.dot(n) - g * h / beta);
        Self {
            radius0,
            delta,
            aa,
            beta,
            dd,
            xx,
            slope,
            h,
            g,
            n,
            m,
            k,
            w,
            tilt,
            kk,
            ww,
            e,
            roots: Roots::new([a, b, e], aa, beta),
        }
    }

    /// Whether the roots, apart from `C`, are accurate enough by (6).
    #[inline(always)]
    pub fn is_plain(&self) -> bool {
        const FAR: f64 = 3.0 * UNIT_ROUNDOFF;
        const SQUARED: f64 = 5376.0 * 5376.0;
        let (aa, beta, dd, xx) = (self.aa, self.beta, self.dd, self.xx);
        let (tilt, kk, ww, e) = (self.tilt, self.kk, self.ww, self.e);
        let (rr, squared) = (self.radius0 * self.radius0, self.delta * self.delta);
        let (sigma, pace) = (squared / beta, aa * dd);
        let is_a_good = (2.0 + sigma) * pace < power_of_two(12) * self.roots.a.abs();

        let sum = self.roots.b.abs() + self.roots.s;
        let sums = sum * sum;
        let of_b = 2.0 * aa * ((1.0 + sigma) * (1.0 + sigma) * xx + rr * aa * (sigma / beta));
        let is_b_good = pace * of_b < power_of_two(24) * sums;

        let (k, tt, f) = (dd * (rr * aa + squared * xx), xx * pace, kk + tilt * ww);
        let h = 10.0 * kk * k + 1.25 * (tilt * ww) * (tilt * tt);
        let l = 1.0625 * h + 17.0 * (f * f);
        let from_afar = at_most(400.0 * (beta / (aa * aa)) * sums, power_of_two(80) * e);
        let is_e_good = (e > LEAST)
            & (FAR * (2.0 * k + tilt * tt) < e)
            & ((l < e * (SQUARED * e)) | (l < e * from_afar));
        is_a_good & is_b_good & is_e_good
    }

    /// `C` of (2).
    #[inline(always)]
    pub fn constant_term(&self) -> f64 {
        self.m.dot(self.m) - self.g * (self.g / self.beta)
    }

    /// Bounds the error of [`Rounded::constant_term`] if that may be above
    /// [`GOOD_CONSTANT_TERM`]; zero otherwise. From (5), with the 1.5 of `R` rounded up to 2.
    #[inline(always)]
    pub fn error_of_constant_term(&self) -> f64 {
        let sigma = self.delta * self.delta / self.beta;
        let of_radius = self.radius0 * self.radius0 * self.aa / self.beta;
        let error = power_of_two(-47) * self.aa * ((1.0 + sigma) * self.xx + of_radius);
        let is_good = error <= GOOD_CONSTANT_TERM * self.constant_term().abs();
        if is_good { 0.0 } else { error }
    }

    /// `C` of (2), if it is accurate enough.
    pub fn good_constant_term(&self) -> Option<f64> {
        let (aa, g) = (self.aa, self.g);
        let reach = self.xx.sqrt() * aa.sqrt();
        let size = self.radius0 * aa + self.delta.abs() * reach;
        let mm = self.m.dot(self.m);
        let wide = reach * mm.sqrt() + mm + g.abs() * (size / self.beta);
        let second = reach * reach + size * (size / self.beta);
        let c = Difference {
            value: self.constant_term(),
            error: ROUNDINGS * (wide + 3.0 * UNIT_ROUNDOFF * second),
        };
        c.is_within(GOOD_CONSTANT_TERM).then_some(c.value)
    }
}

/// The lesser of two numbers.
#[inline(always)]
fn at_most(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// The terms of [`Rounded`] with their error bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    a: Difference,
    b: Difference,
    e: Difference,
    s: f64,
}

impl Bounds {
    pub fn new(rounded: &Rounded) -> Self {
        const U: f64 = UNIT_ROUNDOFF;
        let (radius0, delta, aa, beta) = (rounded.radius0, rounded.delta, rounded.aa, rounded.beta);
        let (tilt, kk, ww) = (rounded.tilt, rounded.kk, rounded.ww);
        let [length, speed, distance] = [aa, rounded.dd, rounded.xx].map(f64::sqrt);
        let (reach, pace, nn) = (distance * length, length * speed, rounded.n.dot(rounded.n));

        // |δn| <= 3 u pace, also in h, which rounds by 2 u more.
        let steep = pace * nn.sqrt() + nn + (delta * delta / beta) * (pace * rounded.slope.abs());
        let a = Difference {
            value: rounded.roots.a,
            error: ROUNDINGS * (steep + 9.0 * U * pace * pace),
        };
        // |m·n| <= reach |n|, each with 3 u of reach and of pace.
        let size = radius0 * aa + delta.abs() * reach;
        let b = Difference {
            value: rounded.roots.b,
            error: ROUNDINGS * (reach * pace + size * (delta.abs() * pace) / beta),
        };
        // |δk| <= 5 u K with K = |d| (r0 |a| + |Δ| |x|), |δw| <= 6 u |x| |a| |d|.
        let (moment, triple) = (
            speed * (radius0 * length + delta.abs() * distance),
            reach * speed,
        );
        let (k, w) = (rounded.k.length(), rounded.w.abs());
        let first = k * moment + tilt * (w * triple) + kk + tilt * ww;
        let second = moment * moment + tilt * (triple * triple);
        let e = Difference {
            value: rounded.e,
            error: ROUNDINGS * (first + 3.0 * U * second),
        };
        let s = rounded.roots.s;
        Self { a, b, e, s }
    }

    /// Whether the line certainly misses the wall.
    pub fn rejects(&self) -> bool {
        self.e.value < -INPUTS * self.e.error
    }

    /// Whether the roots, apart from `C`, are accurate enough.
    pub fn is_good(&self) -> bool {
        let sum = |error| Difference {
            value: self.b.value.abs() + self.s,
            error,
        };
        // A relative error of at most a quarter less than doubles in the root.
        let of_root = self.s * (self.e.error / self.e.value);
        let is_root_good = self.e.is_within(GOOD)
            || self.e.is_within(0.25) && sum(of_root).is_within(GOOD_FROM_AFAR);
        is_root_good && self.a.is_within(GOOD) && sum(self.b.error).is_within(GOOD)
    }
}
