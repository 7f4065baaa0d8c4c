//! The triple-product solver ("Qr"): ray against cylinder.
//!
//! With the axis `a = p1 - p0`, the ray `o + t d` and `x = o - p0`, let
//! `n = a × d` and `m = a × x`. A point of the line is at distance `radius`
//! from the axis where `|m + t n|² = radius² |a|²`:
//!
//! ```text
//! |n|² t² + 2 (m·n) t + |m|² - radius² |a|² = 0                            (1)
//! ```
//!
//! Since `m × n = (a × x) × (a × d) = a (x·n)`, Lagrange's identity gives
//! `|m|² |n|² - (m·n)² = |a|² w²` with the triple product `w = x·n`, and the
//! quarter discriminant of (1) is `|a|² D` with
//!
//! ```text
//! D = radius² |n|² - w²,   t = (-(m·n) ∓ |a| √D) / |n|²                    (2)
//! ```
//!
//! `|w| / |n|` is the distance between the two lines. Why this form: `w` does not change when
//! the origin slides along the ray or along the axis, so no square of the distance or of the
//! length enters `D` and cancels later; the relative error of `D` is a few units of 2^-53 times
//! `1 + |x| / radius`. The roots of `|a|²` and `D` are computed separately, which halves the
//! exponents in play.
//!
//! This is true of `w` only if `n` is perpendicular to `a`. Rounded products leave an error
//! along `a` of some 2^-53 `|a| |d|`, which `x·n` multiplies by the whole axial distance to the
//! origin: for a ray nearly along a long cylinder it would exceed everything else. So if the
//! sine of the angle is below 1/4, the products of `n` are exact.
//!
//! If the two terms of a root of (2) cancel, the root is `C / q`, `C` the constant term of (1)
//! and `q = -(m·n) ± |a| √D` the sum that does not cancel. For an origin next to the wall `C`
//! cancels as well, and is computed from exact products.
//!
//! The axial position of a point is `y = x·a + t d·a`, inside the slab between the disks iff
//! `0 <= y <= |a|²`. `slab` intersects wall and slab, and requests the second root only if
//! the first does not decide.
//!
//! `ties.rs` has the exact decisions at the rims.
//!
//! `docs/derivations.md`, section 2, derives the error bounds. They are for f64, the precision
//! of the tracer; f32 exists for comparison.

mod axis;
mod line;
mod roots;

use glam::DVec3;

use super::slab::{FirstIntersection, Question, Slab, WholeChord};
use super::{Chord, Cylinder, Intersection};
use crate::math::{Real, RealVector};
use axis::constant_term;
pub use axis::{Axis, StatedAxis};
pub(super) use line::{LEAST_SQUARED_SINE, Line};
pub(super) use roots::{Quotient, Root, Roots};

/// The first intersection with `t_min <= t + shift <= t_max` of the line
/// `p0 + from_p0 + t * direction` with the cylinder's surface.
///
/// `from_p0` is the ray's origin relative to the cylinder's `p0`, and `shift` is its position
/// on the whole ray, as in [`Chord::first`]. The largest component of `direction` is between
/// 2^-100 and 2^100 in size; with the range of [`Cylinder`] nothing then overflows. A
/// non-finite argument is a miss.
// Always inlined: callbacks are compiled for several instruction sets, and it is their loop.
#[inline(always)]
#[must_use]
pub fn first(
    cylinder: &Cylinder,
    from_p0: DVec3,
    direction: DVec3,
    shift: f64,
    t_min: f64,
    t_max: f64,
) -> Option<Intersection> {
    let question = FirstIntersection {
        caps: cylinder.caps(),
        shift,
        t_min,
        t_max,
    };
    answer(&StatedAxis::of(cylinder), from_p0, direction, question)
}

/// The interval in which that line is inside the closed solid, or `None` if it misses; under
/// the conditions of [`first`].
#[inline]
#[must_use]
pub fn chord(cylinder: &Cylinder, from_p0: DVec3, direction: DVec3) -> Option<Chord> {
    answer(&StatedAxis::of(cylinder), from_p0, direction, WholeChord)
}

/// The result of a function of that chord, for any form of the cylinder and either precision.
/// `None` if there is no chord.
#[inline(always)]
pub fn answer<S: Real, A: Axis<S>, Q: Question<S>>(
    axis: &A,
    from_p0: S::Vector,
    direction: S::Vector,
    question: Q,
) -> Option<Q::Answer> {
    let (x, d) = (from_p0, direction);
    let line = Line::new(axis, x, d);
    if line.is_parallel() {
        // From disk to disk, if the line is not farther from the axis than the wall.
        let chord = parallel_chord(constant_term(axis, x, axis.a().cross(x)), slab(axis, x, d))?;
        return question.of_chord(chord);
    }
    // A miss of the infinite wall. Written so that NaN is a miss.
    if !(line.discriminant >= S::ZERO) {
        return None;
    }
    let roots = Roots::new(axis, x, d, &line);
    question.of_overlap(&slab(axis, x, d).overlap(roots))
}

/// The chord of a line along the axis, from the constant term, whose sign is that of its
/// distance from the wall.
#[cold]
fn parallel_chord<S: Real>(constant_term: S, slab: Slab<S>) -> Option<Chord<S>> {
    if !(constant_term <= S::ZERO) {
        return None;
    }
    slab.along(constant_term == S::ZERO)
}

/// The line as seen along the axis.
#[inline(always)]
pub(super) fn slab<S: Real>(axis: &impl Axis<S>, x: S::Vector, d: S::Vector) -> Slab<S> {
    Slab {
        height: axis.aa(),
        position: x.dot(axis.a()),
        slope: d.dot(axis.a()),
    }
}
