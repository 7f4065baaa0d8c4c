//! Where f64 meets Embree's f32: a prototype's own frame, and rays in it.
//!
//! Each prototype's Embree scene lives in the frame `(p - centre) · 2^k` in
//! which its bounding sphere has a radius R in [1, 2). The f32 ray that
//! searches for candidates starts where the f64 ray enters that sphere (or at
//! the start of its range, if that is inside), so that every number Embree
//! sees is below 4 in size, wherever the ray comes from and however long its
//! direction is. `docs/derivations.md`, section 4, proves that boxes grown by
//! [`BOX_GROWTH`] R are then never missed by Embree's slab test.
//!
//! A ray that starts farther than [`FAR`] away is moved in double-double to
//! its point nearest to the centre and then handed on relative to the centre:
//! the solvers and placements work near the solids, and the distance costs
//! only what f64 cannot hold of `t`.

use glam::DVec3;

use crate::embree::{Box32, Ray32};
use crate::math::{
    Bounds, DoubleDouble, Ray, UNIT_ROUNDOFF, f32_above, f32_below, power_of_two_below,
};

/// By how much boxes are grown on every side, in radii of the bounding sphere.
/// The proof needs 18 · 2^-24 of it; the next power of two is 2^-19.
pub(crate) const BOX_GROWTH: f64 = 1.0 / (1 << 19) as f64;

/// Rays that start more than this many units of the frame (one to two such
/// make a radius) from the centre are moved nearer before anything is solved.
/// Below it, an error of a few 2^-53 of the distance is under 2^-34 R, far
/// inside the growth of the boxes; above it the double-double step, about as
/// dear as one solve, is paid once a prototype.
pub(crate) const FAR: f64 = (1 << 16) as f64;

/// A ray in a prototype's own space.
///
/// Its points are `base + origin + (t - shift) * direction` for the `t` of the
/// ray that was asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay {
    pub origin: DVec3,
    pub direction: DVec3,
    /// Zero, or the centre of the prototype for a ray that was moved.
    pub base: DVec3,
    pub shift: f64,
}

impl LocalRay {
    pub fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            base: DVec3::ZERO,
            shift: 0.0,
        }
    }

    /// The ray's origin as seen from a point of the prototype's space.
    #[inline]
    pub fn origin_from(&self, point: DVec3) -> DVec3 {
        self.origin - (point - self.base)
    }
}

/// How the `t` of a query becomes the `t_far` of the f32 ray in the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// The query's `t` at the point nearest to the centre is `shift + nearest`.
    shift: f64,
    nearest: f64,
    /// Where the f32 ray starts, counted from the nearest point.
    start: f64,
    /// Units of the f32 ray's parameter in one unit of `t`.
    rate: f64,
}

impl Window {
    /// `t` counted from the nearest point, moved by `outward` times the
    /// rounding of the differences.
    fn past_nearest(&self, t: f64, outward: f64) -> f64 {
        let slack = 4.0 * UNIT_ROUNDOFF * (t.abs() + self.shift.abs() + self.nearest.abs());
        let difference = (t - self.shift) - self.nearest;
        if difference.is_finite() {
            difference + outward * slack
        } else {
            difference
        }
    }

    /// The end of the f32 ray for hits up to `t`; never too small.
    #[inline]
    pub fn t_far(&self, t: f64) -> f32 {
        self.length_to(self.past_nearest(t, 1.0))
    }

    /// The length of the f32 ray up to `end`, counted from the nearest point.
    /// The 2^-30 stands for the roundings, which are below 2^-48 in the frame.
    #[inline]
    fn length_to(&self, end: f64) -> f32 {
        f32_above((end - self.start) * self.rate + 1.0 / (1 << 30) as f64)
    }
}

/// A ray on its way through one prototype.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub ray: LocalRay,
    pub window: Window,
}

/// The frame of a prototype's Embree scene.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    centre: DVec3,
    /// `2^k`.
    scale: f64,
    /// R, the radius of the bounding sphere in the frame, rounded up.
    radius: f64,
    /// The prototype's box in the frame, grown.
    lower: DVec3,
    upper: DVec3,
}

impl Frame {
    /// The frame of a box that is not empty and not a point.
    pub fn new(bounds: &Bounds) -> Self {
        let centre = bounds.centre();
        let corner = (bounds.upper - centre).max(centre - bounds.lower);
        let radius = corner.length() * (1.0 + 8.0 * UNIT_ROUNDOFF);
        let scale = 1.0 / power_of_two_below(radius);
        let radius = radius * scale;
        let grow = radius * BOX_GROWTH;
        Self {
            centre,
            scale,
            radius,
            lower: (bounds.lower - centre) * scale - grow,
            upper: (bounds.upper - centre) * scale + grow,
        }
    }

    /// The middle of the prototype's box.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// The f32 box for a box of the prototype's space, grown and rounded
    /// outward.
    pub fn grown_box(&self, bounds: &Bounds) -> Box32 {
        let grow = self.radius * BOX_GROWTH;
        let lower = (bounds.lower - self.centre) * self.scale - grow;
        let upper = (bounds.upper - self.centre) * self.scale + grow;
        Box32 {
            lower: lower.to_array().map(f32_below),
            upper: upper.to_array().map(f32_above),
        }
    }

    /// The ray as the solvers of this prototype get it, and its point nearest
    /// to the centre, in the frame: the ray's parameter and the place.
    pub fn approach(&self, ray: &LocalRay) -> (LocalRay, f64, DVec3) {
        let origin = ray.origin_from(self.centre) * self.scale;
        let direction = ray.direction * self.scale;
        let squared = direction.length_squared();
        let nearest = -origin.dot(direction) / squared;
        if origin.abs().max_element() <= FAR {
            return (*ray, nearest, origin + direction * nearest);
        }
        self.approach_from_afar(ray, nearest)
    }

    /// As [`Frame::approach`], in double-double. The first guess of the nearest
    /// point is off by a few ulps of the distance, which a second step mends.
    #[cold]
    fn approach_from_afar(&self, ray: &LocalRay, guess: f64) -> (LocalRay, f64, DVec3) {
        let direction = ray.direction * self.scale;
        let component = |i: usize| {
            let from_centre = DoubleDouble::sum(ray.origin[i], -self.centre[i]);
            let scaled = DoubleDouble {
                high: from_centre.high * self.scale,
                low: from_centre.low * self.scale,
            };
            scaled.plus(DoubleDouble::product(guess, direction[i])).high
        };
        let place = DVec3::new(component(0), component(1), component(2));
        let rest = -place.dot(direction) / direction.length_squared();
        let nearest = place + direction * rest;
        let moved = LocalRay {
            origin: nearest / self.scale,
            direction: ray.direction,
            base: self.centre,
            shift: ray.shift + (guess + rest),
        };
        (moved, 0.0, nearest)
    }

    /// Enters the prototype: the ray for its solvers and the f32 ray for its
    /// Embree scene, or `None` where nothing in `[t_min, t_max]` can be hit.
    pub fn enter(&self, ray: &LocalRay, t_min: f64, t_max: f64) -> Option<(Level, Ray32)> {
        let (ray, nearest, place) = self.approach(ray);
        let direction = ray.direction * self.scale;

        // The sphere, inflated beyond the grown boxes. NaN is a miss.
        let sphere = self.radius * (1.0 + 4.0 * BOX_GROWTH);
        let outside = place.length_squared();
        if !(outside <= sphere * sphere) {
            return None;
        }
        let half_chord = ((sphere * sphere - outside) / direction.length_squared()).sqrt();
        let rate = power_of_two_below(direction.abs().max_element());
        let mut window = Window {
            shift: ray.shift,
            nearest,
            start: 0.0,
            rate,
        };
        window.start = window.past_nearest(t_min, -1.0).max(-half_chord);
        let end = window.past_nearest(t_max, 1.0).min(half_chord);
        if !(window.start <= end) {
            return None;
        }

        let start = place + direction * window.start;
        let direction = direction / rate;
        if !self.meets_box(start, direction, (end - window.start) * rate) {
            return None;
        }
        let ray32 = Ray32 {
            origin: start.as_vec3().to_array(),
            direction: direction.as_vec3().to_array(),
            t_near: 0.0,
            t_far: window.length_to(end),
        };
        Some((Level { ray, window }, ray32))
    }

    /// Enters the prototype wherever the ray passes, for a query that does not
    /// ask Embree: the window is the whole line.
    pub fn enter_unseen(&self, ray: &LocalRay) -> Level {
        let (ray, nearest, _) = self.approach(ray);
        let window = Window {
            shift: ray.shift,
            nearest,
            start: f64::NEG_INFINITY,
            rate: 1.0,
        };
        Level { ray, window }
    }

    /// Whether the stretch of the ray meets the prototype's grown box. The
    /// growth dwarfs the roundings here.
    fn meets_box(&self, start: DVec3, direction: DVec3, length: f64) -> bool {
        let inverse = direction.recip();
        let at_lower = (self.lower - start) * inverse;
        let at_upper = (self.upper - start) * inverse;
        // 0 · inf = NaN means a ray in a face of the grown box: nothing is
        // there to be hit, so either answer will do.
        let enter = at_lower.min(at_upper);
        let leave = at_lower.max(at_upper);
        let enter = enter.x.max(enter.y).max(enter.z).max(0.0);
        let leave = leave.x.min(leave.y).min(leave.z).min(length);
        enter <= leave * (1.0 + 16.0 * UNIT_ROUNDOFF)
    }
}
