//! Rotations by degrees. They use only sums, products, square roots and `libm`, so
//! the results are the same on every machine; glam's own rotations call the
//! platform's sine.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::power_of_two;

/// The unit vector along `vector`, or `None` if it is zero or not finite. Its
/// size is divided out before anything is squared, so nothing overflows.
#[must_use]
pub fn unit(vector: DVec3) -> Option<DVec3> {
    let size = vector.abs().max_element();
    (size > 0.0 && size.is_finite()).then(|| {
        let scaled = vector / size;
        scaled / scaled.length()
    })
}

/// The unit vector along a vector. One whose length is 1 to within roundings is its own, so
/// that a direction survives being written and read.
#[must_use]
pub fn unit_or_same(vector: DVec3) -> Option<DVec3> {
    match is_unit(vector) {
        true => Some(vector),
        false => unit(vector),
    }
}

/// Whether the square of a vector's length is within 2^-49 of 1, 16 u. A direction from angles
/// has components of 3 roundings, one from [`unit()`] a length of 3 roundings, and the square has
/// two more: 8 u.
#[must_use]
pub fn is_unit(vector: DVec3) -> bool {
    (vector.length_squared() - 1.0).abs() <= power_of_two(-49)
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
///
/// The angle is reduced to [-45, 45] degrees, which is exact, and the quarter
/// turns are put back by swapping and negating.
#[must_use]
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    let quarters = libm::round(turned / 90.0);
    let (sin, cos) = libm::sincos((turned - 90.0 * quarters) * (PI / 180.0));
    match (quarters as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The rotation about a unit axis by an angle given by its sine and cosine
/// (Rodrigues' formula).
#[must_use]
pub fn rotation(axis: DVec3, (sin, cos): (f64, f64)) -> DMat3 {
    let across = DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    );
    let along = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    DMat3::from_diagonal(DVec3::splat(cos)) + across * sin + along * (1.0 - cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn sin_cos_quarter_turns_are_exact() {
        let expected = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for turn in -9_i32..=9 {
            let degrees = 90.0 * f64::from(turn);
            let found = sin_cos_degrees(degrees);
            assert_eq!(found, expected[turn.rem_euclid(4) as usize], "{degrees}");
        }
        assert_eq!(
            sin_cos_degrees(90.0 + 360.0 * (1_u64 << 40) as f64),
            (1.0, 0.0)
        );
    }

    #[test]
    fn sin_cos_random_angles_agree_with_radians() {
        let mut random = Random::new(11, 0);
        for _ in 0..10_000 {
            let degrees = random.uniform(-720.0, 720.0);
            let (sin, cos) = sin_cos_degrees(degrees);
            let (sin_radians, cos_radians) = libm::sincos(degrees * (PI / 180.0));
            let error = (sin - sin_radians).abs().max((cos - cos_radians).abs());
            assert!(error < 3e-15, "{:#x}: {error:e}", degrees.to_bits());
        }
    }

    #[test]
    fn rotation_of_a_quarter_about_z_takes_x_to_y_exactly() {
        let axis = unit(DVec3::new(0.0, 0.0, 7.0)).expect("an axis");
        let matrix = rotation(axis, sin_cos_degrees(90.0));
        assert_eq!(matrix * DVec3::X, DVec3::Y);
        assert_eq!(matrix * DVec3::Y, DVec3::NEG_X);
    }
}
