//! The hull of two balls, or one ball.
//!
//! *Displaced.* The points within δ of it are the hull of balls larger by δ. Shrunk, a ball of
//! less than δ vanishes, and the ball of radius δ between both takes its place.
//!
//! *Depth.* The solid is a union of balls of radius `r0 + v Δ` about `p0 + v a`, v
//! in \[0, 1\]. The depth in it is the greatest of the depths in all of them,
//!
//! ```text
//! max r0 + v Δ - |(y - v |a|, ρ)|                                           (1)
//! ```
//!
//! since the nearest point of the surface is on one of them, and the segment to it passes or
//! begins beside its center. It is concave in v, and greatest at
//! `v |a| = y + ρ Δ / √(|a|² - Δ²)`, or at an end: at that of the greater ball if
//! it contains the other. An error of v only chooses another ball beside the nearest one.
//!
//! *Support.* With the ends `e` as seen from the anchor: `h(m) = max (m·e + r |m|)`.

use glam::DVec3;

use super::between::{Between, Parts};
use super::outline::Outline;
use super::taper::{Taper, UNIT, is_beyond_ends, is_surely_beyond_ends};
use super::{ConvexShape, Scaled, Shape};
use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::solid::Part;
use cyltrace_oracle::{ExactVector, exact};

/// Balls about one or two points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balls {
    pub ends: [(DVec3, f64); 2],
    /// The parts of the surface that are on either ball.
    pub parts: [Part; 2],
}

impl Balls {
    fn taper(&self) -> Taper {
        Taper {
            ends: self.ends,
            touches_balls: true,
        }
    }

    /// The length of the axis, and the sine of the wall's slope.
    fn slope(&self) -> (f64, f64) {
        let length = self.axis().length();
        (length, (self.ends[1].1 - self.ends[0].1) / length)
    }
}

impl ConvexShape for Balls {
    fn end_points(&self) -> [DVec3; 2] {
        self.ends.map(|(end, _)| end)
    }

    fn axis(&self) -> DVec3 {
        self.ends[1].0 - self.ends[0].0
    }

    fn at_origin(&self) -> Shape {
        let start = self.ends[0].0;
        let ends = self.ends.map(|(end, radius)| (end - start, radius));
        Shape::Balls(Self { ends, ..*self })
    }

    fn displaced(&self, outward: f64) -> Option<Shape> {
        let axis = self.axis();
        let growth = self.ends[1].1 - self.ends[0].1;
        let mut ends = self.ends.map(|(end, radius)| (end, radius + outward));
        let [(p0, radius0), (p1, radius1)] = &mut ends;
        if *radius0 < 0.0 && *radius1 > 0.0 {
            *p0 -= axis * (*radius0 / growth);
            *radius0 = 0.0;
        } else if *radius1 < 0.0 && *radius0 > 0.0 {
            *p1 -= axis * (*radius1 / growth);
            *radius1 = 0.0;
        }
        Some(Shape::Balls(Self { ends, ..*self }))
    }

    fn half_width(&self) -> f64 {
        let greater = self.ends[0].1.max(self.ends[1].1);
        if self.ends[0].0 == self.ends[1].0 {
            greater
        } else {
            0.5 * greater
        }
    }

    fn surely_contains(&self, y: DVec3, error: f64) -> bool {
        let [(start, radius0), (end, radius1)] = self.ends;
        let in_ball = |from: DVec3, radius: f64| {
            from.length() * (1.0 + 8.0 * UNIT) + error <= radius * (1.0 - 8.0 * UNIT)
        };
        in_ball(y, radius0)
            || in_ball(y - (end - start), radius1)
            || self.taper().surely_contains(y, error)
    }

    fn is_surely_beyond(&self, y: DVec3, error: f64, m: DVec3) -> bool {
        is_surely_beyond_ends(&self.ends, (y, error), m, m.length())
    }

    fn contains(&self, point: &Scaled) -> bool {
        let Scaled { x, scale } = point;
        let [(start, radius0), (end, radius1)] = self.ends;
        let in_ball = |from: &ExactVector, radius: f64| {
            let reach = exact(radius) * scale;
            from.dot(from) <= &reach * &reach
        };
        let between = &ExactVector::new(end) - &ExactVector::new(start);
        in_ball(x, radius0)
            || in_ball(&(x - &between.times(scale)), radius1)
            || self.taper().contains(point)
    }

    fn is_beyond(&self, x: &Scaled, m: DVec3) -> bool {
        let m = ExactVector::new(m);
        is_beyond_ends(&self.ends, x, &m, (&m.dot(&m), &exact(1.0)))
    }

    /// See (1).
    fn depth(&self, point: DVec3) -> f64 {
        let [(p0, radius0), (p1, radius1)] = self.ends;
        let from_p0 = point - p0;
        let (length, delta) = ((p1 - p0).length(), radius1 - radius0);
        if !(delta.abs() < length) {
            let from_p1 = point - p1;
            return (radius0 - from_p0.length()).max(radius1 - from_p1.length());
        }
        let axis = (p1 - p0) / length;
        let height = from_p0.dot(axis);
        let away = (from_p0 - axis * height).length();
        let slope = delta / ((length - delta) * (length + delta)).sqrt();
        let along = (height + away * slope).clamp(0.0, length);
        radius0 + delta * (along / length) - libm::hypot(height - along, away)
    }

    fn add_parts(&self, between: &Between, parts: &mut Parts) {
        let [radius0, radius1] = self.ends.map(|(_, radius)| radius);
        let axis = self.axis();
        let (length, sine) = self.slope();
        let first = between.sphere(self.parts[0], DVec3::ZERO, radius0);
        let second = between.sphere(self.parts[1], axis, radius1);
        if !(sine.abs() < 1.0) {
            // One ball contains the other.
            parts.extend(first.filter(|_| radius0 >= radius1));
            parts.extend(second.filter(|_| radius1 >= radius0));
            return;
        }
        let unit = axis / length;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let slope = sine / cosine;
        let ends = between.off(unit);
        let heights = ends.each_ref().map(|end| end.height + slope * end.distance);
        let way = (between.high - between.low).length();
        let steep = 1.0 + slope.abs();
        let slack = (between.slack() + way + 8.0 * UNIT_ROUNDOFF * (length + way)) * steep;
        let lowest = heights[0].min(heights[1]) - slack;
        let highest = heights[0].max(heights[1]) + slack;
        parts.extend(first.filter(|_| lowest <= 0.0));
        parts.extend(second.filter(|_| highest >= length));
        let slack = between.slack() * steep + 8.0 * UNIT_ROUNDOFF * (radius0 + length);
        let mut beyond = ends
            .iter()
            .map(|end| end.distance * cosine - sine * end.height >= radius0 - slack);
        if lowest <= length && highest >= 0.0 && beyond.any(|is_beyond| is_beyond) {
            parts.push((Part::Side, between.wall(&ends, unit, slope)));
        }
    }

    fn outline(&self) -> Outline {
        let between = self.axis();
        let axis = between.try_normalize().unwrap_or(DVec3::Z);
        let [(p0, radius0), (_, radius1)] = self.ends;
        let bottom = (-radius0).min(between.length() - radius1);
        let top = radius0.max(between.length() + radius1);
        Outline::about(p0 + axis * bottom, axis, top - bottom, [radius0, radius1])
    }

    /// Of the spheres and the wall that touches them, the farthest out.
    fn wall(&self, outline: &Outline, height: f64, outward: DVec3) -> (f64, DVec3) {
        let [radius0, radius1] = self.ends.map(|(_, radius)| radius);
        let (length, sine) = self.slope();
        let height = height + (-radius0).min(length - radius1);
        let seams = [-radius0 * sine, length - radius1 * sine];
        if sine.abs() < 1.0 && (seams[0]..=seams[1]).contains(&height) {
            let cosine = (1.0 - sine * sine).sqrt();
            let radius = (radius0 + sine * height) / cosine;
            return (radius, outward * cosine - outline.axis * sine);
        }
        let spheres = [(height, radius0), (height - length, radius1)].map(|(height, radius)| {
            let across = ((radius - height) * (radius + height)).max(0.0).sqrt();
            (across, (outward * across + outline.axis * height) / radius)
        });
        spheres[usize::from(spheres[1].0 > spheres[0].0)]
    }
}
