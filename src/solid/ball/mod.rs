//! The ball: ray against sphere.
//!
//! With the ray `o + t d` and `x = o - center`, a point of the line is at
//! distance `radius` from the center where
//!
//! ```text
//! |d|² t² + 2 (x·d) t + |x|² - radius² = 0                                 (1)
//! ```
//!
//! By Lagrange's identity `|x|² |d|² - (x·d)² = |x × d|²`, so that the quarter
//! discriminant is
//!
//! ```text
//! D = radius² |d|² - |x × d|²,   t = (-(x·d) ∓ √D) / |d|²                  (2)
//! ```
//!
//! `|x × d| / |d|` is the distance between line and center. It does not change when the origin
//! slides along the ray, so no square of the distance enters `D` and cancels later. Rounded
//! products leave an error of at most `3 u |x| |d|` in the length of `x × d`, u = 2^-53, and a
//! rounding of `x` adds `u |x| |d|`. The square of that length and that of the radius round by
//! a few u of themselves. Where the sign of `D` is then uncertain, or the sum `|x·d| + √D` is
//! off by too much, as for lines that graze the ball, `D` is computed from exact numbers. So
//! the sign of `D`, which alone distinguishes a hit from a miss, is always the exact one. (For
//! an origin `k` radii away the relative error of `D` is about `k u`, but `√D` is a k-th of
//! that sum.)
//!
//! A simpler test without roots comes first. The error of the rounded `D` is at most
//! `2^-50 (R + Q + √(Q S) + 2^-52 S)` with `R = radius² |d|²`, `Q = |x × d|²`, `S = |x|² |d|²`,
//! so it is below `2^-36 |D|` if
//!
//! ```text
//! R + Q <= 2^12 |D|,   2^-25 Q S <= D²,   2^-52 S <= 2^12 |D|              (3)
//! ```
//!
//! since `2^12 + 2^12.5 + 2^12` is less than 2^14. Such a `D` is *plain*. None is if `D²`
//! overflows.
//!
//! Where the two terms of a root cancel, the root is `C / q`: `C` is the constant term of (1),
//! and `q` the sum that does not cancel. Next to the sphere `C` is computed from exact numbers.

mod quick;

use glam::DVec3;

use super::chord::{Chord, ChordEnd};
use super::exact::{Expression, Number, cross, dot, quotient, sign, vector};
use super::offset::{Between, Offset};
use super::{Location, Part};
use crate::math::{UNIT_ROUNDOFF, power_of_two};

pub(super) use quick::{QuickBall, quick_first};

/// The relative error up to which a rounded `D` is used: the roots then have half of it, 2^-13
/// of an ulp of f32.
const GOOD: f64 = power_of_two(-36);

/// The greatest share of the noncancelling sum that the error of `√D` may be otherwise: the hit
/// point is then within 2^-44 of its distance from the origin.
const GOOD_FROM_AFAR: f64 = power_of_two(-44);

/// 2^12 of (3). It trades the number of roots for room in the bound, as does the next constant.
const MOST_OF_PLAIN: f64 = power_of_two(12);

/// 2^-25 of (3).
const MOST_OF_SQUARES: f64 = power_of_two(-25);

/// Below this, relative to `radius²`, `C` is computed from exact numbers; see the corresponding
/// limit of the triple-product solver.
const LEAST_CONSTANT_TERM: f64 = power_of_two(-20);

/// The interval of `t` in which the line `center + x + t d` is inside the closed ball, with
/// both ends on `part`; `None` if it misses. A ball of radius zero is its center. A non-finite
/// argument is a miss.
pub(super) fn chord(x: impl Offset, d: DVec3, radius: f64, part: Part) -> Option<Chord> {
    let from = FromBall { x, radius };
    let x = x.rounded();
    if !(x.is_finite() && d.is_finite()) {
        return None;
    }
    let dd = d.dot(d);
    let b = x.dot(d);
    let discriminant = from.discriminant(x, d, dd, b);
    if discriminant < 0.0 {
        return None;
    }
    let [enter, leave] = Roots::new(dd, b, discriminant).both(|| from.constant_term(x));
    let end = |t| ChordEnd {
        t,
        part,
        on_rim: false,
    };
    Some(Chord {
        enter: end(enter),
        leave: end(leave),
        lies_on: None,
    })
}

/// The roots of (1).
#[derive(Clone, Copy, Debug)]
struct Roots {
    /// `|d|²`.
    dd: f64,
    /// `x·d`.
    b: f64,
    /// `√D`.
    s: f64,
}

impl Roots {
    #[inline(always)]
    fn new(dd: f64, b: f64, discriminant: f64) -> Self {
        Self {
            dd,
            b,
            s: discriminant.sqrt(),
        }
    }

    /// The numerators of (2).
    #[inline(always)]
    fn sums(&self) -> [f64; 2] {
        [-self.b - self.s, self.s - self.b]
    }

    /// Whether the terms of a numerator cancel.
    #[inline(always)]
    fn cancels(&self, sum: f64) -> bool {
        sum.abs() < 0.5 * self.b.abs()
    }

    /// The root of a numerator; `constant_term` is called if its terms cancel.
    #[inline(always)]
    fn root(&self, sum: f64, other: f64, constant_term: impl Fn() -> f64) -> f64 {
        let (numerator, denominator) = if self.cancels(sum) {
            (constant_term(), other)
        } else {
            (sum, self.dd)
        };
        numerator / denominator
    }

    /// The roots in order.
    #[inline(always)]
    fn both(&self, constant_term: impl Fn() -> f64) -> [f64; 2] {
        let [first, second] = self.sums();
        let enter = self.root(first, second, &constant_term);
        // Next to a tangent, rounding may put the two in the wrong order.
        [enter, self.root(second, first, constant_term).max(enter)]
    }
}

/// `C` of (1) from the rounded difference, and whether it is accurate enough.
#[inline(always)]
fn rounded_constant_term(x: DVec3, radius: f64) -> (f64, bool) {
    let rr = radius * radius;
    let rounded = x.dot(x) - rr;
    (rounded, !(rounded.abs() < LEAST_CONSTANT_TERM * rr))
}

/// `D` of (2) from rounded products, and the terms of its error bound.
#[derive(Clone, Copy, Debug)]
struct RoundedDiscriminant {
    value: f64,
    /// `radius² |d|²`.
    reach: f64,
    /// `|x × d|²`.
    squared: f64,
    /// `|x|² |d|²`.
    spread: f64,
}

impl RoundedDiscriminant {
    /// `x` is the rounded difference and `dd` is `|d|²`.
    #[inline(always)]
    fn new(x: DVec3, d: DVec3, dd: f64, radius: f64) -> Self {
        let across = x.cross(d);
        let (squared, reach) = (across.dot(across), radius * radius * dd);
        Self {
            value: reach - squared,
            reach,
            squared,
            spread: x.dot(x) * dd,
        }
    }

    /// Whether the value is accurate enough for a root with this `x·d`. NaN counts as accurate.
    #[inline(always)]
    fn is_good(&self, b: f64) -> bool {
        // The length of `x × d` is off by at most 4 u |x| |d|, squares round by 3 u and 5 u of
        // themselves. The last term covers the second order.
        let first = self.reach + self.squared + (self.squared * self.spread).sqrt();
        let error = 8.0 * UNIT_ROUNDOFF * (first + 2.0 * UNIT_ROUNDOFF * self.spread);
        // A relative error of at most a quarter less than doubles in the root.
        let s = self.value.sqrt();
        let displaced = s * (error / self.value);
        let is_good_from_afar =
            (error <= 0.25 * self.value) & (displaced <= GOOD_FROM_AFAR * (b.abs() + s));
        (self.value < -error) | !(GOOD * self.value.abs() < error) | is_good_from_afar
    }

    /// Whether the value is plain, by (3).
    #[inline(always)]
    fn is_plain(&self) -> bool {
        let (size, square) = (self.value.abs() * MOST_OF_PLAIN, self.value * self.value);
        (self.reach + self.squared <= size)
            & (MOST_OF_SQUARES * self.squared * self.spread <= square)
            & (2.0 * UNIT_ROUNDOFF * self.spread <= size)
            & (square < f64::INFINITY)
    }
}

/// The exact location of a point.
pub(super) fn locate(center: DVec3, radius: f64, point: DVec3) -> Location {
    if !point.is_finite() {
        return Location::Outside;
    }
    let x = Between {
        from: center,
        to: point,
    };
    Location::of_sign(sign(&FromBall { x, radius }))
}

/// A point and a ball; as an expression `|x|² - radius²`.
#[derive(Clone, Copy, Debug)]
struct FromBall<W> {
    /// The offset from the center to the point.
    x: W,
    radius: f64,
}

impl<W: Offset> FromBall<W> {
    /// `D` of (2) for the line through the point. `x` is the rounded difference, `dd` is `|d|²`
    /// and `b` is `x·d`.
    fn discriminant(&self, x: DVec3, d: DVec3, dd: f64, b: f64) -> f64 {
        let discriminant = RoundedDiscriminant::new(x, d, dd, self.radius);
        if discriminant.is_plain() || discriminant.is_good(b) {
            return discriminant.value;
        }
        quotient(&Discriminant { from: *self, d }, 1.0)
    }

    /// `C` of (1); `x` is the rounded difference.
    fn constant_term(&self, x: DVec3) -> f64 {
        let (rounded, is_good) = rounded_constant_term(x, self.radius);
        if is_good {
            rounded
        } else {
            quotient(self, 1.0)
        }
    }
}

impl<W: Offset> Expression for FromBall<W> {
    fn value<N: Number>(&self) -> N {
        let (x, r) = (self.x.exactly::<N>(), N::of(self.radius));
        dot(&x, &x).minus(&r.times(&r))
    }
}

struct Discriminant<W> {
    from: FromBall<W>,
    d: DVec3,
}

impl<W: Offset> Expression for Discriminant<W> {
    fn value<N: Number>(&self) -> N {
        let FromBall { x, radius } = self.from;
        let (x, d) = (x.exactly::<N>(), vector(self.d));
        let (across, r) = (cross(&x, &d), N::of(radius));
        let reach = r.times(&r).times(&dot(&d, &d));
        reach.minus(&dot(&across, &across))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_from_afar_are_distinguished_by_one_ulp() {
        // Both lines pass the center at the distance 5/3 · 3 = 5, from 1e9 away and at a slope.
        let far = DVec3::new(-4.0, 3.0, 0.0) * 1e9;
        let tangent = far + DVec3::new(3.0, 4.0, 0.0);
        let d = DVec3::new(4.0, -3.0, 0.0);
        let found = chord(tangent, d, 5.0, Part::Side).unwrap();
        assert_eq!((found.enter.t, found.leave.t), (1e9, 1e9));
        assert_eq!(chord(tangent, d, 5.0_f64.next_down(), Part::Side), None);
        let crossed = chord(tangent, d, 13.0, Part::Side).unwrap();
        assert_eq!((crossed.enter.t, crossed.leave.t), (1e9 - 2.4, 1e9 + 2.4));
        assert_eq!(chord(tangent * f64::NAN, d, 5.0, Part::Side), None);
    }

    #[test]
    fn root_next_to_the_origin_keeps_its_bits() {
        let outside = power_of_two(-40);
        let x = DVec3::new(-1.0 - outside, 0.0, 0.0);
        let found = chord(x, DVec3::X * 4.0, 1.0, Part::Side).unwrap();
        assert_eq!(found.enter.t, outside / 4.0);
        assert_eq!(found.leave.t, (2.0 + outside) / 4.0);
    }

    #[test]
    fn ball_of_no_radius_is_its_center() {
        let d = DVec3::new(1.0, 3.0, 7.0);
        assert_eq!(chord(d * -3.0, d, 0.0, Part::Cap0).unwrap().enter.t, 3.0);
        assert_eq!(chord(d * -3.0 + DVec3::Z * 1e-14, d, 0.0, Part::Cap0), None);
    }

    #[test]
    fn sphere_belongs_to_the_ball() {
        let (center, point) = (DVec3::new(1e8, 0.0, 0.0), DVec3::new(1e8 + 3.0, 4.0, 0.0));
        assert_eq!(locate(center, 5.0, point), Location::Boundary);
        assert_eq!(locate(center, 5.0_f64.next_up(), point), Location::Inside);
        let outside = locate(center, 5.0_f64.next_down(), point);
        assert_eq!(outside, Location::Outside);
        assert_eq!(locate(center, 5.0, DVec3::INFINITY), Location::Outside);
    }
}
