//! A camera that goes round the point that it looks at.
//!
//! With the unit vector `a` along the camera's upward direction, a vector `v` is turned by the
//! angle `φ` to `v cos φ + (a × v) sin φ + a (a · v)(1 - cos φ)` (Rodrigues' formula).

use glam::DVec3;

use super::AimedCamera;
use crate::math::sin_cos_degrees;

impl AimedCamera {
    /// The camera turned about the axis through the point that it looks at, or through the
    /// center of the scene's box in an automatic frame, along the upward direction of its
    /// frame: counterclockwise as seen from above. By 0 degrees it is unchanged to the last bit.
    #[must_use]
    pub fn turned(&self, degrees: f64) -> Self {
        if degrees == 0.0 {
            return self.clone();
        }
        let (sine, cosine) = sin_cos_degrees(degrees);
        let axis = self.axis;
        let turn =
            |v: DVec3| v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
        Self {
            eye: self.target + turn(self.eye - self.target),
            right: turn(self.right),
            up: turn(self.up),
            forward: turn(self.forward),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::math::{Bounds, Random};
    use crate::scene::description::{Camera, Film, Frame, Projection};

    const FILM: Film = Film {
        width: 320,
        height: 180,
    };

    fn aimed(frame: Frame, bounds: &Bounds) -> AimedCamera {
        let projection = Projection::Perspective { fov_degrees: 40.0 };
        let description = Camera {
            projection,
            frame,
            lens: None,
        };
        AimedCamera::new(&description, bounds, FILM)
    }

    /// A turned camera is the one that is stated at the turned position.
    #[test]
    fn turned_camera_is_the_one_at_the_turned_position() {
        let look_at = DVec3::new(1.0, 2.0, 3.0);
        let at = |position| {
            let up = DVec3::Z * 7.0;
            let frame = Frame::LookAt {
                position,
                look_at,
                up,
            };
            aimed(frame, &Bounds::EMPTY)
        };
        let start = at(look_at + DVec3::new(4.0, 0.0, 1.0));
        for (degrees, offset) in [
            (90.0, DVec3::new(0.0, 4.0, 1.0)),
            (180.0, DVec3::new(-4.0, 0.0, 1.0)),
            (-90.0, DVec3::new(0.0, -4.0, 1.0)),
            (360.0, DVec3::new(4.0, 0.0, 1.0)),
        ] {
            let (turned, expected) = (start.turned(degrees), at(look_at + offset));
            let mut random = Random::new(61, 0);
            for _ in 0..20 {
                let position = DVec2::new(random.uniform(0.0, 320.0), random.uniform(0.0, 180.0));
                let (ray, other) = (turned.ray(position), expected.ray(position));
                assert!(ray.origin.distance(other.origin) < 1e-14, "{degrees}");
                assert!(ray.direction.distance(other.direction) < 1e-14, "{degrees}");
            }
        }
        assert_eq!(format!("{:?}", start.turned(0.0)), format!("{start:?}"));
    }

    /// The center of the box stays where it is in the picture.
    #[test]
    fn automatic_frames_turn_about_the_center_of_the_box() {
        let bounds = Bounds {
            lower: DVec3::new(-1.0, -2.0, 0.0),
            upper: DVec3::new(3.0, 1.0, 5.0),
        };
        let camera = aimed(Frame::Auto, &bounds);
        let middle = camera.project(bounds.center()).expect("in view");
        for degrees in [10.0, 123.0, -77.0] {
            let turned = camera.turned(degrees);
            let seen = turned.project(bounds.center()).expect("in view");
            assert!(seen.distance(middle) < 1e-11, "{degrees}");
            assert!((turned.eye.z - camera.eye.z).abs() < 1e-13);
        }
    }
}
