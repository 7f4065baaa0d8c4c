//! The exact solver: hit, part and order are those of exact arithmetic, for any f64 inputs.
//!
//! Every decision is the sign of a polynomial in the inputs, or of `p + q √s` with polynomials
//! `p`, `q`, `s`. Three stages compute it; each runs only if the one before is not certain:
//!
//! 1. the triple-product solver in f64 with a certificate (`certificate`): if every compared
//!    quantity is beyond the bound of its rounding, the result is certain;
//! 2. the decisions of `decide` in double-double with a running error bound (`bounded`): 106
//!    bits, enough for all but true ties;
//! 3. the same decisions in binary numbers of any length (`dashu`), which decide ties.
//!
//! The parameter `t` of the result is a quotient of such numbers. As an f64 from stage 1 it is
//! within the certificate's bound; [`rounded_t`] rounds it correctly.

mod big;
mod bounded;
mod certificate;
mod decide;
mod estimate;
mod expression;
mod number;
mod root;

use glam::DVec3;

use super::offset::Offset;
use super::{Chord, ChordEnd, Cylinder, Part};
use crate::math::Ray;
use crate::solid::Crossing;
pub(super) use big::{Big, ratio, unit};
use bounded::Bounded;
use decide::{At, End, Terms};
pub(super) use expression::{Expression, cross, difference, dot, quotient, sign, vector};
pub(super) use number::Number;
pub use root::Target;

/// The stage that decided a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// f64, certified.
    Double,
    /// Double-double with a running error bound.
    DoubleDouble,
    /// Numbers of any length.
    AnyLength,
}

/// An exact hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactHit {
    /// The ray's parameter, within `t_error` of the true one.
    pub t: f64,
    /// The error bound of `t`.
    pub t_error: f64,
    /// The part of the surface.
    pub part: Part,
    /// The direction of the crossing.
    pub crossing: Crossing,
    at: At,
}

/// The first point of the cylinder's surface in the ray's range, and the stage that decided it.
/// `None` is a miss, as certain as a hit.
///
/// The ray is valid ([`Ray::is_valid`]) and the largest component of its direction is within
/// 2^±100 in size, as for the triple-product solver.
#[inline]
#[must_use]
pub fn first(cylinder: &Cylinder, ray: &Ray) -> (Option<ExactHit>, Stage) {
    match certificate::first(cylinder, ray) {
        Some(answer) => (answer, Stage::Double),
        None => first_uncertified(*cylinder, *ray),
    }
}

/// Takes copies, so that the caller does not need its arguments in memory for this rare case.
#[cold]
fn first_uncertified(cylinder: Cylinder, ray: Ray) -> (Option<ExactHit>, Stage) {
    let (cylinder, ray) = (&cylinder, &ray);
    let (decision, stage) = match decide::decide::<Bounded>(cylinder, ray) {
        Some(decision) => (decision, Stage::DoubleDouble),
        None => {
            let decision = decide::decide::<Big>(cylinder, ray);
            let decision = decision.expect("signs of numbers of any length are certain");
            (decision, Stage::AnyLength)
        }
    };
    let hit = decision.map(|decision| {
        let t = root::rounded::<f64>(*cylinder, *ray, decision.at);
        ExactHit {
            t,
            t_error: t.abs() * crate::math::UNIT_ROUNDOFF,
            part: decision.part,
            crossing: decision.crossing,
            at: decision.at,
        }
    });
    (hit, stage)
}

/// The interval in which the line `p0 + x + t direction` is inside the closed solid, or `None`
/// if it misses. The parts of its ends are exact, and their `t` are the nearest numbers. A
/// non-finite argument is a miss, and so is a direction of zero.
///
/// It serves the rare lines that rounded numbers do not decide: it takes some hundred times as
/// long as the triple-product solver.
pub(super) fn chord(cylinder: &Cylinder, x: &impl Offset, direction: DVec3) -> Option<Chord> {
    if !(x.rounded().is_finite() && direction.is_finite()) || direction == DVec3::ZERO {
        return None;
    }
    let bounded = Terms::<Bounded>::new(cylinder, x, direction).ends();
    let ends = bounded.unwrap_or_else(|| {
        let ends = Terms::<Big>::new(cylinder, x, direction).ends();
        ends.expect("signs of numbers of any length are certain")
    })?;
    let end = |end: End| ChordEnd {
        t: root::rounded_on_line(cylinder, x, direction, end.at),
        part: end.part,
        on_rim: end.on_rim | end.touches,
    };
    Some(Chord {
        enter: end(ends.enter),
        leave: end(ends.leave),
        lies_on: ends.lies_on,
    })
}

/// The f32 or f64 nearest to the true parameter of a hit of this cylinder and ray; ties go to
/// the even one.
#[inline]
#[must_use]
pub fn rounded_t<S: Target>(cylinder: &Cylinder, ray: &Ray, hit: &ExactHit) -> S {
    // Rounding is monotonic, so everything between the two rounds to the same.
    let nearest = S::from_f64(hit.t - hit.t_error);
    if nearest == S::from_f64(hit.t + hit.t_error) {
        return nearest;
    }
    root::rounded(*cylinder, *ray, hit.at)
}
