//! The orientation of an object: an orthonormal right-handed frame.
//!
//! The frame is the matrix `M` that maps object directions to world directions; its
//! columns are the object's axes in world coordinates. A product of two frames
//! deviates from orthonormality by a few units of u = 2^-53, and over a million
//! products the deviations would add up. So each product takes one step of Newton's
//! iteration for the nearest orthonormal matrix (Higham, "Computing the polar
//! decomposition", 1986):
//!
//! ```text
//! M' = M - M E / 2,   E = Mᵀ M - I
//! ```
//!
//! The step squares the deviation: about 8 u becomes less than 2^-98. `E` is computed
//! from exact products, so it is accurate although it is a difference of nearly equal
//! numbers. The remaining error is the rounding of the entries of `M'`, each by at
//! most u of itself: every entry of `M'ᵀ M' - I` is below
//! `2 u Σ |m_ki| |m_kj| <= 2 u`, after any number of rotations, and its Frobenius norm at
//! most 6 u. The norm of `M Mᵀ - I` is the same. Where `E` is zero, as for quarter turns, the
//! step changes nothing.

use glam::{DMat3, DVec3};

use super::{DoubleDouble, UNIT_ROUNDOFF, frobenius_norm, rotation, sin_cos_degrees, unit};

/// The rotation of an object about its own center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    world_from_object: DMat3,
}

impl Default for Orientation {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Orientation {
    /// No rotation.
    pub const IDENTITY: Self = Self {
        world_from_object: DMat3::IDENTITY,
    };

    /// The orientation of an object with these axes in the world, taken as exact numbers;
    /// `None` unless they are right-handed and as orthonormal as those of every orientation:
    /// the Frobenius norm of `Mᵀ M - I` is at most 6 · 2^-53.
    ///
    /// ```
    /// use cyltrace::math::Orientation;
    ///
    /// let turned = Orientation::IDENTITY.rotated_x(30.0).rotated_z(20.0);
    /// let [x, y, z] = [0, 1, 2].map(|axis| turned.world_from_object().col(axis));
    /// assert_eq!(Orientation::from_axes(x, y, z), Some(turned));
    /// assert_eq!(Orientation::from_axes(x, y, z * 1.001), None);
    /// ```
    #[must_use]
    pub fn from_axes(x: DVec3, y: DVec3, z: DVec3) -> Option<Self> {
        /// 6 u, and what is of the order of u².
        const MOST: f64 = 6.0 * UNIT_ROUNDOFF * (1.0 + 1e-12);
        let world_from_object = DMat3::from_cols(x, y, z);
        // Comparisons with NaN are false.
        let is_orthonormal = frobenius_norm(&residual(&world_from_object)) <= MOST;
        (is_orthonormal && world_from_object.determinant() > 0.0)
            .then_some(Self { world_from_object })
    }

    /// Adds a right-handed rotation about the world's x axis. Multiples of 90
    /// degrees are exact.
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_x(self, degrees: f64) -> Self {
        let (sin, cos) = finite_sin_cos(degrees);
        self.turned(DMat3::from_cols(
            DVec3::X,
            DVec3::new(0.0, cos, sin),
            DVec3::new(0.0, -sin, cos),
        ))
    }

    /// Adds a rotation about the world's y axis; see [`Orientation::rotated_x`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_y(self, degrees: f64) -> Self {
        let (sin, cos) = finite_sin_cos(degrees);
        self.turned(DMat3::from_cols(
            DVec3::new(cos, 0.0, -sin),
            DVec3::Y,
            DVec3::new(sin, 0.0, cos),
        ))
    }

    /// Adds a rotation about the world's z axis; see [`Orientation::rotated_x`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_z(self, degrees: f64) -> Self {
        let (sin, cos) = finite_sin_cos(degrees);
        self.turned(DMat3::from_cols(
            DVec3::new(cos, sin, 0.0),
            DVec3::new(-sin, cos, 0.0),
            DVec3::Z,
        ))
    }

    /// Adds a right-handed rotation about an axis of any length in the world.
    ///
    /// # Panics
    /// When the angle is not finite, or the axis is zero or not finite.
    #[must_use]
    pub fn rotated(self, axis: DVec3, degrees: f64) -> Self {
        let axis = unit(axis).expect("the axis of a rotation must be finite and not zero");
        self.turned(rotation(axis, finite_sin_cos(degrees)))
    }

    /// This rotation, followed by `next`.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        self.turned(next.world_from_object)
    }

    /// The inverse rotation.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self {
            world_from_object: self.world_from_object.transpose(),
        }
    }

    /// The matrix that maps object directions to world directions. Its columns
    /// are the object's axes.
    #[must_use]
    pub fn world_from_object(&self) -> DMat3 {
        self.world_from_object
    }

    /// Whether every axis of the object is parallel to an axis of the world.
    #[must_use]
    pub fn is_axis_aligned(&self) -> bool {
        self.world_from_object
            .to_cols_array()
            .into_iter()
            .all(|entry| entry == 0.0 || entry.abs() == 1.0)
    }

    /// An object direction in world coordinates, rounded.
    #[must_use]
    pub fn to_world(&self, object: DVec3) -> DVec3 {
        self.world_from_object * object
    }

    /// A world direction in object coordinates, rounded.
    #[inline]
    #[must_use]
    pub fn to_object(&self, world: DVec3) -> DVec3 {
        let frame = &self.world_from_object;
        DVec3::new(
            frame.x_axis.dot(world),
            frame.y_axis.dot(world),
            frame.z_axis.dot(world),
        )
    }

    fn turned(self, turn: DMat3) -> Self {
        Self {
            world_from_object: orthonormal(turn * self.world_from_object),
        }
    }
}

fn finite_sin_cos(degrees: f64) -> (f64, f64) {
    assert!(
        degrees.is_finite(),
        "the rotation angle must be finite, but is {degrees} degrees"
    );
    sin_cos_degrees(degrees)
}

/// The Newton step derived at the top of this file.
fn orthonormal(matrix: DMat3) -> DMat3 {
    matrix - matrix * (residual(&matrix) * 0.5)
}

/// `Mᵀ M - I` from exact products.
fn residual(matrix: &DMat3) -> DMat3 {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let off = |i: usize, j: usize| {
        let (a, b) = (columns[i], columns[j]);
        DoubleDouble::product(a.x, b.x)
            .plus(DoubleDouble::product(a.y, b.y))
            .plus(DoubleDouble::product(a.z, b.z))
            .plus(DoubleDouble::sum(if i == j { -1.0 } else { 0.0 }, 0.0))
            .high
    };
    let (xy, yz, zx) = (off(0, 1), off(1, 2), off(2, 0));
    DMat3::from_cols(
        DVec3::new(off(0, 0), xy, zx),
        DVec3::new(xy, off(1, 1), yz),
        DVec3::new(zx, yz, off(2, 2)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    #[test]
    fn quarter_turns_are_exact_and_right_handed() {
        let turned = Orientation::IDENTITY;
        assert_eq!(turned.rotated_x(90.0).to_world(DVec3::Y), DVec3::Z);
        assert_eq!(turned.rotated_y(90.0).to_world(DVec3::Z), DVec3::X);
        assert_eq!(turned.rotated_z(90.0).to_world(DVec3::X), DVec3::Y);
        assert_eq!(
            turned.rotated(DVec3::Z * 7.0, -270.0),
            turned.rotated_z(90.0)
        );
        let several = turned.rotated_x(90.0).rotated_y(-180.0).rotated_z(450.0);
        assert!(several.is_axis_aligned());
        assert!(!turned.rotated_x(1.0).is_axis_aligned());
        // The turn about x takes Y to Z, the one about y takes Z to -Z, and the one
        // about z leaves that fixed.
        assert_eq!(several.to_world(DVec3::Y), DVec3::NEG_Z);
        assert_eq!(several.to_object(DVec3::NEG_Z), DVec3::Y);
    }

    #[test]
    fn axes_of_turned_objects_are_an_orientation_and_others_are_not() {
        let mut random = Random::new(31, 0);
        let mut turned = Orientation::IDENTITY;
        for case in 0..20_000 {
            turned = turned.rotated(random.direction(), random.uniform(-400.0, 400.0));
            for turned in [turned, turned.inverse()] {
                let frame = turned.world_from_object;
                let (x, y, z) = (frame.x_axis, frame.y_axis, frame.z_axis);
                assert_eq!(Orientation::from_axes(x, y, z), Some(turned), "case {case}");
                assert_eq!(Orientation::from_axes(y, x, z), None, "case {case}");
                let longer = x * (1.0 + 8.0 * f64::EPSILON);
                assert_eq!(Orientation::from_axes(longer, y, z), None, "case {case}");
            }
        }
        for wrong in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::MAX] {
            assert_eq!(Orientation::from_axes(wrong, DVec3::Y, DVec3::Z), None);
        }
    }

    #[test]
    fn turns_follow_each_other() {
        let (first, second) = (
            Orientation::IDENTITY.rotated_x(90.0),
            Orientation::IDENTITY.rotated_z(90.0),
        );
        assert_eq!(first.then(second), first.rotated_z(90.0));
        assert_ne!(first.then(second), second.then(first));
        assert_eq!(
            first.then(second).then(first.then(second).inverse()),
            Orientation::IDENTITY
        );
    }
}
