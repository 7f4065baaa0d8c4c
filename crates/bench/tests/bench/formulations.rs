//! Every formulation against exact arithmetic on cases that are easy: far from
//! flipping the answer, so that only the size of the errors is in question.
//!
//! With u the unit roundoff of the precision and `size` the sum of all lengths
//! that enter (positions, the way to the hit), a formulation evaluates the
//! wall's quadratic with an error of some `u size²`: a dozen roundings in each
//! coefficient, and the unit axis rounded to u. Its slope at the root is
//! `2 |d| sin r √g`, with the angle to the axis and the gap g
//! (`docs/derivations.md`, section 2); the discriminant's own roundings add as
//! much again. The plane of a disk is off by `u size` along the axis.
//! Hence, with a factor for counts of roundings,
//!
//! ```text
//! |t - t*| |d| <= 32 u size² / (r sin √g)   on the wall,   16 u size / cos   on a disk
//! ```

use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cylinder, Part};
use cyltrace_bench::formulations::{self, Formulation, Precision, Problem};
use cyltrace_oracle::CylinderTruth;
use glam::DVec3;
use rayon::prelude::*;

const SEED: u64 = 23;
const CASES: u64 = 20_000;

/// An easy problem, the truth, and the bound of `|t - t*|` in units of u.
struct Case {
    problem: Problem,
    truth: CylinderTruth,
    bound: f64,
    size: f64,
}

/// A case of numbers that f32 holds; `None` where an end of the cylinder or the
/// range is within a twentieth of changing the answer.
fn easy_case(index: u64) -> Option<Case> {
    let mut random = Random::new(SEED, index);
    let round = |v: DVec3| v.as_vec3().as_dvec3();
    let p0 = round(random.direction() * random.uniform(0.0, 2.0));
    let p1 = round(p0 + random.direction() * random.uniform(0.5, 5.0));
    let radius = round(DVec3::splat(random.uniform(0.2, 1.0))).x;
    let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
    let cylinder = Cylinder::new(p0, p1, radius, caps).expect("a cylinder");
    let middle = p0 + (p1 - p0) * random.uniform(0.0, 1.0);
    let target = middle + random.direction() * random.uniform(0.0, 1.5 * radius);
    let origin = round(target + random.direction() * random.log_uniform(0.1, 10.0));
    let direction = round((target - origin) * random.log_uniform(0.1, 10.0));
    let ray = Ray::new(origin, direction);

    let (a, d, x) = (p1 - p0, direction, origin - p0);
    let cos = (a.dot(d) / (a.length() * d.length())).abs();
    let sin = (1.0 - cos * cos).sqrt();
    let truth = cyltrace_oracle::first_hit(&cylinder, &ray);
    let place = |t: f64| {
        let from_p0 = x + d * t;
        let axial = from_p0.dot(a) / a.length_squared();
        (axial, (from_p0 - a * axial).length() / radius)
    };
    // Where the line meets the planes of the ends and, beside the closest
    // approach of the axis, the infinite wall.
    let is_near = |value: f64, limit: f64| (value - limit).abs() < 0.05;
    let (start_axial, start_radial) = place(0.0);
    let on_planes =
        [0.0, 1.0].map(|end| place((end - start_axial) / (a.dot(d) / a.length_squared())).1);
    let across = d - a * (d.dot(a) / a.length_squared());
    let closest = -x.dot(across) / across.length_squared();
    let half_chord = (1.0 - place(closest).1.powi(2)).max(0.0).sqrt() * radius / across.length();
    let on_wall = [closest - half_chord, closest + half_chord].map(|t| place(t).0);
    let is_hard = cos < 0.1
        || sin < 0.1
        || truth.wall_gap < 0.1
        || is_near(start_radial, 1.0)
        || is_near(start_axial, 0.0)
        || is_near(start_axial, 1.0)
        || on_planes.iter().any(|&radial| is_near(radial, 1.0))
        || on_wall
            .iter()
            .any(|&axial| is_near(axial, 0.0) || is_near(axial, 1.0));
    if is_hard {
        return None;
    }
    let way = truth
        .hit
        .as_ref()
        .map_or(0.0, |hit| hit.t_f64().abs() * d.length());
    let size = p0.length() + p1.length() + origin.length() + radius + way;
    let along = match truth.hit.as_ref().map(|hit| hit.part) {
        Some(Part::Cap0 | Part::Cap1) => 16.0 * size / cos,
        Some(Part::Side) | None => 32.0 * size * size / (radius * sin * truth.wall_gap.sqrt()),
        part => panic!("a cylinder has no part {part:?}"),
    };
    Some(Case {
        problem: Problem { cylinder, ray },
        truth,
        bound: along / d.length(),
        size,
    })
}

fn roundoff(precision: Precision) -> f64 {
    match precision {
        Precision::F32 => f64::from(f32::EPSILON) / 2.0,
        Precision::F64 => f64::EPSILON / 2.0,
    }
}

/// The greatest part of the bound that a formulation used.
fn judge(formulation: &dyn Formulation, cases: &[Case]) -> f64 {
    let name = format!("{} {}", formulation.name(), formulation.precision().name());
    let problems: Vec<Problem> = cases.iter().map(|case| case.problem).collect();
    let u = roundoff(formulation.precision());
    let mut worst = 0.0_f64;
    for (case, found) in cases.iter().zip(formulation.answers(&problems)) {
        let Problem { cylinder, ray } = case.problem;
        let show = || format!("{name}, seed {SEED}: {cylinder:?} {ray:?}, found {found:?}");
        let expected = case.truth.hit.as_ref();
        // Its second root is what it is known not to try.
        if formulation.name() == "cross-product" && found.is_none() && expected.is_some() {
            let part = expected.map(|hit| hit.part);
            assert!(
                part == Some(Part::Side) && cylinder.caps() != Caps::Both,
                "{}",
                show()
            );
            continue;
        }
        assert_eq!(
            found.map(|answer| answer.part),
            expected.map(|hit| hit.part),
            "{}",
            show()
        );
        let (Some(answer), Some(hit)) = (found, expected) else {
            continue;
        };
        let off = cyltrace_oracle::to_f64(&(cyltrace_oracle::exact(answer.t) - &hit.t)).abs();
        let used = off / (u * case.bound);
        assert!(
            used <= 1.0,
            "t off by {off:e}, {used} of the bound: {}",
            show()
        );
        worst = worst.max(used);

        // The normal turns as the point moves, and with the rounded axis.
        let a = cylinder.p1() - cylinder.p0();
        let from_p0 = ray.at(hit.t_f64()) - cylinder.p0();
        let normal = match hit.part {
            Part::Side => (from_p0 - a * (from_p0.dot(a) / a.length_squared())).normalize(),
            Part::Cap0 => -a.normalize(),
            Part::Cap1 => a.normalize(),
            part => panic!("a cylinder has no part {part:?}"),
        };
        let moved = u * (case.bound * ray.direction.length() + 32.0 * case.size);
        let turned = (answer.normal - normal).length();
        assert!(
            turned <= 2.0 * moved / cylinder.radius(),
            "normal off by {turned:e}: {}",
            show()
        );
    }
    worst
}

#[test]
fn formulations_on_easy_cases_agree_with_exact_arithmetic() {
    let cases: Vec<Case> = (0..4 * CASES)
        .into_par_iter()
        .filter_map(easy_case)
        .collect();
    assert!(
        cases.len() as u64 >= CASES,
        "only {} easy cases",
        cases.len()
    );
    let cases = &cases[..CASES as usize];
    let hits = cases.iter().filter(|case| case.truth.hit.is_some()).count() as u64;
    assert!(
        hits > CASES / 4 && hits < CASES,
        "{hits} hits: the cases are lopsided"
    );
    for formulation in formulations::all() {
        let worst = judge(&*formulation, cases);
        println!(
            "{} {}: t used at most {worst:.3} of its bound",
            formulation.name(),
            formulation.precision().name()
        );
    }
}
