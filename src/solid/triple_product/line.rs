//! A line relative to the axis: `n`, `w` and `D` of (2).

use super::Axis;
use crate::math::{Real, RealVector, Wide, power_of_two, wide_cross};

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
pub(in crate::solid) const LEAST_SQUARED_SINE: f64 = 1.0 / 16.0;

/// The position of a line relative to an axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Line<S: Real> {
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

#[inline]
fn parallel_below<S: Real>() -> S {
    let limit = S::from_f64(PARALLEL_BELOW);
    if limit > S::MIN_POSITIVE {
        limit
    } else {
        S::MIN_POSITIVE
    }
}
