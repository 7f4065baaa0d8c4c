//! The aimed camera, which maps positions on the film to rays.
//!
//! Film positions are in pixels, `x` to the right and `y` downward, with
//! `(0, 0)` at the picture's upper left corner. Rays start at the eye
//! (perspective, panorama) or on the plane through it (orthographic), at `t = 0`. `lens` moves
//! them to a point of the lens. `measures` has lengths and depths, and `turning` goes round the
//! scene.

mod framing;
mod lens;
mod measures;
mod panorama;
mod turning;

use glam::{DVec2, DVec3};

use super::description::{Camera, Film, Frame, Projection};
use super::view_volume::ViewVolume;
use crate::math::{Bounds, Ray};
use lens::AimedLens;

/// The direction from the scene to the eye of an automatic frame: a three-quarter
/// view, 28 degrees above the horizon. A sun at the default azimuth of 135 degrees
/// then shines from the left and from behind the viewer.
const AUTO_EYE: DVec3 = DVec3::new(-0.8, -0.4, 0.48);

/// A camera with a fixed position, direction and angle of view.
#[derive(Clone, Debug)]
pub struct AimedCamera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half of the picture, across and up: lengths at distance 1 in a
    /// perspective, scene units otherwise.
    half: DVec2,
    kind: Kind,
    film: DVec2,
    lens: Option<AimedLens>,
    /// What the camera looks at: the stated point, or the center of the scene's box.
    target: DVec3,
    /// The unit vector of the frame's upward direction.
    axis: DVec3,
}

/// The kind of a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Perspective,
    Orthographic,
    Panorama,
}

impl AimedCamera {
    /// The camera of `description` for a picture of the size `film`. `bounds`
    /// contain the scene; automatic frames use them.
    #[must_use]
    pub fn new(description: &Camera, bounds: &Bounds, film: Film) -> Self {
        let size = DVec2::new(f64::from(film.width), f64::from(film.height));
        let shape = DVec2::new(size.x / size.y, 1.0);
        let (towards_eye, up, eye, target) = match description.frame {
            Frame::Auto => (AUTO_EYE, DVec3::Z, center(bounds), center(bounds)),
            Frame::LookAt {
                position,
                look_at,
                up,
            } => (position - look_at, up, position, look_at),
        };
        let forward = -unit(towards_eye);
        let right = unit(forward.cross(unit(up)));
        let mut camera = Self {
            eye,
            right,
            up: right.cross(forward),
            forward,
            half: shape,
            kind: Kind::of(description.projection),
            film: size,
            lens: None,
            target,
            axis: unit(up),
        };
        let corners = camera.corners(bounds);
        let auto = description.frame == Frame::Auto;
        match description.projection {
            Projection::Perspective { fov_degrees } => {
                camera.half = shape * libm::tan((0.5 * fov_degrees).to_radians());
                if auto {
                    camera.step_back(&corners);
                }
            }
            Projection::Orthographic { height } => {
                if auto {
                    camera.slide_before(&corners);
                }
                let half_height = height
                    .map_or_else(|| camera.fitting_half_height(bounds), |height| 0.5 * height);
                camera.half = shape * half_height;
            }
            Projection::Panorama => camera.level(unit(up)),
        }
        camera.lens = description.lens.and_then(|lens| camera.aimed_lens(lens));
        camera
    }

    /// As [`AimedCamera::new`], if the description alone determines the picture;
    /// `None` if the camera depends on the bounds of the scene.
    #[must_use]
    pub fn stated(description: &Camera, film: Film) -> Option<Self> {
        let is_stated = match (description.frame, description.projection) {
            (Frame::Auto, _) => false,
            (Frame::LookAt { .. }, Projection::Orthographic { height }) => height.is_some(),
            (Frame::LookAt { .. }, Projection::Perspective { .. } | Projection::Panorama) => true,
        };
        is_stated.then(|| Self::new(description, &Bounds::at(DVec3::ZERO), film))
    }

    /// The volume that the camera's rays cover; `None` if that is everything.
    #[must_use]
    pub fn view_volume(&self) -> Option<ViewVolume> {
        let (radius, slope) = self.lens.map_or((0.0, 0.0), |lens| lens.reach());
        let side = |across: DVec3, half: f64| match self.kind {
            Kind::Perspective => (self.forward * (half + slope) - across, radius),
            _ => (self.forward * slope - across, half + radius),
        };
        let (right, up) = (self.right, self.up);
        (self.kind != Kind::Panorama).then(|| {
            ViewVolume::new(
                self.eye,
                [
                    side(right, self.half.x),
                    side(-right, self.half.x),
                    side(up, self.half.y),
                    side(-up, self.half.y),
                ],
            )
        })
    }

    /// The ray through a film position, and through the middle of the lens if there is one.
    #[must_use]
    pub fn ray(&self, position: DVec2) -> Ray {
        if self.kind == Kind::Panorama {
            return Ray::new(self.eye, self.panorama_direction(position));
        }
        let across = self.half.x * (2.0 * position.x / self.film.x - 1.0);
        let upward = self.half.y * (1.0 - 2.0 * position.y / self.film.y);
        let offset = self.right * across + self.up * upward;
        match self.kind {
            Kind::Perspective => Ray::new(self.eye, self.forward + offset),
            _ => Ray::new(self.eye + offset, self.forward),
        }
    }

    /// The film position of a point; `None` behind the eye of a perspective. The
    /// position may lie outside the picture. With a lens, it is the middle of the point's disk.
    #[must_use]
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let seen = self.coordinates(point);
        let scale = match self.kind {
            Kind::Perspective => seen.z,
            Kind::Orthographic => 1.0,
            Kind::Panorama => return Some(self.panorama_position(seen)),
        };
        let x = seen.x / (self.half.x * scale);
        let y = seen.y / (self.half.y * scale);
        (self.kind == Kind::Orthographic || seen.z > 0.0)
            .then(|| DVec2::new(1.0 + x, 1.0 - y) * 0.5 * self.film)
    }

    /// A point in camera coordinates: to the right, upward, forward.
    fn coordinates(&self, point: DVec3) -> DVec3 {
        self.seen_direction(point - self.eye)
    }

    /// The corners of the scene's box in camera coordinates.
    fn corners(&self, bounds: &Bounds) -> [DVec3; 8] {
        let middle = center(bounds);
        let half = half_extent(bounds);
        std::array::from_fn(|corner| {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            self.coordinates(middle + half * DVec3::new(side(0), side(1), side(2)))
        })
    }
}

impl Kind {
    fn of(projection: Projection) -> Self {
        match projection {
            Projection::Perspective { .. } => Self::Perspective,
            Projection::Orthographic { .. } => Self::Orthographic,
            Projection::Panorama => Self::Panorama,
        }
    }
}

/// The center of the box; the origin for an empty box.
fn center(bounds: &Bounds) -> DVec3 {
    if bounds.is_empty() {
        DVec3::ZERO
    } else {
        bounds.center()
    }
}

/// Half of the box's edges; an empty box is shown like a unit cube.
fn half_extent(bounds: &Bounds) -> DVec3 {
    if bounds.is_empty() {
        DVec3::splat(0.5)
    } else {
        bounds.extent() * 0.5
    }
}

/// `v` at unit length; scaled first, so that no square overflows.
fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    fn film(width: u32, height: u32) -> Film {
        Film { width, height }
    }

    fn auto(projection: Projection) -> Camera {
        Camera {
            projection,
            frame: Frame::Auto,
            lens: None,
        }
    }

    #[test]
    fn ray_through_projected_point_passes_through_the_point() {
        let bounds = Bounds {
            lower: DVec3::new(-1.0, -2.0, 0.0),
            upper: DVec3::new(3.0, 1.0, 5.0),
        };
        let mut random = Random::new(8, 0);
        for projection in [
            Projection::Perspective { fov_degrees: 40.0 },
            Projection::Orthographic { height: None },
            Projection::Orthographic { height: Some(9.0) },
            Projection::Panorama,
        ] {
            let camera = AimedCamera::new(&auto(projection), &bounds, film(640, 360));
            for case in 0..200 {
                let point = bounds.lower
                    + bounds.extent() * DVec3::new(random.unit(), random.unit(), random.unit());
                let ray = camera.ray(camera.project(point).expect("before the eye"));
                let to_point = point - ray.origin;
                let t = to_point.dot(ray.direction) / ray.direction.length_squared();
                let miss = ray.at(t).distance(point);
                assert!(
                    t > 0.0 && miss < 1e-12,
                    "case {case}: t {t:?}, off by {miss:e}"
                );
            }
        }
    }

    #[test]
    fn look_at_orthographic_height_spans_the_picture() {
        let description = Camera {
            projection: Projection::Orthographic { height: Some(4.0) },
            frame: Frame::LookAt {
                position: DVec3::new(0.0, -10.0, 0.0),
                look_at: DVec3::ZERO,
                up: DVec3::Z,
            },
            lens: None,
        };
        let camera = AimedCamera::new(&description, &Bounds::EMPTY, film(200, 100));
        assert_eq!(camera.ray(DVec2::ZERO).origin, DVec3::new(-4.0, -10.0, 2.0));
        assert_eq!(
            camera.ray(DVec2::new(200.0, 100.0)).origin,
            DVec3::new(4.0, -10.0, -2.0)
        );
        assert_eq!(camera.ray(DVec2::ZERO).direction, DVec3::Y);
    }

    #[test]
    fn look_at_perspective_upper_pixel_looks_up() {
        let description = Camera {
            projection: Projection::Perspective { fov_degrees: 90.0 },
            frame: Frame::LookAt {
                position: DVec3::ZERO,
                look_at: DVec3::X,
                up: DVec3::Z,
            },
            lens: None,
        };
        let camera = AimedCamera::new(&description, &Bounds::EMPTY, film(100, 100));
        let direction = camera.ray(DVec2::new(50.0, 0.0)).direction;
        assert!((direction - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-15);
        let left = camera.ray(DVec2::new(0.0, 50.0)).direction;
        assert!((left - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
    }
}
