//! Whether a ray spawned from a hit meets the surface where it left it.
//!
//! From the hit that a solver reports, the surface point is built and a ray
//! spawned by the library's rule ([`SpawnMargin`]), to the side that the hit
//! was seen from; then the same solver is asked. Outward, any hit of the
//! convex solid is a self-hit. Inward, the first thing a ray can meet is the
//! far side on its way out; a hit on the way in means that it started outside.

use crate::math::Random;
use crate::solid::formulations::{Answer, Formulation, Precision, Problem};
use crate::solid::{SpawnMargin, spawned_ray, surface_point};

use super::witness::Witness;

/// Makes the directions independent of the cases.
const STREAM: u64 = 1 << 62;

/// Whether the library itself traces with this formulation and so promises
/// something about it.
#[must_use]
pub fn is_own(formulation: &dyn Formulation) -> bool {
    let own = [
        "triple-product",
        "triple-product-prepared",
        "exact",
        "exact-rounded",
    ];
    formulation.precision() == Precision::F64 && own.contains(&formulation.name())
}

/// Spawned rays and how many of them met where they left.
pub(super) struct Count {
    pub rays: u64,
    pub self_hits: u64,
}

/// Spawns a ray from each hit.
pub(super) fn count(
    formulation: &dyn Formulation,
    witnesses: &[Witness],
    answers: &[Option<Answer>],
    seed: u64,
) -> Count {
    let hits = witnesses.iter().zip(answers);
    let (outward, problems): (Vec<bool>, Vec<Problem>) = hits
        .filter_map(|(witness, answer)| {
            let mut random = Random::new(seed, STREAM | witness.index);
            let answer = answer.filter(|answer| answer.t.is_finite())?;
            spawn(&witness.problem, &answer, &mut random)
        })
        .unzip();
    let met_again = formulation.answers(&problems);
    let self_hits = met_again
        .iter()
        .zip(&problems)
        .zip(outward)
        .filter(|&((answer, problem), outward)| {
            answer.is_some_and(|answer| outward || problem.ray.direction.dot(answer.normal) < 0.0)
        })
        .count() as u64;
    Count {
        rays: problems.len() as u64,
        self_hits,
    }
}

/// A ray from a hit to the side that it was seen from, one in three of them
/// almost within the surface, and whether that is the outer side. `None` where
/// rounding turned the direction to the other side.
fn spawn(problem: &Problem, answer: &Answer, random: &mut Random) -> Option<(bool, Problem)> {
    let Problem { cylinder, ray } = problem;
    let from_p0 = (ray.origin - cylinder.p0()) + ray.direction * answer.t;
    let surface = surface_point(cylinder, answer.part, from_p0);
    let offset = SpawnMargin::new(cylinder, &surface).offset(surface.point, surface.error);

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
    let cylinder = *cylinder;
    (direction.dot(normal) > 0.0).then_some((side > 0.0, Problem { cylinder, ray }))
}
