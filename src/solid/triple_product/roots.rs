//! The roots (2), the ends of a line's interval inside the wall.

use super::axis::constant_term;
use super::{Axis, Line};
use crate::math::{Real, RealVector};
use crate::solid::slab::{Slab, Wall};
use crate::solid::{Chord, ties};

/// The two roots of the wall.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Roots<S: Real, A> {
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
pub(in crate::solid) enum Root {
    /// With the minus sign in (2), where the line enters.
    First,
    /// With the plus sign, where the line leaves.
    Second,
}

/// A root as a quotient of two numbers.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Quotient<S> {
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
