//! Where an object is and which way it is turned.
//!
//! A point goes to the object by the difference to the center first, so that a
//! far center costs one rounding of that difference and not of the products.

use glam::{DAffine3, DVec3};

use super::Orientation;

/// A rigid motion from an object's own space, with its center at zero, to the
/// world. Turns are about the object's own center and leave it where it is; they
/// and translations follow each other in the order of the calls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Where the object's center is in the world.
    pub center: DVec3,
    /// Which way the object is turned.
    pub orientation: Orientation,
}

impl Pose {
    /// Not turned, with its center at a point.
    #[must_use]
    pub fn at(center: DVec3) -> Self {
        Self {
            center,
            orientation: Orientation::IDENTITY,
        }
    }

    /// Moved on.
    #[must_use]
    pub fn translated(self, by: DVec3) -> Self {
        Self {
            center: self.center + by,
            ..self
        }
    }

    /// Turned on about its center; see [`Orientation::rotated_x`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_x(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_x(degrees))
    }

    /// Turned on about its center; see [`Orientation::rotated_y`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_y(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_y(degrees))
    }

    /// Turned on about its center; see [`Orientation::rotated_z`].
    ///
    /// # Panics
    /// When the angle is not finite.
    #[must_use]
    pub fn rotated_z(self, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated_z(degrees))
    }

    /// Turned on about its center; see [`Orientation::rotated`].
    ///
    /// # Panics
    /// When the angle is not finite, or the axis is zero or not finite.
    #[must_use]
    pub fn rotated(self, axis: DVec3, degrees: f64) -> Self {
        self.oriented(self.orientation.rotated(axis, degrees))
    }

    /// A point of the object in the world, rounded.
    #[must_use]
    pub fn point_to_world(&self, object: DVec3) -> DVec3 {
        self.orientation.to_world(object) + self.center
    }

    /// A point of the world as the object sees it, rounded.
    #[must_use]
    pub fn point_to_object(&self, world: DVec3) -> DVec3 {
        self.orientation.to_object(world - self.center)
    }

    /// A direction of the object in the world, rounded.
    #[must_use]
    pub fn direction_to_world(&self, object: DVec3) -> DVec3 {
        self.orientation.to_world(object)
    }

    /// A direction of the world as the object sees it, rounded.
    #[must_use]
    pub fn direction_to_object(&self, world: DVec3) -> DVec3 {
        self.orientation.to_object(world)
    }

    /// The map that takes the object's points to the world's.
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
