//! The sRGB transfer curve of IEC 61966-2-1, from codes to linear values.
//!
//! ```text
//! linear(c) = c / 12.92                       where c <= 0.04045,
//!             ((c + 0.055) / 1.055)^2.4       elsewhere, c = code / greatest code
//! ```
//!
//! A value is off by a few roundings of f64, so an encoder that rounds to the nearest code
//! returns the same code.

use std::sync::LazyLock;

use glam::DVec3;

/// The linear values of all 8-bit codes.
static EIGHT_BITS: LazyLock<Vec<f64>> =
    LazyLock::new(|| (0..=255).map(|c| linear(c, 255)).collect());

/// The linear values of all 16-bit codes.
static SIXTEEN_BITS: LazyLock<Vec<f64>> =
    LazyLock::new(|| (0..=65535).map(|code| linear(code, 65535)).collect());

/// The linear color of three 8-bit codes.
pub(super) fn decode8(codes: [u8; 3]) -> DVec3 {
    let table = EIGHT_BITS.as_slice();
    DVec3::from(codes.map(|code| table[usize::from(code)]))
}

/// The linear color of three 16-bit codes.
pub(super) fn decode16(codes: [u16; 3]) -> DVec3 {
    let table = SIXTEEN_BITS.as_slice();
    DVec3::from(codes.map(|code| table[usize::from(code)]))
}

fn linear(code: u32, greatest: u32) -> f64 {
    let encoded = f64::from(code) / f64::from(greatest);
    match encoded <= 0.04045 {
        true => encoded / 12.92,
        false => libm::pow((encoded + 0.055) / 1.055, 2.4),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_of_the_standard_and_the_same_for_both_depths() {
        assert_eq!(decode8([0, 255, 255]), DVec3::new(0.0, 1.0, 1.0));
        let [dark, middle, _] = decode8([10, 128, 0]).to_array();
        assert!((dark - 10.0 / 255.0 / 12.92).abs() < 1e-17, "{dark}");
        // The linear value of the code 128, to ten digits, from a table of the curve.
        assert!((middle - 0.215_860_500_1).abs() < 1e-10, "{middle}");
        for code in 0..=255_u8 {
            let wide = u16::from(code) * 257;
            assert_eq!(decode8([code; 3]), decode16([wide; 3]), "{code}");
        }
    }
}
