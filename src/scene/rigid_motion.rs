//! The motion of a solid: a rotation about its center and a translation.

use glam::DVec3;

use crate::math::Orientation;

/// A rotation about a center and a translation. A missing part changes no bit.
pub(super) struct RigidMotion {
    pub turn: Option<Orientation>,
    pub center: DVec3,
    pub translation: Option<DVec3>,
}

impl RigidMotion {
    /// Moves a point.
    pub fn point(&self, point: DVec3) -> DVec3 {
        let turned = self.turn.map_or(point, |turn| {
            self.center + turn.to_world(point - self.center)
        });
        self.translation.map_or(turned, |by| turned + by)
    }

    /// Rotates a direction.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.turn.map_or(direction, |turn| turn.to_world(direction))
    }

    /// The new orientation of an object, given the one before.
    pub fn orientation(&self, before: Orientation) -> Orientation {
        self.turn.map_or(before, |turn| before.then(turn))
    }
}
