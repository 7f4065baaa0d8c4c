//! Double-doubles with an error bound.
//!
//! `value` is within `error` of the exact number. Sums of the double-double format are within
//! `4 · 2^-106` of the sum of the sizes, products within `8 · 2^-106` of the product of the
//! sizes. Both constants are doubled here, which covers the roundings of the bounds themselves.
//! Exact results keep an error of zero: products of plain f64s, and differences that vanish.

use std::cmp::Ordering;

use super::Number;
use crate::math::{DoubleDouble, power_of_two};

/// Twice the error of a sum, relative to the sizes of its terms.
const SUM_ERROR: f64 = power_of_two(-103);

/// Twice the relative error of a product.
const PRODUCT_ERROR: f64 = power_of_two(-102);

/// A product below this size may have lost low bits to underflow.
const LEAST_PRODUCT: f64 = power_of_two(-900);

/// A double-double and its error bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub value: DoubleDouble,
    pub error: f64,
}

impl Bounded {
    fn exact(value: DoubleDouble) -> Self {
        Self { value, error: 0.0 }
    }

    fn is_plain(&self) -> bool {
        self.error == 0.0 && self.value.low == 0.0
    }

    fn negated(&self) -> Self {
        Self {
            value: self.value.negated(),
            error: self.error,
        }
    }
}

impl Number for Bounded {
    fn of(x: f64) -> Self {
        Self::exact(DoubleDouble { high: x, low: 0.0 })
    }

    fn difference(a: f64, b: f64) -> Self {
        Self::exact(DoubleDouble::sum(a, -b))
    }

    fn plus(&self, other: &Self) -> Self {
        let value = self.value.plus(other.value);
        let inherited = self.error + other.error;
        let cancels = self.value == other.negated().value;
        let is_exact = cancels || (self.is_plain() && other.is_plain());
        let rounding = if is_exact {
            0.0
        } else {
            SUM_ERROR * (self.value.high.abs() + other.value.high.abs())
        };
        Self {
            value,
            error: inherited + rounding,
        }
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.value, other.value);
        let size = (a.high * b.high).abs();
        let is_zero =
            size == 0.0 && (self.is_plain() && a.high == 0.0 || other.is_plain() && b.high == 0.0);
        if is_zero {
            return Self::of(0.0);
        }
        let value = a.times(b);
        let inherited =
            a.high.abs() * other.error + b.high.abs() * self.error + 2.0 * self.error * other.error;
        let rounding = if self.is_plain() && other.is_plain() && size >= LEAST_PRODUCT {
            0.0
        } else {
            // Below the least product nothing is certain.
            PRODUCT_ERROR * size
                + if size < LEAST_PRODUCT {
                    LEAST_PRODUCT
                } else {
                    0.0
                }
        };
        Self {
            value,
            error: 2.0 * inherited + rounding,
        }
    }

    fn sign(&self) -> Option<Ordering> {
        let high = self.value.high;
        // The low word is below an ulp of the high one, so half of the high word is a safe
        // bound. A product that overflowed is NaN and has no sign.
        if 0.5 * high.abs() > self.error {
            high.partial_cmp(&0.0)
        } else if high == 0.0 && self.error == 0.0 {
            Some(Ordering::Equal)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::big::Big;
    use super::super::estimate::Estimate;
    use super::*;
    use crate::math::Random;

    /// Evaluates random expressions in the number types: the exact one is within the error
    /// bounds.
    #[test]
    fn bounds_hold_for_random_expressions() {
        let mut random = Random::new(77, 0);
        for case in 0..3_000 {
            let mut number = || {
                let size = random.log_uniform(1e-6, 1e6);
                size * if random.below(2) == 0 { 1.0 } else { -1.0 }
            };
            let inputs: [f64; 6] = std::array::from_fn(|_| number());
            let big = expression::<Big>(&inputs);
            let off = |value: &Big| value.minus(&big).0.to_f64().value().abs();
            let bounded = expression::<Bounded>(&inputs);
            let as_big = Big::of(bounded.value.high).plus(&Big::of(bounded.value.low));
            assert!(off(&as_big) <= bounded.error, "case {case}: {bounded:?}");
            let estimate = expression::<Estimate>(&inputs);
            let as_big = Big::of(estimate.value);
            assert!(off(&as_big) <= estimate.error, "case {case}: {estimate:?}");
        }
    }

    /// Signs next to zero are certain or unknown, never wrong.
    #[test]
    fn signs_of_estimates_are_right_next_to_zero() {
        let mut random = Random::new(78, 0);
        let mut certain = 0;
        for case in 0..3_000 {
            let (x, y) = (random.log_uniform(1e-3, 1e3), random.log_uniform(1e-3, 1e3));
            // x² y² less a number some ulps beside it.
            let square = (x * y) * (x * y);
            let beside = square * (1.0 + (random.below(17) as f64 - 8.0) * f64::EPSILON);
            let sign = |x: &Big| x.sign().expect("certain");
            let terms = |x, y, beside| {
                Big::of(x)
                    .times(&Big::of(y))
                    .times(&Big::of(x))
                    .times(&Big::of(y))
                    .minus(&Big::of(beside))
            };
            let exact = sign(&terms(x, y, beside));
            let of = Estimate::of;
            let estimate = of(x)
                .times(&of(y))
                .times(&of(x))
                .times(&of(y))
                .minus(&of(beside));
            if let Some(sign) = estimate.sign() {
                certain += 1;
                assert_eq!(sign, exact, "case {case}");
            }
        }
        assert!((300..2_700).contains(&certain), "{certain} of 3000");
    }

    fn expression<N: Number>(x: &[f64; 6]) -> N {
        let a = N::difference(x[0], x[1]);
        let b = N::difference(x[2], x[3]).times(&N::of(x[4]));
        let c = a.times(&b).plus(&N::of(x[5]).times(&a));
        c.times(&c).minus(&b.times(&b).times(&N::of(x[0])))
    }

    #[test]
    fn differences_that_vanish_are_certain() {
        let third = 1.0 / 3.0;
        let one = Bounded::of(third).times(&Bounded::of(0.7));
        let other = Bounded::of(0.7).times(&Bounded::of(third));
        assert_eq!(one.minus(&other).sign(), Some(Ordering::Equal));
        assert_eq!(Bounded::of(0.0).times(&one).sign(), Some(Ordering::Equal));
        let rounded = one.times(&one).minus(&one.times(&other));
        assert_eq!(rounded.sign(), None);
    }
}
