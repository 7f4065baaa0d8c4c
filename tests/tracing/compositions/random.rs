//! Random trees of operations, and the mouths of bores.

use cyltrace::math::{Orientation, Random};
use cyltrace::solid::{ComposedIntersection, Composition, Crossing};
use glam::DVec3;

use super::{at, cylinder, intersections, turned_cuboid};
use Crossing::{Enter, Leave};
use test_support::trees::{draw_solid, draw_tree, holds};

const SEED: u64 = 61;

pub fn cases() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(20_000, |count| count.parse().expect("a number"))
}

/// Below this distance along a ray, points are not asked about: their own rounding
/// is 1e-15, and grazing rays leave a surface slowly.
const THIN: f64 = 1e-6;

/// What was found in many random cases.
#[derive(Default)]
struct Figures {
    cases: u64,
    points: u64,
    inside: u64,
    intersections: usize,
    most: usize,
    films: u64,
}

/// Random trees and rays, each checked for everything.
fn run(is_coarse: bool, is_turned: bool, stream: u64) -> Figures {
    let mut figures = Figures::default();
    for index in 0..cases() {
        let mut random = Random::new(SEED + stream, index);
        let turn = if is_turned {
            let axis = random.direction();
            Orientation::IDENTITY.rotated(axis, random.uniform(0.0, 360.0))
        } else {
            Orientation::IDENTITY
        };
        let tree = draw_tree(&mut random, 3, &mut |random| {
            draw_solid(random, is_coarse, turn)
        });
        let direction = random.direction() * random.log_uniform(0.1, 10.0);
        let through = random.direction() * random.unit() * 2.0;
        let origin = through - direction * (random.uniform(0.0, 4.0) / direction.length());
        check(&tree, origin, direction, &mut figures);
    }
    figures
}

fn check(tree: &Composition, origin: DVec3, direction: DVec3, figures: &mut Figures) {
    let show = || format!("{tree:?}\n{origin:?} {direction:?}");
    let all = intersections(tree, origin, direction);
    // Entries and exits alternate, in order, numbered.
    for (position, met) in all.iter().enumerate() {
        let crossing = if position % 2 == 0 { Enter } else { Leave };
        assert_eq!(met.intersection.crossing, crossing, "{}", show());
        assert_eq!(met.rank as usize, position + 1, "{}", show());
    }
    assert!(all.len().is_multiple_of(2), "{}", show());
    assert!(
        all.is_sorted_by(|one, other| one.intersection.t <= other.intersection.t),
        "{}",
        show()
    );
    figures.films += all
        .windows(2)
        .filter(|pair| {
            (pair[1].intersection.t - pair[0].intersection.t) * direction.length() < 1e-11
        })
        .count() as u64;
    // The other way round it is the same.
    let reversed = intersections(tree, origin, -direction);
    let turned: Vec<_> = reversed
        .iter()
        .rev()
        .map(|met| (-met.intersection.t, met.intersection.part, met.leaf))
        .collect();
    let forward: Vec<_> = all
        .iter()
        .map(|met| (met.intersection.t, met.intersection.part, met.leaf))
        .collect();
    assert_eq!(forward, turned, "{}", show());
    // The crossings have the bits of the leaves.
    let operands = tree.operands();
    let mut ends = Vec::new();
    for operand in &operands {
        let x = origin - operand.solid.anchor();
        if let Some(chord) = operand.solid.chord(x, direction) {
            ends.extend([chord.enter.t, chord.leave.t]);
        }
    }
    let of_leaves = |met: &ComposedIntersection| ends.contains(&met.intersection.t);
    assert!(all.iter().all(of_leaves), "{}", show());
    // Between any two ends the ray is where exact membership says.
    ends.sort_by(f64::total_cmp);
    for pair in ends.windows(2) {
        let (length, t) = (
            (pair[1] - pair[0]) * direction.length(),
            (pair[0] + pair[1]) / 2.0,
        );
        if length > THIN {
            let point = origin + direction * t;
            let passed = all.iter().filter(|met| met.intersection.t < t).count();
            assert_eq!(passed % 2 == 1, holds(tree, point), "{}\nat {t}", show());
            assert_eq!(passed % 2 == 1, tree.contains(point), "{}\nat {t}", show());
            figures.points += 1;
            figures.inside += u64::from(passed % 2 == 1);
        }
    }
    figures.cases += 1;
    figures.intersections += all.len();
    figures.most = figures.most.max(all.len());
}

fn print(name: &str, figures: &Figures) {
    println!(
        "{name}: {} cases, {} points ({} inside), {} intersections, at most {} a ray, {} films",
        figures.cases,
        figures.points,
        figures.inside,
        figures.intersections,
        figures.most,
        figures.films
    );
    assert!(figures.inside > figures.cases / 10 && figures.most >= 8);
}

#[test]
fn random_trees_agree_with_membership() {
    print("any", &run(false, false, 0));
}

#[test]
fn trees_with_common_faces_agree_and_have_no_films() {
    for (is_turned, stream) in [(false, 1), (true, 2)] {
        let figures = run(true, is_turned, stream);
        print(if is_turned { "turned" } else { "coarse" }, &figures);
        assert_eq!(figures.films, 0);
    }
}

#[test]
fn mouth_of_a_turned_bore_is_open() {
    // No ray that comes out of the bore's mouth may meet anything there.
    let mut open = 0;
    for index in 0..cases() {
        let mut random = Random::new(SEED, index);
        let offset = random.direction() * random.log_uniform(0.1, 1e6);
        let turn = Orientation::IDENTITY.rotated(random.direction(), random.uniform(0.0, 360.0));
        let place = |point: DVec3| offset + turn.to_world(point);
        let block = turned_cuboid(offset, at(2.0, 2.0, 1.0), turn);
        let bore = cylinder(place(DVec3::NEG_Z), place(DVec3::Z), 1.0);
        let drilled = Composition::Difference(vec![block, bore]);
        let mouth = at(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 1.0);
        let down = at(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), -1.0);
        let (through, direction) = (place(mouth), turn.to_world(down));
        let far = random.log_uniform(0.01, 1e3);
        let met = intersections(&drilled, through - direction * far, direction);
        for intersection in &met {
            let from_mouth = (intersection.intersection.t - far) * direction.length();
            assert!(
                from_mouth.abs() > 1e-3,
                "{from_mouth:e} {offset} {direction}"
            );
        }
        open += 1;
    }
    assert_eq!(open, cases());
}
