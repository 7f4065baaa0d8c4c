//! From f64 to Embree's f32: a prototype's own frame, and rays in it.
//!
//! Each prototype's Embree scene uses the frame `(p - center) · 2^k` in which its bounding
//! sphere has a radius R in [1, 2). The f32 ray that searches for candidates starts where the
//! f64 ray enters that sphere (or at the start of its range, if that is inside). So every
//! number that Embree receives is below 4 in size, for any origin and any length of the
//! direction. `docs/derivations.md`, section 4, proves that Embree's slab test then never
//! misses boxes grown by [`BOX_GROWTH`] R.
//!
//! A ray that starts farther than [`FAR`] away is moved in double-double to its point nearest
//! to the center, and then stored relative to the center: solvers and placements compute near
//! the solids, and the distance costs only the precision that f64 lacks for `t`.

mod packet;
mod rays;

use glam::DVec3;

pub(crate) use packet::{
    Enter, IntoChild, IntoInstance, PacketEntry, PacketLevel, PacketRays, ROWS, Rows,
};
pub(crate) use rays::{Level, LocalRay, Window};

use crate::embree::{Box32, Ray32};
use crate::math::{Bounds, DoubleDouble, UNIT_ROUNDOFF, f32_above, f32_below, power_of_two_below};

/// The growth of boxes on every side, in radii of the bounding sphere, if the prototype is in
/// no instance of Embree's. The proof needs 18 · 2^-24 of it for single rays and 22 · 2^-24 for
/// packets; the next power of two is 2^-19.
pub(crate) const BOX_GROWTH: f64 = 1.0 / (1 << 19) as f64;

/// Rays that start more than this number of units of the frame from the center (one to two
/// units make a radius) are moved nearer before anything is solved. Below it, an error of a few
/// 2^-53 of the distance is under 2^-34 R, far inside the growth of the boxes. Above it, the
/// double-double step, which takes about as long as one solve, runs once per prototype.
pub(crate) const FAR: f64 = (1 << 16) as f64;

/// The frame of a prototype's Embree scene.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    center: DVec3,
    /// `2^k`.
    scale: f64,
    /// R, the radius of the bounding sphere in the frame, rounded up.
    radius: f64,
    /// The growth of boxes on every side, in the frame.
    growth: f64,
    /// The prototype's box in the frame, grown.
    lower: DVec3,
    upper: DVec3,
}

impl Frame {
    /// The frame of a box that is not empty and not a point.
    pub fn new(bounds: &Bounds) -> Self {
        let center = bounds.center();
        let corner = (bounds.upper - center).max(center - bounds.lower);
        let radius = corner.length() * (1.0 + 8.0 * UNIT_ROUNDOFF);
        let scale = 1.0 / power_of_two_below(radius);
        let radius = radius * scale;
        let growth = radius * BOX_GROWTH;
        Self {
            center,
            scale,
            radius,
            growth,
            lower: (bounds.lower - center) * scale - growth,
            upper: (bounds.upper - center) * scale + growth,
        }
    }

    /// Grows boxes by at least this share of the radius.
    pub fn grow_to(&mut self, share: f64) {
        let further = (self.radius * share - self.growth).max(0.0);
        self.growth += further;
        self.lower -= further;
        self.upper += further;
    }

    /// The middle of the prototype's box.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The number of units of the frame in a unit of the prototype's space.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A point of the prototype's space in the frame.
    pub fn place(&self, point: DVec3) -> DVec3 {
        (point - self.center) * self.scale
    }

    /// The radius of the bounding sphere in the frame, in [1, 2].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The growth of boxes on every side, in the frame.
    pub fn slack(&self) -> f64 {
        self.growth
    }

    /// The f32 box for a box of the prototype's space, grown and rounded outward.
    pub fn grown_box(&self, bounds: &Bounds) -> Box32 {
        let grow = self.slack();
        let lower = (bounds.lower - self.center) * self.scale - grow;
        let upper = (bounds.upper - self.center) * self.scale + grow;
        Box32 {
            lower: lower.to_array().map(f32_below),
            upper: upper.to_array().map(f32_above),
        }
    }

    /// Whether a ray starts so far away that it has to be moved nearer.
    #[inline(always)]
    fn is_far(&self, ray: &LocalRay) -> bool {
        is_far(ray.origin_from(self.center) * self.scale)
    }

    /// The ray for the solvers of this prototype, moved nearer if it is far. A ray that arrives
    /// at a prototype has not been moved in it: its base is zero.
    #[inline]
    pub fn approach(&self, ray: &LocalRay) -> LocalRay {
        if self.is_far(ray) {
            self.approached(ray).0
        } else {
            *ray
        }
    }

    /// The ray for the solvers, and its point nearest to the center.
    fn approached(&self, ray: &LocalRay) -> (LocalRay, Passing) {
        debug_assert_eq!(ray.base, DVec3::ZERO, "the ray was moved before");
        let passing = self.passing(ray);
        if passing.is_far {
            self.approach_from_afar(ray, passing.nearest)
        } else {
            (*ray, passing)
        }
    }

    /// How a ray passes the center.
    #[inline(always)]
    fn passing(&self, ray: &LocalRay) -> Passing {
        let origin = ray.origin_from(self.center) * self.scale;
        let direction = ray.direction * self.scale;
        let inverse_square = 1.0 / direction.length_squared();
        let nearest = -origin.dot(direction) * inverse_square;
        Passing {
            inverse_square,
            nearest,
            place: origin + direction * nearest,
            is_far: is_far(origin),
        }
    }

    /// Whether a ray that starts far away certainly misses the sphere, which avoids the
    /// double-double step. The place is off by less than 2^-48 of the distance: two products
    /// and sums in each of three components, and as much for the ray's parameter. Written so
    /// that NaN is not certain.
    #[cold]
    fn is_missed_from_afar(&self, passing: &Passing) -> bool {
        const ROUNDING: f64 = 1.0 / (1_u64 << 48) as f64;
        let sphere = self.radius * (1.0 + 4.0 * BOX_GROWTH);
        let place = passing.place.length_squared();
        let squared_distance = passing.nearest * passing.nearest / passing.inverse_square + place;
        // (a + b)² <= 2 (a² + b²)
        place > 2.0 * (sphere * sphere + ROUNDING * ROUNDING * squared_distance)
    }

    /// As [`Frame::approach`], in double-double. The first guess of the nearest point is off by
    /// a few ulps of the distance, which a second step corrects.
    #[cold]
    fn approach_from_afar(&self, ray: &LocalRay, guess: f64) -> (LocalRay, Passing) {
        let direction = ray.direction * self.scale;
        let component = |i: usize| {
            let from_center = DoubleDouble::sum(ray.origin[i], -self.center[i]);
            let scaled = DoubleDouble {
                high: from_center.high * self.scale,
                low: from_center.low * self.scale,
            };
            scaled.plus(DoubleDouble::product(guess, direction[i])).high
        };
        let place = DVec3::new(component(0), component(1), component(2));
        let rest = -place.dot(direction) / direction.length_squared();
        let nearest = place + direction * rest;
        let moved = LocalRay {
            origin: nearest / self.scale,
            direction: ray.direction,
            base: self.center,
            shift: ray.shift + (guess + rest),
        };
        let passing = Passing {
            inverse_square: 1.0 / direction.length_squared(),
            nearest: 0.0,
            place: nearest,
            is_far: true,
        };
        (moved, passing)
    }

    /// Enters the prototype: returns the ray for its solvers and the f32 ray for its Embree
    /// scene, or `None` if nothing in `[t_min, t_max]` can be hit.
    pub fn enter(&self, ray: &LocalRay, t_min: f64, t_max: f64) -> Option<(Level, Ray32)> {
        if let Some(entry) = self.entry_from_inside(ray, t_min, t_max) {
            return entry.of(ray);
        }
        let passing = self.passing(ray);
        if passing.is_far {
            return self.enter_from_afar(ray, &passing, t_min, t_max);
        }
        self.entry(ray, &passing, t_min, t_max).of(ray)
    }

    /// As [`Frame::enter`], for a ray that has to be moved nearer.
    #[cold]
    fn enter_from_afar(
        &self,
        ray: &LocalRay,
        passing: &Passing,
        t_min: f64,
        t_max: f64,
    ) -> Option<(Level, Ray32)> {
        if self.is_missed_from_afar(passing) {
            return None;
        }
        let (ray, passing) = self.approach_from_afar(ray, passing.nearest);
        self.entry(&ray, &passing, t_min, t_max).of(&ray)
    }

    /// The entry of a ray that starts within the sphere, as most rays from surfaces do. It
    /// needs no root, and the end of the sphere does not matter. `None` if the ray starts
    /// elsewhere or is far away.
    #[inline(always)]
    fn entry_from_inside(&self, ray: &LocalRay, t_min: f64, t_max: f64) -> Option<Entry> {
        let origin = ray.origin_from(self.center) * self.scale;
        let direction = ray.direction * self.scale;
        let mut window = Window {
            shift: ray.shift,
            nearest: 0.0,
            start: 0.0,
            rate: power_of_two_below(direction.abs().max_element()),
        };
        window.start = window.past_nearest(t_min, -1.0);
        let start = origin + direction * window.start;
        // Written so that NaN counts as elsewhere.
        let is_inside = start.length_squared() <= self.radius * self.radius && !is_far(origin);
        let end = window.past_nearest(t_max, 1.0);
        is_inside.then(|| self.entry_at(start, direction, window, end))
    }

    /// The entry of a ray, if it enters. There is no branch in it, so that rows of lanes are
    /// computed together.
    #[inline(always)]
    fn entry(&self, ray: &LocalRay, passing: &Passing, t_min: f64, t_max: f64) -> Entry {
        let direction = ray.direction * self.scale;
        // The sphere, inflated beyond the grown boxes. NaN is a miss.
        let sphere = self.radius * (1.0 + 4.0 * BOX_GROWTH);
        let outside = passing.place.length_squared();
        let half_chord = ((sphere * sphere - outside) * passing.inverse_square).sqrt();
        let rate = power_of_two_below(direction.abs().max_element());
        let mut window = Window {
            shift: ray.shift,
            nearest: passing.nearest,
            start: 0.0,
            rate,
        };
        window.start = window.past_nearest(t_min, -1.0).max(-half_chord);
        let end = window.past_nearest(t_max, 1.0).min(half_chord);

        let start = passing.place + direction * window.start;
        let mut entry = self.entry_at(start, direction, window, end);
        entry.is_inside &= outside <= sphere * sphere;
        entry
    }

    /// The entry of a ray whose window begins at `start`, in the frame.
    #[inline(always)]
    fn entry_at(&self, start: DVec3, direction: DVec3, window: Window, end: f64) -> Entry {
        // A power of two has an exact inverse.
        let direction = direction * (1.0 / window.rate);
        let intersects_box =
            self.intersects_box(start, direction, (end - window.start) * window.rate);
        Entry {
            window,
            ray32: Ray32 {
                origin: [start.x as f32, start.y as f32, start.z as f32],
                direction: direction.to_array().map(in_steps),
                t_near: 0.0,
                t_far: window.length_to(end),
            },
            is_inside: (window.start <= end) & intersects_box,
        }
    }

    /// Enters the prototype for any ray, for a query without Embree: the window is the whole
    /// line.
    pub fn enter_unseen(&self, ray: &LocalRay) -> Level {
        let (ray, passing) = self.approached(ray);
        let window = Window {
            shift: ray.shift,
            nearest: passing.nearest,
            start: f64::NEG_INFINITY,
            rate: 1.0,
        };
        Level { ray, window }
    }

    /// Whether the segment of the ray intersects the prototype's grown box, which Embree does
    /// not test if a scene has few primitives. The growth is far greater than the roundings
    /// here.
    #[inline(always)]
    fn intersects_box(&self, start: DVec3, direction: DVec3, length: f64) -> bool {
        let inverse = direction.recip();
        let at_lower = (self.lower - start) * inverse;
        let at_upper = (self.upper - start) * inverse;
        // 0 · inf = NaN means a ray in a face of the grown box, where nothing can be hit, so
        // either result is right.
        let enter = at_lower.min(at_upper);
        let leave = at_lower.max(at_upper);
        let enter = enter.x.max(enter.y).max(enter.z).max(0.0);
        let leave = leave.x.min(leave.y).min(leave.z).min(length);
        enter <= leave * (1.0 + 16.0 * UNIT_ROUNDOFF)
    }
}

/// Whether a ray that starts at `origin`, in the frame, has to be moved nearer. NaN is far.
#[inline(always)]
fn is_far(origin: DVec3) -> bool {
    !(origin.abs().max_element() <= FAR)
}

/// Adding this to a number below 2 in size, and subtracting it again, rounds the number to a
/// multiple of 2^-30.
const ROUNDER: f64 = 1.5 * (1 << 22) as f64;

/// A component of a direction for Embree, rounded to a multiple of 2^-30. Embree replaces
/// components of at most 1e-18 in size by +1e-18, whatever their sign. For coherent packets it
/// groups rays by the signs of their components, and then relies on the signs of the inverses:
/// so one ray with -1e-19 beside one with -1e-17 makes the packet miss boxes. Multiples of
/// 2^-30 are zero, which has one sign, or large enough. The rounding moves a ray by less than
/// 2^-29 over its length of at most 4 through the sphere, a 32nd of what rounding to f32 does.
#[inline(always)]
fn in_steps(component: f64) -> f32 {
    ((component + ROUNDER) - ROUNDER) as f32
}

/// The point of a ray nearest to the center of a prototype.
#[derive(Clone, Copy, Debug)]
struct Passing {
    /// One over the square of the direction's length in the frame.
    inverse_square: f64,
    /// The ray's parameter at that point, within some roundings: only the consistency with
    /// `place` matters.
    nearest: f64,
    /// The point, in the frame.
    place: DVec3,
    /// Whether the ray starts so far away that it has to be moved nearer.
    is_far: bool,
}

/// The entry of a ray into a prototype.
#[derive(Clone, Copy, Debug)]
struct Entry {
    window: Window,
    ray32: Ray32,
    /// Whether anything can be hit; if not, the rest has no meaning.
    is_inside: bool,
}

impl Entry {
    /// The entry of a ray in the prototype's own space, if it is inside.
    #[inline(always)]
    fn of(&self, ray: &LocalRay) -> Option<(Level, Ray32)> {
        let level = Level {
            ray: *ray,
            window: self.window,
        };
        self.is_inside.then_some((level, self.ray32))
    }
}
