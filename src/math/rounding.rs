//! The unit roundoff, directed rounding to f32, and powers of two for exact scaling.

/// Half an ulp of 1: every operation of f64 has at most this relative error.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// `2^exponent`, exactly, for `-1022 <= exponent <= 1023`.
///
/// # Panics
/// When the exponent is out of range.
#[must_use]
pub const fn power_of_two(exponent: i32) -> f64 {
    assert!(
        -1022 <= exponent && exponent <= 1023,
        "the power of two must be a normal f64"
    );
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The greatest power of two that is not above `x`, a positive normal number.
#[must_use]
pub fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & 0x7FF0_0000_0000_0000)
}

/// The least f32 that is not below `x`; infinity beyond the greatest f32.
#[must_use]
pub fn f32_above(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        nearest.next_up()
    } else {
        nearest
    }
}

/// The greatest f32 that is not above `x`; minus infinity below the least f32.
#[must_use]
pub fn f32_below(x: f64) -> f32 {
    -f32_above(-x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn powers_of_two_are_exact() {
        assert_eq!(power_of_two(-150), 2.0_f64.powi(-150));
        assert_eq!(power_of_two(1023) * 2.0, f64::INFINITY);
        for (x, below) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (0.75, 0.5),
            (1e300, power_of_two(996)),
        ] {
            assert_eq!(power_of_two_below(x), below, "{x:e}");
        }
    }

    #[test]
    fn f32_limits_enclose_their_number() {
        let mut random = Random::new(1, 0);
        for _ in 0..10_000 {
            let x = random.log_uniform(1e-44, 1e38) * if random.below(2) == 0 { 1.0 } else { -1.0 };
            let (low, high) = (f32_below(x), f32_above(x));
            assert!(f64::from(low) <= x && x <= f64::from(high), "{x:e}");
            assert!(low == high || low.next_up() == high, "{x:e}");
        }
        assert_eq!(f32_above(1e300), f32::INFINITY);
        assert_eq!(f32_below(1e300), f32::MAX);
    }
}
