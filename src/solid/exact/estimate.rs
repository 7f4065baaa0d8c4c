//! f64 numbers with an error bound: the stage that decides nearly all signs.
//!
//! `value` is within `error` of the exact number. An operation that rounds adds at most
//! `2^-53 |value|`; here it adds twice that, which covers the roundings of the bounds themselves
//! for expressions of up to some 2^50 operations: each bound loses at most `2^-51` of itself at
//! each operation. A product may lose low bits to underflow, at most the least normal number. A
//! value that overflowed is infinite or NaN, and so is its error, and has no sign.

use std::cmp::Ordering;

use super::Number;

/// Twice the relative error of an operation.
const ROUNDING: f64 = f64::EPSILON;

/// A number and its error bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub value: f64,
    pub error: f64,
}

impl Number for Estimate {
    #[inline]
    fn of(x: f64) -> Self {
        Self {
            value: x,
            error: 0.0,
        }
    }

    #[inline]
    fn difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Self {
            value,
            error: ROUNDING * value.abs(),
        }
    }

    #[inline]
    fn plus(&self, other: &Self) -> Self {
        let value = self.value + other.value;
        Self {
            value,
            error: self.error + other.error + ROUNDING * value.abs(),
        }
    }

    #[inline]
    fn minus(&self, other: &Self) -> Self {
        self.plus(&Self {
            value: -other.value,
            error: other.error,
        })
    }

    #[inline]
    fn times(&self, other: &Self) -> Self {
        let value = self.value * other.value;
        let inherited = self.error * (other.value.abs() + other.error);
        Self {
            value,
            error: inherited
                + self.value.abs() * other.error
                + ROUNDING * value.abs()
                + f64::MIN_POSITIVE,
        }
    }

    #[inline]
    fn sign(&self) -> Option<Ordering> {
        let is_certain = self.value.abs() > self.error || self.error == 0.0;
        is_certain.then(|| self.value.partial_cmp(&0.0)).flatten()
    }
}
