//! The aimed camera, which maps positions on the film to rays.
//!
//! Film positions are in pixels, `x` to the right and `y` downward, with
//! `(0, 0)` at the picture's upper left corner. Rays start at the eye
//! (perspective) or on the plane through it (orthographic), at `t = 0`.

use glam::{DVec2, DVec3};

use crate::math::{Bounds, Ray};

use super::ViewVolume;
use super::description::{Camera, Film, Frame, Projection};

/// The share of the picture that an automatic frame leaves free on each side:
/// large enough to show that nothing is cut off, small enough to waste little.
const MARGIN: f64 = 0.04;

/// The direction from the scene to the eye of an automatic frame: a three-quarter
/// view, 28 degrees above the horizon. A sun at the default azimuth of 135 degrees
/// then shines from the left and from behind the viewer.
const AUTO_EYE: DVec3 = DVec3::new(-0.8, -0.4, 0.48);

/// The least distance from the eye of an automatic perspective to the nearest
/// corner of the scene's box, in diagonals of the box. Without it a wide angle
/// of view would put the eye at the corner, which then counts as inside the
/// picture. With it the near end of a long scene looks at most a few times
/// larger than the far end.
const CLEARANCE: f64 = 0.25;

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
    perspective: bool,
    film: DVec2,
}

impl AimedCamera {
    /// The camera of `description` for a picture of the size `film`. `bounds`
    /// contain the scene; automatic frames use them.
    #[must_use]
    pub fn new(description: &Camera, bounds: &Bounds, film: Film) -> Self {
        let size = DVec2::new(f64::from(film.width), f64::from(film.height));
        let shape = DVec2::new(size.x / size.y, 1.0);
        let (towards_eye, up, target) = match description.frame {
            Frame::Auto => (AUTO_EYE, DVec3::Z, center(bounds)),
            Frame::LookAt {
                position,
                look_at,
                up,
            } => (position - look_at, up, position),
        };
        let forward = -unit(towards_eye);
        let right = unit(forward.cross(unit(up)));
        let mut camera = Self {
            eye: target,
            right,
            up: right.cross(forward),
            forward,
            half: shape,
            perspective: matches!(description.projection, Projection::Perspective { .. }),
            film: size,
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
        }
        camera
    }

    /// As [`AimedCamera::new`], if the description alone determines the picture;
    /// `None` if the camera depends on the bounds of the scene.
    #[must_use]
    pub fn stated(description: &Camera, film: Film) -> Option<Self> {
        let is_stated = match (description.frame, description.projection) {
            (Frame::Auto, _) => false,
            (Frame::LookAt { .. }, Projection::Orthographic { height }) => height.is_some(),
            (Frame::LookAt { .. }, Projection::Perspective { .. }) => true,
        };
        is_stated.then(|| Self::new(description, &Bounds::at(DVec3::ZERO), film))
    }

    /// The volume that the camera's rays cover.
    #[must_use]
    pub fn view_volume(&self) -> ViewVolume {
        let side = |across: DVec3, half: f64| {
            if self.perspective {
                (self.forward * half - across, 0.0)
            } else {
                (-across, half)
            }
        };
        let (right, up) = (self.right, self.up);
        ViewVolume::new(
            self.eye,
            [
                side(right, self.half.x),
                side(-right, self.half.x),
                side(up, self.half.y),
                side(-up, self.half.y),
            ],
        )
    }

    /// The ray through a film position.
    #[must_use]
    pub fn ray(&self, position: DVec2) -> Ray {
        let across = self.half.x * (2.0 * position.x / self.film.x - 1.0);
        let upward = self.half.y * (1.0 - 2.0 * position.y / self.film.y);
        let offset = self.right * across + self.up * upward;
        if self.perspective {
            Ray::new(self.eye, self.forward + offset)
        } else {
            Ray::new(self.eye + offset, self.forward)
        }
    }

    /// The film position of a point; `None` behind the eye of a perspective. The
    /// position may lie outside the picture.
    #[must_use]
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let seen = self.coordinates(point);
        let scale = if self.perspective { seen.z } else { 1.0 };
        let x = seen.x / (self.half.x * scale);
        let y = seen.y / (self.half.y * scale);
        (!self.perspective || seen.z > 0.0).then(|| DVec2::new(1.0 + x, 1.0 - y) * 0.5 * self.film)
    }

    /// A point in camera coordinates: to the right, upward, forward.
    fn coordinates(&self, point: DVec3) -> DVec3 {
        let from_eye = point - self.eye;
        DVec3::new(
            from_eye.dot(self.right),
            from_eye.dot(self.up),
            from_eye.dot(self.forward),
        )
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

    /// Moves the eye of a perspective back to the nearest point from which all
    /// corners are in the picture, margin included, and sideways so that the
    /// free space is the same on opposite sides.
    ///
    /// With the slope `s` of the picture's edge, a corner (x, z) is left of
    /// the right edge when `x - shift <= s (z + distance)`, and likewise on
    /// the other side. So `distance >= max(x/s - z) - shift/s` and
    /// `distance >= max(-x/s - z) + shift/s`; some shift allows the mean of
    /// both maxima, and none allows less.
    fn step_back(&mut self, corners: &[DVec3; 8]) {
        let slope = self.half * (1.0 - 2.0 * MARGIN);
        let reach =
            |x: fn(&DVec3) -> f64, s: f64| greatest(corners.iter().map(move |c| x(c) / s - c.z));
        let across = 0.5 * (reach(|c| c.x, slope.x) + reach(|c| -c.x, slope.x));
        let upward = 0.5 * (reach(|c| c.y, slope.y) + reach(|c| -c.y, slope.y));
        let diagonal = corners[0].distance(corners[7]);
        let clear = greatest(corners.iter().map(|c| -c.z)) + CLEARANCE * diagonal;
        let distance = across.max(upward).max(clear);
        let depths = corners.map(|c| c.z + distance);
        let shift_right = balancing_shift(&corners.map(|c| c.x), &depths);
        let shift_up = balancing_shift(&corners.map(|c| c.y), &depths);
        self.eye += self.right * shift_right + self.up * shift_up - self.forward * distance;
    }

    /// Moves the film plane of an orthographic camera in front of all corners,
    /// and centers the corners in the picture.
    fn slide_before(&mut self, corners: &[DVec3; 8]) {
        let low = |axis: usize| -greatest(corners.iter().map(|c| -c[axis]));
        let high = |axis: usize| greatest(corners.iter().map(|c| c[axis]));
        let depth = high(2) - low(2);
        self.eye += self.right * (0.5 * (low(0) + high(0)))
            + self.up * (0.5 * (low(1) + high(1)))
            + self.forward * (low(2) - depth * MARGIN);
    }

    /// Half of the height that shows the scene's box from the position of the
    /// orthographic camera.
    fn fitting_half_height(&self, bounds: &Bounds) -> f64 {
        let aspect = self.film.x / self.film.y;
        let corners = self.corners(bounds);
        let reach = greatest(corners.iter().map(|c| c.y.abs().max(c.x.abs() / aspect)));
        reach / (1.0 - 2.0 * MARGIN)
    }
}

/// The shift for which the greatest and the least slope `(x - shift) / depth`
/// add up to zero. Their sum falls as the shift grows, so bisection finds it; 60
/// halvings exhaust the digits that the picture can show. No other shift makes
/// the larger of the two sizes smaller.
fn balancing_shift(x: &[f64; 8], depths: &[f64; 8]) -> f64 {
    let (mut low, mut high) = (-greatest(x.iter().map(|x| -x)), greatest(x.iter().copied()));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let slopes = || x.iter().zip(depths).map(|(x, depth)| (x - middle) / depth);
        if greatest(slopes()) > greatest(slopes().map(|slope| -slope)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
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

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
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
        }
    }

    fn corners_on_film(camera: &AimedCamera, bounds: &Bounds) -> Vec<DVec2> {
        (0..8)
            .map(|corner| {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 0 {
                        bounds.lower[axis]
                    } else {
                        bounds.upper[axis]
                    }
                };
                let point = DVec3::new(pick(0), pick(1), pick(2));
                camera.project(point).expect("corner is before the eye")
            })
            .collect()
    }

    #[test]
    fn auto_frame_random_boxes_all_corners_in_the_picture_and_tight() {
        let mut random = Random::new(7, 0);
        let mut tight = 0;
        for case in 0..2000 {
            let extent = DVec3::from_array(std::array::from_fn(|_| random.log_uniform(1e-3, 1e3)));
            let lower = random.direction() * random.log_uniform(1e-3, 1e6);
            let bounds = Bounds {
                lower,
                upper: lower + extent,
            };
            let size = film(1 + random.below(2000) as u32, 1 + random.below(2000) as u32);
            let projection = if case % 2 == 0 {
                Projection::Perspective {
                    fov_degrees: random.uniform(1.0, 150.0),
                }
            } else {
                Projection::Orthographic { height: None }
            };
            let camera = AimedCamera::new(&auto(projection), &bounds, size);
            let mut touched = 0.0_f64;
            let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for on_film in corners_on_film(&camera, &bounds) {
                let relative = on_film / DVec2::new(f64::from(size.width), f64::from(size.height));
                let edge = (relative - 0.5).abs().max_element();
                // Boxes far from the origin may use half of the margin: their
                // corners are rounded to few digits of their extent.
                assert!(
                    edge < 0.5 - 0.5 * MARGIN,
                    "seed 7 case {case}: {on_film:?} outside {size:?}, {bounds:?}, {projection:?}"
                );
                touched = touched.max(edge);
                least = least.min(relative);
                most = most.max(relative);
            }
            assert!(
                (least + most - 1.0).abs().max_element() < 1e-3,
                "seed 7 case {case}: {least:?} to {most:?} is off the middle, {bounds:?}"
            );
            let nearest = -greatest(camera.corners(&bounds).iter().map(|c| -c.z));
            let held_back =
                camera.perspective && nearest < (CLEARANCE + 1e-3) * bounds.extent().length();
            tight += usize::from(!held_back);
            assert!(
                held_back || touched > 0.5 - 1.5 * MARGIN,
                "seed 7 case {case}: only {touched} of 0.5 used, {bounds:?}, {projection:?}"
            );
        }
        assert!(tight > 1200, "most frames are tight, here {tight} of 2000");
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
        };
        let camera = AimedCamera::new(&description, &Bounds::EMPTY, film(100, 100));
        let direction = camera.ray(DVec2::new(50.0, 0.0)).direction;
        assert!((direction - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-15);
        let left = camera.ray(DVec2::new(0.0, 50.0)).direction;
        assert!((left - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
    }
}
