//! The heights of a line's points on a cone's wall, compared with the two ends.
//!
//! Heights `y = x·a + t s`, `s = d·a`, are compared with those at which the wall ends. For a
//! cone through two disks these are 0 and `|a|²`. A cone that touches two balls touches them in
//! circles, the seams, at `-r0 Δ` and `|a|² - r1 Δ`.
//!
//! At a root of the wall the rounded height is off by some u of its terms and by the error of
//! `t`, at most 2^-29 of itself (`wall.rs`). Within [`NEAR`] of an end the comparison is exact:
//! with `Â = β A`, `B̂ = β B` and `Ê = |a|² E`, the roots are `t = (-B̂ ∓ √R) / Â`,
//! `R = β |a|² Ê`, so that
//!
//! ```text
//! (y - end) Â = P ∓ s √R,   P = (x·a - end) Â - s B̂
//! ```
//!
//! whose sign follows from the signs of `P`, `s` and `P² - s² R`. So a line that touches a rim
//! is not lost, and none passes through a seam.

use std::cmp::Ordering::{self, Equal, Greater, Less};

use glam::DVec3;

use super::taper::{Fit, Measures, Taper, Term};
use crate::math::power_of_two;
use crate::solid::exact::{Expression, Number, dot, quotient, sign, vector};
use crate::solid::offset::Offset;

/// The distance from an end, relative to their terms, within which rounded heights are not
/// decisive.
pub(super) const NEAR: f64 = power_of_two(-28);

/// The share of its terms below which a sum is computed exactly.
pub(super) const CANCELS: f64 = power_of_two(-20);

/// An end of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solid) enum End {
    /// The end at `p0`.
    First,
    /// The end at `p1`.
    Second,
}

/// A root of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solid) enum Root {
    /// Where the line enters.
    Enter,
    /// Where the line leaves.
    Leave,
}

/// A line as seen along the axis, from rounded products.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub slope: f64,
    pub above: [f64; 2],
}

impl Rounded {
    #[inline(always)]
    pub fn new(taper: &Taper<impl Offset>, x: DVec3, d: DVec3) -> Self {
        let (a, delta) = (taper.axis(), taper.radius1 - taper.radius0);
        let (from_p0, from_p1) = (x.dot(a), (x - a).dot(a));
        let [seam0, seam1] = match taper.fit {
            Fit::Disks => [0.0, 0.0],
            Fit::Balls => [taper.radius0 * delta, taper.radius1 * delta],
        };
        Self {
            slope: d.dot(a),
            above: [from_p0 + seam0, from_p1 + seam1],
        }
    }
}

/// The size of the terms of heights at `t = 0`, for a line whose origin is at a distance.
#[inline(always)]
pub(super) fn terms(taper: &Taper<impl Offset>, distance: f64) -> f64 {
    let (length, delta) = (taper.axis().length(), taper.radius1 - taper.radius0);
    length * (distance + length) + taper.radius0.max(taper.radius1) * delta.abs()
}

/// The parameter at which a line crosses a plane, from its height above the plane at `t = 0`.
#[inline(always)]
pub(super) fn plane_at(above: f64, slope: f64) -> f64 {
    -above / slope
}

/// A line as seen along the axis.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Heights<'a, A, X> {
    taper: &'a Taper<A>,
    x: X,
    d: DVec3,
    /// The change of the height per unit of `t`; its sign is exact.
    pub slope: f64,
    /// The heights above the ends at `t = 0`; their signs are exact.
    pub above: [f64; 2],
    /// The size of the terms of `above`.
    terms: f64,
}

impl<'a, A: Offset, X: Offset> Heights<'a, A, X> {
    pub fn new(taper: &'a Taper<A>, x: X, d: DVec3) -> Self {
        let terms = terms(taper, x.rounded().length());
        let checked = |rounded: f64, terms: f64, which| {
            if rounded.abs() < CANCELS * terms {
                quotient(&At { taper, x, d, which }, 1.0)
            } else {
                rounded
            }
        };
        let rounded = Rounded::new(taper, x.rounded(), d);
        let [above0, above1] = rounded.above;
        let steepest = d.length() * taper.axis().length();
        Self {
            taper,
            x,
            d,
            slope: checked(rounded.slope, steepest, Which::Slope),
            above: [
                checked(above0, terms, Which::Above(End::First)),
                checked(above1, terms, Which::Above(End::Second)),
            ],
            terms,
        }
    }

    fn above(&self, end: End) -> f64 {
        match end {
            End::First => self.above[0],
            End::Second => self.above[1],
        }
    }

    /// The parameter at which the line crosses the plane across the axis at an end.
    pub fn at(&self, end: End) -> f64 {
        plane_at(self.above(end), self.slope)
    }

    /// Compares the height of a root, which is near `t`, with an end.
    pub fn compare(&self, root: Root, t: f64, end: End) -> Ordering {
        let rise = t * self.slope;
        let height = self.above(end) + rise;
        if t.is_finite() && height.abs() <= NEAR * (self.terms + rise.abs()) {
            return self.compare_exactly(root, end);
        }
        // NaN is possible outside of the ranges of solids and rays.
        height.partial_cmp(&0.0).unwrap_or(Equal)
    }

    #[cold]
    fn compare_exactly(&self, root: Root, end: End) -> Ordering {
        let Self { taper, x, d, .. } = *self;
        let of = |which| sign(&At { taper, x, d, which });
        let times = |one: Ordering, other: Ordering| match other {
            Less => one.reverse(),
            Equal => Equal,
            Greater => one,
        };
        let steepness = of(Which::Term(Term::A));
        if steepness == Equal {
            // The only root is `-C / (2 B)`.
            return times(of(Which::Linear(end)), of(Which::Term(Term::B)));
        }
        let by_root = match (root, of(Which::Term(Term::E))) {
            (_, Equal) => Equal,
            (Root::Enter, _) => of(Which::Slope).reverse(),
            (Root::Leave, _) => of(Which::Slope),
        };
        let above = match (of(Which::Sum(end)), by_root) {
            (Equal, other) | (other, Equal) => other,
            (one, other) if one == other => one,
            (one, _) => times(one, of(Which::Squares(end))),
        };
        times(above, steepness)
    }
}

/// The exact quantities.
#[derive(Clone, Copy, Debug)]
enum Which {
    /// `s`.
    Slope,
    /// `x·a - end`.
    Above(End),
    /// `Â`, `B̂` or `Ê`.
    Term(Term),
    /// `P`.
    Sum(End),
    /// `P² - s² R`.
    Squares(End),
    /// `2 (x·a - end) B̂ - s Ĉ`.
    Linear(End),
}

struct At<'a, A, X> {
    taper: &'a Taper<A>,
    x: X,
    d: DVec3,
    which: Which,
}

impl<A: Offset, X: Offset> Expression for At<'_, A, X> {
    fn value<N: Number>(&self) -> N {
        let taper = self.taper;
        let (a, x) = (taper.a.exactly::<N>(), self.x.exactly());
        let d = vector(self.d);
        let measures = taper.measures(&a);
        let Measures {
            aa, delta, beta, ..
        } = &measures;
        let slope = dot(&d, &a);
        let above = |end| {
            let y = match end {
                End::First => dot(&x, &a),
                End::Second => dot(&x, &a).minus(aa),
            };
            let radius = match end {
                End::First => taper.radius0,
                End::Second => taper.radius1,
            };
            match taper.fit {
                Fit::Disks => y,
                Fit::Balls => y.plus(&N::of(radius).times(delta)),
            }
        };
        let term = |term| taper.term(&x, &d, term);
        let sum = |end| {
            let first: N = above(end).times(&term(Term::A));
            first.minus(&slope.times(&term(Term::B)))
        };
        match self.which {
            Which::Slope => slope,
            Which::Above(end) => above(end),
            Which::Term(one) => term(one),
            Which::Sum(end) => sum(end),
            Which::Squares(end) => {
                let r = beta.times(aa).times(&term(Term::E));
                let p = sum(end);
                p.times(&p).minus(&slope.times(&slope).times(&r))
            }
            Which::Linear(end) => {
                let first = N::of(2.0).times(&above(end)).times(&term(Term::B));
                first.minus(&slope.times(&term(Term::C)))
            }
        }
    }
}
