//! Rays in shared planes, along edges and through corners: regularised operations against
//! samples of what is around each point (`reference.rs`), and the rows of known answers.

use cyltrace::math::Random;
use cyltrace::solid::{Caps, Composition, Cone, Crossing, Location, Part, RoundedCone};
use glam::DVec3;

use super::reference::Reference;
use super::{at, cuboid, cylinder, intersections, intersections_in, sphere};
use Crossing::{Enter, Leave};

fn cone(p0: DVec3, p1: DVec3, radius0: f64, radius1: f64) -> Composition {
    let cone = Cone::new(p0, p1, radius0, radius1, Caps::Both).expect("a cone");
    Composition::Solid(cone.into())
}

fn difference(parts: Vec<Composition>) -> Composition {
    Composition::Difference(parts)
}

/// A block of 4 x 4 x 4 without the half with x > 0, cut by a block of the same width.
fn half() -> Composition {
    let block = |x: f64| cuboid(DVec3::X * x, DVec3::splat(2.0));
    difference(vec![block(0.0), block(2.0)])
}

/// A pipe whose bore is as long as it is.
fn bore() -> Composition {
    let along_z = |radius| cylinder(DVec3::ZERO, DVec3::Z * 2.0, radius);
    difference(vec![along_z(1.0), along_z(0.5)])
}

/// A bore of two pieces that end in one plane.
fn joint() -> Composition {
    let along_z = |z0: f64, z1: f64, radius| cylinder(DVec3::Z * z0, DVec3::Z * z1, radius);
    difference(vec![
        along_z(-1.0, 3.0, 1.0),
        along_z(-1.0, 1.0, 0.5),
        along_z(1.0, 3.0, 0.5),
    ])
}

/// Two boxes, one on the other.
fn stack() -> Composition {
    Composition::Union(vec![
        cuboid(DVec3::ZERO, DVec3::ONE),
        cuboid(DVec3::Z * 2.0, DVec3::ONE),
    ])
}

fn crossings(composition: &Composition, origin: DVec3, direction: DVec3) -> Vec<f64> {
    let met = intersections_in(composition, origin, direction, [0.0, f64::INFINITY]);
    met.iter().map(|met| met.intersection.t).collect()
}

#[test]
fn known_answers_of_rays_and_points_in_shared_planes() {
    let half = half();
    for (origin, direction, expected) in [
        (at(5.0, 2.0, 0.0), at(-1.0, 0.0, 0.0), vec![5.0, 7.0]),
        (at(5.0, 1.9999999, 0.0), at(-1.0, 0.0, 0.0), vec![5.0, 7.0]),
        (at(5.0, 2.0000001, 0.0), at(-1.0, 0.0, 0.0), vec![]),
        (at(5.0, 0.0, 2.0), at(-1.0, 0.0, 0.0), vec![5.0, 7.0]),
        (at(5.0, 2.0, 0.0), at(-1.0, 0.0, 0.1), vec![5.0, 7.0]),
        (at(1.0, 2.0, 5.0), at(0.0, 0.0, -1.0), vec![]),
    ] {
        assert_eq!(crossings(&half, origin, direction), expected, "{origin}");
    }
    for (point, expected) in [
        (at(2.0, 2.0, 0.0), Location::Outside),
        (at(1.0, 2.0, 0.0), Location::Outside),
        (at(0.0, 2.0, 0.0), Location::Boundary),
        (at(-1.0, 2.0, 0.0), Location::Boundary),
        (at(0.0, 0.0, 0.0), Location::Boundary),
        (at(-1.0, 0.0, 0.0), Location::Inside),
    ] {
        assert_eq!(half.locate(point), expected, "{point}");
    }
    let across = |composition: &Composition, z: f64, y: f64| {
        crossings(composition, at(-5.0, y, z), DVec3::X)
    };
    assert_eq!(across(&bore(), 2.0, 0.0), [4.0, 4.5, 5.5, 6.0]);
    assert_eq!(across(&bore(), 1.0, 0.0), [4.0, 4.5, 5.5, 6.0]);
    assert_eq!(across(&bore(), 2.0, 0.1).len(), 4);
    let joint = joint();
    assert_eq!(across(&joint, 1.0, 0.0), [4.0, 4.5, 5.5, 6.0]);
    assert_eq!(across(&joint, 1.0000001, 0.0), [4.0, 4.5, 5.5, 6.0]);
    assert_eq!(crossings(&joint, DVec3::Z, DVec3::X), [0.5, 1.0]);
    assert!(crossings(&joint, DVec3::Z, DVec3::Z).is_empty());
    let stack = stack();
    for (direction, expected) in [
        (at(1.0, 0.0, 0.0), 0.75),
        (at(1.0, 0.0, 0.5), 0.75),
        (at(0.0, 0.0, 1.0), 2.0),
    ] {
        assert_eq!(crossings(&stack, at(0.25, 0.0, 1.0), direction), [expected]);
    }
    assert_eq!(across(&stack, 1.0, 0.0), [4.0, 6.0]);
    let cylinders = Composition::Union(vec![
        cylinder(DVec3::ZERO, DVec3::Z, 1.0),
        cylinder(DVec3::Z, DVec3::Z * 2.0, 1.0),
    ]);
    assert_eq!(across(&cylinders, 1.0, 0.0), [4.0, 6.0]);
    assert_eq!(crossings(&cylinders, DVec3::Z, DVec3::Z), [1.0]);
}

#[test]
fn parts_and_normals_are_those_of_faces_that_are_there() {
    // At the rim of a bore that ends in a cap, its cap is no face, but its wall is.
    let bore = bore();
    let reported: Vec<_> = intersections(&bore, at(-5.0, 0.0, 2.0), DVec3::X)
        .iter()
        .map(|met| (met.intersection.part, met.leaf, met.intersection.crossing))
        .collect();
    let expected = [
        (Part::Cap1, 0, Enter),
        (Part::Side, 1, Leave),
        (Part::Side, 1, Enter),
        (Part::Cap1, 0, Leave),
    ];
    assert_eq!(reported, expected);
    // The first leaf ends where the second begins: of the set only the second is left, on the
    // outer side of the first.
    let [first, second] = [0.0, 2.0].map(|z| cuboid(DVec3::Z * z, DVec3::ONE));
    // Its box is not apart from that of the first.
    let apart = sphere(at(2.0, 2.0, 0.0), 1.25);
    let rest = Composition::Union(vec![Composition::Intersection(vec![first, apart]), second]);
    let met = intersections(&rest, at(0.25, 0.5, -5.0), DVec3::Z);
    assert_eq!((met[0].intersection.t, met[0].leaf), (6.0, 0));
    assert!(met[0].is_reversed);
    let surface = rest.surface(&met[0], |anchor| at(0.25, 0.5, 1.0) - anchor);
    assert_eq!(surface.normal, DVec3::NEG_Z);
}

#[test]
fn slivers_between_surfaces_that_touch_belong_to_the_set() {
    // The edges of this block touch the ball at (3, 4, 0): only there are block and
    // sphere together.
    let block = cuboid(DVec3::ZERO, at(3.0, 4.0, 1.0));
    let rest = difference(vec![block.clone(), sphere(DVec3::ZERO, 5.0)]);
    let touch = intersections(&rest, DVec3::ZERO, at(3.0, 4.0, 0.0));
    let touch: Vec<_> = touch.iter().map(|met| met.intersection.t).collect();
    assert_eq!(touch, [-1.0, -1.0, 1.0, 1.0]);
    assert_eq!(rest.locate(at(3.0, 4.0, 0.0)), Location::Boundary);
    let common = Composition::Intersection(vec![block, sphere(DVec3::ZERO, 5.0)]);
    assert_eq!(common.locate(at(3.0, 4.0, 0.0)), Location::Boundary);
    // A cylinder within another that touches it along a line, and one beside it.
    let outer = || cylinder(DVec3::ZERO, DVec3::Z * 4.0, 2.0);
    let inner = || cylinder(DVec3::X, DVec3::X + DVec3::Z * 4.0, 1.0);
    let beside = || cylinder(DVec3::X * 3.0, DVec3::X * 3.0 + DVec3::Z * 4.0, 1.0);
    let point = at(2.0, 0.0, 1.0);
    for (set, expected) in [
        (difference(vec![outer(), inner()]), Location::Boundary),
        (difference(vec![inner(), outer()]), Location::Outside),
        (
            Composition::Intersection(vec![outer(), beside()]),
            Location::Outside,
        ),
        (
            Composition::Union(vec![outer(), beside()]),
            Location::Boundary,
        ),
    ] {
        assert_eq!(set.locate(point), expected, "{set:?}");
        let along = intersections(&set, at(2.0, 0.0, -3.0), DVec3::Z);
        assert_eq!(along.len(), if expected.is_held() { 2 } else { 0 });
        let through = intersections(&set, at(2.0, -3.0, 1.0), DVec3::Y);
        assert_eq!(through.len(), if expected.is_held() { 2 } else { 0 });
    }
}

#[test]
fn walls_on_one_ruling_change_places_where_they_bend_alike() {
    // The cone has a slope of 3 to 4. The cylinder's axis is 5/2 inside of the ruling from
    // (3, 0, 0) to (0, 0, 4), and the cone's radius of curvature falls from 15/4 to 0 along it:
    // up to a third the cylinder is within the cone, from there on the cone is within the cylinder.
    let cone = || cone(DVec3::ZERO, DVec3::Z * 4.0, 3.0, 0.0);
    let cylinder = || cylinder(at(1.0, 0.0, -1.5), at(-2.0, 0.0, 2.5), 2.5);
    let (origin, direction) = (at(3.0, 0.0, 0.0), at(-3.0, 0.0, 4.0));
    let third = 1.0 / 3.0;
    for (set, expected) in [
        (difference(vec![cone(), cylinder()]), vec![0.0, third]),
        // Below its base the cylinder reaches past the cone.
        (
            difference(vec![cylinder(), cone()]),
            vec![0.0, 0.0, third, 1.0],
        ),
        (
            Composition::Intersection(vec![cone(), cylinder()]),
            vec![0.0, 1.0],
        ),
    ] {
        let met = intersections(&set, origin, direction);
        let along: Vec<_> = met.iter().map(|met| met.intersection.t).collect();
        assert_eq!(along.len(), expected.len(), "{set:?} {along:?}");
        for (t, expected) in along.iter().zip(expected) {
            assert!((t - expected).abs() < 1e-14, "{along:?}");
        }
    }
}

#[test]
fn seams_of_rounded_cones_bend_on_one_side() {
    let rounded = RoundedCone::new(DVec3::ZERO, DVec3::Z * 4.0, 1.0, 1.0).expect("a capsule");
    let capsule = || Composition::Solid(rounded.into());
    let wall = || cylinder(DVec3::ZERO, DVec3::Z * 4.0, 1.0);
    let block = cuboid(DVec3::X * 2.0, DVec3::ONE);
    let (seam, middle) = (DVec3::X, at(1.0, 0.0, 2.0));
    for (set, point, expected) in [
        (
            difference(vec![capsule(), wall()]),
            seam,
            Location::Boundary,
        ),
        (
            difference(vec![capsule(), wall()]),
            middle,
            Location::Outside,
        ),
        (difference(vec![wall(), capsule()]), seam, Location::Outside),
        (
            difference(vec![wall(), capsule()]),
            middle,
            Location::Outside,
        ),
        (
            Composition::Intersection(vec![capsule(), block.clone()]),
            seam,
            Location::Outside,
        ),
        (
            Composition::Union(vec![capsule(), block]),
            seam,
            Location::Boundary,
        ),
    ] {
        assert_eq!(set.locate(point), expected, "{set:?} {point}");
    }
    let ends = difference(vec![capsule(), wall()]);
    let along = intersections(&ends, at(1.0, 0.0, -3.0), DVec3::Z);
    let along: Vec<_> = along.iter().map(|met| met.intersection.t).collect();
    assert_eq!(along, [3.0, 3.0, 7.0, 7.0]);
}

/// A whole number below `end`.
fn below(random: &mut Random, end: u32) -> f64 {
    random.below(end.into()) as f64
}

/// A whole number near zero.
fn whole(random: &mut Random, reach: u32) -> f64 {
    below(random, 2 * reach + 1) - f64::from(reach)
}

fn whole_vector(random: &mut Random, reach: u32) -> DVec3 {
    let mut one = || whole(random, reach);
    at(one(), one(), one())
}

fn leaf(random: &mut Random) -> Composition {
    let size = |random: &mut Random| 1.0 + below(random, 3);
    let center = whole_vector(random, 2);
    let axis = DVec3::AXES[random.below(3) as usize] * size(random);
    match random.below(8) {
        0..=2 => cuboid(center, at(size(random), size(random), size(random))),
        3 | 4 => cylinder(center - axis, center + axis, size(random)),
        5 => {
            let radius1 = below(random, 3);
            cone(center - axis, center + axis, size(random), radius1)
        }
        6 => cone(center - axis, center + axis, 0.0, size(random)),
        _ => {
            let radius = [1.0, 2.0, 3.0, 5.0][random.below(4) as usize];
            sphere(center, radius)
        }
    }
}

fn tree(random: &mut Random, depth: u32) -> Composition {
    if depth == 0 {
        return leaf(random);
    }
    let parts = (0..2 + random.below(2))
        .map(|_| {
            let depth = random.below(depth.into()) as u32;
            tree(random, depth)
        })
        .collect();
    match random.below(3) {
        0 => Composition::Union(parts),
        1 => Composition::Intersection(parts),
        _ => Composition::Difference(parts),
    }
}

/// A tree that is not empty: a tenth of the lines meet it.
fn solid_tree(model: u64) -> Composition {
    let mut random = Random::new(71, model);
    loop {
        let set = tree(&mut random, 1 + model as u32 % 3);
        let is_met = |index: &u64| {
            let (through, direction) = line(&mut Random::new(72, *index));
            !intersections(&set, through, direction).is_empty()
        };
        if (0..100).filter(is_met).count() >= 10 {
            return set;
        }
    }
}

/// A line of whole numbers: in a plane, along an axis or through whole points.
fn line(random: &mut Random) -> (DVec3, DVec3) {
    let through = whole_vector(random, 4);
    let direction = match random.below(4) {
        0 => DVec3::AXES[random.below(3) as usize],
        1 | 2 => {
            let mut direction = whole_vector(random, 3);
            direction[random.below(3) as usize] = 0.0;
            direction
        }
        _ => whole_vector(random, 2),
    };
    let direction = if direction == DVec3::ZERO {
        DVec3::Y
    } else {
        direction
    };
    (through, direction)
}

fn rays() -> u64 {
    std::env::var("CYLTRACE_RAYS").map_or(1_000, |count| count.parse().expect("a number"))
}

fn models() -> u64 {
    std::env::var("CYLTRACE_MODELS").map_or(20, |count| count.parse().expect("a number"))
}

/// Every ray against the samples; what they agreed on.
fn compare(name: &str, composition: &Composition, seed: u64) -> [u64; 3] {
    let reference = Reference::new(composition);
    let [mut judged, mut met, mut touches] = [0; 3];
    for index in 0..rays() {
        let mut random = Random::new(seed, index);
        let (through, direction) = line(&mut random);
        let origin = through - direction * below(&mut random, 4);
        let Some(expected) = reference.crossings(origin, direction) else {
            continue;
        };
        judged += 1;
        let show = || format!("{name}: {composition:?}\n{origin} {direction}\n{expected:?}");
        let found = intersections(composition, origin, direction);
        let reported: Vec<_> = found
            .iter()
            .map(|met| (met.intersection.t, met.intersection.crossing))
            .collect();
        let is_same = reported.len() == expected.len()
            && reported
                .iter()
                .zip(&expected)
                .all(|(one, other)| one.1 == other.1 && (one.0 - other.0).abs() < 1e-9);
        assert!(is_same, "{}\nfound {reported:?}", show());
        for one in &found {
            let point = origin + direction * one.intersection.t;
            let part = one.intersection.part;
            let surface = composition.surface(one, |anchor| point - anchor);
            assert!(
                reference.has_face(point, one.leaf, part, surface.normal),
                "{}\n{one:?} {}",
                show(),
                surface.normal
            );
        }
        met += found.len() as u64;
        let pairs = found.windows(2);
        touches += pairs
            .filter(|pair| pair[0].intersection.t == pair[1].intersection.t)
            .count() as u64;
        // Points of the line, as stated.
        let t = below(&mut random, 17) - 8.0;
        let point = origin + direction * t;
        let located = composition.locate(point);
        assert_eq!(located, reference.locate(point), "{}\n{point}", show());
    }
    [judged, met, touches]
}

/// Named and random models, `CYLTRACE_MODELS` of these; every second one from `first` on.
fn compare_models(first: u64) {
    let mut sums = [0; 3];
    let mut add = |name: &str, set: &Composition, seed: u64| {
        let found = compare(name, set, seed);
        sums = std::array::from_fn(|i| sums[i] + found[i]);
    };
    let named = [half(), bore(), joint(), stack()];
    for (set, name) in named.iter().zip(["half", "bore", "joint", "stack"]) {
        add(name, set, 3 + first);
    }
    for model in (first..models()).step_by(2) {
        let set = solid_tree(model);
        add(&format!("model {model}"), &set, 1_000 + model);
    }
    let [judged, met, touches] = sums;
    println!("{judged} rays judged, {met} intersections, {touches} touches");
    assert!(met > judged / 2 && touches > judged / 100);
}

#[test]
fn rays_in_shared_planes_agree_with_samples() {
    compare_models(0);
}

#[test]
fn more_rays_in_shared_planes_agree_with_samples() {
    compare_models(1);
}
