//! Numbers as unevaluated sums of two f64: about 106 bits.
//!
//! The error-free sum is Knuth's (The Art of Computer Programming, vol. 2,
//! 4.2.2), the error-free product Dekker's ("A floating-point technique for
//! extending the available precision", 1971) with Veltkamp's split. A fused
//! multiply-add would give the same numbers, but it is a library call on
//! cargo's default target.

/// The sum `high + low` with `|low| <= ulp(high) / 2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// The sum rounded to f64.
    pub high: f64,
    /// The rounding error.
    pub low: f64,
}

impl DoubleDouble {
    /// `a + b`, exactly (barring overflow).
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let b_seen = high - a;
        let low = (a - (high - b_seen)) + (b - b_seen);
        Self { high, low }
    }

    /// `a * b`, exactly, where both are below 2^990 in size and the product is
    /// zero or above 2^-960.
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let (a_high, a_low) = split(a);
        let (b_high, b_low) = split(b);
        let low = a_low * b_low - (((high - a_high * b_high) - a_low * b_high) - a_high * b_low);
        Self { high, low }
    }

    /// `self + other` with a relative error below `4 · 2^-106` of
    /// `|self| + |other|`.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + (self.low + other.low))
    }

    /// `self * other` with a relative error below `8 · 2^-106`, under the
    /// conditions of [`DoubleDouble::product`]: the product of the low words
    /// is left out and the two mixed ones are rounded.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let mixed = self.high * other.low + self.low * other.high;
        Self::sum(product.high, product.low + mixed)
    }

    /// The number with the other sign, exactly.
    #[must_use]
    pub fn negated(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

/// Splits `x` into a sum of two numbers of 26 bits.
fn split(x: f64) -> (f64, f64) {
    const FACTOR: f64 = ((1_u32 << 27) + 1) as f64;
    let scaled = FACTOR * x;
    let high = scaled - (scaled - x);
    (high, x - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn product_is_exact() {
        let mut random = Random::new(2, 0);
        for _ in 0..10_000 {
            let a = (random.bits() >> 11) as i64 - (1 << 52);
            let b = (random.bits() >> 11) as i64 - (1 << 52);
            let product = DoubleDouble::product(a as f64, b as f64);
            let exact = i128::from(a) * i128::from(b);
            assert_eq!(
                product.high as i128 + product.low as i128,
                exact,
                "{a} * {b}"
            );
        }
    }

    #[test]
    fn sum_keeps_what_f64_loses() {
        let sum = DoubleDouble::sum(1e20, 1.0);
        assert_eq!((sum.high, sum.low), (1e20, 1.0));
        let back = sum.plus(DoubleDouble {
            high: -1e20,
            low: 0.0,
        });
        assert_eq!((back.high, back.low), (1.0, 0.0));
    }
}
