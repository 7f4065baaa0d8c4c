//! Formulations against textbook answers, and where they are known to fail.
//!
//! Agreement with exact arithmetic is in `crates/bench/tests/bench/formulations.rs`.

use glam::DVec3;

use super::*;
use cyltrace::math::{Ray, power_of_two};
use cyltrace::solid::{Caps, Cylinder};

const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];

/// A ray from `origin` along `direction` at the cylinder of radius 1 from
/// z = -1 to z = 1.
fn problem(caps: Caps, origin: [f64; 3], direction: [f64; 3]) -> Problem {
    Problem {
        cylinder: Cylinder::new(DVec3::NEG_Z, DVec3::Z, 1.0, caps).unwrap(),
        ray: Ray::new(DVec3::from(origin), DVec3::from(direction)),
    }
}

fn answer(formulation: &dyn Formulation, problem: Problem) -> Option<Answer> {
    formulation.answers(&[problem])[0]
}

/// Asks every formulation; these problems are exact in f32.
fn all_answer(problem: Problem, expected: Option<(f64, Part, DVec3)>) {
    for formulation in all() {
        let found = answer(&*formulation, problem);
        assert_eq!(
            found.map(|answer| (answer.t, answer.part, answer.normal)),
            expected,
            "{} {} {problem:?}",
            formulation.name(),
            formulation.precision().name()
        );
    }
}

#[test]
fn formulations_from_outside_hit_wall_and_disks() {
    let wall = Some((2.0, Part::Side, DVec3::X));
    all_answer(problem(Caps::Both, [3.0, 0.0, 0.5], [-1.0, 0.0, 0.0]), wall);
    all_answer(problem(Caps::None, [5.0, 0.0, 0.5], [-2.0, 0.0, 0.0]), wall);
    all_answer(
        problem(Caps::Both, [0.25, 0.0, 5.0], [0.0, 0.0, -1.0]),
        Some((4.0, Part::Cap1, DVec3::Z)),
    );
    all_answer(
        problem(Caps::Both, [-1.5, 0.0, -3.0], [0.5, 0.0, 1.0]),
        Some((2.0, Part::Cap0, DVec3::NEG_Z)),
    );
}

#[test]
fn formulations_beside_the_cylinder_miss() {
    for (origin, direction) in [
        ([3.0, 1.5, 0.0], [-1.0, 0.0, 0.0]),
        ([3.0, 0.0, 1.5], [-1.0, 0.0, 0.0]),
        ([1.5, 0.0, 5.0], [0.0, 0.0, -1.0]),
        ([3.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ([3.0, 0.0, 3.0], [-1.0, 0.0, -1.0e-3]),
    ] {
        all_answer(problem(Caps::Both, origin, direction), None);
    }
}

#[test]
fn formulations_from_inside_hit_on_the_way_out() {
    all_answer(
        problem(Caps::Both, [0.0; 3], [0.0, 1.0, 0.0]),
        Some((1.0, Part::Side, DVec3::Y)),
    );
    all_answer(
        problem(Caps::Both, [0.0; 3], [0.25, 0.0, 2.0]),
        Some((0.5, Part::Cap1, DVec3::Z)),
    );
}

#[test]
fn formulations_parallel_to_the_axis_see_only_disks() {
    let along = |caps| problem(caps, [0.5, 0.0, 5.0], [0.0, 0.0, -2.0]);
    let (cap0, cap1) = (
        Some((3.0, Part::Cap0, DVec3::NEG_Z)),
        Some((2.0, Part::Cap1, DVec3::Z)),
    );
    all_answer(along(Caps::Both), cap1);
    all_answer(along(Caps::P1), cap1);
    all_answer(along(Caps::P0), cap0);
    all_answer(along(Caps::None), None);
}

#[test]
fn formulations_at_the_ends_of_the_range_count_them() {
    let mut problem = problem(Caps::Both, [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let exit = Some((4.0, Part::Side, DVec3::NEG_X));
    let entry = Some((2.0, Part::Side, DVec3::X));
    for (t_min, t_max, expected) in [
        (0.0, 2.0, entry),
        (0.0, 1.875, None),
        (2.5, f64::INFINITY, exit),
        (2.5, 4.0, exit),
        (2.5, 3.5, None),
        (-9.0, 9.0, entry),
    ] {
        (problem.ray.t_min, problem.ray.t_max) = (t_min, t_max);
        all_answer(problem, expected);
    }
}

/// Through the open end at z = 1 and on to the wall's inside.
#[test]
fn cross_product_through_an_open_end_needs_the_second_root() {
    let problem = problem(Caps::P0, [-2.0, 0.0, 4.0], [1.0, 0.0, -1.25]);
    for formulation in all() {
        let found = answer(&*formulation, problem).map(|answer| (answer.t, answer.part));
        let expected = (formulation.name() != "cross-product").then_some((3.0, Part::Side));
        assert_eq!(found, expected, "{}", formulation.name());
    }
}

#[test]
fn cross_product_facing_the_viewer_turns_the_normal_inside() {
    let problem = problem(Caps::Both, [0.0; 3], [0.0, 1.0, 0.0]);
    for precision in PRECISIONS {
        for (facing, expected) in [(Facing::Outward, DVec3::Y), (Facing::Viewer, DVec3::NEG_Y)] {
            let formulation = cross_product(Roots::Both, facing, precision);
            let found = answer(&*formulation, problem).unwrap();
            assert_eq!(found.normal, expected, "{facing:?}");
        }
    }
}

#[test]
fn object_space_at_its_own_surface_drops_the_hit() {
    let problem = problem(Caps::Both, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    for precision in PRECISIONS {
        let found = answer(&*object_space(DEFAULT_TOLERANCE, precision), problem).unwrap();
        assert_eq!(found.t, 2.0);
        let exact = by_name("triple-product", precision).unwrap();
        assert_eq!(answer(&*exact, problem).unwrap().t, 0.0);
    }
}

/// The tolerance is larger than the whole cylinder: a miss by nine radii is
/// taken for a hit of a disk, and a plain hit of the wall is lost.
#[test]
fn object_space_in_a_small_unit_is_wrong() {
    let unit = power_of_two(-27);
    let small = |origin: DVec3, direction: DVec3| Problem {
        cylinder: Cylinder::new(DVec3::NEG_Z * unit, DVec3::Z * unit, unit, Caps::Both).unwrap(),
        ray: Ray::new(origin * unit, direction),
    };
    let beside = small(DVec3::new(10.0, 0.0, 1e3), DVec3::NEG_Z);
    let at_wall = small(DVec3::new(10.0, 0.0, 0.0), DVec3::NEG_X);
    for precision in PRECISIONS {
        let tolerant = object_space(DEFAULT_TOLERANCE, precision);
        assert!(answer(&*tolerant, beside).is_some());
        assert!(answer(&*tolerant, at_wall).is_none());
        let strict = object_space(0.0, precision);
        assert!(answer(&*strict, beside).is_none());
        assert_eq!(answer(&*strict, at_wall).unwrap().t, 9.0 * unit);
    }
}

/// From 10^5 radii away the dot products have lost the radius in f32:
/// `oc·oc - (oc·a)²` is known to 2^-24 of the distance squared.
#[test]
fn center_dot_from_far_away_misses_in_f32_only() {
    let height = 0.984375_f64;
    let far = problem(Caps::Both, [1e5, height, 0.5], [-1.0, 0.0, 0.0]);
    let x = (1.0 - height * height).sqrt();
    for (name, f32_is_right) in [
        ("center-dot", false),
        ("center-dot-tuned", false),
        ("start-cap", false),
        ("projection", false),
        ("triple-product", true),
        ("triple-product-prepared", true),
    ] {
        for precision in PRECISIONS {
            let found = answer(&*by_name(name, precision).unwrap(), far);
            let is_right = found.is_some_and(|answer| (1e5 - answer.t - x).abs() < 0.01);
            let expected = precision == Precision::F64 || f32_is_right;
            assert_eq!(is_right, expected, "{name} {precision:?} {found:?}");
        }
    }
}

#[test]
fn prepared_products_give_the_same_bits() {
    let mut random = cyltrace::math::Random::new(17, 0);
    for _ in 0..2_000 {
        let p0 = random.direction();
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let p1 = p0 + random.direction() * random.log_uniform(1e-3, 1e3);
        let cylinder = Cylinder::new(p0, p1, random.log_uniform(1e-3, 1e1), caps).unwrap();
        let origin = random.direction() * random.log_uniform(1e-2, 1e2);
        let target = p0 + (p1 - p0) * random.unit();
        let ray = Ray::new(origin, target - origin);
        let problem = Problem { cylinder, ray };
        for precision in PRECISIONS {
            let [stated, prepared] = ["triple-product", "triple-product-prepared"]
                .map(|name| answer(&*by_name(name, precision).unwrap(), problem));
            let bits =
                |found: Option<Answer>| found.map(|answer| (answer.t.to_bits(), answer.part));
            assert_eq!(bits(stated), bits(prepared), "{problem:?}");
        }
    }
}

#[test]
fn names_of_all_are_found_again() {
    for formulation in all() {
        let found = by_name(formulation.name(), formulation.precision()).unwrap();
        assert_eq!(found.name(), formulation.name());
        assert_eq!(found.precision(), formulation.precision());
        assert_eq!(found.bytes(), formulation.bytes());
    }
    assert!(by_name("ellipsoid", Precision::F64).is_none());
    let bytes = |name| by_name(name, Precision::F64).unwrap().bytes();
    assert_eq!(
        (bytes("triple-product"), bytes("triple-product-prepared")),
        (64, 88)
    );
}

#[test]
fn batch_digest_depends_on_the_answers() {
    let hit = problem(Caps::Both, [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let later = problem(Caps::Both, [4.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let miss = problem(Caps::Both, [3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    for formulation in all() {
        let digest = |problems: &[Problem]| formulation.batch(problems).run();
        assert_eq!(digest(&[miss]), 0);
        assert_ne!(digest(&[hit]), 0);
        assert_ne!(digest(&[hit, hit]), digest(&[hit, later]));
        assert_eq!(digest(&[hit, miss, later]), digest(&[hit, later]));
    }
}
