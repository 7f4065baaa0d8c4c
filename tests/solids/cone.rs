//! Cones and rounded cones against exact truth, on families of hard cases.
//!
//! `CYLTRACE_CASES=1000000 cargo test --release --test solids cone` is the full run.

use std::thread;

use cyltrace::math::Ray;
use cyltrace::solid::{
    AnySolid, Caps, Chord, Cone, ConvexSolid, Cylinder, Intersection, surface_point, triple_product,
};
use cyltrace_oracle::cases::{Inputs, TaperCase, TaperFamily, TaperSolid};
use cyltrace_oracle::{
    Exact, ExactRay, TrueHit, TrueSolid, distance_to_cone, distance_to_rounded_cone, exact,
    hits_of_any, to_f64,
};
use glam::DVec3;

const SEED: u64 = 23;

fn cases() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(10_000, |count| count.parse().expect("a number"))
}

/// What a solid and its oracle say of a case.
struct Answer {
    found: Vec<Intersection>,
    truth: Vec<TrueHit>,
    chord: Option<Chord>,
    reversed: Option<Chord>,
}

fn answer(solid: TaperSolid, case: &TaperCase, caps: Caps) -> Answer {
    fn of<S: ConvexSolid>(solid: S, ray: &Ray, truth: Vec<TrueHit>) -> Answer {
        let x = ray.origin - solid.anchor();
        let chord = solid.chord(x, ray.direction);
        let found = chord.map_or(Vec::new(), |chord| {
            let hits = chord.intersections(solid.caps(), 0.0, ray.t_min, ray.t_max);
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
            of(
                cone,
                &case.ray,
                TrueSolid::hits(&cone, &ExactRay::new(&case.ray)),
            )
        }
        TaperSolid::RoundedCone => {
            let rounded = case.rounded_cone();
            of(
                rounded,
                &case.ray,
                TrueSolid::hits(&rounded, &ExactRay::new(&case.ray)),
            )
        }
    }
}

fn gap(solid: TaperSolid, case: &TaperCase, caps: Caps) -> f64 {
    match solid {
        TaperSolid::Cone => TrueSolid::gap(&case.cone(caps), &case.ray),
        TaperSolid::RoundedCone => TrueSolid::gap(&case.rounded_cone(), &case.ray),
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
        let wrong: Vec<u64> = [&found.wrong_hits[..], &found.wrong_parts].concat();
        let name = format!("{solid:?} {family:?} {}", inputs.name());
        println!(
            "{name}: {} intersections, {} wrong hits, {} wrong parts, p99.9 {p999:.5} ulp, greatest {:.3}",
            found.hits,
            found.wrong_hits.len(),
            found.wrong_parts.len(),
            found.errors.last().copied().unwrap_or(0.0),
        );
        // The differences p1 - p0 and o - p0 are rounded: a number may be taken for
        // one that is u of it away, the ends for either difference.
        let allowed = match inputs {
            Inputs::F32 => 0.0,
            Inputs::F64 => 4.0 * inputs.unit_roundoff(),
        };
        for index in wrong {
            let case = family.case(solid, SEED, index, inputs);
            let gap = gap(solid, &case, Caps::Both);
            if inputs == Inputs::F32 || gap > allowed {
                broken.push(format!("{name} {index}: gap {gap:e}"));
            }
        }
        // Of full f64 numbers a root may be within a rounding of zero.
        if inputs == Inputs::F32 && p999 > 0.501 {
            broken.push(format!("{name}: p99.9 {p999}"));
        }
        if let Some(index) = found.not_reversible.first() {
            broken.push(format!("{name} {index}: reversed"));
        }
        // A family that misses shows nothing.
        if found.hits < cases() / 5 {
            broken.push(format!("{name}: {} intersections", found.hits));
        }
    }
    assert!(broken.is_empty(), "{broken:#?}; seed {SEED}");
}

#[test]
fn cones_of_f32_numbers_are_hit_as_exact_arithmetic_says() {
    check(TaperSolid::Cone, Inputs::F32);
}

#[test]
fn rounded_cones_of_f32_numbers_are_hit_as_exact_arithmetic_says() {
    check(TaperSolid::RoundedCone, Inputs::F32);
}

#[test]
fn cones_of_f64_numbers_are_hit_rightly_outside_the_rounding() {
    check(TaperSolid::Cone, Inputs::F64);
}

#[test]
fn rounded_cones_of_f64_numbers_are_hit_rightly_outside_the_rounding() {
    check(TaperSolid::RoundedCone, Inputs::F64);
}

/// Points in, on and around a solid: those where its ray meets it, rounded, and, on
/// the grids, points of the line in whole numbers.
fn points(case: &TaperCase, found: &[Intersection]) -> Vec<DVec3> {
    let ray = &case.ray;
    let mut points = vec![ray.origin, case.p0, case.p1, case.p0.midpoint(case.p1)];
    points.extend((0..40).map(|t| ray.origin + ray.direction * f64::from(t)));
    points.extend(found.iter().map(|hit| ray.origin + ray.direction * hit.t));
    points
}

#[test]
fn points_are_held_as_exact_arithmetic_says() {
    let mut held = [0, 0];
    for family in TaperFamily::ALL {
        for index in 0..cases() / 100 {
            for inputs in Inputs::ALL {
                let case = family.case(TaperSolid::Cone, SEED, index, inputs);
                let cone = case.cone(Caps::Both);
                for point in points(&case, &answer(TaperSolid::Cone, &case, Caps::Both).found) {
                    let truth = TrueSolid::truly_contains(&cone, point);
                    assert_eq!(cone.contains(point), truth, "{family:?} {index} {point:?}");
                    held[usize::from(truth)] += 1;
                }
                let case = family.case(TaperSolid::RoundedCone, SEED, index, inputs);
                let solid = case.rounded_cone();
                for point in points(
                    &case,
                    &answer(TaperSolid::RoundedCone, &case, Caps::Both).found,
                ) {
                    let truth = TrueSolid::truly_contains(&solid, point);
                    assert_eq!(solid.contains(point), truth, "{family:?} {index} {point:?}");
                    held[usize::from(truth)] += 1;
                }
            }
        }
    }
    println!("{held:?}");
    assert!(held[0] > 1000 && held[1] > 1000, "{held:?}");
}

/// From within there is one intersection ahead, from outside none or two.
#[test]
fn count_of_intersections_agrees_with_contains() {
    for solid in [TaperSolid::Cone, TaperSolid::RoundedCone] {
        let mut inside = 0;
        for family in [TaperFamily::Inside, TaperFamily::Uniform, TaperFamily::Far] {
            for index in 0..cases() {
                let case = family.case(solid, SEED, index, Inputs::F64);
                let holds = match solid {
                    TaperSolid::Cone => case.cone(Caps::Both).contains(case.ray.origin),
                    TaperSolid::RoundedCone => case.rounded_cone().contains(case.ray.origin),
                };
                let count = answer_of(solid, &case).map_or(0, |chord| {
                    chord
                        .intersections(Caps::Both, 0.0, 0.0, f64::INFINITY)
                        .count()
                });
                assert_eq!(holds, count == 1, "{solid:?} {family:?} {index}: {count}");
                inside += u64::from(holds);
            }
        }
        assert!(inside >= cases() / 2, "{inside}");
    }
}

fn answer_of(solid: TaperSolid, case: &TaperCase) -> Option<Chord> {
    let x = case.ray.origin - case.p0;
    match solid {
        TaperSolid::Cone => case.cone(Caps::Both).chord(x, case.ray.direction),
        TaperSolid::RoundedCone => case.rounded_cone().chord(x, case.ray.direction),
    }
}

/// Reported points are within their bound of the surface, and within the box.
#[test]
fn points_of_hits_are_within_their_bounds() {
    let mut greatest: f64 = 0.0;
    for family in TaperFamily::ALL {
        for index in 0..cases() / 20 {
            for solid in [TaperSolid::Cone, TaperSolid::RoundedCone] {
                let case = family.case(solid, SEED, index, Inputs::F64);
                for hit in answer(solid, &case, Caps::Both).found {
                    let from_p0 = case.ray.origin - case.p0 + case.ray.direction * hit.t;
                    let (met, off, bounds) = match solid {
                        TaperSolid::Cone => {
                            let cone = case.cone(Caps::Both);
                            let met = cone.surface_point(hit.part, from_p0);
                            let off = distance_to_cone(&cone, hit.part, met.point);
                            (met, off, cone.bounds())
                        }
                        TaperSolid::RoundedCone => {
                            let rounded = case.rounded_cone();
                            let met = rounded.surface_point(hit.part, from_p0);
                            let off = distance_to_rounded_cone(&rounded, hit.part, met.point);
                            (met, off, rounded.bounds())
                        }
                    };
                    let name = || format!("{solid:?} {family:?} {index} {hit:?} {met:?} {off:e}");
                    assert!(off <= met.error, "{}", name());
                    assert!((met.normal.length() - 1.0).abs() < 1e-14, "{}", name());
                    assert!((0.0..1.0).contains(&met.u()), "{}", name());
                    assert!((0.0..=1.0).contains(&met.v), "{}", name());
                    let slack = DVec3::splat(met.error);
                    let is_in_box = met.point.cmpge(bounds.lower - slack).all()
                        && met.point.cmple(bounds.upper + slack).all();
                    assert!(is_in_box, "{}", name());
                    greatest = greatest.max(off / met.error);
                }
            }
        }
    }
    println!("greatest share of the bound: {greatest:.3}");
    // A bound that nothing comes near would say nothing.
    assert!(greatest > 0.05, "{greatest}");
}

/// A cone with equal radii has the cylinder's answers, bit for bit.
#[test]
fn cone_with_equal_radii_is_the_cylinder() {
    let mut hits = 0;
    for family in TaperFamily::ALL {
        for index in 0..cases() / 10 {
            let case = family.case(TaperSolid::Cone, SEED, index, Inputs::F64);
            let radius = case.radius0.max(case.radius1);
            let cone = Cone::new(case.p0, case.p1, radius, radius, Caps::Both).unwrap();
            let cylinder = Cylinder::new(case.p0, case.p1, radius, Caps::Both).unwrap();
            let (x, d) = (case.ray.origin - case.p0, case.ray.direction);
            let chord = cone.chord(x, d);
            assert_eq!(chord, triple_product::chord(&cylinder, x, d));
            assert_eq!(cone.bounds(), cylinder.bounds());
            for end in chord.iter().flat_map(|chord| [chord.enter, chord.leave]) {
                let from_p0 = x + d * end.t;
                assert_eq!(
                    cone.surface_point(end.part, from_p0),
                    surface_point(&cylinder, end.part, from_p0)
                );
                hits += 1;
            }
        }
    }
    assert!(hits > cases(), "{hits}");
}

/// A line that only touches the rim of an open end is an entry and an exit of the wall, as
/// every tangent is. Whole numbers meet the rim to the last bit.
#[test]
fn lines_that_touch_the_rim_of_an_open_end_enter_and_leave_there() {
    let axis = DVec3::new(2.25, 0.0, 0.5);
    let rim = DVec3::Y;
    let ways = [DVec3::Z, DVec3::NEG_Z];
    for caps in [Caps::None, Caps::P0, Caps::P1, Caps::Both] {
        let cylinder = Cylinder::new(DVec3::ZERO, axis, 1.0, caps).unwrap();
        let cone = Cone::new(DVec3::ZERO, axis, 1.0, 0.0, caps).unwrap();
        let swapped = Cone::new(axis, DVec3::ZERO, 0.0, 1.0, caps).unwrap();
        let far_rim = Cylinder::new(-axis, DVec3::ZERO, 1.0, caps).unwrap();
        let solids: [AnySolid; 4] = [cylinder.into(), cone.into(), swapped.into(), far_rim.into()];
        for (solid, way) in solids.iter().flat_map(|solid| ways.map(|way| (solid, way))) {
            // Of a cylinder this line runs through the rim into the solid or out of it.
            let tilted = way + DVec3::Y * 0.5 * way.z;
            for direction in [way, tilted] {
                let ray = Ray::new(rim - direction * 8.0, direction);
                let truth = hits_of_any(solid, &ray);
                let x = ray.origin - solid.anchor();
                let found = solid.chord(x, direction).map_or(Vec::new(), |chord| {
                    chord.intersections(caps, 0.0, 0.0, f64::INFINITY).collect()
                });
                let keys = |met: &Intersection| (met.part, met.crossing, met.t);
                let found: Vec<_> = found.iter().map(keys).collect();
                let expected = truth
                    .iter()
                    .map(|hit| (hit.part, hit.crossing, hit.t_f64()));
                let expected: Vec<_> = expected.collect();
                assert_eq!(found, expected, "{solid:?} {ray:?}");
                assert!(!found.is_empty(), "{solid:?} {ray:?}");
            }
        }
    }
}
