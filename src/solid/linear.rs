//! Heights over planes: linear forms `f·x + c`. Their `x` may be a rounded [`Offset`].
//!
//! Three products and three sums round by at most `4 u S` together, u = 2^-53, with
//! `S = Σ |f_i x_i| + |c|`, and a rounded `x` adds `u S`. A value of at least `2^-10 S` is
//! therefore within `1.25 · 2^-41` of itself, 2^-16 of an ulp of f32, and has the right sign. A
//! smaller value has lost too much to cancellation and is computed again from exact numbers. So
//! every value has the exact sign, and is zero only if it truly is.

use glam::DVec3;

use super::exact::{Expression, Number, dot, quotient, vector};
use super::offset::Offset;
use crate::math::{UNIT_ROUNDOFF, power_of_two};

/// The share of its terms from which on a rounded value is used.
const LEAST_SHARE: f64 = power_of_two(-10);

/// The size below which products may have lost bits to underflow.
const LEAST_SIZE: f64 = power_of_two(-900);

/// Bounds the relative error of a quotient of two values, with room for the error of a
/// comparison.
pub(super) const MARGIN: f64 = power_of_two(-39);

/// `f·x`, for finite numbers.
#[inline]
pub(super) fn product(f: DVec3, x: impl Offset) -> f64 {
    checked(rounded_product(f, x.rounded()), f, x, 0.0)
}

/// `c + f·x` and `c - f·x`, for finite numbers.
#[inline]
pub(super) fn heights(f: DVec3, x: impl Offset, c: f64) -> [f64; 2] {
    let [over, under] = rounded_heights(f, x.rounded(), c);
    [checked(over, f, x, c), checked(under, -f, x, c)]
}

/// A value of rounded products, and the sum of the sizes of its terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub value: f64,
    size: f64,
}

impl Rounded {
    /// Whether the value has lost too much to cancellation or underflow.
    #[inline(always)]
    pub fn is_poor(&self) -> bool {
        (self.value.abs() < LEAST_SHARE * self.size) | (self.size < LEAST_SIZE)
    }

    /// Bounds the difference from the value from exact numbers: `5 u S`, and half as much again
    /// for the roundings of a quotient with it. Zero if this value is used.
    #[inline(always)]
    pub fn slack(&self) -> f64 {
        let slack = if self.size < LEAST_SIZE {
            f64::INFINITY
        } else {
            8.0 * UNIT_ROUNDOFF * self.size
        };
        if self.is_poor() { slack } else { 0.0 }
    }
}

/// [`product`] without exact numbers.
#[inline(always)]
pub(super) fn rounded_product(f: DVec3, x: DVec3) -> Rounded {
    let terms = f * x;
    Rounded {
        value: terms.x + terms.y + terms.z,
        size: sum_of_sizes(terms),
    }
}

/// The sum of the sizes of the components: at least the length of `v`, at most √3 times the
/// length, and computed without a root.
#[inline(always)]
pub(super) fn sum_of_sizes(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// [`heights`] without exact numbers.
#[inline(always)]
pub(super) fn rounded_heights(f: DVec3, x: DVec3, c: f64) -> [Rounded; 2] {
    let product = rounded_product(f, x);
    let size = product.size + c.abs();
    [c + product.value, c - product.value].map(|value| Rounded { value, size })
}

#[inline(always)]
fn checked(rounded: Rounded, f: DVec3, x: impl Offset, c: f64) -> f64 {
    if rounded.is_poor() {
        return from_exact_numbers(f, x, c);
    }
    rounded.value
}

/// Takes copies, so that the caller does not need its vectors in memory for this rare case.
#[cold]
#[inline(never)]
fn from_exact_numbers<W: Offset>(f: DVec3, x: W, c: f64) -> f64 {
    // Along a coordinate axis there is one term, and only its sum with `c` rounds.
    let is_whole = |factor: &f64| *factor == 0.0 || factor.abs() == 1.0;
    let terms = f * x.rounded();
    let count = terms.to_array().iter().filter(|term| **term != 0.0).count();
    if x.is_rounded() && f.to_array().iter().all(is_whole) && count <= 1 {
        return c + (terms.x + terms.y + terms.z);
    }
    quotient(&Linear { f, x, c }, 1.0)
}

struct Linear<W> {
    f: DVec3,
    x: W,
    c: f64,
}

impl<W: Offset> Expression for Linear<W> {
    fn value<N: Number>(&self) -> N {
        dot(&vector::<N>(self.f), &self.x.exactly()).plus(&N::of(self.c))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_keep_their_bits_and_sign_where_terms_cancel() {
        let f = DVec3::new(0.6, 0.8, 0.0);
        // As f64, 0.6 and 0.8 are not those numbers, but the products cancel exactly.
        let x = DVec3::new(0.8, -0.6, 3.0);
        assert_eq!(product(f, x), 0.0);
        let off = DVec3::new(0.8_f64.next_up(), -0.6, 3.0);
        let step = 0.8_f64.next_up() - 0.8;
        assert!((product(f, off) / (0.6 * step) - 1.0).abs() < 1e-15);
        let [over, under] = heights(f, off, 0.5 * step);
        assert!((over / (1.1 * step) - 1.0).abs() < 1e-15, "{over:e}");
        assert!((under / (-0.1 * step) - 1.0).abs() < 1e-14, "{under:e}");
    }

    #[test]
    fn heights_along_an_axis_round_once() {
        let [over, under] = heights(DVec3::NEG_Y, DVec3::new(7.0, 0.1, 1e300), 0.1);
        assert_eq!([over, under], [0.0, 0.2]);
        assert_eq!(product(DVec3::X, DVec3::new(1e-320, 5.0, 1.0)), 1e-320);
        assert_eq!(product(DVec3::X, DVec3::Y), 0.0);
    }
}
