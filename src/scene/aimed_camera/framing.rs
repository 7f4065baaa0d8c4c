//! Automatic frames: the camera is moved so that the box of the scene fills the picture.

use glam::DVec3;

use super::AimedCamera;
use crate::math::Bounds;

/// The share of the picture that an automatic frame leaves free on each side:
/// large enough to show that nothing is cut off, small enough to waste little.
const MARGIN: f64 = 0.04;

/// The least distance from the eye of an automatic perspective to the nearest
/// corner of the scene's box, in diagonals of the box. Without it a wide angle
/// of view would put the eye at the corner, which then counts as inside the
/// picture. With it the near end of a long scene looks at most a few times
/// larger than the far end.
const CLEARANCE: f64 = 0.25;

impl AimedCamera {
    /// Moves the eye of a perspective back to the nearest point from which all
    /// corners are in the picture, margin included, and sideways so that the
    /// free space is the same on opposite sides.
    ///
    /// With the slope `s` of the picture's edge, a corner (x, z) is left of
    /// the right edge when `x - shift <= s (z + distance)`, and likewise on
    /// the other side. So `distance >= max(x/s - z) - shift/s` and
    /// `distance >= max(-x/s - z) + shift/s`; some shift allows the mean of
    /// both maxima, and none allows less.
    pub(super) fn step_back(&mut self, corners: &[DVec3; 8]) {
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
    pub(super) fn slide_before(&mut self, corners: &[DVec3; 8]) {
        let low = |axis: usize| -greatest(corners.iter().map(|c| -c[axis]));
        let high = |axis: usize| greatest(corners.iter().map(|c| c[axis]));
        let depth = high(2) - low(2);
        self.eye += self.right * (0.5 * (low(0) + high(0)))
            + self.up * (0.5 * (low(1) + high(1)))
            + self.forward * (low(2) - depth * MARGIN);
    }

    /// Half of the height that shows the scene's box from the position of the
    /// orthographic camera.
    pub(super) fn fitting_half_height(&self, bounds: &Bounds) -> f64 {
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

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;
    use crate::scene::aimed_camera::Kind;
    use crate::scene::description::{Camera, Film, Frame, Projection};
    use glam::DVec2;

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
            let size = Film {
                width: 1 + random.below(2000) as u32,
                height: 1 + random.below(2000) as u32,
            };
            let projection = if case % 2 == 0 {
                Projection::Perspective {
                    fov_degrees: random.uniform(1.0, 150.0),
                }
            } else {
                Projection::Orthographic { height: None }
            };
            let description = Camera {
                projection,
                frame: Frame::Auto,
                lens: None,
            };
            let camera = AimedCamera::new(&description, &bounds, size);
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
            let held_back = camera.kind == Kind::Perspective
                && nearest < (CLEARANCE + 1e-3) * bounds.extent().length();
            tight += usize::from(!held_back);
            assert!(
                held_back || touched > 0.5 - 1.5 * MARGIN,
                "seed 7 case {case}: only {touched} of 0.5 used, {bounds:?}, {projection:?}"
            );
        }
        assert!(tight > 1200, "most frames are tight, here {tight} of 2000");
    }
}
