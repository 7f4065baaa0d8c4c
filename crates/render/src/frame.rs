//! The frame of a surface.

use glam::DVec3;

/// Three orthogonal unit vectors; the last is a normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Frame {
    /// A frame about a unit vector.
    pub fn about(normal: DVec3) -> Self {
        let (x, y) = normal.any_orthonormal_pair();
        Self { x, y, z: normal }
    }

    /// A vector of the frame, in the world.
    pub fn in_world(self, vector: DVec3) -> DVec3 {
        self.x * vector.x + self.y * vector.y + self.z * vector.z
    }

    /// A vector of the world, in the frame.
    pub fn in_frame(self, vector: DVec3) -> DVec3 {
        DVec3::new(vector.dot(self.x), vector.dot(self.y), vector.dot(self.z))
    }
}
