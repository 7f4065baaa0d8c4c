//! The result of a query.

use glam::DVec3;

use crate::math::Ray;
use crate::scene::{MaterialIndex, PrototypeIndex};
use crate::solid::{Crossing, Part, SolidKind, spawned_ray};

/// An intersection of a ray and the surface of a solid, in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter.
    pub t: f64,
    /// The hit point, projected onto the surface.
    pub point: DVec3,
    /// Bounds the distance of `point` from the true surface, in scene units.
    pub error: f64,
    /// Outward unit normal.
    pub normal: DVec3,
    /// Angle around the axis divided by 2π, in [0, 1).
    pub u: f64,
    /// Axial position from `p0` to `p1`, in [0, 1].
    pub v: f64,
    /// The prototype that contains the solid.
    pub prototype: PrototypeIndex,
    /// The kind of solid.
    pub solid: SolidKind,
    /// The solid's number within its prototype.
    pub primitive: u32,
    /// The part of the surface.
    pub part: Part,
    /// Whether the ray enters or leaves the solid.
    pub crossing: Crossing,
    /// The placements from the root to the prototype, outermost first.
    pub instance: Vec<u32>,
    /// The solid's material.
    pub material: MaterialIndex,
    /// The distance along the normal at which a new ray has to start.
    pub(crate) spawn_offset: f64,
}

impl Hit {
    /// A ray that leaves the surface here, towards `direction`, and does not hit it again at
    /// its start: it begins on the side that `direction` points to.
    #[must_use]
    pub fn spawn(&self, direction: DVec3) -> Ray {
        spawned_ray(self.point, self.normal, self.spawn_offset, direction)
    }
}
