//! Panoramas: all directions around the eye, as on a map with evenly spaced longitudes and
//! latitudes.
//!
//! The poles are along `up`, whatever the direction of the view. At the share `x` of the picture's
//! width from the left and the share `y` of its height from the top, the longitude is
//! `λ = 2π (x - 1/2)`, from the view to the right, and the latitude `φ = π (1/2 - y)`:
//!
//! ```text
//! direction = cos φ (cos λ forward + sin λ right) + sin φ up
//! ```
//!
//! The left and right edge are the same meridian, behind the viewer; an edge at the top or bottom
//! is a pole.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::AimedCamera;

impl AimedCamera {
    /// Turns the camera so that `up`, a unit vector, is its upward direction.
    pub(super) fn level(&mut self, up: DVec3) {
        self.up = up;
        self.forward = up.cross(self.right);
    }

    /// The direction at a film position.
    pub(super) fn panorama_direction(&self, position: DVec2) -> DVec3 {
        let share = position / self.film;
        let (sin_longitude, cos_longitude) = libm::sincos(TAU * (share.x - 0.5));
        let (sin_latitude, cos_latitude) = libm::sincos(PI * (0.5 - share.y));
        let level = self.forward * cos_longitude + self.right * sin_longitude;
        level * cos_latitude + self.up * sin_latitude
    }

    /// The film position of a point in camera coordinates.
    pub(super) fn panorama_position(&self, seen: DVec3) -> DVec2 {
        let longitude = libm::atan2(seen.x, seen.z);
        let latitude = libm::atan2(seen.y, libm::hypot(seen.x, seen.z));
        DVec2::new(0.5 + longitude / TAU, 0.5 - latitude / PI) * self.film
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::{Camera, Film, Frame, Projection};

    /// From the origin, looking east and downward, north to the left.
    fn panorama() -> AimedCamera {
        let description = Camera {
            projection: Projection::Panorama,
            frame: Frame::LookAt {
                position: DVec3::ZERO,
                look_at: DVec3::new(1.0, 0.0, -0.7),
                up: DVec3::Z,
            },
            lens: None,
        };
        let film = Film {
            width: 400,
            height: 200,
        };
        AimedCamera::stated(&description, film).expect("stated")
    }

    #[test]
    fn panorama_has_the_horizon_in_the_middle_and_poles_at_the_edges() {
        let camera = panorama();
        for (x, y, expected) in [
            (200.0, 100.0, DVec3::X),
            (100.0, 100.0, DVec3::Y),
            (300.0, 100.0, DVec3::NEG_Y),
            (0.0, 100.0, DVec3::NEG_X),
            (400.0, 100.0, DVec3::NEG_X),
            (200.0, 50.0, DVec3::new(0.5, 0.0, 0.5).normalize()),
        ] {
            let ray = camera.ray(DVec2::new(x, y));
            assert_eq!(ray.origin, DVec3::ZERO);
            assert!((ray.direction - expected).length() < 1e-15, "{x} {y}");
        }
        for x in [0.0, 13.0, 200.0, 400.0] {
            let direction = |y| camera.ray(DVec2::new(x, y)).direction;
            assert!((direction(0.0) - DVec3::Z).length() < 1e-15, "{x}");
            assert!((direction(200.0) + DVec3::Z).length() < 1e-15, "{x}");
        }
    }

    #[test]
    fn panorama_is_continuous_across_its_seam() {
        let camera = panorama();
        for y in [0.0, 7.0, 100.0, 180.0] {
            let [left, right] = [0.0, 400.0].map(|x| camera.ray(DVec2::new(x, y)).direction);
            assert!((left - right).length() < 1e-15, "{y}");
        }
    }

    #[test]
    fn panorama_covers_everything() {
        assert!(panorama().view_volume().is_none());
    }
}
