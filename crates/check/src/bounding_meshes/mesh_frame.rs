//! The f32 space of a window's meshes, in which rays are exact.
//!
//! A point of the mesh is `(world - center) · 2^k`, with `k` such that half the
//! diagonal of the window is in [1, 2). Embree gets an f32 ray there, the
//! intersector an f64 ray in the world, and the two must be exactly the same ray. A direction of f32 numbers divided by `2^k` is exact in f64, and `t`
//! means the same in both. The origin is exact if `center + origin / 2^k` is:
//!
//! Let `P` be the power of two next above `F = max |center| + 2^11 / 2^k`, with
//! the requested center, and let `s = 2^-52 P`. The center is rounded to
//! multiples of `s`, which moves it by `s/2` at most; the coordinates of
//! origins in the mesh are below 2^10 and multiples of `s · 2^k`. So the sum is
//! a multiple of `s`, in size at most `F + s/2 <= 2^53 s`: at most 2^53 steps,
//! which f64 represents. An origin is first rounded to f32, then to the multiples;
//! where those are finer than the f32 number's last bit, it is one already, and
//! where they are coarser, a multiple has no more bits than it had.
//!
//! Numbers below 2^-60 are rounded to 0 (the multiples are at least 2^-60), so
//! that no subnormal number, which Embree treats as 0, makes the rays differ.

use glam::DVec3;

use cyltrace::embree::Ray32;
use cyltrace::math::{Ray, power_of_two, power_of_two_below};
use cyltrace_oracle::{ExactVector, exact};

use super::window::Window;

/// The greatest coordinate of an origin in the mesh: some 250 to 500
/// diagonals of the window.
const FARTHEST_ORIGIN: f64 = (1 << 10) as f64;

/// Smaller numbers in rays are 0.
const LEAST: f64 = power_of_two(-60);

/// The space of a window's meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshFrame {
    center: DVec3,
    /// `2^k`.
    scale: f64,
    /// Origins in the mesh are multiples of it.
    grid: f64,
}

impl MeshFrame {
    /// The frame of a window that is not empty.
    pub fn new(window: &Window) -> Self {
        let extent = window.extent();
        let center = extent.center();
        let scale = 1.0 / power_of_two_below(extent.extent().length() / 2.0);
        let farthest = center.abs().max_element() + 2.0 * FARTHEST_ORIGIN / scale;
        let step = 2.0 * power_of_two_below(farthest) * power_of_two(-52);
        Self {
            center: (center / step).round() * step,
            scale,
            grid: (step * scale).max(LEAST),
        }
    }

    /// The point of the world that is the mesh's origin, exactly.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Units of the mesh in one of the world, a power of two.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The mesh's point for a point of the world, rounded.
    pub fn mesh_from_world(&self, point: DVec3) -> DVec3 {
        (point - self.center) * self.scale
    }

    /// The world's point for a point of the mesh.
    pub fn exact_world_from_mesh(&self, point: DVec3) -> ExactVector {
        let from_center = ExactVector::new(point).times(&exact(1.0 / self.scale));
        &ExactVector::new(self.center) + &from_center
    }

    /// A ray near the requested one, for Embree and for an intersector.
    ///
    /// The origin moves to the grid, and to within [`FARTHEST_ORIGIN`] if it is
    /// farther away; the direction is rounded to f32 and scaled by a power of
    /// two; the range is given in lengths of the requested direction, which is
    /// finite and not zero, and is rounded and scaled likewise.
    pub fn ray(&self, origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> (Ray32, Ray) {
        let place = self.mesh_from_world(origin);
        let place = place.clamp(
            DVec3::splat(-FARTHEST_ORIGIN),
            DVec3::splat(FARTHEST_ORIGIN),
        );
        let place = place.map(|x| (f64::from(x as f32) / self.grid).round() * self.grid);

        let size = power_of_two_below(direction.abs().max_element());
        let way = (direction / size).map(|x| f64::from(x as f32));
        let way = way.map(|x| if x.abs() < LEAST { 0.0 } else { x });

        // A step of 1 in the mesh's ray is one of 1 / (size · scale).
        let steps = size * self.scale;
        let at_least_zero = |t: f64| if t < LEAST { 0.0 } else { t as f32 };
        let ray = Ray32 {
            origin: place.to_array().map(|x| x as f32),
            direction: way.to_array().map(|x| x as f32),
            t_near: at_least_zero(t_min * steps).min(f32::MAX),
            t_far: at_least_zero(t_max * steps),
        };
        let in_world = Ray {
            origin: self.center + place / self.scale,
            direction: way / self.scale,
            t_min: f64::from(ray.t_near),
            t_max: f64::from(ray.t_far),
        };
        (ray, in_world)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::{Bounds, Random};

    /// Windows of all sizes, at all distances up to where f64 ends.
    #[test]
    fn rays_in_mesh_and_world_are_one() {
        let mut random = Random::new(51, 0);
        for case in 0..5_000 {
            let size = random.log_uniform(1e-20, 1e20);
            let away = random.direction() * (size * random.log_uniform(1e-3, 1e17));
            let bounds = Bounds::at(away).grown(size).rounded_outward();
            let frame = MeshFrame::new(&Window {
                bounds: Some(bounds),
                ..Window::default()
            });
            let wished = away + random.direction() * (size * random.log_uniform(1e-6, 6.0));
            let direction = random.direction() * random.log_uniform(1e-9, 1e9);
            let length = size / direction.length();
            let t_min = random.uniform(-0.1, 0.1) * length;
            let (ray32, ray) = frame.ray(wished, direction, t_min, 3.0 * length);
            assert!(ray.is_valid(), "case {case}: {ray:?}");
            assert_eq!(f64::from(ray32.t_near), ray.t_min, "case {case}");
            assert_eq!(f64::from(ray32.t_far), ray.t_max, "case {case}");
            let origin = DVec3::from_array(ray32.origin.map(f64::from));
            let origin = frame.exact_world_from_mesh(origin);
            assert_eq!(origin.0, ExactVector::new(ray.origin).0, "case {case}");
            let way = DVec3::from_array(ray32.direction.map(f64::from));
            let in_mesh = ExactVector::new(ray.direction).times(&exact(frame.scale()));
            assert_eq!(ExactVector::new(way).0, in_mesh.0, "case {case}");

            // It is the requested ray, except for the rounding of f32 and of f64 so far
            // away from the origin.
            let step = size * 2e-6 + away.length() * 8e-16;
            let moved = (ray.origin - wished).length();
            assert!(moved <= step, "case {case}: moved by {moved}");
            let reached = ray.at(ray.t_max) - (wished + direction * (3.0 * length));
            let off = reached.length();
            assert!(off <= 2.0 * step, "case {case}: the end moved by {off}");
        }
    }
}
