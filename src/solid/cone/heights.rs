//! Where the points of a line on a cone's wall lie between the two ends.
//!
//! Heights `y = x·a + t s`, `s = d·a`, are compared with those at which the wall
//! ends: 0 and `|a|²` for a cone through two disks; for one that touches two balls
//! the circles in which it does, at `-r0 Δ` and `|a|² - r1 Δ`, the seams.
//!
//! At a root of the wall the rounded height is off by some u of its terms and by
//! what `t` is off, at most 2^-29 of itself (`wall.rs`). Within [`NEAR`] of an end the
//! question is settled exactly: with `Â = β A`, `B̂ = β B` and `Ê = |a|² E`, the roots
//! are `t = (-B̂ ∓ √R) / Â`, `R = β |a|² Ê`, so that
//!
//! ```text
//! (y - end) Â = P ∓ s √R,   P = (x·a - end) Â - s B̂
//! ```
//!
//! and the sign of that follows from the signs of `P`, `s` and `P² - s² R`. So a line
//! that touches a rim is not lost, and none slips through a seam.

use std::cmp::Ordering::{self, Equal, Greater, Less};

use glam::DVec3;

use super::wall::{Fit, Measures, Taper, Term};
use crate::math::power_of_two;
use crate::solid::exact::{Expression, Number, dot, quotient, sign, vector};
use crate::solid::way::Way;

/// How near to an end rounded heights do not tell, relative to their terms.
pub(super) const NEAR: f64 = power_of_two(-28);

/// Below this share of its terms a sum is computed exactly.
pub(super) const CANCELS: f64 = power_of_two(-20);

/// Which end of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solid) enum End {
    /// That at `p0`.
    First,
    /// That at `p1`.
    Second,
}

/// Which root of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::solid) enum Root {
    /// Where the line comes in.
    Enter,
    /// Where it goes out.
    Leave,
}

/// What rounded products make of a line as seen along the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub slope: f64,
    pub above: [f64; 2],
}

impl Rounded {
    #[inline(always)]
    pub fn new(taper: &Taper<impl Way>, x: DVec3, d: DVec3) -> Self {
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

/// The size of the terms of heights at `t = 0`, of a line that starts at a distance.
#[inline(always)]
pub(super) fn terms(taper: &Taper<impl Way>, distance: f64) -> f64 {
    let (length, delta) = (taper.axis().length(), taper.radius1 - taper.radius0);
    length * (distance + length) + taper.radius0.max(taper.radius1) * delta.abs()
}

/// Where a line comes through the plane that it is so far above of at `t = 0`.
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
    /// What `t = 1` adds to the height; its sign is exact.
    pub slope: f64,
    /// The heights above the ends at `t = 0`; their signs are exact.
    pub above: [f64; 2],
    /// The size of the terms of `above`.
    terms: f64,
}

impl<'a, A: Way, X: Way> Heights<'a, A, X> {
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

    /// Where the line comes through the plane across the axis at an end.
    pub fn at(&self, end: End) -> f64 {
        plane_at(self.above(end), self.slope)
    }

    /// How the height of a root, which is about at `t`, compares with an end.
    pub fn compare(&self, root: Root, t: f64, end: End) -> Ordering {
        let way = t * self.slope;
        let height = self.above(end) + way;
        if t.is_finite() && height.abs() <= NEAR * (self.terms + way.abs()) {
            return self.compare_exactly(root, end);
        }
        // Out of the ranges of solids and rays it may be no number.
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

/// What is computed exactly.
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

impl<A: Way, X: Way> Expression for At<'_, A, X> {
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
