//! Values and signs of polynomials that keep their bits if terms cancel.
//!
//! A solver uses this file for a difference that is small relative to its terms. It evaluates
//! the same polynomial in double-double with a running error bound, and if those 106 bits do
//! not decide, in numbers of any length. Signs are first evaluated in f64 with an error bound,
//! which decides those of points that are not next to a surface.

use std::cmp::Ordering;

use super::Number;
use super::big::Big;
use super::bounded::Bounded;
use super::estimate::Estimate;
use crate::math::power_of_two;

/// A double-double is accepted as the value if its error bound is below this share of it.
///
/// It trades bits of the value for time. Next to a surface, where rays are spawned, a constant
/// term is about 2^-48 of its terms. At 2^-50 the 106 bits of a double-double are nearly always
/// enough; at 2^-60 a quarter of such rays needed numbers of any length, which take ten times
/// as long as everything else.
const GOOD: f64 = power_of_two(-50);

/// A polynomial in exact numbers.
pub(in crate::solid) trait Expression {
    /// Its value.
    fn value<N: Number>(&self) -> N;
}

/// The expression over a positive `divisor`, within ten units of 2^-53 of itself if it does not
/// underflow. It has the exact sign, and is zero only if the expression is.
#[cold]
pub(in crate::solid) fn quotient(expression: &impl Expression, divisor: f64) -> f64 {
    let bounded = expression.value::<Bounded>();
    let high = bounded.value.high;
    let rounded = if bounded.error <= GOOD * high.abs() && high.is_finite() {
        high / divisor
    } else {
        expression.value::<Big>().over(divisor)
    };
    if rounded == 0.0 {
        // Zero, or below the range of f64: then the sign is kept.
        return match sign(expression) {
            Ordering::Less => -f64::MIN_POSITIVE,
            Ordering::Equal => 0.0,
            Ordering::Greater => f64::MIN_POSITIVE,
        };
    }
    rounded
}

/// Compares the expression with zero.
pub(in crate::solid) fn sign(expression: &impl Expression) -> Ordering {
    let estimate = expression.value::<Estimate>().sign();
    estimate.unwrap_or_else(|| long_sign(expression))
}

#[cold]
fn long_sign(expression: &impl Expression) -> Ordering {
    let bounded = expression.value::<Bounded>().sign();
    bounded.unwrap_or_else(|| {
        let sign = expression.value::<Big>().sign();
        sign.expect("signs of numbers of any length are certain")
    })
}

/// `a·b`.
pub(in crate::solid) fn dot<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].times(&b[0])
        .plus(&a[1].times(&b[1]))
        .plus(&a[2].times(&b[2]))
}

/// `a × b`.
pub(in crate::solid) fn cross<N: Number>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    let term = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// The numbers of a vector.
pub(in crate::solid) fn vector<N: Number>(v: glam::DVec3) -> [N; 3] {
    v.to_array().map(N::of)
}

/// `a - b`, exactly.
pub(in crate::solid) fn difference<N: Number>(a: glam::DVec3, b: glam::DVec3) -> [N; 3] {
    std::array::from_fn(|i| N::difference(a[i], b[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x² - y² - z`, over one.
    struct Cancelling(f64, f64, f64);

    impl Expression for Cancelling {
        fn value<N: Number>(&self) -> N {
            let [x, y, z] = [self.0, self.1, self.2].map(N::of);
            x.times(&x).minus(&y.times(&y)).minus(&z)
        }
    }

    #[test]
    fn value_keeps_its_bits_where_all_of_f64_cancels() {
        let eps = f64::EPSILON;
        // (1 + e)² - 1 - 2 e = e².
        assert_eq!(
            quotient(&Cancelling(1.0 + eps, 1.0, 2.0 * eps), 4.0),
            eps * eps / 4.0
        );
        assert_eq!(quotient(&Cancelling(3.0, 3.0, 0.0), 1.0), 0.0);
    }

    #[test]
    fn sign_is_kept_below_the_least_f64() {
        let tiny = power_of_two(-700);
        assert_eq!(
            quotient(&Cancelling(0.0, tiny, 0.0), 1.0),
            -f64::MIN_POSITIVE
        );
        assert_eq!(sign(&Cancelling(tiny, 0.0, 0.0)), Ordering::Greater);
    }
}
