//! Whether a ray spawned from a hit hits the surface at its own origin.
//!
//! From the hit that a solver reports, the surface point is built and a ray spawned by
//! the library's rule ([`SpawnMargin`](cyltrace::solid::SpawnMargin)), to the side that
//! the hit was seen from; then the same solver traces it. Outward, any hit of the
//! convex solid is a self-hit. Inward, the first thing a ray can meet is the far side
//! on its way out; a hit on the way in through the part that it left means that it
//! started outside. Through another part it may start outside: a point of an edge is
//! moved along the normal of one of its parts, and what the other needs is not known.

use crate::formulations::Answer;
use cyltrace::math::Random;
use cyltrace::solid::{Part, spawned_ray};
use cyltrace_oracle::cases::Case;

use super::contender::{Contender, solver};
use super::witness::Witness;

/// Makes the directions independent of the cases.
const STREAM: u64 = 1 << 62;

/// Spawned rays, and those that hit their own origin.
pub(super) struct Count {
    pub rays: u64,
    pub self_hits: u64,
}

/// What a spawned ray left.
#[derive(Clone, Copy)]
struct Left {
    part: Part,
    /// Whether to the outer side.
    is_outward: bool,
}

/// Spawns a ray from each hit but those at an apex.
pub(super) fn count(
    contender: &Contender,
    witnesses: &[Witness],
    answers: &[Option<Answer>],
    seed: u64,
) -> Count {
    let hits = witnesses.iter().zip(answers);
    let (left, cases): (Vec<Left>, Vec<Case>) = hits
        .filter_map(|(witness, answer)| {
            let mut random = Random::new(seed, STREAM | witness.index);
            let answer = answer.filter(|answer| answer.t.is_finite())?;
            // At an apex no normal distinguishes the sides.
            let is_apex = witness.truth.is_some_and(|truth| truth.normal.is_none());
            if is_apex {
                return None;
            }
            spawn(&witness.case, &answer, &mut random)
        })
        .unzip();
    let met_again = contender.answers(&cases);
    let self_hits = met_again
        .iter()
        .zip(&cases)
        .zip(left)
        .filter(|&((answer, case), left)| {
            answer.is_some_and(|answer| {
                let enters = case.ray.direction.dot(answer.normal) < 0.0;
                left.is_outward || enters && answer.part == left.part
            })
        })
        .count() as u64;
    Count {
        rays: cases.len() as u64,
        self_hits,
    }
}

/// A ray from a hit to the side that it was seen from, one in three of them
/// almost within the surface, and what it left. `None` where
/// rounding turned the direction to the other side.
fn spawn(case: &Case, answer: &Answer, random: &mut Random) -> Option<(Left, Case)> {
    let Case { solid, ray } = *case;
    let known = solver(&solid);
    let from_anchor = (ray.origin - known.anchor()) + ray.direction * answer.t;
    let surface = known.surface_point(answer.part, from_anchor);
    let offset = known
        .spawn_margin(&surface)
        .offset(surface.point, surface.error);

    let side = if ray.direction.dot(surface.normal) < 0.0 {
        1.0
    } else {
        -1.0
    };
    let normal = surface.normal * side;
    let height = match random.below(3) {
        0 => random.log_uniform(1e-17, 1.0),
        _ => random.unit(),
    };
    let heading = random.direction();
    let direction = heading - normal * heading.dot(normal) + normal * height;
    let ray = spawned_ray(surface.point, surface.normal, offset, direction);
    let left = Left {
        part: answer.part,
        is_outward: side > 0.0,
    };
    (direction.dot(normal) > 0.0).then_some((left, Case { solid, ray }))
}
