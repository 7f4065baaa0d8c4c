//! Affine placements: the inverse map into the child's space and its rounding error.
//!
//! A placement maps a child's point `c` to the parent's `p = L c + T`. A ray is
//! mapped by the inverse, `c = L⁻¹ (p - T)`. The subtraction comes first, so a
//! large translation costs at most one rounding of the difference; a folded
//! inverse `L⁻¹ p - L⁻¹ T` would cancel two large numbers.
//!
//! The rounding error is stated as a displacement *in the parent's space*: the
//! computed `c` is the exact image of a point at most `inverse_error · |p - T|`
//! from `p`. With `κ = ‖L‖ ‖L⁻¹‖` (Frobenius norms), `G` the computed inverse and
//! u = 2^-53:
//!
//! - the subtraction moves `p - T` by at most `u |p - T|`;
//! - `G` instead of `L⁻¹` moves the image by `L (G - L⁻¹) v = (L G - I) v`, and
//!   `‖L G - I‖` is measured, with a rounding of its own below `4 u κ`;
//! - the product `G v` has relative error `3 u |G| |v|` a component, which `L`
//!   takes to at most `3 u κ |v|`.
//!
//! The sum of the three, `‖L G - I‖ + u (1 + 7 κ)`, is `inverse_error`.

use glam::{DAffine3, DMat3, DVec3};

use super::UNIT_ROUNDOFF;

/// Maps points and vectors of a parent to a child placed in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChildFromParent {
    inverse: DMat3,
    translation: DVec3,
}

impl ChildFromParent {
    /// The inverse of a placement; its matrix must be invertible.
    #[must_use]
    pub fn new(parent_from_child: &DAffine3) -> Self {
        Self {
            inverse: parent_from_child.matrix3.inverse(),
            translation: parent_from_child.translation,
        }
    }

    /// The child's origin in the parent's space.
    #[must_use]
    pub fn translation(&self) -> DVec3 {
        self.translation
    }

    /// The child's vector for a parent's vector. For a point `p`, apply this
    /// to `p - translation`.
    #[must_use]
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.inverse * vector
    }

    /// The parent's unit normal for a child's normal, by the inverse transpose.
    #[must_use]
    pub fn parent_normal(&self, child_normal: DVec3) -> DVec3 {
        (self.inverse.transpose() * child_normal).normalize()
    }
}

/// Bounds on the stretch and the rounding errors of a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementErrors {
    /// An upper bound of `|L v| / |v|` over all vectors `v`.
    pub stretch: f64,
    /// A lower bound of `|L v| / |v|` over all vectors `v`.
    pub shrink: f64,
    /// An upper bound of `‖L‖ ‖L⁻¹‖`, in Frobenius norms; 3 for a rotation.
    pub condition: f64,
    /// A computed point of the child is the exact image of a parent's point
    /// that is displaced by at most this factor times its distance from the
    /// child's origin. For a vector, its length takes the place of the distance.
    pub inverse_error: f64,
}

impl PlacementErrors {
    /// The bounds for a placement and its computed inverse.
    #[must_use]
    pub fn new(parent_from_child: &DAffine3, child_from_parent: &ChildFromParent) -> Self {
        let matrix = parent_from_child.matrix3;
        let inverse = child_from_parent.inverse;
        let condition =
            frobenius_norm(&matrix) * frobenius_norm(&inverse) * (1.0 + 16.0 * UNIT_ROUNDOFF);
        let residual = frobenius_norm(&(matrix * inverse - DMat3::IDENTITY));
        Self {
            stretch: spectral_norm_bound(&matrix),
            // L⁻¹ = G (L G)⁻¹, and |(L G)⁻¹| <= 1 / (1 - |L G - I|).
            shrink: (1.0 - residual) / spectral_norm_bound(&inverse),
            condition,
            inverse_error: residual + UNIT_ROUNDOFF * (1.0 + 7.0 * condition),
        }
    }
}

/// `√‖Lᵀ L‖∞`, an upper bound of the spectral norm that is tight for rotations
/// with one scale, so that products of it do not grow with depth.
fn spectral_norm_bound(matrix: &DMat3) -> f64 {
    let gram = matrix.transpose() * *matrix;
    let rows = gram.abs() * DVec3::ONE;
    rows.max_element().sqrt() * (1.0 + 8.0 * UNIT_ROUNDOFF)
}

/// The square root of the sum of the squared entries, an upper bound of the
/// factor by which the matrix lengthens a vector.
#[must_use]
pub fn frobenius_norm(matrix: &DMat3) -> f64 {
    (matrix.x_axis.length_squared()
        + matrix.y_axis.length_squared()
        + matrix.z_axis.length_squared())
    .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    /// Nested placements multiply their bounds, so the excess of a rotation would add up.
    #[test]
    fn rotations_neither_stretch_nor_shrink() {
        let mut random = Random::new(5, 0);
        for case in 0..1_000 {
            let x = random.direction();
            let y = x.cross(random.direction()).normalize();
            let scale = random.log_uniform(1e-3, 1e3);
            let affine = DAffine3::from_mat3(DMat3::from_cols(x, y, x.cross(y)) * scale);
            let errors = PlacementErrors::new(&affine, &ChildFromParent::new(&affine));
            assert!((errors.stretch / scale - 1.0).abs() < 1e-14, "case {case}");
            assert!((errors.shrink / scale - 1.0).abs() < 1e-14, "case {case}");
        }
    }

    /// Maps a point into the child and back, the latter in higher precision, and
    /// measures the error of the round trip.
    #[test]
    fn inverse_error_covers_the_round_trip() {
        let mut random = Random::new(4, 0);
        for case in 0..5_000 {
            let mut vector = |low, high| {
                let size = random.log_uniform(low, high);
                random.direction() * size
            };
            let matrix = DMat3::from_cols(vector(1e-3, 1e3), vector(1e-3, 1e3), vector(1e-3, 1e3));
            let affine = DAffine3::from_mat3_translation(matrix, vector(1.0, 1e7));
            let back = ChildFromParent::new(&affine);
            let errors = PlacementErrors::new(&affine, &back);
            let point = vector(1.0, 1e7);
            let child = back.vector(point - affine.translation);

            // The residual L c + T - p, each product and sum exact but for 2^-106.
            let mut residual = DVec3::ZERO;
            for row in 0..3 {
                use crate::math::DoubleDouble as Double;
                let l = matrix.row(row);
                let sum = Double::product(l.x, child.x)
                    .plus(Double::product(l.y, child.y))
                    .plus(Double::product(l.z, child.z))
                    .plus(Double::sum(affine.translation[row], -point[row]));
                residual[row] = sum.high;
            }
            let bound = errors.inverse_error * (point - affine.translation).length();
            assert!(
                residual.length() <= bound,
                "case {case}: {residual:?} exceeds {bound:e}"
            );
            assert!(
                (matrix * point).length() <= errors.stretch * point.length(),
                "case {case}"
            );
            assert!(
                child.length() * errors.shrink <= (point - affine.translation).length(),
                "case {case}"
            );
        }
    }
}
