//! Lengths and directions as the camera sees them.

use glam::DVec3;

use super::{AimedCamera, Kind};
use crate::math::Bounds;

impl AimedCamera {
    /// The pixels of a length of 1 across the view: anywhere for an orthographic camera, and at
    /// the distance of the point that a perspective one looks at (the center of the scene's box
    /// in an automatic frame). `None` for a panorama, and where that distance is not positive.
    #[must_use]
    pub fn pixels_per_unit(&self) -> Option<f64> {
        let distance = match self.kind {
            Kind::Orthographic => 1.0,
            Kind::Perspective => self.coordinates(self.target).z,
            Kind::Panorama => return None,
        };
        (distance > 0.0).then(|| 0.5 * self.film.y / (self.half.y * distance))
    }

    /// A direction in camera coordinates: to the right, upward, forward. For a panorama these
    /// are the directions at the middle of the picture.
    #[must_use]
    pub fn seen_direction(&self, direction: DVec3) -> DVec3 {
        DVec3::new(
            direction.dot(self.right),
            direction.dot(self.up),
            direction.dot(self.forward),
        )
    }

    /// The distance of a point along the view; for a panorama, from the eye.
    #[must_use]
    pub fn depth(&self, point: DVec3) -> f64 {
        match self.kind {
            Kind::Panorama => point.distance(self.eye),
            Kind::Perspective | Kind::Orthographic => self.coordinates(point).z,
        }
    }

    /// The least and greatest [`AimedCamera::depth`] of a box, 0 where the box is behind the eye.
    #[must_use]
    pub fn depth_range(&self, bounds: &Bounds) -> [f64; 2] {
        let depths = match self.kind {
            Kind::Perspective | Kind::Orthographic => {
                let depths = self.corners(bounds).map(|corner| corner.z);
                let least = depths.iter().copied().fold(f64::INFINITY, f64::min);
                [least, depths.into_iter().fold(f64::NEG_INFINITY, f64::max)]
            }
            Kind::Panorama => {
                let from_center = (self.eye - super::center(bounds)).abs();
                let half = super::half_extent(bounds);
                let nearest = (from_center - half).max(DVec3::ZERO);
                [nearest.length(), (from_center + half).length()]
            }
        };
        depths.map(|depth| depth.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use crate::scene::description::{Camera, Film, Frame, Projection};

    const FILM: Film = Film {
        width: 320,
        height: 180,
    };

    fn camera(projection: Projection, random: &mut Random) -> (AimedCamera, DVec3) {
        let look_at = random.direction() * 3.0;
        let frame = Frame::LookAt {
            position: look_at + random.direction() * random.uniform(0.5, 9.0),
            look_at,
            up: random.direction(),
        };
        let description = Camera {
            projection,
            frame,
            lens: None,
        };
        (
            AimedCamera::new(&description, &Bounds::EMPTY, FILM),
            look_at,
        )
    }

    /// Two points that are a length apart, projected.
    #[test]
    fn unit_lengths_have_the_pixels_of_their_projection() {
        let mut random = Random::new(51, 0);
        for case in 0..200 {
            let projection = match case % 2 {
                0 => Projection::Perspective {
                    fov_degrees: random.uniform(5.0, 140.0),
                },
                _ => Projection::Orthographic {
                    height: Some(random.uniform(0.5, 20.0)),
                },
            };
            let (camera, look_at) = camera(projection, &mut random);
            let across = camera.right * 0.3 + camera.up * 0.4;
            let [one, other] = [look_at - across, look_at + across]
                .map(|point| camera.project(point).expect("in view"));
            let expected = one.distance(other);
            let pixels = camera.pixels_per_unit().expect("a scale");
            assert!((pixels - expected).abs() < 1e-11 * expected, "case {case}");
        }
        let (panorama, _) = camera(Projection::Panorama, &mut random);
        assert_eq!(panorama.pixels_per_unit(), None);
    }

    #[test]
    fn depths_of_points_of_a_box_are_in_its_range() {
        let mut random = Random::new(52, 0);
        let bounds = Bounds {
            lower: DVec3::new(-1.0, -2.0, 0.0),
            upper: DVec3::new(3.0, 1.0, 5.0),
        };
        for projection in [
            Projection::Perspective { fov_degrees: 40.0 },
            Projection::Orthographic { height: Some(1.0) },
            Projection::Panorama,
        ] {
            for _ in 0..20 {
                let (camera, _) = camera(projection, &mut random);
                let [least, greatest] = camera.depth_range(&bounds);
                let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
                for place in 0..9 * 9 * 9 {
                    let share = DVec3::new(
                        f64::from(place % 9),
                        f64::from(place / 9 % 9),
                        f64::from(place / 81),
                    ) / 8.0;
                    let depth = camera
                        .depth(bounds.lower + bounds.extent() * share)
                        .max(0.0);
                    assert!(depth > least - 1e-12 && depth < greatest + 1e-12);
                    (nearest, farthest) = (nearest.min(depth), farthest.max(depth));
                }
                // Half the diagonal of a cell of the grid, at most.
                assert!(nearest - least < 0.5 && greatest - farthest < 1e-12);
            }
        }
    }
}
