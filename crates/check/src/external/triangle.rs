//! A ray against a triangle in f64, without gaps between neighbours.
//!
//! Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (2013): the corners are
//! moved by the origin and sheared along the ray's longest component, so that the ray is the
//! third axis. A corner's two numbers across the ray are rounded in the same way in every
//! triangle that has it. Of these rounded numbers an edge's area `a b - c d` is rounded
//! monotonically: it has the right sign, or is 0, and its sign is the opposite one in the
//! triangle on the other side. A triangle is hit where no two of its three areas have opposite
//! signs, so a ray to a common edge or corner hits at least one of the triangles there.
//!
//! A corner is displaced by the rounding of three operations on its distance from the
//! origin, some 2^-51 of it, whatever the size of the mesh.

use glam::DVec3;

use cyltrace::math::{Ray, power_of_two_below};

/// A ray in the form that tests of triangles use.
pub(super) struct ShearedRay {
    pub origin: DVec3,
    /// The direction over `size`, and its longest component.
    pub direction: DVec3,
    axis: usize,
    shear: DVec3,
    /// A power of two near the longest component of the ray's direction, which may be near
    /// either end of f64.
    size: f64,
    /// The range of `t`, times `size`.
    pub range: (f64, f64),
}

impl ShearedRay {
    /// `None` if the ray is not valid.
    pub fn new(ray: &Ray) -> Option<Self> {
        if !ray.is_valid() {
            return None;
        }
        let size = power_of_two_below(ray.direction.abs().max_element());
        let direction = ray.direction / size;
        let axis = direction.abs().max_position();
        let [x, y, z] = [axis + 1, axis + 2, axis].map(|i| direction[i % 3]);
        Some(Self {
            origin: ray.origin,
            direction,
            axis,
            shear: DVec3::new(x / z, y / z, 1.0 / z),
            size,
            range: (ray.t_min * size, ray.t_max * size),
        })
    }

    /// The ray's own `t`.
    pub fn t(&self, scaled: f64) -> f64 {
        scaled / self.size
    }

    /// The `t` at which the ray hits a triangle, in the scale of `range`, which may exclude it.
    pub fn hit(&self, corners: [DVec3; 3]) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| self.sheared(corner));
        let areas = [
            c.x * b.y - c.y * b.x,
            a.x * c.y - a.y * c.x,
            b.x * a.y - b.y * a.x,
        ];
        if areas.iter().any(|&area| area < 0.0) && areas.iter().any(|&area| area > 0.0) {
            return None;
        }
        let whole = areas[0] + areas[1] + areas[2];
        let t = (areas[0] * a.z + areas[1] * b.z + areas[2] * c.z) / whole;
        // A triangle that is seen edge-on has no area.
        (whole != 0.0 && t.is_finite()).then_some(t)
    }

    fn sheared(&self, corner: DVec3) -> DVec3 {
        let from_origin = corner - self.origin;
        let [x, y, z] = [self.axis + 1, self.axis + 2, self.axis].map(|i| from_origin[i % 3]);
        DVec3::new(x - self.shear.x * z, y - self.shear.y * z, self.shear.z * z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Random;

    /// Fans of triangles about a corner, and rays to their corners and edges.
    #[test]
    fn rays_to_common_corners_and_edges_hit_a_triangle() {
        let mut random = Random::new(17, 0);
        for case in 0..20_000 {
            let scale = random.log_uniform(1e-9, 1e9);
            let middle = random.direction() * scale * random.log_uniform(1e-3, 1e3);
            let rim: Vec<DVec3> = (0..6)
                .map(|side| {
                    let (sin, cos) = libm::sincos(f64::from(side));
                    let off = DVec3::new(cos, sin, random.uniform(-0.2, 0.2));
                    middle + off * scale * random.uniform(0.5, 2.0)
                })
                .collect();
            let share = if case % 3 == 0 { 0.0 } else { random.unit() };
            let side = random.below(6) as usize;
            let target = middle + (rim[side] - middle) * (0.9 * share);
            let origin = middle + DVec3::new(random.unit(), random.unit(), 4.0) * scale;
            // Within the sizes that a direction may have.
            let direction = (target - origin) * random.log_uniform(1e-130, 1e130);
            let ray = ShearedRay::new(&Ray::new(origin, direction)).expect("a ray");
            let hits = (0..6).filter_map(|side| ray.hit([middle, rim[side], rim[(side + 1) % 6]]));
            let nearest = hits.map(|t| (ray.origin + ray.direction * t - target).length());
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let extent = middle.length() + 10.0 * scale;
            assert!(nearest <= 1e-13 * extent, "case {case}: {nearest}");
        }
    }

    #[test]
    fn far_corner_does_not_move_what_is_near() {
        let corners = [DVec3::ZERO, DVec3::new(1e12, 1.0, 0.0), DVec3::Y];
        let ray = Ray::new(DVec3::new(0.25, 0.5, 3.0), DVec3::NEG_Z);
        let t = ShearedRay::new(&ray).expect("a ray").hit(corners);
        assert_eq!(t, Some(3.0));
        let beside = Ray::new(DVec3::new(0.25, -1e-9, 3.0), DVec3::NEG_Z);
        assert_eq!(ShearedRay::new(&beside).expect("a ray").hit(corners), None);
    }

    #[test]
    fn triangles_edge_on_and_without_area_are_missed() {
        let ray = ShearedRay::new(&Ray::new(DVec3::ZERO, DVec3::X)).expect("a ray");
        let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        assert_eq!(ray.hit([at(1.0, -1.0), at(2.0, 1.0), at(3.0, -1.0)]), None);
        assert_eq!(ray.hit([DVec3::X; 3]), None);
    }
}
