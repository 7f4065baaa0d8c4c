//! The mesh of a cuboid, which is exact up to roundings.
//!
//! A corner is computed like a point of the surface, with the same error ([`Cuboid`]'s
//! `surface_point`).

use glam::DVec3;

use super::{Fit, Outline, Tessellated};
use crate::math::UNIT_ROUNDOFF;
use crate::solid::Cuboid;

impl Tessellated for Cuboid {
    fn outline(&self, _: u32, _: Fit) -> Outline {
        Outline::Cuboid(*self)
    }
}

/// The corners. Bit i of a corner's number is its side of axis i.
pub(super) fn vertices(cuboid: &Cuboid) -> Vec<DVec3> {
    let corner = |number: u32| {
        let side = |bit: u32| if number >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let own = cuboid.half_widths() * DVec3::new(side(0), side(1), side(2));
        cuboid.center() + cuboid.orientation().to_world(own)
    };
    (0..8).map(corner).collect()
}

/// Two triangles of each face.
pub(super) fn triangles() -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(12);
    for axis in 0..3 {
        let [face, next, last] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|axis| 1_u32 << axis);
        // Seen against the axis, the two other axes are counter-clockwise.
        let upper = [face, face + next, face + next + last, face + last];
        let lower = [0, last, next + last, next];
        for [a, b, c, d] in [upper, lower] {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// The error bound of a corner.
pub(super) fn corner_error(cuboid: &Cuboid) -> f64 {
    let reach = cuboid.half_widths().element_sum();
    UNIT_ROUNDOFF * (cuboid.center().length() + 18.0 * reach)
}
