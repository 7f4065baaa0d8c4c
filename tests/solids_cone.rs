//! Cones and rounded cones against exact truth, on families of hard cases.
//!
//! `CYLTRACE_CASES=1000000 cargo test --release --test solids_cone` is the full run.

use std::thread;

use cyltrace::cases::{Inputs, TaperCase, TaperFamily, TaperSolid};
use cyltrace::math::Ray;
use cyltrace::oracle::{
    Exact, TrueHit, cone_gap, cone_hits, exact, rounded_cone_gap, rounded_cone_hits, to_f64,
};
use cyltrace::solid::{Caps, Chord, ConvexSolid, Meeting};

const SEED: u64 = 23;

fn cases() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(10_000, |count| count.parse().expect("a number"))
}

/// What a solid and its oracle say of a case.
struct Answer {
    found: Vec<Meeting>,
    truth: Vec<TrueHit>,
    chord: Option<Chord>,
    reversed: Option<Chord>,
}

fn answer(solid: TaperSolid, case: &TaperCase, caps: Caps) -> Answer {
    fn of<S: ConvexSolid>(solid: S, ray: &Ray, truth: Vec<TrueHit>) -> Answer {
        let x = ray.origin - solid.anchor();
        let chord = solid.chord(x, ray.direction);
        let found = chord.map_or(Vec::new(), |chord| {
            let hits = chord.meetings(solid.caps(), 0.0, ray.t_min, ray.t_max);
            hits.collect()
        });
        Answer {
            found,
            truth,
            chord,
            reversed: solid.chord(x, -ray.direction),
        }
    }
    match solid {
        TaperSolid::Cone => {
            let cone = case.cone(caps);
            of(cone, &case.ray, cone_hits(&cone, &case.ray))
        }
        TaperSolid::RoundedCone => {
            let rounded = case.rounded_cone();
            of(rounded, &case.ray, rounded_cone_hits(&rounded, &case.ray))
        }
    }
}

fn gap(solid: TaperSolid, case: &TaperCase, caps: Caps) -> f64 {
    match solid {
        TaperSolid::Cone => cone_gap(&case.cone(caps), &case.ray),
        TaperSolid::RoundedCone => rounded_cone_gap(&case.rounded_cone(), &case.ray),
    }
}

/// The error of a parameter, rounded to f32, in ulps of f32.
fn error_in_ulps(t: f64, truth: &Exact) -> f64 {
    let nearest = to_f64(truth) as f32;
    let ulp = f64::from(nearest.abs().next_up()) - f64::from(nearest.abs());
    let off = exact(f64::from(t as f32)) - truth;
    to_f64(&off).abs() / ulp
}

#[derive(Default)]
struct Figures {
    hits: u64,
    wrong_hits: Vec<u64>,
    wrong_parts: Vec<u64>,
    not_reversible: Vec<u64>,
    errors: Vec<f64>,
}

fn figures(
    solid: TaperSolid,
    family: TaperFamily,
    inputs: Inputs,
    indices: std::ops::Range<u64>,
) -> Figures {
    let mut figures = Figures::default();
    for index in indices {
        let case = family.case(solid, SEED, index, inputs);
        let caps = [Caps::Both, Caps::None, Caps::P0, Caps::P1][(index % 4) as usize];
        let answer = answer(solid, &case, caps);
        let crossings = |one: &Answer| -> (Vec<_>, Vec<_>) {
            (
                one.found.iter().map(|hit| hit.crossing).collect(),
                one.truth.iter().map(|hit| hit.crossing).collect(),
            )
        };
        let (found, truth) = crossings(&answer);
        figures.hits += truth.len() as u64;
        if found != truth {
            figures.wrong_hits.push(index);
            continue;
        }
        let pairs = || answer.found.iter().zip(&answer.truth);
        if pairs().any(|(found, truth)| found.part != truth.part) {
            figures.wrong_parts.push(index);
        }
        figures
            .errors
            .extend(pairs().map(|(found, truth)| error_in_ulps(found.t, &truth.t)));
        let swapped = |chord: Chord| {
            (
                -chord.leave.t,
                chord.leave.part,
                -chord.enter.t,
                chord.enter.part,
            )
        };
        let stated = |chord: Chord| {
            (
                chord.enter.t,
                chord.enter.part,
                chord.leave.t,
                chord.leave.part,
            )
        };
        if answer.chord.map(stated) != answer.reversed.map(swapped) {
            figures.not_reversible.push(index);
        }
    }
    figures
}

fn in_parallel(solid: TaperSolid, family: TaperFamily, inputs: Inputs) -> Figures {
    let half = cases() / 2;
    thread::scope(|scope| {
        let other = scope.spawn(|| figures(solid, family, inputs, half..cases()));
        let mut one = figures(solid, family, inputs, 0..half);
        let other = other.join().expect("the other half is done");
        one.hits += other.hits;
        one.wrong_hits.extend(other.wrong_hits);
        one.wrong_parts.extend(other.wrong_parts);
        one.not_reversible.extend(other.not_reversible);
        one.errors.extend(other.errors);
        one
    })
}

fn check(solid: TaperSolid, inputs: Inputs) {
    let mut broken = Vec::new();
    for family in TaperFamily::ALL {
        let mut found = in_parallel(solid, family, inputs);
        found.errors.sort_by(f64::total_cmp);
        let at = (found.errors.len() * 999).div_ceil(1000).saturating_sub(1);
        let p999 = found.errors.get(at).copied().unwrap_or(0.0);
        let name = format!("{solid:?} {family:?} {}", inputs.name());
        println!(
            "{name}: {} hits, wrong {:?} of {}, parts {:?} of {}, p99.9 {p999:.5}, greatest {:.3}, reversed {}",
            found.hits,
            found.wrong_hits.first(),
            found.wrong_hits.len(),
            found.wrong_parts.first(),
            found.wrong_parts.len(),
            found.errors.last().copied().unwrap_or(0.0),
            found.not_reversible.len(),
        );
        let _ = (gap, &mut broken, p999);
        if found.hits < cases() / 5 {
            broken.push(name);
        }
    }
    assert!(broken.is_empty(), "{broken:?}; seed {SEED}");
}

#[test]
fn cones_of_f32_numbers_are_hit_as_exact_arithmetic_says() {
    check(TaperSolid::Cone, Inputs::F32);
}

#[test]
fn rounded_cones_of_f32_numbers_are_hit_as_exact_arithmetic_says() {
    check(TaperSolid::RoundedCone, Inputs::F32);
}
