//! What rounded products make of a line and a cone's wall, and when that will do.
//!
//! Each of `A`, `B`, `C` and `E` of `wall.rs` is a difference; the bounds of
//! [`Rounded::new`] follow from `|δn| <= 3 u |a| |d|`, `|δm| <= 3 u |a| |x|`,
//! `|δ(x × d)| <= 3 u |x| |d|` and `|δ(d·a)| <= 3 u |a| |d|`, u = 2^-53. Where
//! one is too large for what the value is used for, which is rare but for lines that
//! graze the wall or are nearly along it, all are computed from exact numbers: then
//! their signs are exact, and their relative errors at most some ten u.
//!
//! What is asked: an error of `A` or `B` below [`GOOD`] of the value, of `B` of the
//! sum `|B| + s`, `s = |a|² √(E/β)`, that does not cancel. Of `E` the sign is needed,
//! and of the root `s` what it adds to that sum: for an origin `k` sizes away the
//! relative error of `E` is some `k u`, but `s` is a k-th of `|B|`. So an error of
//! `E` that leaves the sign certain will do if it displaces the sum by less than
//! [`GOOD_FROM_AFAR`] of it, and for a line that certainly passes by, any.
//!
//! `x` and `a` may be rounded differences ([`Way`]). That adds u to the first, third and
//! fourth of these bounds and 2 u to the second, so that errors are below twice the
//! bounds. Exact numbers are those of the differences.
//!
//! Of the two roots one has no cancellation in its sum `q`; where the other's terms
//! cancel it is `C / q`, with an error of `C` below [`GOOD_CONSTANT_TERM`].

use glam::DVec3;

use super::wall::Taper;
use crate::math::{UNIT_ROUNDOFF, power_of_two};
use crate::solid::way::Way;

/// The relative error up to which rounded products will do: a root then has less
/// than 2^-11 of an ulp of f32.
const GOOD: f64 = power_of_two(-36);

/// How much of the sum that does not cancel the error of `√E` may be: the point of a
/// hit is then within 2^-44 of the way to it.
const GOOD_FROM_AFAR: f64 = power_of_two(-44);

/// The relative error of `C`, which is that of a `t` near zero, up to which rounded
/// products will do: as of the triple product's constant term, 30 bits are left, more
/// than an f32 has.
const GOOD_CONSTANT_TERM: f64 = power_of_two(-30);

/// The factor of all bounds: the roundings named above and those of further products and
/// sums, at most 13 u, and of `β`, at most 10 u.
const ROUNDINGS: f64 = 24.0 * UNIT_ROUNDOFF;

/// How many times the bounds are exceeded at most if `x` and `a` are rounded. Only the sign of
/// `E` is decided so near to a bound that it matters.
const INPUTS: f64 = 2.0;

/// A rounded difference and a bound of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Difference {
    pub value: f64,
    error: f64,
}

impl Difference {
    /// Whether the error is at most a share of the value, or the value no number.
    fn is_within(&self, share: f64) -> bool {
        !(share * self.value.abs() < self.error)
    }
}

/// What rounded products make of (2) and (4).
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub aa: f64,
    pub beta: f64,
    pub h: f64,
    m: DVec3,
    /// `|x| |a|`, which bounds `|m|`.
    reach: f64,
    pub a: Difference,
    pub b: Difference,
    pub e: Difference,
    /// `|a|² √(E/β)`.
    s: f64,
}

impl Rounded {
    pub fn new(taper: &Taper<impl Way>, x: DVec3, d: DVec3) -> Self {
        const U: f64 = UNIT_ROUNDOFF;
        let (axis, r0) = (taper.axis(), taper.radius0);
        let delta = taper.radius1 - r0;
        let (aa, dd, beta) = (axis.dot(axis), d.dot(d), taper.beta());
        let (length, speed, distance) = (aa.sqrt(), dd.sqrt(), x.length());
        let (n, m, l) = (axis.cross(d), axis.cross(x), x.cross(d));
        let (nn, w, slope) = (n.dot(n), x.dot(n), d.dot(axis));
        let (k, h) = (n * r0 + l * delta, delta * slope);
        let (kk, ww, tilt) = (k.dot(k), w * w, (beta + delta * delta) / aa);
        let (reach, pace) = (distance * length, length * speed);

        // |δn| <= 3 u pace, also in h, which rounds by 2 u more.
        let steep = pace * nn.sqrt() + nn + (delta * delta / beta) * (pace * slope.abs());
        let a = Difference {
            value: nn - h * h / beta,
            error: ROUNDINGS * (steep + 9.0 * U * pace * pace),
        };
        // |m·n| <= reach |n|, each with 3 u of reach and of pace.
        let g = r0 * aa + delta * x.dot(axis);
        let size = r0 * aa + delta.abs() * reach;
        let b = Difference {
            value: m.dot(n) - g * h / beta,
            error: ROUNDINGS * (reach * pace + size * (delta.abs() * pace) / beta),
        };
        // |δk| <= 5 u K with K = |d| (r0 |a| + |Δ| |x|), |δw| <= 6 u |x| |a| |d|.
        let (moment, triple) = (
            speed * (r0 * length + delta.abs() * distance),
            reach * speed,
        );
        let first = k.length() * moment + tilt * (w.abs() * triple) + kk + tilt * ww;
        let second = moment * moment + tilt * (triple * triple);
        let value = kk - ww * tilt;
        let e = Difference {
            value,
            error: ROUNDINGS * (first + 3.0 * U * second),
        };
        Self {
            aa,
            beta,
            h,
            m,
            reach,
            a,
            b,
            e,
            s: aa * (value / beta).sqrt(),
        }
    }

    /// Whether the line certainly does not reach the wall.
    pub fn passes_by(&self) -> bool {
        self.e.value < -INPUTS * self.e.error
    }

    /// Whether the roots, but for `C`, are good.
    pub fn is_good(&self) -> bool {
        let sum = |error| Difference {
            value: self.b.value.abs() + self.s,
            error,
        };
        // A relative error of at most a quarter is less than doubled in the root.
        let of_root = self.s * (self.e.error / self.e.value);
        let is_root_good = self.e.is_within(GOOD)
            || self.e.is_within(0.25) && sum(of_root).is_within(GOOD_FROM_AFAR);
        is_root_good && self.a.is_within(GOOD) && sum(self.b.error).is_within(GOOD)
    }

    /// `C` of (2), if it is good.
    pub fn constant_term(&self, taper: &Taper<impl Way>, x: DVec3) -> Option<f64> {
        let delta = taper.radius1 - taper.radius0;
        let g = taper.radius0 * self.aa + delta * x.dot(taper.axis());
        let size = taper.radius0 * self.aa + delta.abs() * self.reach;
        let mm = self.m.dot(self.m);
        let wide = self.reach * mm.sqrt() + mm + g.abs() * (size / self.beta);
        let second = self.reach * self.reach + size * (size / self.beta);
        let c = Difference {
            value: mm - g * (g / self.beta),
            error: ROUNDINGS * (wide + 3.0 * UNIT_ROUNDOFF * second),
        };
        c.is_within(GOOD_CONSTANT_TERM).then_some(c.value)
    }
}
