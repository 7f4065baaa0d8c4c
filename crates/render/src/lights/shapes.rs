//! Lights with a place: points, spheres and rectangles.
//!
//! - A point of the intensity `I` at the distance `d` gives the irradiance `I / d²`.
//! - A sphere of the radius `r` around a point at the distance `d` covers the cone with
//!   `sin θ = r / d`, the solid angle `Ω = 2 π (1 - cos θ)`. Directions are uniform in the cone.
//!   Near the axis `1 - cos θ` cancels, so that it is `sin² θ / (1 + cos θ)`.
//! - A rectangle of the area `A` is sampled uniformly by area: the density per solid angle is
//!   `d² / (A cos)` with the cosine at the light.

use std::f64::consts::{PI, TAU};

use cyltrace::math::Ray;
use cyltrace::scene::{Light, LightShape};
use glam::DVec3;

use super::LightSample;

/// A light with a place that gives light.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeLight {
    shape: LightShape,
    /// The radiance, or the intensity of a point.
    emission: DVec3,
}

impl ShapeLight {
    /// The light, or `None` if it gives none.
    pub fn new(light: &Light) -> Option<Self> {
        let emission = light.color * light.strength;
        (emission != DVec3::ZERO).then_some(Self {
            shape: light.shape,
            emission,
        })
    }

    /// The rank of the shape in the order of all lights with a place.
    pub fn rank(&self) -> u8 {
        match self.shape {
            LightShape::Point { .. } => 0,
            LightShape::Sphere { .. } => 1,
            LightShape::Rectangle { .. } => 2,
        }
    }

    /// The radiant power.
    pub fn power(&self) -> DVec3 {
        self.emission
            * match self.shape {
                LightShape::Point { .. } => 2.0 * TAU,
                LightShape::Sphere { radius, .. } => 4.0 * PI * PI * radius * radius,
                LightShape::Rectangle {
                    edges: [one, other],
                    ..
                } => PI * one.cross(other).length(),
            }
    }

    /// A sample of the light that reaches a point, or `None` if none does.
    pub fn sample(&self, point: DVec3, numbers: (f64, f64)) -> Option<LightSample> {
        match self.shape {
            LightShape::Point { position } => {
                let to_light = position - point;
                let distance = to_light.length();
                (distance > 0.0).then(|| LightSample {
                    direction: to_light / distance,
                    distance,
                    arriving: self.emission / (distance * distance),
                    density: None,
                })
            }
            LightShape::Sphere { center, radius } => {
                let cone = Cone::of(center - point, radius)?;
                let rise = numbers.0 * cone.rise;
                let sine = (rise * (2.0 - rise)).sqrt();
                let (sin_around, cos_around) = libm::sincos(numbers.1 * TAU);
                let (right, up) = cone.axis.any_orthonormal_pair();
                let direction = right * (sine * cos_around)
                    + up * (sine * sin_around)
                    + cone.axis * (1.0 - rise);
                let direction = direction.normalize();
                let distance = self.distance(&Ray::new(point, direction));
                self.seen(direction, distance.unwrap_or(cone.tangent), cone.density())
            }
            LightShape::Rectangle { corner, edges } => {
                let target = corner + edges[0] * numbers.0 + edges[1] * numbers.1;
                let to_light = target - point;
                let distance = to_light.length();
                let direction = to_light / distance;
                let density = self.density(point, direction, distance);
                self.seen(direction, distance, density)
            }
        }
    }

    fn seen(&self, direction: DVec3, distance: f64, density: f64) -> Option<LightSample> {
        let is_seen = density > 0.0 && density.is_finite();
        is_seen.then(|| LightSample {
            direction,
            distance,
            arriving: self.emission / density,
            density: Some(density),
        })
    }

    /// The distance in `t` to a ray's first intersection with the light's emitting side.
    pub fn distance(&self, ray: &Ray) -> Option<f64> {
        let t = match self.shape {
            LightShape::Point { .. } => return None,
            LightShape::Sphere { center, radius } => {
                let to_center = center - ray.origin;
                let square = ray.direction.length_squared();
                let nearest = to_center.dot(ray.direction) / square;
                let beside = to_center - ray.direction * nearest;
                let inside = radius * radius - beside.length_squared();
                if inside < 0.0 || to_center.length_squared() <= radius * radius {
                    return None;
                }
                nearest - (inside / square).sqrt()
            }
            LightShape::Rectangle { corner, edges } => {
                let normal = edges[0].cross(edges[1]);
                let facing = -normal.dot(ray.direction);
                if facing <= 0.0 {
                    return None;
                }
                let from_corner = ray.origin - corner;
                let t = normal.dot(from_corner) / facing;
                let place = from_corner + ray.direction * t;
                // Coordinates along the edges, by Cramer's rule in the plane.
                let square = normal.length_squared();
                let along = place.cross(edges[1]).dot(normal) / square;
                let across = edges[0].cross(place).dot(normal) / square;
                let inside = 0.0..=1.0;
                if !inside.contains(&along) || !inside.contains(&across) {
                    return None;
                }
                t
            }
        };
        (t > ray.t_min && t < ray.t_max).then_some(t)
    }

    /// The radiance of the emitting side.
    pub fn radiance(&self) -> DVec3 {
        self.emission
    }

    /// The density per solid angle of samples in a unit direction that reaches the light at a
    /// distance.
    pub fn density(&self, point: DVec3, direction: DVec3, distance: f64) -> f64 {
        match self.shape {
            LightShape::Point { .. } => 0.0,
            LightShape::Sphere { center, radius } => {
                Cone::of(center - point, radius).map_or(0.0, |cone| cone.density())
            }
            LightShape::Rectangle { edges, .. } => {
                // The normal's length is the area.
                let facing = -edges[0].cross(edges[1]).dot(direction);
                if facing > 0.0 {
                    distance * distance / facing
                } else {
                    0.0
                }
            }
        }
    }
}

/// The cone of directions to a sphere.
struct Cone {
    axis: DVec3,
    /// `1 - cos θ`.
    rise: f64,
    /// The distance to where the cone touches the sphere.
    tangent: f64,
}

impl Cone {
    /// The cone, or `None` from inside the sphere.
    fn of(to_center: DVec3, radius: f64) -> Option<Self> {
        let distance = to_center.length();
        if distance <= radius {
            return None;
        }
        let sine = radius / distance;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        Some(Self {
            axis: to_center / distance,
            rise: sine * sine / (1.0 + cosine),
            tangent: distance * cosine,
        })
    }

    fn density(&self) -> f64 {
        1.0 / (TAU * self.rise)
    }
}
