//! The parameter of a decided hit, correctly rounded.
//!
//! In double-double first: `√s` by one Newton step from the f64 root, the
//! quotient by one correction, with the bound of what the terms and these steps
//! are off (`2^-100` of the size covers the steps). If the sum `high + low` keeps
//! its `high` with the bound added to `low` on either side, `high` is the nearest
//! f64. Otherwise the quotient is approximated by long numbers, and the
//! neighbouring midpoints between f64s are compared with the true parameter
//! exactly.

use std::cmp::Ordering;

use super::big::Big;
use super::bounded::Bounded;
use super::decide::{At, Decision, Terms};
use super::{Cylinder, Number, Ray};
use crate::math::{DoubleDouble, power_of_two};

/// The bound of a double-double root or quotient, relative to its size.
const STEP_ERROR: f64 = power_of_two(-100);

/// Bits of the approximation that is compared with midpoints; enough to be
/// next to the right f64 whatever cancels in practice. The comparison, not
/// this number, makes the result right.
const LONG: usize = 400;

/// The f64 nearest to the parameter of a hit; of two, the even one.
pub(super) fn rounded(cylinder: &Cylinder, ray: &Ray, decision: &Decision) -> f64 {
    if decision.at == At::Start {
        return ray.t_min;
    }
    let terms = Terms::<Bounded>::new(cylinder, ray);
    in_double_double(&terms, decision.at)
        .unwrap_or_else(|| in_long_numbers(&Terms::new(cylinder, ray), decision.at))
}

/// The numerator and denominator of the parameter, the root left to `root`.
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

fn in_double_double(terms: &Terms<Bounded>, at: At) -> Option<f64> {
    let (numerator, denominator) = quotient(terms, at, bounded_root)?;
    let divisor = denominator.value.high;
    let first = numerator.value.high / divisor;
    let rest = numerator.minus(&denominator.times(&Bounded::of(first)));
    let t = DoubleDouble::sum(first, rest.value.high / divisor);
    let error = 2.0 * (rest.error / divisor.abs()) + STEP_ERROR * first.abs();
    let is_certain = denominator.error < 0.25 * divisor.abs() && error.is_finite();
    let keeps = |off: f64| t.high + (t.low + off) == t.high;
    (is_certain && keeps(error) && keeps(-error)).then_some(t.high)
}

/// The root of a number that is not negative, if it is known to be positive.
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

fn in_long_numbers(terms: &Terms<Big>, at: At) -> f64 {
    let long = |x: &Big| Big(x.0.clone().with_precision(LONG).value());
    let root = |s: &Big| Some(Big(long(s).0.sqrt()));
    let (numerator, denominator) = quotient(terms, at, root).expect("the hit has a quotient");
    let mut t = (long(&numerator).0 / long(&denominator).0).to_f64().value();
    // Step to the f64 whose midpoints with its neighbours enclose the parameter.
    loop {
        let beyond = |neighbour: f64| {
            let half = Big::of(0.5);
            let midpoint = Big::of(t).plus(&Big::of(neighbour)).times(&half);
            terms
                .compare(at, &midpoint)
                .expect("long numbers are certain")
        };
        let is_odd = t.to_bits() & 1 == 1;
        let (up, down) = (beyond(t.next_up()), beyond(t.next_down()));
        if up == Ordering::Greater || (up == Ordering::Equal && is_odd) {
            t = t.next_up();
        } else if down == Ordering::Less || (down == Ordering::Equal && is_odd) {
            t = t.next_down();
        } else {
            return t;
        }
    }
}
