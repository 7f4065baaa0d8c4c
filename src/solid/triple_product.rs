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
//! `0 <= y <= |a|²`. `slab.rs` intersects wall and slab, and requests the second root only if
//! the first does not decide.
//!
//! `ties.rs` has the exact decisions at the rims.
//!
//! `docs/derivations.md`, section 2, derives the error bounds. They are for f64, the precision
//! of the tracer; f32 exists for comparison.

use glam::DVec3;

use super::slab::{FirstIntersection, Question, Slab, Wall, WholeChord};
use super::{Chord, Cylinder, Intersection, ties};
use crate::math::{Real, RealVector, Wide, power_of_two, wide_cross, wide_square};

/// Below this (2^-700), `radius² |n|²` could lose bits to underflow and the ray counts as
/// parallel to the axis. `|a| |d|` is at least 2^-250 (the least length of a cylinder times the
/// least direction), so the angle is then below 2^-100: along any chord of a cylinder in range
/// the ray leaves the parallel by far less than an ulp of its origin. The range of f32 is
/// smaller; there the limit is its least normal number.
const PARALLEL_BELOW: f64 = power_of_two(-700);

/// The square of the sine of the angle between ray and axis below which the products of `a × d`
/// have to be exact: `docs/derivations.md`, section 2.
///
/// It trades time for the constants of the bounds: at 1/16, a sine of 1/4, the
/// exact products are needed for 3 % of random directions and (3) and (5) have
/// 20 u and 10 u; at 1/4 it would be 13 % and 16 u and 8 u.
pub(super) const LEAST_SQUARED_SINE: f64 = 1.0 / 16.0;

/// Below this, relative to `radius² |a|²`, the constant term of (1) is computed
/// from exact products.
///
/// It trades time for bits of a `t` near zero: at 2^-20, the rounded term has 30 bits left,
/// more than an f32 has. Rays spawned at a wall, whose offset is an ulp of f32 of their
/// coordinates, rarely need the exact products.
const LEAST_CONSTANT_TERM: f64 = power_of_two(-20);

/// The solver's view of a cylinder: its axis `a`, its radius, and products of them, which may
/// be stored or computed on request.
pub trait Axis<S: Real>: Copy {
    /// `a = p1 - p0`.
    fn a(&self) -> S::Vector;
    /// The radius.
    fn radius(&self) -> S;
    /// `|a|²`.
    fn aa(&self) -> S;
    /// `|a|`.
    fn length(&self) -> S;
    /// `radius² |a|²`.
    fn rr_aa(&self) -> S;

    /// The constant term of (1) from exact products.
    #[inline(always)]
    fn exact_constant_term(&self, x: S::Vector) -> S {
        let ([ax, ay, az], [xx, xy, xz]) = (self.a().components(), x.components());
        exact_constant_term(ax, ay, az, xx, xy, xz, self.radius())
    }
}

/// An axis without stored products.
#[derive(Clone, Copy, Debug)]
pub struct StatedAxis<S: Real> {
    /// `p1 - p0`.
    pub a: S::Vector,
    /// The radius.
    pub radius: S,
}

impl StatedAxis<f64> {
    /// The axis of a cylinder.
    #[inline]
    pub fn of(cylinder: &Cylinder) -> Self {
        Self {
            a: cylinder.p1() - cylinder.p0(),
            radius: cylinder.radius(),
        }
    }
}

impl<S: Real> Axis<S> for StatedAxis<S> {
    #[inline]
    fn a(&self) -> S::Vector {
        self.a
    }

    #[inline]
    fn radius(&self) -> S {
        self.radius
    }

    #[inline]
    fn aa(&self) -> S {
        self.a.dot(self.a)
    }

    #[inline]
    fn length(&self) -> S {
        self.aa().sqrt()
    }

    #[inline]
    fn rr_aa(&self) -> S {
        self.radius * self.radius * self.aa()
    }
}

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

/// The position of a line relative to an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<S: Real> {
    /// `a × d`.
    pub n: S::Vector,
    /// `|n|²`.
    pub nn: S,
    /// The triple product `x·n`.
    pub w: S,
    /// `radius² |n|² - w²`.
    pub discriminant: S,
}

impl<S: Real> Line<S> {
    #[inline(always)]
    pub fn new(axis: &impl Axis<S>, x: S::Vector, d: S::Vector) -> Self {
        let line = Self::rounded(axis, x, d);
        if line.is_near_axis(axis, d) {
            return Self::of_normal(axis, x, exact_normal::<S>(axis.a(), d));
        }
        line
    }

    /// By rounded products.
    #[inline(always)]
    pub fn rounded(axis: &impl Axis<S>, x: S::Vector, d: S::Vector) -> Self {
        Self::of_normal(axis, x, axis.a().cross(d))
    }

    #[inline(always)]
    fn of_normal(axis: &impl Axis<S>, x: S::Vector, n: S::Vector) -> Self {
        let nn = n.dot(n);
        let w = x.dot(n);
        Self {
            n,
            nn,
            w,
            discriminant: axis.radius() * axis.radius() * nn - w * w,
        }
    }

    /// Whether rounded products are not accurate enough.
    #[inline(always)]
    pub fn is_near_axis(&self, axis: &impl Axis<S>, d: S::Vector) -> bool {
        self.nn < S::from_f64(LEAST_SQUARED_SINE) * (axis.aa() * d.dot(d))
    }

    /// Whether the line counts as parallel to the axis.
    #[inline]
    pub fn is_parallel(&self) -> bool {
        self.nn < parallel_below()
    }
}

/// The two roots of the wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots<S: Real, A> {
    axis: A,
    m: S::Vector,
    x: S::Vector,
    d: S::Vector,
    nn: S,
    /// `k² / g` of `ties.rs`.
    displacement: S,
    /// `m·n`.
    pub mn: S,
    /// `|a| √D`.
    pub s: S,
}

/// One of the two roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    /// With the minus sign in (2), where the line enters.
    First,
    /// With the plus sign, where the line leaves.
    Second,
}

/// A root as a quotient of two numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quotient<S> {
    pub numerator: S,
    pub denominator: S,
    /// Whether it is `C / q`, not a sum over `|n|²`.
    pub is_indirect: bool,
}

impl<S: Real, A: Axis<S>> Roots<S, A> {
    #[inline(always)]
    pub fn new(axis: &A, x: S::Vector, d: S::Vector, line: &Line<S>) -> Self {
        Self {
            displacement: ties::displacement(axis, d, line),
            ..Self::of_ordinary(axis, x, d, line.n, line.nn, line.discriminant)
        }
    }

    /// From the terms of a line that is neither near the axis nor grazes the wall.
    #[inline(always)]
    pub fn of_ordinary(
        axis: &A,
        x: S::Vector,
        d: S::Vector,
        n: S::Vector,
        nn: S,
        discriminant: S,
    ) -> Self {
        let m = axis.a().cross(x);
        Self {
            axis: *axis,
            m,
            x,
            d,
            nn,
            displacement: S::from_f64(ties::ORDINARY_DISPLACEMENT),
            mn: m.dot(n),
            s: axis.length() * discriminant.sqrt(),
        }
    }

    /// A root in the form in which its terms do not cancel.
    #[inline(always)]
    pub fn quotient(&self, root: Root) -> Quotient<S> {
        let (sum, other) = match root {
            Root::First => (-self.mn - self.s, self.s - self.mn),
            Root::Second => (self.s - self.mn, -self.mn - self.s),
        };
        if sum.abs() < S::from_f64(0.5) * self.mn.abs() {
            Quotient {
                numerator: constant_term(&self.axis, self.x, self.m),
                denominator: other,
                is_indirect: true,
            }
        } else {
            Quotient {
                numerator: sum,
                denominator: self.nn,
                is_indirect: false,
            }
        }
    }
}

/// `C = |m|² - radius² |a|²`, where `m = a × x`.
#[inline(always)]
fn constant_term<S: Real>(axis: &impl Axis<S>, x: S::Vector, m: S::Vector) -> S {
    let least = axis.rr_aa();
    let c = m.dot(m) - least;
    if c.abs() < S::from_f64(LEAST_CONSTANT_TERM) * least {
        return axis.exact_constant_term(x);
    }
    c
}

#[cold]
#[inline(never)]
fn exact_constant_term<S: Real>(ax: S, ay: S, az: S, xx: S, xy: S, xz: S, radius: S) -> S {
    let (a, x) = ([ax, ay, az], [xx, xy, xz]);
    let aa = wide_square::<S>(a.map(|one| S::Wide::product(one, S::from_f64(1.0))));
    let mm = wide_square::<S>(wide_cross::<S>(S::Vector::of(a), S::Vector::of(x)));
    mm.minus(S::Wide::product(radius, radius).times(aa))
        .rounded()
}

impl<S: Real, A: Axis<S>> Wall<S> for Roots<S, A> {
    #[inline(always)]
    fn enter(&self) -> S {
        let root = self.quotient(Root::First);
        root.numerator / root.denominator
    }

    #[inline(always)]
    fn leave(&self) -> S {
        let root = self.quotient(Root::Second);
        root.numerator / root.denominator
    }

    const DECIDES_RIMS: bool = S::DECIDES_TIES;

    #[inline(always)]
    fn squared_rounding(&self, slab: &Slab<S>) -> S {
        let squared_sizes = self.m.dot(self.m)
            + slab.position * slab.position
            + slab.height * slab.height
            + self.axis.rr_aa();
        ties::squared_rounding(self.displacement, squared_sizes)
    }

    #[inline(always)]
    fn exact_chord(&self) -> Option<Chord<S>> {
        let [a, x, d] = [self.axis.a(), self.x, self.d].map(RealVector::components);
        let ([ax, ay, az], [xx, xy, xz], [dx, dy, dz]) = (a, x, d);
        ties::exact_chord(ax, ay, az, self.axis.radius(), xx, xy, xz, dx, dy, dz)
    }
}

/// `a × d` from exact products. Products below 2^-960 are not exact in f64, but they are
/// negligible in a vector that does not count as zero.
#[inline(always)]
fn exact_normal<S: Real>(a: S::Vector, d: S::Vector) -> S::Vector {
    let ([ax, ay, az], [dx, dy, dz]) = (a.components(), d.components());
    S::Vector::of(cross_of_exact_products(ax, ay, az, dx, dy, dz))
}

/// Takes separate numbers: they are passed in registers, and the caller does not need its
/// vectors in memory for this rare case.
#[cold]
#[inline(never)]
fn cross_of_exact_products<S: Real>(ax: S, ay: S, az: S, dx: S, dy: S, dz: S) -> [S; 3] {
    let (a, d) = (S::Vector::of([ax, ay, az]), S::Vector::of([dx, dy, dz]));
    wide_cross::<S>(a, d).map(S::Wide::rounded)
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

#[inline]
fn parallel_below<S: Real>() -> S {
    let limit = S::from_f64(PARALLEL_BELOW);
    if limit > S::MIN_POSITIVE {
        limit
    } else {
        S::MIN_POSITIVE
    }
}
