//! The thin lens: rays from points of a disk that meet in a plane.
//!
//! A lens of radius `R` is centered at the origin `o` of the pinhole's ray `o + t d`, across the
//! view, where `d` has the component 1 along the view. So the ray crosses the sharp plane, at the
//! distance `f`, at `t = f`. A thin lens refracts all light from a point of that plane to one point
//! of the film. The ray through the point `l` of the lens is then
//!
//! ```text
//! (o + l) + t (d - l/f),        at t = f: o + f d
//! ```
//!
//! At the depth `z` the rays of a film position fill a disk of the radius `R |1 - z/f|`. In an
//! ideal lens of focal length `F` this is the object's side of the circle of confusion: an image at
//! the distance `v = F f / (f - F)` behind the lens scales the disk by `v / z`, which is the usual
//! formula `2 R F |z - f| / (z (f - F))` for its diameter.
//!
//! Lens points are uniform on the disk: `|l| = R sqrt(u)` and the angle `2π v`.

use glam::{DVec2, DVec3};

use super::AimedCamera;
use crate::math::Ray;
use crate::scene::description::Lens;

/// A lens at a known distance from its sharp plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct AimedLens {
    radius: f64,
    focus: f64,
}

impl AimedLens {
    /// The most by which its rays start beside those of the middle, and the most by which they move
    /// away from those per unit of depth.
    pub fn reach(self) -> (f64, f64) {
        (self.radius, self.radius / self.focus)
    }
}

impl AimedCamera {
    /// The lens of a camera whose eye is in place. `None` if the default distance of the sharp plane
    /// is not positive, as in a scene whose box is a point.
    pub(super) fn aimed_lens(&self, lens: Lens) -> Option<AimedLens> {
        let focus = lens
            .focus
            .unwrap_or_else(|| self.coordinates(self.target).z);
        (focus > 0.0).then_some(AimedLens {
            radius: 0.5 * lens.aperture,
            focus,
        })
    }

    /// Whether rays start at different points of a lens.
    #[must_use]
    pub fn has_lens(&self) -> bool {
        self.lens.is_some()
    }

    /// The ray through a film position and the point of the lens that two numbers in [0, 1)
    /// choose, uniformly. The same as [`AimedCamera::ray`] without a lens.
    #[must_use]
    pub fn ray_through_lens(&self, position: DVec2, numbers: (f64, f64)) -> Ray {
        let middle = self.ray(position);
        let Some(lens) = self.lens else {
            return middle;
        };
        let point = self.lens_point(lens.radius, numbers);
        Ray::new(middle.origin + point, middle.direction - point / lens.focus)
    }

    /// A point of a lens, relative to its center.
    fn lens_point(&self, radius: f64, (first, second): (f64, f64)) -> DVec3 {
        let (sine, cosine) = libm::sincos(second * std::f64::consts::TAU);
        (self.right * cosine + self.up * sine) * (radius * first.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Bounds, Random};
    use crate::scene::description::{Camera, Film, Frame, Projection};

    const FILM: Film = Film {
        width: 300,
        height: 200,
    };

    fn camera(random: &mut Random, lens: Lens) -> AimedCamera {
        let projection = match random.below(2) {
            0 => Projection::Perspective {
                fov_degrees: random.uniform(1.0, 150.0),
            },
            _ => Projection::Orthographic {
                height: Some(random.uniform(1.0, 9.0)),
            },
        };
        let position = random.direction() * random.uniform(0.0, 20.0);
        let frame = Frame::LookAt {
            position,
            look_at: position + random.direction() * 5.0,
            up: random.direction(),
        };
        let description = Camera {
            projection,
            frame,
            lens: Some(lens),
        };
        AimedCamera::new(&description, &Bounds::EMPTY, FILM)
    }

    fn on_film(random: &mut Random) -> DVec2 {
        DVec2::new(random.uniform(0.0, 300.0), random.uniform(0.0, 200.0))
    }

    #[test]
    fn rays_of_a_film_position_meet_in_the_sharp_plane() {
        let mut random = Random::new(41, 0);
        for case in 0..300 {
            let aperture = random.log_uniform(1e-3, 10.0);
            let stated = random.log_uniform(0.1, 100.0);
            let focus = (case % 3 > 0).then_some(stated);
            let camera = camera(&mut random, Lens { aperture, focus });
            let distance = focus.unwrap_or(5.0);
            let position = on_film(&mut random);
            let pinhole = camera.ray(position);
            let meeting = pinhole.at(distance);
            assert!(((meeting - camera.eye).dot(camera.forward) - distance).abs() < 1e-11);
            let mut farthest = 0.0_f64;
            for _ in 0..50 {
                let numbers = (random.unit(), random.unit());
                let ray = camera.ray_through_lens(position, numbers);
                let miss = ray.at(distance).distance(meeting);
                assert!(miss < 1e-12 * (100.0 + distance), "case {case}: {miss:e}");
                let start = ray.origin - pinhole.origin;
                assert!(start.dot(camera.forward).abs() < 1e-12, "case {case}");
                farthest = farthest.max(start.length());
            }
            let share = farthest / (0.5 * aperture);
            assert!((0.9..=1.0 + 1e-12).contains(&share), "case {case}: {share}");
        }
    }

    /// A quarter of the numbers is within half of the radius, and every half plane has half.
    #[test]
    fn lens_points_are_uniform_on_the_disk() {
        let lens = Lens {
            aperture: 2.0,
            focus: Some(1.0),
        };
        let camera = camera(&mut Random::new(42, 0), lens);
        let side = 64;
        let (mut inner, mut right, mut up) = (0, 0, 0);
        for cell in 0..side * side {
            let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
            let numbers = (middle(cell / side), middle(cell % side));
            let point = camera.lens_point(1.0, numbers);
            inner += u32::from(point.length() < 0.5);
            right += u32::from(point.dot(camera.right) > 0.0);
            up += u32::from(point.dot(camera.up) > 0.0);
        }
        let all = side * side;
        assert_eq!((inner, right, up), (all / 4, all / 2, all / 2));
    }

    /// The film positions from which rays can reach a point beside the sharp plane fill the disk of
    /// the thin-lens formula.
    #[test]
    fn points_beside_the_sharp_plane_fill_the_circle_of_confusion() {
        let (focus, aperture, fov_degrees) = (4.0, 0.5, 50.0_f64);
        let description = Camera {
            projection: Projection::Perspective { fov_degrees },
            frame: Frame::LookAt {
                position: DVec3::ZERO,
                look_at: DVec3::X,
                up: DVec3::Z,
            },
            lens: Some(Lens {
                aperture,
                focus: Some(focus),
            }),
        };
        let camera = AimedCamera::new(&description, &Bounds::EMPTY, FILM);
        for depth in [1.0, 3.0, 4.0, 5.0, 40.0] {
            let point = DVec3::new(depth, 0.0, 0.0);
            // The film at the distance v behind a lens of the focal length F.
            let focal_length = 0.05;
            let image = focal_length * focus / (focus - focal_length);
            let blur =
                aperture * focal_length * (depth - focus).abs() / (depth * (focus - focal_length));
            let pixels_per_length = 100.0 / (image * libm::tan((0.5 * fov_degrees).to_radians()));
            let expected = 0.5 * blur * pixels_per_length;
            // The ray through the rim of the lens that hits the point crosses the sharp plane where
            // the film position of the ray is.
            for number in 0..8 {
                let rim = camera.lens_point(0.5 * aperture, (1.0, f64::from(number) / 8.0));
                let seen = rim + (point - rim) * (focus / depth);
                let position = camera.project(seen).expect("before the eye");
                let radius = position.distance(DVec2::new(150.0, 100.0));
                assert!(
                    (radius - expected).abs() < 1e-10,
                    "{depth}: {radius}, {expected}"
                );
                let ray = camera.ray_through_lens(position, (1.0, f64::from(number) / 8.0));
                assert!(ray.at(depth).distance(point) < 1e-13);
            }
        }
    }

    #[test]
    fn camera_without_a_lens_is_a_pinhole() {
        let mut random = Random::new(43, 0);
        let lens = Lens {
            aperture: 1.0,
            focus: None,
        };
        let mut camera = camera(&mut random, lens);
        assert!(camera.has_lens());
        camera.lens = None;
        assert!(!camera.has_lens());
        let position = on_film(&mut random);
        assert_eq!(
            camera.ray(position),
            camera.ray_through_lens(position, (0.3, 0.7))
        );
    }
}
