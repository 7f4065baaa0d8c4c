//! The parameter of a decided hit, correctly rounded.
//!
//! First in double-double: `√s` by one Newton step from the f64 root, the quotient by one
//! correction, with a bound of the errors of the terms and of these steps (`2^-100` of the size
//! covers the steps). If the sum `high + low` keeps its `high` with the bound added to `low` on
//! either side, `high` is the nearest f64. To f32, the sum is rounded with the bound added on
//! either side. Otherwise long numbers approximate the quotient, and the neighbouring midpoints
//! are compared exactly with the true parameter.

use std::cmp::Ordering;

use glam::DVec3;

use super::big::Big;
use super::bounded::Bounded;
use super::decide::{At, Terms};
use super::{Cylinder, Number, Ray};
use crate::math::{DoubleDouble, Real, UNIT_ROUNDOFF, power_of_two};
use crate::solid::offset::{Between, Offset};

/// The bound of a double-double root or quotient, relative to its size.
const STEP_ERROR: f64 = power_of_two(-100);

/// The bits of the approximation that is compared with midpoints: enough to be next to the
/// right f64 in practice, whatever cancels. The comparison, not this number, makes the result
/// right.
const LONG: usize = 400;

/// A type that a parameter can be rounded to: f32 or f64.
pub trait Target: Real {
    /// The number nearest to `high + low`, if it is also nearest to everything within `error`
    /// of that.
    fn nearest(t: DoubleDouble, error: f64) -> Option<Self>;

    /// The least number above.
    #[must_use]
    fn next_up(self) -> Self;

    /// The greatest number below.
    #[must_use]
    fn next_down(self) -> Self;

    /// Whether the last bit is set.
    fn is_odd(self) -> bool;
}

impl Target for f64 {
    fn nearest(t: DoubleDouble, error: f64) -> Option<Self> {
        let keeps = |off: f64| t.high + (t.low + off) == t.high;
        (keeps(error) && keeps(-error)).then_some(t.high)
    }

    fn next_up(self) -> Self {
        self.next_up()
    }

    fn next_down(self) -> Self {
        self.next_down()
    }

    fn is_odd(self) -> bool {
        self.to_bits() & 1 == 1
    }
}

impl Target for f32 {
    fn nearest(t: DoubleDouble, error: f64) -> Option<Self> {
        // Doubled, for the roundings of these sums.
        let off = 2.0 * (t.low.abs() + error) + t.high.abs() * UNIT_ROUNDOFF;
        let (below, above) = ((t.high - off) as Self, (t.high + off) as Self);
        (below == above).then_some(below)
    }

    fn next_up(self) -> Self {
        self.next_up()
    }

    fn next_down(self) -> Self {
        self.next_down()
    }

    fn is_odd(self) -> bool {
        self.to_bits() & 1 == 1
    }
}

/// The number nearest to the parameter of a hit; ties go to the even one. Takes copies, for
/// callers that rarely need it.
pub(super) fn rounded<S: Target>(cylinder: Cylinder, ray: Ray, at: At) -> S {
    if at == At::Start {
        return S::from_f64(ray.t_min);
    }
    let x = Between {
        from: cylinder.p0(),
        to: ray.origin,
    };
    rounded_on_line(&cylinder, &x, ray.direction, at)
}

/// As [`rounded`], for a point other than the start of the range.
pub(super) fn rounded_on_line<S: Target>(
    cylinder: &Cylinder,
    x: &impl Offset,
    direction: DVec3,
    at: At,
) -> S {
    let terms = Terms::<Bounded>::new(cylinder, x, direction);
    let t: S = in_double_double(&terms, at)
        .unwrap_or_else(|| in_long_numbers(&Terms::new(cylinder, x, direction), at));
    // Turns -0 into 0.
    t + S::ZERO
}

/// The numerator and denominator of the parameter; `root` computes the root.
fn quotient<N: Number>(
    terms: &Terms<N>,
    at: At,
    root: impl FnOnce(&N) -> Option<N>,
) -> Option<(N, N)> {
    let zero = N::of(0.0);
    Some(match at {
        At::FirstRoot => (
            zero.minus(&terms.mn).minus(&root(&terms.s)?),
            terms.nn.clone(),
        ),
        At::SecondRoot => (root(&terms.s)?.minus(&terms.mn), terms.nn.clone()),
        At::Plane0 => (zero.minus(&terms.ya), terms.yd.clone()),
        At::Plane1 => (terms.aa.minus(&terms.ya), terms.yd.clone()),
        At::Start => return None,
    })
}

fn in_double_double<S: Target>(terms: &Terms<Bounded>, at: At) -> Option<S> {
    let (numerator, denominator) = quotient(terms, at, bounded_root)?;
    let divisor = denominator.value.high;
    let first = numerator.value.high / divisor;
    let rest = numerator.minus(&denominator.times(&Bounded::of(first)));
    let t = DoubleDouble::sum(first, rest.value.high / divisor);
    let error = 2.0 * (rest.error / divisor.abs()) + STEP_ERROR * first.abs();
    let is_certain = denominator.error < 0.25 * divisor.abs() && error.is_finite();
    is_certain.then(|| S::nearest(t, error))?
}

/// The root of a nonnegative number, if it is known to be positive.
fn bounded_root(s: &Bounded) -> Option<Bounded> {
    let high = s.value.high;
    if !(high > 4.0 * s.error) {
        return None;
    }
    let guess = high.sqrt();
    let rest = s.minus(&Bounded::of(guess).times(&Bounded::of(guess)));
    Some(Bounded {
        value: DoubleDouble::sum(guess, rest.value.high / (2.0 * guess)),
        error: rest.error / guess + STEP_ERROR * guess,
    })
}

fn in_long_numbers<S: Target>(terms: &Terms<Big>, at: At) -> S {
    let long = |x: &Big| Big(x.0.clone().with_precision(LONG).value());
    let root = |s: &Big| Some(Big(long(s).0.sqrt()));
    let (numerator, denominator) = quotient(terms, at, root).expect("the hit has a quotient");
    let mut t = S::from_f64((long(&numerator).0 / long(&denominator).0).to_f64().value());
    // Steps to the number whose midpoints with its neighbours enclose the parameter.
    loop {
        let beyond = |neighbour: S| {
            let half = Big::of(0.5);
            let sum = Big::of(t.to_f64()).plus(&Big::of(neighbour.to_f64()));
            terms
                .compare(at, &sum.times(&half))
                .expect("long numbers are certain")
        };
        let (up, down) = (beyond(t.next_up()), beyond(t.next_down()));
        if up == Ordering::Greater || (up == Ordering::Equal && t.is_odd()) {
            t = t.next_up();
        } else if down == Ordering::Less || (down == Ordering::Equal && t.is_odd()) {
            t = t.next_down();
        } else {
            return t;
        }
    }
}
