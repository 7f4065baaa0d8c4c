//! Arithmetic that is written once for f32 and f64.
//!
//! The traits contain only what the solvers use: the four operations, roots, and
//! three-vectors. Every operation is one operation of the precision, rounded to
//! nearest; the vectors are glam's.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{DVec3, Vec3};

use super::DoubleDouble;

/// f32 or f64.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A vector of three such numbers.
    type Vector: RealVector<Self>;
    /// Numbers of about twice the precision.
    type Wide: Wide<Self>;

    /// Zero.
    const ZERO: Self;
    /// The least positive normal number.
    const MIN_POSITIVE: Self;
    /// Whether solvers decide ties by exact arithmetic. They do not in f32, which exists
    /// for comparison.
    const DECIDES_TIES: bool;

    /// The number of this precision nearest to `x`.
    fn from_f64(x: f64) -> Self;

    /// The same number in f64.
    fn to_f64(self) -> f64;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The absolute value with the sign of `sign`.
    #[must_use]
    fn copysign(self, sign: Self) -> Self;

    /// The square root, correctly rounded; NaN below zero.
    #[must_use]
    fn sqrt(self) -> Self;
}

/// A vector of three numbers.
pub trait RealVector<S>:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<S, Output = Self>
    + Div<S, Output = Self>
    + Neg<Output = Self>
{
    /// The vector of this precision nearest to `v`.
    fn from_f64(v: DVec3) -> Self;

    /// The same vector in f64.
    fn to_f64(self) -> DVec3;

    /// The scalar product.
    fn dot(self, other: Self) -> S;

    /// The vector product.
    #[must_use]
    fn cross(self, other: Self) -> Self;

    /// The three numbers.
    fn components(self) -> [S; 3];

    /// The vector of three numbers.
    fn of(components: [S; 3]) -> Self;

    /// The vector of length 1 in this direction; NaN for zero.
    #[must_use]
    fn normalize(self) -> Self;
}

/// A number in which products of two `S` are exact, if they do not underflow.
pub trait Wide<S>: Copy {
    /// `a b`, exactly.
    fn product(a: S, b: S) -> Self;

    /// The sum.
    #[must_use]
    fn plus(self, other: Self) -> Self;

    /// The difference.
    #[must_use]
    fn minus(self, other: Self) -> Self;

    /// The product.
    #[must_use]
    fn times(self, other: Self) -> Self;

    /// The number rounded to `S`.
    fn rounded(self) -> S;
}

impl Wide<f32> for f64 {
    fn product(a: f32, b: f32) -> Self {
        Self::from(a) * Self::from(b)
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn minus(self, other: Self) -> Self {
        self - other
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn rounded(self) -> f32 {
        self as f32
    }
}

impl Wide<f64> for DoubleDouble {
    fn product(a: f64, b: f64) -> Self {
        Self::product(a, b)
    }

    fn plus(self, other: Self) -> Self {
        self.plus(other)
    }

    fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    fn times(self, other: Self) -> Self {
        self.times(other)
    }

    fn rounded(self) -> f64 {
        self.high
    }
}

/// `a × b` as wide numbers; every product is exact and only the differences
/// are rounded.
pub fn wide_cross<S: Real>(a: S::Vector, b: S::Vector) -> [S::Wide; 3] {
    let (a, b) = (a.components(), b.components());
    let term =
        |i: usize, j: usize| S::Wide::product(a[i], b[j]).minus(S::Wide::product(a[j], b[i]));
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// `v·v` of wide numbers.
pub fn wide_square<S: Real>(v: [S::Wide; 3]) -> S::Wide {
    let [x, y, z] = v.map(|component| component.times(component));
    x.plus(y).plus(z)
}

/// Implements the traits by the methods of the types.
macro_rules! impl_real {
    ($scalar:ident, $vector:ident, $wide:ident, $decides_ties:literal) => {
        impl Real for $scalar {
            type Vector = $vector;
            type Wide = $wide;

            const ZERO: Self = 0.0;
            const MIN_POSITIVE: Self = $scalar::MIN_POSITIVE;
            const DECIDES_TIES: bool = $decides_ties;

            #[inline]
            fn from_f64(x: f64) -> Self {
                x as $scalar
            }

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn abs(self) -> Self {
                $scalar::abs(self)
            }

            #[inline]
            fn copysign(self, sign: Self) -> Self {
                $scalar::copysign(self, sign)
            }

            #[inline]
            fn sqrt(self) -> Self {
                $scalar::sqrt(self)
            }
        }

        impl RealVector<$scalar> for $vector {
            #[inline]
            fn from_f64(v: DVec3) -> Self {
                $vector::new(v.x as $scalar, v.y as $scalar, v.z as $scalar)
            }

            #[inline]
            fn to_f64(self) -> DVec3 {
                DVec3::new(f64::from(self.x), f64::from(self.y), f64::from(self.z))
            }

            #[inline]
            fn dot(self, other: Self) -> $scalar {
                $vector::dot(self, other)
            }

            #[inline]
            fn cross(self, other: Self) -> Self {
                $vector::cross(self, other)
            }

            #[inline]
            fn components(self) -> [$scalar; 3] {
                self.to_array()
            }

            #[inline]
            fn of(components: [$scalar; 3]) -> Self {
                $vector::from_array(components)
            }

            #[inline]
            fn normalize(self) -> Self {
                $vector::normalize(self)
            }
        }
    };
}

impl_real!(f32, Vec3, f64, false);
impl_real!(f64, DVec3, DoubleDouble, true);
