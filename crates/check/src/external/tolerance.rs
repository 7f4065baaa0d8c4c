//! By how much an external answer may be off.
//!
//! The allowance is a sum of a mesh's deviation (`deviation`), a share of the distances that
//! arithmetic sees (of the ray's origin, and of the hit from it), and a share of the distance
//! of the solid's farthest corner from the world's origin. All of it is about this ray and this
//! solid: a far solid elsewhere in the scene, or a far vertex elsewhere in a mesh, changes
//! nothing.
//!
//! The *way* is the distance to the hit, of two hits to the nearer one: if a reported hit lies
//! before the exact one, nothing beyond matters, and if it lies behind, the exact hit is on the
//! surface that it passed. A reported hit without an exact one may be anywhere: its way counts
//! up to the end of the scene, `|o| + 2 R` with `R` the scene's greatest coordinate.

use super::deviation::{Deviation, Slack};
use cyltrace::math::{Bounds, Ray};
use cyltrace::solid::AnySolid;

/// The unit roundoff of f32.
const UNIT_ROUNDOFF_32: f64 = 1.0 / (1 << 24) as f64;

/// The displacements of a ray and a surface in an f32 renderer, in
/// units of 2^-24 of the distances: the origin 1, the direction 1, end points
/// and radius 2, a placement's matrix 4, the ray taken through it 4, and the
/// solver's last sum and product 4.
const F32_ROUNDINGS: f64 = 16.0;

/// The relative tolerance that suits a renderer in f32: 16 · 2^-24.
pub const F32_TOLERANCE: f64 = F32_ROUNDINGS * UNIT_ROUNDOFF_32;

/// By how much answers may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// By how much a mesh may be off.
    pub deviation: Deviation,
    /// A share of the distances of a ray's origin from the world's and of the hit from it.
    pub of_way: f64,
    /// A share of a solid's greatest distance from the world's origin.
    pub of_extent: f64,
}

/// By how much the answer for a ray may be off.
pub(super) struct Allowance {
    fixed: f64,
    of_extent: f64,
}

/// By how much an answer about a solid may be off: the sum of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin {
    /// A length in the world.
    pub length: f64,
    /// Lengths in the solid's own space.
    pub slack: Slack,
}

impl Tolerance {
    /// For a ray and the way that counts.
    pub fn along(&self, ray: &Ray, way: f64) -> Allowance {
        Allowance {
            fixed: self.deviation.everywhere() + self.of_way * (ray.origin.length() + way),
            of_extent: self.of_extent,
        }
    }
}

impl Allowance {
    /// As a length, for solids within `extent` of the world's origin, without the part that
    /// depends on the solid itself.
    pub fn of(&self, extent: f64) -> f64 {
        self.fixed + self.of_extent * extent
    }
}

/// The way of a ray; `None` if both answers are a miss.
pub(super) fn way(
    ray: &Ray,
    reported: Option<f64>,
    exact: Option<f64>,
    greatest: f64,
) -> Option<f64> {
    let length = |t: f64| t.abs() * ray.direction.length();
    match (reported.map(length), exact.map(length)) {
        (None, None) => None,
        (Some(reported), Some(exact)) => Some(reported.min(exact)),
        (None, Some(exact)) => Some(exact),
        (Some(reported), None) => Some(reported.min(ray.origin.length() + 2.0 * greatest)),
    }
}

/// The distance of a box's farthest corner from the origin; 0 of an empty box.
pub(super) fn farthest(bounds: &Bounds) -> f64 {
    match bounds.is_empty() {
        true => 0.0,
        false => bounds.lower.abs().max(bounds.upper.abs()).length(),
    }
}

/// The least radius of some solids; infinite without solids.
pub(super) fn least_radius(solids: impl IntoIterator<Item = AnySolid>) -> f64 {
    let radii = solids.into_iter().map(|solid| solid.radius());
    radii.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn way_is_to_the_nearer_hit_and_ends_beyond_the_scene() {
        let ray = Ray::new(DVec3::new(0.0, 0.0, -3.0), DVec3::Z * 2.0);
        assert_eq!(way(&ray, None, None, 5.0), None);
        assert_eq!(way(&ray, None, Some(1.0), 5.0), Some(2.0));
        assert_eq!(way(&ray, Some(1e9), Some(1.0), 5.0), Some(2.0));
        assert_eq!(way(&ray, Some(0.5), Some(1e9), 5.0), Some(1.0));
        assert_eq!(way(&ray, Some(0.5), None, 5.0), Some(1.0));
        assert_eq!(way(&ray, Some(1e30), None, 5.0), Some(13.0));
    }
}
