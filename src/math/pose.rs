//! The position and orientation of an object.
//!
//! The map into object space subtracts the center first, so a distant center costs
//! one rounding of the difference and none of the products.

use glam::{DAffine3, DVec3};

use super::Orientation;

/// A rigid motion from an object's own space, with its center at zero, to the
/// world. Rotations are about the object's own center. Rotations and translations
/// apply in the order of the calls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// The object's center in the world.
    pub center: DVec3,
    /// The object's rotation about its center.
    pub orientation: Orientation,
}

impl Pose {
    /// No rotation, with the center at a point.
    #[must_use]
    pub fn at(center: DVec3) -> Self {
        Self {
            center,
            orientation: Orientation::IDENTITY,
        }
    }

    /// Adds a translation.
    #[must_use]
    pub fn translated(self, by: DVec3) -> Self {
        Self {
            center: self.center + by,
            ..self
        }
    }

    /// Adds a rotation about the center; see [`Orientation::rotated_x`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_x(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_x(degrees))
    }

    /// Adds a rotation about the center; see [`Orientation::rotated_y`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_y(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_y(degrees))
    }

    /// Adds a rotation about the center; see [`Orientation::rotated_z`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_z(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_z(degrees))
    }

    /// Adds a rotation about the center; see [`Orientation::rotated`].
    ///
    /// # Panics
    /// When the angle is not finite, or the axis is zero or not finite.
    #[must_use]
    pub fn rotated(self, axis: DVec3, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated(axis, degrees))
    }

    /// An object point in world coordinates, rounded.
    #[must_use]
    pub fn point_to_world(&self, object: DVec3) -> DVec3 {
        self.orientation.to_world(object) + self.center
    }

    /// A world point in object coordinates, rounded.
    #[must_use]
    pub fn point_to_object(&self, world: DVec3) -> DVec3 {
        self.orientation.to_object(world - self.center)
    }

    /// An object direction in world coordinates, rounded.
    #[must_use]
    pub fn direction_to_world(&self, object: DVec3) -> DVec3 {
        self.orientation.to_world(object)
    }

    /// A world direction in object coordinates, rounded.
    #[must_use]
    pub fn direction_to_object(&self, world: DVec3) -> DVec3 {
        self.orientation.to_object(world)
    }

    /// The map from object points to world points.
    #[must_use]
    pub fn world_from_object(&self) -> DAffine3 {
        DAffine3 {
            matrix3: self.orientation.world_from_object(),
            translation: self.center,
        }
    }

    fn oriented(self, orientation: Orientation) -> Self {
        Self {
            orientation,
            ..self
        }
    }
}
