//! The lights of a scene.

use glam::DVec3;

/// A light so far away that it has a direction only: a disk of uniform radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector towards the middle of the sun.
    pub direction: DVec3,
    /// Linear RGB.
    pub color: DVec3,
    /// Factor on `color`; irradiance on a surface that faces the sun.
    pub strength: f64,
    /// The angle that the disk spans, in degrees, from 0 to 90; 0 makes shadows sharp.
    pub angle_degrees: f64,
}

impl Sun {
    /// The angle that the sun spans as seen from the earth, in degrees.
    pub const ANGLE_DEGREES: f64 = 0.53;
}

/// Light from every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Linear RGB.
    pub color: DVec3,
    /// Factor on `color`.
    pub strength: f64,
}

/// The sky on a clear day, brighter around the sun and towards the horizon.
///
/// Its sun is that of the scene, which must not be below the horizon, the x-y plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearSky {
    /// How hazy the air is, from 2 (clear) to 10 (hazy).
    pub turbidity: f64,
    /// The reflectance of the ground below the horizon, linear RGB, each component in [0, 1].
    pub ground: DVec3,
    /// Factor on the radiance of sky and ground; 0 or greater.
    pub strength: f64,
}

/// A light with a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The emitting shape.
    pub shape: LightShape,
    /// Linear RGB.
    pub color: DVec3,
    /// Factor on `color`: the radiance of a sphere or a rectangle, the radiant intensity of a
    /// point.
    pub strength: f64,
}

/// The shape of a light with a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// A point, which no ray hits. It emits the same intensity in all directions.
    Point {
        /// The point.
        position: DVec3,
    },
    /// A sphere that emits outward.
    Sphere {
        /// The center.
        center: DVec3,
        /// The radius, greater than 0.
        radius: f64,
    },
    /// A parallelogram that emits on the side that the cross product of its edges points to.
    Rectangle {
        /// A corner.
        corner: DVec3,
        /// The edges from that corner, not parallel.
        edges: [DVec3; 2],
    },
}
