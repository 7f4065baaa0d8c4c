//! The families of cases are reproducible and are what they say they are.

use cyltrace_oracle::cases::Problem;
use cyltrace_oracle::cases::{Family, Inputs};
use glam::DVec3;

const SEED: u64 = 5;
const CASES: u64 = 2_000;

fn cases(family: Family, inputs: Inputs) -> impl Iterator<Item = Problem> {
    (0..CASES).map(move |index| family.case(SEED, index, inputs))
}

/// All numbers of a case.
fn numbers(problem: &Problem) -> Vec<f64> {
    let Problem { cylinder, ray } = problem;
    let vectors = [cylinder.p0(), cylinder.p1(), ray.origin, ray.direction];
    let components = vectors.iter().flat_map(DVec3::to_array);
    components.chain([cylinder.radius()]).collect()
}

#[test]
fn family_names_are_read_back_and_unknown_ones_listed() {
    for family in Family::ALL {
        assert_eq!(family.name().parse(), Ok(family));
    }
    let message = "knot".parse::<Family>().unwrap_err().to_string();
    assert!(
        message.contains("\"knot\"") && message.contains("capgraze"),
        "{message}"
    );
}

#[test]
fn case_drawn_again_is_the_same_and_others_differ() {
    for family in Family::ALL {
        let case = family.case(SEED, 3, Inputs::F64);
        assert_eq!(case, family.case(SEED, 3, Inputs::F64));
        assert_ne!(case, family.case(SEED, 4, Inputs::F64));
        assert_ne!(case, family.case(SEED + 1, 3, Inputs::F64));
    }
}

#[test]
fn case_of_f32_inputs_holds_f32_numbers_only() {
    for family in Family::ALL {
        for (index, problem) in cases(family, Inputs::F32).enumerate() {
            for number in numbers(&problem) {
                assert_eq!(
                    f64::from(number as f32),
                    number,
                    "{family:?} {index}: {problem:?}"
                );
            }
        }
        let has_long_number = |problem: Problem| {
            numbers(&problem)
                .iter()
                .any(|&number| f64::from(number as f32) != number)
        };
        assert!(
            cases(family, Inputs::F64).all(has_long_number),
            "{family:?}"
        );
    }
}

#[test]
fn family_has_hits_and_misses() {
    let never_misses = [
        Family::NearParallel,
        Family::SurfaceIn,
        Family::Inside,
        Family::Fibre,
    ];
    for family in Family::ALL {
        for inputs in Inputs::ALL {
            let hits = cases(family, inputs)
                .take(500)
                .filter(|case| {
                    cyltrace_oracle::first_hit(&case.cylinder, &case.ray)
                        .hit
                        .is_some()
                })
                .count();
            assert!(hits >= 200, "{family:?} {inputs:?}: {hits} hits of 500");
            assert!(
                hits < 500 || never_misses.contains(&family),
                "{family:?} {inputs:?}"
            );
        }
    }
}

#[test]
fn case_parallel_to_the_axis_is_so_exactly() {
    for inputs in Inputs::ALL {
        for problem in cases(Family::Parallel, inputs) {
            let axis = cyltrace_oracle::ExactVector::new(problem.cylinder.p1());
            let axis = &axis - &cyltrace_oracle::ExactVector::new(problem.cylinder.p0());
            let sine = axis.cross(&cyltrace_oracle::ExactVector::new(problem.ray.direction));
            assert_eq!(sine.length(), 0.0, "{problem:?}");
        }
    }
}

/// Half of the answers change within the rounding of the distance.
#[test]
fn case_next_to_a_tangent_has_a_gap_of_the_size_of_a_rounding() {
    for inputs in Inputs::ALL {
        let near = cases(Family::Tangent, inputs)
            .filter(|case| {
                let truth = cyltrace_oracle::first_hit(&case.cylinder, &case.ray);
                truth.wall_gap < 100.0 * inputs.unit_roundoff()
            })
            .count() as u64;
        assert!(near > CASES * 9 / 10, "{inputs:?}: {near} of {CASES}");
    }
}
