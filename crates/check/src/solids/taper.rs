//! A wall whose radius changes evenly along an axis: that of a cone between its disks, or
//! that which touches two balls.
//!
//! With the axis `a` of length `L`, the radii `r0` and `r1` at its ends and the slope
//! `k = (r1 - r0) / L`, a point at height `y` and distance `ρ` from the axis is within the wall
//! of the disks if `ρ <= r0 + k y` for `0 <= y <= L`. The wall of the balls touches them: with
//! `c² = 1 - k²` it is `ρ c <= r0 + k y`, and starts at `y = -r0 k`, with the height `L c²`.

use glam::DVec3;

use super::Scaled;
use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace_oracle::{Exact, ExactVector, exact};

/// u, doubled for the roundings of the bounds.
pub(crate) const UNIT: f64 = 2.0 * UNIT_ROUNDOFF;

/// A wall about an axis that starts at the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taper {
    pub ends: [(DVec3, f64); 2],
    pub touches_balls: bool,
}

impl Taper {
    /// True only if a point, off by at most `error`, is within the wall and its heights.
    pub fn surely_contains(&self, y: DVec3, error: f64) -> bool {
        let [(start, radius0), (end, radius1)] = self.ends;
        let axis = end - start;
        let length = axis.length();
        let (height, off) = (y.dot(axis) / length, y.cross(axis).length() / length);
        let slope = (radius1 - radius0) / length;
        let cos_squared = if self.touches_balls {
            1.0 - slope * slope
        } else {
            1.0
        };
        // So that its root loses no more than a factor of 1000.
        if !(cos_squared >= 1e-6) {
            return false;
        }
        let cos = cos_squared.sqrt();
        let start = if self.touches_balls {
            -radius0 * slope
        } else {
            0.0
        };
        let end = start + length * cos_squared;
        let size = radius0 + radius1 + length + y.length();
        let error = 2.0 * (1.0 + slope.abs()) * error + 1e3 * 8.0 * UNIT * size;
        start + error <= height
            && height + error <= end
            && off * cos + error <= radius0 + slope * height
    }

    /// Whether a point is within the wall and its heights.
    pub fn contains(&self, point: &Scaled) -> bool {
        let Scaled { x, scale } = point;
        let radii = self.ends.map(|(_, radius)| exact(radius));
        let axis = &between(&self.ends);
        let (squared, growth) = (axis.dot(axis), &radii[1] - &radii[0]);
        let along = x.dot(axis);
        let zero = exact(0.0);
        let (narrowed, start) = if self.touches_balls {
            (&squared - &growth * &growth, &radii[0] * &growth)
        } else {
            (squared.clone(), zero.clone())
        };
        if narrowed <= zero {
            return false;
        }
        let height = &along + start * scale;
        if height < zero || height > &narrowed * scale {
            return false;
        }
        let across = x.cross(axis);
        let width = &radii[0] * &squared * scale + growth * along;
        width >= zero && across.dot(&across) * narrowed <= &width * &width
    }
}

/// The exact vector between two ends.
fn between([(start, _), (end, _)]: &[(DVec3, f64); 2]) -> ExactVector {
    &ExactVector::new(*end) - &ExactVector::new(*start)
}

/// True only if `m·y` exceeds `m·e + r w` for both ends `e` of radius `r`, seen from the first
/// one. `width` is `w`.
pub(super) fn is_surely_beyond_ends(
    ends: &[(DVec3, f64); 2],
    (y, error): (DVec3, f64),
    m: DVec3,
    width: f64,
) -> bool {
    ends.iter().all(|&(end, radius)| {
        let from_start = end - ends[0].0;
        let size = y.length() + from_start.length() + radius;
        let error = 2.0 * error + 8.0 * UNIT * size;
        m.dot(y - from_start) - radius * width > error * m.length()
    })
}

/// Whether `m·x` exceeds `m·e + r w` for both ends. `width_squared` is `w² q`, with the square
/// `q` of any length.
pub(super) fn is_beyond_ends(
    ends: &[(DVec3, f64); 2],
    Scaled { x, scale }: &Scaled,
    m: &ExactVector,
    (width_squared, q): (&Exact, &Exact),
) -> bool {
    let offsets = [ExactVector::new(DVec3::ZERO), between(ends)];
    ends.iter().zip(offsets).all(|((_, radius), offset)| {
        let gap = m.dot(&(x - &offset.times(scale)));
        let reach = exact(*radius) * scale;
        gap > exact(0.0) && &gap * &gap * q > &reach * &reach * width_squared
    })
}
