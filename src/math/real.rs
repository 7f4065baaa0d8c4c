//! Arithmetic that is written once for f32 and f64.
//!
//! Only what the solvers use: the four operations, roots, and three-vectors.
//! Every operation is one operation of the precision, rounded to nearest; the
//! vectors are glam's.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{DVec3, Vec3};

use super::{DoubleDouble, Ray};

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
    /// Three of them.
    type Vector: RealVector<Self>;

    /// Zero.
    const ZERO: Self;
    /// The least positive normal number.
    const MIN_POSITIVE: Self;

    /// The number of this precision nearest to `x`.
    fn from_f64(x: f64) -> Self;

    /// The same number in f64.
    fn to_f64(self) -> f64;

    /// The size.
    #[must_use]
    fn abs(self) -> Self;

    /// The size, with the sign of `sign`.
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

    /// The vector product with a relative error of one roundoff in every
    /// component, whatever the angle, if no product underflows: products are
    /// exact, their difference nearly so, and only then is it rounded.
    #[must_use]
    fn cross_of_exact_products(self, other: Self) -> Self;

    /// The vector of length 1 in this direction; NaN for zero.
    #[must_use]
    fn normalize(self) -> Self;
}

/// A [`Ray`] in any precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOf<S: Real> {
    /// The point at `t = 0`.
    pub origin: S::Vector,
    /// Any direction of any length.
    pub direction: S::Vector,
    /// Least `t` that counts.
    pub t_min: S,
    /// Greatest `t` that counts.
    pub t_max: S,
}

impl<S: Real> RayOf<S> {
    /// The ray with every number rounded to nearest.
    #[must_use]
    pub fn rounded(ray: &Ray) -> Self {
        Self {
            origin: S::Vector::from_f64(ray.origin),
            direction: S::Vector::from_f64(ray.direction),
            t_min: S::from_f64(ray.t_min),
            t_max: S::from_f64(ray.t_max),
        }
    }

    /// The point at parameter `t`, rounded.
    #[inline]
    #[must_use]
    pub fn at(&self, t: S) -> S::Vector {
        self.origin + self.direction * t
    }
}

/// Hands the trait's methods to those of the type.
macro_rules! impl_real {
    ($scalar:ident, $vector:ident, $cross_of_exact_products:ident) => {
        impl Real for $scalar {
            type Vector = $vector;

            const ZERO: Self = 0.0;
            const MIN_POSITIVE: Self = $scalar::MIN_POSITIVE;

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
            fn cross_of_exact_products(self, other: Self) -> Self {
                $cross_of_exact_products(self, other)
            }

            #[inline]
            fn normalize(self) -> Self {
                $vector::normalize(self)
            }
        }
    };
}

impl_real!(f32, Vec3, cross_through_f64);
impl_real!(f64, DVec3, cross_through_double_double);

/// Products of f32 are exact in f64.
fn cross_through_f64(a: Vec3, b: Vec3) -> Vec3 {
    a.as_dvec3().cross(b.as_dvec3()).as_vec3()
}

/// Products of f64 are exact in two words, down to 2^-960.
fn cross_through_double_double(a: DVec3, b: DVec3) -> DVec3 {
    let difference = |i: usize, j: usize| {
        let sum = DoubleDouble::product(a[i], b[j]).plus(DoubleDouble::product(-a[j], b[i]));
        sum.high
    };
    DVec3::new(difference(1, 2), difference(2, 0), difference(0, 1))
}
