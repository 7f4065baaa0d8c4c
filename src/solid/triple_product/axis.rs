//! The axis of a cylinder, and the constant term of (1).

use super::Cylinder;
use crate::math::{Real, RealVector, Wide, power_of_two, wide_cross, wide_square};

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

/// `C = |m|² - radius² |a|²`, where `m = a × x`.
#[inline(always)]
pub(super) fn constant_term<S: Real>(axis: &impl Axis<S>, x: S::Vector, m: S::Vector) -> S {
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
