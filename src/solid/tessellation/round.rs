//! Meshes of spheres, by rings and meridians, with a proven deviation.
//!
//! With N meridians and N/2 rings, for an even N, the corners are at multiples of `δ =
//! 2π/N` in longitude and from the poles. The corners of a cell, four on a plane or three at a
//! pole, are seen from the point `q` of the sphere in the middle of it, in latitude and
//! longitude, under an angle α with
//!
//! ```text
//! cos α = cos(δ/2) - cos β cos γ (1 - cos(δ/2)) >= 2 cos(π/N) - 1 = k      (1)
//! ```
//!
//! where β and γ are the latitudes of `q` and the corner, δ/2 apart, and the
//! longitudes are δ/2 apart too. So `p·q >= k r²` for the corners, hence for every
//! point p of the face between them, and `|p| >= k r`: the mesh with its corners on the
//! sphere is nowhere deeper in it than `(1 - k) r`. One that is larger by 1/k holds the
//! sphere and is nowhere farther out than `(1/k - 1) r`. k is positive from N = 6 on.
//!
//! **Roundings** (u = 2^-53; R is the radius of the corners). The angles have three
//! roundings, together 19 u at most, and turn a corner by that each; a product of two of
//! their sines and cosines is off by 5 u; R is within 12 u; the sum with the centre
//! rounds by u of it. [`sphere_corner_error`] has room for `64 u R + u |p|`, as the
//! cylinder's.

use glam::DVec3;

use super::{Fit, Mesh, inner_factor};
use crate::math::UNIT_ROUNDOFF;
use crate::solid::Sphere;

/// Fewest meridians.
const LEAST_MERIDIANS: u32 = 6;

/// `k`: the radius of the ball inside the mesh whose corners are on the sphere,
/// in radii.
#[must_use]
pub fn sphere_inner_factor(meridians: u32) -> f64 {
    2.0 * inner_factor(meridians) - 1.0
}

/// By how much a mesh may be off the sphere.
#[must_use]
pub fn sphere_deviation(sphere: &Sphere, meridians: u32, fit: Fit) -> f64 {
    let factor = sphere_inner_factor(meridians);
    sphere.radius()
        * match fit {
            Fit::Inscribed => 1.0 - factor,
            Fit::Circumscribed => 1.0 / factor - 1.0,
        }
}

/// By how much a corner of a mesh, as computed, may be off the one meant.
#[must_use]
pub fn sphere_corner_error(sphere: &Sphere, meridians: u32) -> f64 {
    let corner_radius = sphere.radius() / sphere_inner_factor(meridians);
    UNIT_ROUNDOFF * (80.0 * corner_radius + 2.0 * sphere.centre().length())
}

/// The mesh whose corners are on the sphere, or which holds it.
///
/// # Panics
/// When the number of meridians is odd or below 6.
#[must_use]
pub fn sphere_mesh(sphere: &Sphere, meridians: u32, fit: Fit) -> Mesh {
    assert!(
        meridians >= LEAST_MERIDIANS && meridians.is_multiple_of(2),
        "a sphere has an even number of at least {LEAST_MERIDIANS} meridians, not {meridians}"
    );
    let corner_radius = match fit {
        Fit::Inscribed => sphere.radius(),
        Fit::Circumscribed => sphere.radius() / sphere_inner_factor(meridians),
    };
    let angle =
        |step: u32| libm::sincos(std::f64::consts::TAU * f64::from(step) / f64::from(meridians));
    let mut mesh = Mesh::default();
    for pole in [DVec3::NEG_Z, DVec3::Z] {
        mesh.vertices.push(sphere.centre() + pole * corner_radius);
    }
    let rings = meridians / 2 - 1;
    for ring in 1..=rings {
        let (across, along) = angle(ring);
        for meridian in 0..meridians {
            let (sin, cos) = angle(meridian);
            let outward = DVec3::new(across * cos, across * sin, -along);
            mesh.vertices
                .push(sphere.centre() + outward * corner_radius);
        }
    }
    for meridian in 0..meridians {
        let next = (meridian + 1) % meridians;
        let on_ring = |ring: u32, meridian: u32| 2 + (ring - 1) * meridians + meridian;
        mesh.triangles
            .push([0, on_ring(1, next), on_ring(1, meridian)]);
        for ring in 1..rings {
            let (a, b) = (on_ring(ring, meridian), on_ring(ring, next));
            let (c, d) = (on_ring(ring + 1, next), on_ring(ring + 1, meridian));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.triangles
            .push([1, on_ring(rings, meridian), on_ring(rings, next)]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distance of a triangle's plane from the centre, which no point of it is
    /// nearer than.
    fn depth(a: DVec3, b: DVec3, c: DVec3) -> f64 {
        (b - a).cross(c - a).normalize().dot(a)
    }

    #[test]
    fn sphere_meshes_stay_within_their_deviation() {
        let sphere = Sphere::new(DVec3::new(3.0, -2.0, 1.0), 1.5).unwrap();
        for meridians in [6, 8, 30, 200] {
            let error = sphere_corner_error(&sphere, meridians);
            for fit in [Fit::Inscribed, Fit::Circumscribed] {
                let mesh = sphere_mesh(&sphere, meridians, fit);
                let deviation = sphere_deviation(&sphere, meridians, fit);
                let (inner, outer) = match fit {
                    Fit::Inscribed => (1.5 - deviation, 1.5),
                    Fit::Circumscribed => (1.5, 1.5 + deviation),
                };
                let mut deepest = f64::INFINITY;
                for corners in &mesh.triangles {
                    let [a, b, c] = corners.map(|i| mesh.vertices[i as usize] - sphere.centre());
                    deepest = deepest.min(depth(a, b, c));
                    assert!((a.length() - outer).abs() <= error);
                }
                // Outward all, no deeper than promised, and that not for nothing.
                assert!(
                    deepest >= inner - 2.0 * error,
                    "{meridians} {fit:?}: {deepest}"
                );
                assert!(
                    outer - deepest > 0.5 * deviation,
                    "{meridians} {fit:?}: {deepest}"
                );
            }
        }
    }

    #[test]
    fn sphere_mesh_is_closed() {
        let sphere = Sphere::new(DVec3::ZERO, 1.0).unwrap();
        let mesh = sphere_mesh(&sphere, 8, Fit::Inscribed);
        // Euler: corners - edges + triangles = 2, each edge once either way.
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for [a, b, c] in &mesh.triangles {
            edges.extend([(*a, *b), (*b, *c), (*c, *a)]);
        }
        let (corners, triangles) = (mesh.vertices.len(), mesh.triangles.len());
        assert_eq!(corners + triangles, edges.len() / 2 + 2);
        for (a, b) in &edges {
            assert_eq!(edges.iter().filter(|edge| **edge == (*b, *a)).count(), 1);
        }
    }
}
