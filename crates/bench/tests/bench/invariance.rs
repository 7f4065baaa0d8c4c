//! What must not change an answer, or not by more than is promised: powers of
//! two, mirrors, the order of axes and of ends, the ray's direction, and the
//! processor's mode for denormal numbers. The cases are the twenty families.

use std::fmt;
use std::hint::black_box;
use std::ops::RangeInclusive;

use cyltrace::embree::with_flushed_denormals;
use cyltrace::math::{Random, Ray, power_of_two};
use cyltrace::solid::exact::{self, ExactHit};
use cyltrace::solid::{Caps, Crossing, Cylinder, Intersection, Part, triple_product};
use cyltrace_bench::formulations::{Answer, Precision, Problem, by_name};
use cyltrace_bench::stress::{TrueAnswer, Witness, to_bits};
use cyltrace_oracle::cases::{Family, Inputs};
use glam::DVec3;
use rayon::prelude::*;

const SEED: u64 = 29;

/// What bounds the error of the triple product's `t`.
fn bound_of(truth: &TrueAnswer) -> f64 {
    truth.t_bound.expect("a cylinder has a bound")
}

/// Cases of each family and kind of inputs, where no oracle is asked and
/// where one is.
const CASES: u64 = 3_000;
const ORACLE_CASES: u64 = 1_000;

/// Calls `test` with every family and kind of inputs.
fn for_all_families(test: impl Fn(Family, Inputs) + Sync) {
    let kinds = Family::ALL.map(|family| Inputs::ALL.map(|inputs| (family, inputs)));
    let kinds = kinds.as_flattened();
    kinds
        .par_iter()
        .for_each(|&(family, inputs)| test(family, inputs));
}

/// A case and numbers to change it by; every third has the range of its
/// family, the others a whole line or a range whose ends are anywhere near.
fn case(family: Family, inputs: Inputs, index: u64) -> (Problem, Random) {
    let mut random = Random::new(SEED, 1 << 60 | index);
    let mut problem = family.case(SEED, index, inputs);
    let Problem { cylinder, ray } = &mut problem;
    let far = (ray.origin - cylinder.p0()).length() + (cylinder.p1() - cylinder.p0()).length();
    let reach = far / ray.direction.length();
    let range = match index % 3 {
        0 => [ray.t_min, ray.t_max],
        1 => [f64::NEG_INFINITY, f64::INFINITY],
        _ => [-1.0, 1.0].map(|side| side * reach * random.unit()),
    };
    [ray.t_min, ray.t_max] = range;
    (problem, random)
}

/// A number that is compared bit by bit, the sign of a zero included.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Bits(u64);

impl Bits {
    fn of(x: f64) -> Self {
        Self(x.to_bits())
    }
}

impl fmt::Debug for Bits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e} ({:#018x})", f64::from_bits(self.0), self.0)
    }
}

/// All that the library's solvers say of a case.
#[derive(Debug, PartialEq, Eq)]
struct Sayings {
    triple_product: Vec<(Bits, Part, Crossing)>,
    prepared: Option<(Bits, Part)>,
    /// With `t` as found, and rounded correctly.
    exact: Option<(Bits, Bits, Part, Crossing)>,
}

impl Sayings {
    /// Those of a problem, with every `t` times `unit`, a power of two.
    fn of(problem: &Problem, unit: f64) -> Self {
        let t = |t: f64| Bits::of(t * unit);
        let prepared = answer("triple-product-prepared", problem);
        let exact = exactly(problem).map(|hit| {
            let rounded = exact::rounded_t(&problem.cylinder, &problem.ray, &hit);
            (t(hit.t), t(rounded), hit.part, hit.crossing)
        });
        Self {
            triple_product: intersections(problem)
                .iter()
                .map(|one| (t(one.t), one.part, one.crossing))
                .collect(),
            prepared: prepared.map(|answer| (t(answer.t), answer.part)),
            exact,
        }
    }
}

fn intersections(problem: &Problem) -> Vec<Intersection> {
    let Problem { cylinder, ray } = problem;
    let chord = triple_product::chord(cylinder, ray.origin - cylinder.p0(), ray.direction);
    let intersections =
        chord.map(|chord| chord.intersections(cylinder.caps(), 0.0, ray.t_min, ray.t_max));
    intersections.into_iter().flatten().collect()
}

fn answer(formulation: &str, problem: &Problem) -> Option<Answer> {
    let formulation = by_name(formulation, Precision::F64).expect("a known name");
    formulation.answers(&[*problem])[0]
}

fn exactly(problem: &Problem) -> Option<ExactHit> {
    exact::first(&problem.cylinder, &problem.ray).0
}

/// The problem with every vector changed, and every `t` of the range times
/// `unit`.
fn changed(problem: &Problem, length: f64, unit: f64, change: impl Fn(DVec3) -> DVec3) -> Problem {
    let Problem { cylinder, ray } = problem;
    let point = |v| change(v) * length;
    let (p0, p1) = (point(cylinder.p0()), point(cylinder.p1()));
    let cylinder = Cylinder::new(p0, p1, cylinder.radius() * length, cylinder.caps());
    Problem {
        cylinder: cylinder.expect("a cylinder in range"),
        ray: Ray {
            origin: point(ray.origin),
            direction: change(ray.direction) * (length / unit),
            t_min: ray.t_min * unit,
            t_max: ray.t_max * unit,
        },
    }
}

/// The exponent of the greatest power of two that is not above `x`.
fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52 & 0x7ff) as i32 - 1023
}

/// The exponents of the powers of two by which lengths, and the direction, may
/// be scaled such that they stay in the ranges of [`Cylinder`] and of
/// [`triple_product::chord`].
fn room(problem: &Problem) -> [RangeInclusive<i32>; 2] {
    let Problem { cylinder, ray } = problem;
    let (p0, p1, r) = (cylinder.p0(), cylinder.p1(), cylinder.radius());
    let farthest = p0.abs().max(p1.abs()).max(ray.origin.abs());
    let greatest = farthest.max_element().max(r);
    let least = (p1 - p0).length().min(r);
    let speed = exponent(ray.direction.abs().max_element());
    let lengths = -150 - exponent(least)..=149 - exponent(greatest);
    [lengths, -100 - speed..=99 - speed]
}

/// The problem at the least, at the greatest or at any size that lengths and
/// directions may have, and what `t` is to be multiplied with in turn.
fn scaled(problem: &Problem, random: &mut Random) -> (Problem, f64) {
    let [length, speed] = room(problem).map(|room| match random.below(4) {
        0 => *room.start(),
        1 => *room.end(),
        _ => room.start() + random.below((room.end() - room.start() + 1) as u64) as i32,
    });
    let unit = power_of_two(length - speed);
    (changed(problem, power_of_two(length), unit, |v| v), unit)
}

/// That all solvers say the same of a case and of what becomes of it, up to
/// the unit of `t`.
fn assert_same_bits(what: &str, change: impl Fn(&Problem, &mut Random) -> (Problem, f64) + Sync) {
    for_all_families(|family, inputs| {
        for index in 0..CASES {
            let (problem, mut random) = case(family, inputs, index);
            let (other, unit) = change(&problem, &mut random);
            assert_eq!(
                Sayings::of(&other, 1.0 / unit),
                Sayings::of(&problem, 1.0),
                "{what}, {} {}, seed {SEED}, case {index}: {} of {}",
                family.name(),
                inputs.name(),
                to_bits(&other),
                to_bits(&problem)
            );
        }
    });
}

#[test]
fn powers_of_two_scale_answers_exactly() {
    assert_same_bits("scaled", scaled);
}

#[test]
fn direction_scaled_by_powers_of_two_scales_t_exactly() {
    assert_same_bits("direction scaled", |problem, random| {
        let [_, speed] = room(problem);
        let exponents = (speed.end() - speed.start() + 1) as u64;
        let unit = 1.0 / power_of_two(speed.start() + random.below(exponents) as i32);
        (changed(problem, 1.0, unit, |v| v), unit)
    });
}

#[test]
fn mirrored_scenes_have_the_same_bits() {
    assert_same_bits("mirrored", |problem, random| {
        let signs = 1 + random.below(7);
        let sign = |axis: u32| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
        let mirror = DVec3::new(sign(0), sign(1), sign(2));
        (changed(problem, 1.0, 1.0, |v| v * mirror), 1.0)
    });
}

/// The problem with its axes in another order.
fn permuted(problem: &Problem, random: &mut Random) -> Problem {
    const ORDERS: [[usize; 3]; 5] = [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let order = ORDERS[random.below(5) as usize];
    changed(problem, 1.0, 1.0, |v| {
        DVec3::from_array(order.map(|axis| v[axis]))
    })
}

/// The problem with the names of the ends exchanged.
fn swapped(problem: &Problem) -> Problem {
    let cylinder = &problem.cylinder;
    let caps = match cylinder.caps() {
        Caps::P0 => Caps::P1,
        Caps::P1 => Caps::P0,
        same => same,
    };
    let (p0, p1, radius) = (cylinder.p0(), cylinder.p1(), cylinder.radius());
    Problem {
        cylinder: Cylinder::new(p1, p0, radius, caps).expect("the same cylinder"),
        ray: problem.ray,
    }
}

/// What the part is called once the ends are exchanged.
fn other_end(part: Part) -> Part {
    match part {
        Part::Side => Part::Side,
        Part::Cap0 => Part::Cap1,
        Part::Cap1 => Part::Cap0,
        part => panic!("a cylinder has no part {}", part.name()),
    }
}

/// One disk or the other, or none or both.
fn with_any_caps(problem: &Problem, random: &mut Random) -> Problem {
    let one = &problem.cylinder;
    let caps = [one.caps(), Caps::P0, Caps::P1, Caps::None][random.below(4) as usize];
    let cylinder = Cylinder::new(one.p0(), one.p1(), one.radius(), caps);
    Problem {
        cylinder: cylinder.expect("the same cylinder"),
        ray: problem.ray,
    }
}

#[test]
fn exact_answers_ignore_the_order_of_axes_and_of_ends() {
    for_all_families(|family, inputs| {
        for index in 0..CASES {
            let (problem, mut random) = case(family, inputs, index);
            let problem = with_any_caps(&problem, &mut random);
            let said = |problem: &Problem, name: fn(Part) -> Part| {
                exactly(problem).map(|hit| {
                    let t = exact::rounded_t(&problem.cylinder, &problem.ray, &hit);
                    (Bits::of(t), name(hit.part), hit.crossing)
                })
            };
            let expected = said(&problem, |part| part);
            let case = |what: &str| {
                let name = family.name();
                let word = to_bits(&problem);
                format!("{what}, {name} {}, case {index}: {word}", inputs.name())
            };
            let order = permuted(&problem, &mut random);
            assert_eq!(said(&order, |part| part), expected, "{}", case("permuted"));
            let ends = swapped(&problem);
            assert_eq!(said(&ends, other_end), expected, "{}", case("swapped"));
        }
    });
}

/// A case as the oracle and the solver see it.
struct Judged {
    witness: Witness,
    found: Vec<Intersection>,
}

impl Judged {
    /// Holds the library's promise about the first hit, where it gives one.
    fn new(problem: Problem, index: u64, inputs: Inputs, what: &str) -> Self {
        let witness = Witness::new(problem.into(), index, inputs);
        let found = intersections(&problem);
        if witness.is_decided() {
            let case = || format!("{what}, case {index}: {}", to_bits(&problem));
            let truth = witness.truth.as_ref();
            assert_eq!(
                found.first().map(|one| one.part),
                truth.map(|truth| truth.part),
                "{}",
                case()
            );
            if let (Some(one), Some(truth)) = (found.first(), truth) {
                let off = truth.error_of(one.t).abs();
                assert!(off <= bound_of(truth), "{off:e}, {truth:?}, {}", case());
            }
        }
        Self { witness, found }
    }

    /// The bound of the first hit's error.
    fn t_bound(&self) -> f64 {
        self.witness.truth.map_or(0.0, |truth| bound_of(&truth))
    }
}

/// That the triple-product solver keeps its promise about a case and about what
/// becomes of it, and that `agree` says so of the two where it promises both.
fn assert_promised(
    what: &str,
    change: impl Fn(&Problem, &mut Random) -> [Problem; 2] + Sync,
    agree: impl Fn(&Judged, &Judged) -> bool + Sync,
) {
    for_all_families(|family, inputs| {
        let mut decided = 0;
        for index in 0..ORACLE_CASES {
            let mut random = Random::new(SEED, 1 << 60 | index);
            let drawn = family.case(SEED, index, inputs);
            let name = format!("{what}, {} {}, seed {SEED}", family.name(), inputs.name());
            let both = change(&drawn, &mut random)
                .map(|problem| Judged::new(problem, index, inputs, &name));
            let [one, other] = &both;
            if one.witness.is_decided() && other.witness.is_decided() {
                decided += 1;
                assert!(
                    agree(one, other),
                    "{name}, case {index}: {:?} and {:?} of {}",
                    one.found,
                    other.found,
                    to_bits(&drawn)
                );
            }
        }
        // With numbers of full length these are within roundings of a tangent, of the
        // start of their range, and of a rim.
        let is_open = matches!(
            family,
            Family::Tangent | Family::SurfaceIn | Family::ExactRim
        );
        assert!(
            decided > ORACLE_CASES * 9 / 10 || (is_open && inputs == Inputs::F64),
            "{what}, {} {}: only {decided} cases are promised",
            family.name(),
            inputs.name()
        );
    });
}

/// Whether the first hits of both are the same within their bounds, parts
/// going by `name` in the second.
fn same_first(one: &Judged, other: &Judged, name: fn(Part) -> Part) -> bool {
    match (one.found.first(), other.found.first()) {
        (None, None) => true,
        (Some(found), Some(again)) => {
            (found.part, found.crossing) == (name(again.part), again.crossing)
                && (found.t - again.t).abs() <= one.t_bound() + other.t_bound()
        }
        _ => false,
    }
}

#[test]
fn answers_in_any_order_of_axes_are_as_promised() {
    assert_promised(
        "permuted",
        |problem, random| [*problem, permuted(problem, random)],
        |one, other| same_first(one, other, |part| part),
    );
}

#[test]
fn answers_with_ends_exchanged_are_as_promised() {
    assert_promised(
        "swapped",
        |problem, random| {
            let problem = with_any_caps(problem, random);
            [problem, swapped(&problem)]
        },
        |one, other| same_first(one, other, other_end),
    );
}

#[test]
fn rays_reversed_meet_the_same_points_from_the_other_end() {
    assert_promised(
        "reversed",
        |problem, random| {
            let mut problem = *problem;
            let ray = &mut problem.ray;
            let from_p0 = ray.origin - problem.cylinder.p0();
            let chord = triple_product::chord(&problem.cylinder, from_p0, ray.direction);
            // A ray within the surface is met at the start of its range, which
            // is not the start of the other.
            if random.below(2) == 0 || chord.is_some_and(|chord| chord.lies_on.is_some()) {
                ray.t_min = f64::NEG_INFINITY;
            }
            let reversed = Ray {
                direction: -ray.direction,
                t_min: -ray.t_max,
                t_max: -ray.t_min,
                ..*ray
            };
            [
                problem,
                Problem {
                    ray: reversed,
                    ..problem
                },
            ]
        },
        |one, other| {
            let bounds = [one.t_bound(), other.t_bound()];
            one.found.len() == other.found.len()
                && one
                    .found
                    .iter()
                    .zip(other.found.iter().rev())
                    .enumerate()
                    .all(|(number, (found, again))| {
                        // The first of one is the last of the other.
                        let bound = match one.found.len() {
                            1 => bounds[0] + bounds[1],
                            _ => 2.0 * bounds[number],
                        };
                        found.part == again.part
                            && found.crossing != again.crossing
                            && (found.t + again.t).abs() <= bound
                    })
        },
    );
}

/// Everything that is said of a case, normals included, as text.
fn everything(problem: &Problem) -> String {
    let problem = black_box(problem);
    let names = [
        "triple-product",
        "triple-product-prepared",
        "exact",
        "exact-rounded",
    ];
    let answers = names.map(|name| {
        answer(name, problem).map(|found| {
            let normal = found.normal.to_array().map(Bits::of);
            (Bits::of(found.t), found.part, normal)
        })
    });
    format!("{answers:?} {:?}", Sayings::of(problem, 1.0))
}

/// The case at the least sizes, at which products come nearest to the least
/// normal number, and as it was drawn.
#[test]
fn denormal_numbers_flushed_or_not_answers_have_the_same_bits() {
    for_all_families(|family, inputs| {
        for index in 0..CASES {
            let (problem, mut random) = case(family, inputs, index);
            let [length, speed] = room(&problem).map(|room| *room.start());
            let unit = power_of_two(length - speed);
            let least = changed(&problem, power_of_two(length), unit, |v| v);
            let (any, _) = scaled(&problem, &mut random);
            for problem in [problem, least, any] {
                let expected = everything(&problem);
                let (flushed, is_flushing) = with_flushed_denormals(|| {
                    let half = black_box(f64::MIN_POSITIVE) * black_box(0.5);
                    (everything(&problem), half == 0.0)
                });
                assert!(is_flushing, "the mode was not set");
                assert_eq!(
                    flushed,
                    expected,
                    "{} {}, case {index}: {}",
                    family.name(),
                    inputs.name(),
                    to_bits(&problem)
                );
            }
        }
    });
}

/// Rays at 2^-90 to 2^-99 to a cylinder of the least size, within a few ulps of
/// touching its wall: `r² |n|²` is then just above the least normal number, and
/// `D` below it. Such a tangent is nothing that the triple-product solver
/// promises, and it does answer by the mode; the exact one must not.
#[test]
fn denormal_discriminants_flushed_or_not_exact_answers_have_the_same_bits() {
    let mut hits = 0;
    for index in 0..CASES {
        let mut random = Random::new(SEED, 2 << 60 | index);
        let mut size = |exponent: i32, spread: u64| {
            let exponent = exponent + random.below(spread) as i32;
            power_of_two(exponent) * random.uniform(1.0, 2.0)
        };
        let (radius, length, speed) = (size(-150, 1), size(-150, 5), size(-100, 3));
        let (dx, dy) = (size(-99, 10), size(-99, 10));
        let ulps = 4.0 - random.below(9) as f64;
        let across = DVec3::new(-dy, dx, 0.0).normalize() * (1.0 + ulps * f64::EPSILON);
        let origin = across * radius + DVec3::Z * (length * random.uniform(-1.0, 1.0));
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * length, radius, Caps::Both);
        let problem = Problem {
            cylinder: cylinder.expect("a cylinder in range"),
            ray: Ray {
                t_min: f64::NEG_INFINITY,
                ..Ray::new(origin, DVec3::new(dx, dy, 1.0) * speed)
            },
        };
        let expected = Sayings::of(&problem, 1.0).exact;
        let flushed = with_flushed_denormals(|| Sayings::of(black_box(&problem), 1.0).exact);
        assert_eq!(flushed, expected, "case {index}: {}", to_bits(&problem));
        hits += u64::from(expected.is_some());
    }
    assert!((CASES / 4..CASES * 3 / 4).contains(&hits), "{hits} hits");
}
