//! Validates placements, and converts quaternions to rotations.
//!
//! The code uses only additions, products, square roots and `libm`, so a scene has the
//! same numbers on every machine; glam's own rotations call the platform's sine.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::limits::GREATEST_CONDITION;
use crate::math::{ChildFromParent, PlacementErrors, power_of_two};

/// The greatest size of an entry of a placement: 2^100, so that products of a
/// few of them stay within f64.
pub(super) const GREATEST_ENTRY: f64 = power_of_two(100);

/// The least `|det L|` relative to the product of the lengths of L's columns:
/// 2^-40. For a singular matrix, rounding gives about 2^-50; below 2^-40 fewer
/// than a dozen bits of an inverse would be correct.
const LEAST_RELATIVE_DETERMINANT: f64 = power_of_two(-40);

/// Why a placement is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(super) enum TransformError {
    #[error("the placement has the entry {entry}: entries must be at most 2^100 in size")]
    Entry { entry: f64 },
    #[error("the placement scales a direction by {length:e}: the factor must be at least 2^-100")]
    Shrinks { length: f64 },
    #[error(
        "the placement is singular, so it flattens volumes: its determinant is {relative:e} times the product of its columns' lengths, but must be at least 2^-40 times"
    )]
    Singular { relative: f64 },
    #[error(
        "the placement stretches too unevenly: its condition number |L| |L^-1| is {condition:.1e} (Frobenius norms; 3 for a rotation), but must be at most 2^27"
    )]
    Uneven { condition: f64 },
}

/// Bounds of a placement, for the check of nested placements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reach {
    /// An upper bound of the factor by which L lengthens a vector.
    pub stretch: f64,
    /// An upper bound of the factor by which L's inverse lengthens a vector.
    pub squeeze: f64,
    /// An upper bound of the size of the translation's coordinates.
    pub translation: f64,
}

impl Reach {
    /// The bounds of both placements.
    pub fn union(self, other: Self) -> Self {
        Self {
            stretch: self.stretch.max(other.stretch),
            squeeze: self.squeeze.max(other.squeeze),
            translation: self.translation.max(other.translation),
        }
    }
}

/// The rotation of a quaternion (x, y, z, w) of any length, or `None` if it is zero.
pub(super) fn quaternion_rotation(quaternion: [f64; 4]) -> Option<DMat3> {
    let size = quaternion
        .iter()
        .fold(0.0, |size: f64, entry| size.max(entry.abs()));
    (size > 0.0).then(|| {
        let scaled = DQuat::from_array(quaternion.map(|entry| entry / size));
        DMat3::from_quat(DQuat::from_vec4(
            glam::DVec4::from(scaled) / glam::DVec4::from(scaled).length(),
        ))
    })
}

/// Validates a placement and returns its bounds.
///
/// # Errors
/// If an entry of the placement is too large, or the matrix is singular or nearly so.
pub(super) fn checked(parent_from_child: &DAffine3) -> Result<Reach, TransformError> {
    let matrix = parent_from_child.matrix3;
    let translation = parent_from_child.translation;
    for entry in matrix
        .to_cols_array()
        .into_iter()
        .chain(translation.to_array())
    {
        if entry.is_nan() || entry.abs() > GREATEST_ENTRY {
            return Err(TransformError::Entry { entry });
        }
    }
    let lengths = DVec3::new(
        matrix.x_axis.length(),
        matrix.y_axis.length(),
        matrix.z_axis.length(),
    );
    let shortest = lengths.min_element();
    if shortest == 0.0 {
        return Err(TransformError::Singular { relative: 0.0 });
    }
    if shortest < 1.0 / GREATEST_ENTRY {
        return Err(TransformError::Shrinks { length: shortest });
    }
    let relative = DMat3::from_cols(
        matrix.x_axis / lengths.x,
        matrix.y_axis / lengths.y,
        matrix.z_axis / lengths.z,
    )
    .determinant();
    if relative.abs() < LEAST_RELATIVE_DETERMINANT {
        return Err(TransformError::Singular { relative });
    }
    let errors = PlacementErrors::new(parent_from_child, &ChildFromParent::new(parent_from_child));
    let condition = errors.condition;
    if condition > GREATEST_CONDITION {
        return Err(TransformError::Uneven { condition });
    }
    Ok(Reach {
        stretch: errors.stretch,
        squeeze: 1.0 / errors.shrink,
        translation: translation.abs().max_element(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Random, rotation, sin_cos_degrees, unit};

    fn greatest_entry(matrix: &DMat3) -> f64 {
        matrix
            .to_cols_array()
            .into_iter()
            .fold(0.0, |greatest, entry| greatest.max(entry.abs()))
    }

    #[test]
    fn rotation_random_axis_agrees_with_its_quaternion() {
        let mut random = Random::new(12, 0);
        for case in 0..2_000 {
            let axis = random.direction();
            let degrees = random.uniform(-360.0, 360.0);
            let matrix = rotation(unit(axis).expect("an axis"), sin_cos_degrees(degrees));
            let (sin, cos) = sin_cos_degrees(degrees / 2.0);
            let length = random.log_uniform(1e-100, 1e100);
            let half = axis * sin * length;
            let other =
                quaternion_rotation([half.x, half.y, half.z, cos * length]).expect("a quaternion");
            let error = greatest_entry(&(matrix - other));
            assert!(error < 2e-15, "case {case}: {axis:?} {degrees} {error:e}");
            let gram = greatest_entry(&(matrix.transpose() * matrix - DMat3::IDENTITY));
            assert!(gram < 2e-15, "case {case}: {axis:?} {degrees} {gram:e}");
        }
    }

    #[test]
    fn checked_extreme_and_singular_matrices_are_rejected() {
        let scaled = |x, y, z| DAffine3::from_scale(DVec3::new(x, y, z));
        assert!(checked(&scaled(1e30, 1e30, -1e30)).is_ok());
        assert!(checked(&scaled(7e7, 1.0, -1.0)).is_ok());
        assert!(matches!(
            checked(&scaled(2e8, 1.0, -1.0)),
            Err(TransformError::Uneven { .. })
        ));
        assert!(matches!(
            checked(&scaled(1e31, 1.0, 1.0)),
            Err(TransformError::Entry { .. })
        ));
        assert!(matches!(
            checked(&scaled(1e-31, 1.0, 1.0)),
            Err(TransformError::Shrinks { .. })
        ));
        assert!(matches!(
            checked(&scaled(0.0, 1.0, 1.0)),
            Err(TransformError::Singular { relative: 0.0 })
        ));
        let flat = DMat3::from_cols(
            DVec3::new(1.0, 2.0, 3.0),
            DVec3::new(4.0, 5.0, 6.0),
            DVec3::new(7.0, 8.0, 9.0),
        );
        assert!(matches!(
            checked(&DAffine3::from_mat3(flat)),
            Err(TransformError::Singular { .. })
        ));
        let moved = DAffine3::from_translation(DVec3::new(0.0, f64::NAN, 0.0));
        assert!(matches!(
            checked(&moved),
            Err(TransformError::Entry { entry }) if entry.is_nan()
        ));
    }
}
