//! Set operations of solids: what a line meets of them, against exact membership of
//! the leaves.
//!
//! `CYLTRACE_CASES=1000000 cargo test --release --test tracing compositions` is the full run.

mod in_plane;
mod random;
mod reference;
mod wedges;

use cyltrace::math::{Orientation, power_of_two};
use cyltrace::solid::{
    AnySolid, Caps, ComposedIntersection, Composition, Cone, Crossing, Cuboid, Cylinder, Location,
    Part, RoundedCone, SolidKind, Sphere,
};
use glam::DVec3;

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn cylinder(p0: DVec3, p1: DVec3, radius: f64) -> Composition {
    let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).expect("a cylinder");
    Composition::Solid(cylinder.into())
}

fn sphere(center: DVec3, radius: f64) -> Composition {
    Composition::Solid(Sphere::new(center, radius).expect("a sphere").into())
}

fn cuboid(center: DVec3, half_widths: DVec3) -> Composition {
    turned_cuboid(center, half_widths, Orientation::IDENTITY)
}

fn turned_cuboid(center: DVec3, half_widths: DVec3, orientation: Orientation) -> Composition {
    let cuboid = Cuboid::new(center, half_widths, orientation).expect("a cuboid");
    Composition::Solid(cuboid.into())
}

fn intersections_in(
    composition: &Composition,
    origin: DVec3,
    direction: DVec3,
    range: [f64; 2],
) -> Vec<ComposedIntersection> {
    let mut all = Vec::new();
    let from = |anchor| origin - anchor;
    composition.intersections(from, direction, 0.0, range, |met| all.push(met));
    let first = composition.first(from, direction, 0.0, range);
    assert_eq!(
        first,
        all.first().copied(),
        "{composition:?} {origin} {direction}"
    );
    all
}

fn intersections(
    composition: &Composition,
    origin: DVec3,
    direction: DVec3,
) -> Vec<ComposedIntersection> {
    intersections_in(composition, origin, direction, ALL)
}

/// What is told of intersections in a table.
fn told(intersections: &[ComposedIntersection]) -> Vec<(f64, Crossing, Part, u32)> {
    let all = intersections.iter();
    all.map(|met| {
        (
            met.intersection.t,
            met.intersection.crossing,
            met.intersection.part,
            met.leaf,
        )
    })
    .collect()
}

use Crossing::{Enter, Leave};

/// A block of 4 x 4 x 2 with a bore along z that ends in its faces.
fn drilled_block() -> Composition {
    let block = cuboid(DVec3::ZERO, at(2.0, 2.0, 1.0));
    let bore = cylinder(at(0.0, 0.0, -1.0), at(0.0, 0.0, 1.0), 1.0);
    Composition::Difference(vec![block, bore])
}

#[test]
fn drilled_block_is_met_as_it_looks() {
    let block = drilled_block();
    assert_eq!(block.kind(), SolidKind::Difference);
    let across = intersections(&block, at(-5.0, 0.0, 0.5), DVec3::X);
    let expected = [
        (3.0, Enter, Part::XMin, 0),
        (4.0, Leave, Part::Side, 1),
        (6.0, Enter, Part::Side, 1),
        (7.0, Leave, Part::XMax, 0),
    ];
    assert_eq!(told(&across), expected);
    let normals: Vec<_> = across
        .iter()
        .map(|met| {
            let on_ray = at(-5.0, 0.0, 0.5) + DVec3::X * met.intersection.t_local;
            let surface = block.surface(met, |anchor| on_ray - anchor);
            assert_eq!(surface.point, on_ray);
            surface.normal
        })
        .collect();
    assert_eq!(normals, [DVec3::NEG_X, DVec3::X, DVec3::NEG_X, DVec3::X]);
    // Down the hole, also along its wall's rim; beside it.
    assert_eq!(intersections(&block, at(0.2, 0.3, 9.0), DVec3::NEG_Z), []);
    let beside = intersections(&block, at(1.5, 0.0, 9.0), DVec3::NEG_Z);
    let expected = [(8.0, Enter, Part::ZMax, 0), (10.0, Leave, Part::ZMin, 0)];
    assert_eq!(told(&beside), expected);
    // In at the mouth and out through the wall.
    let slanted = intersections(&block, at(0.0, 0.0, 2.0), at(1.0, 0.0, -1.5));
    assert_eq!(told(&slanted)[0], (1.0, Enter, Part::Side, 1));
    // Ranges choose of the same intersections.
    let origin = at(-5.0, 0.0, 0.5);
    for (range, expected) in [
        ([3.5, 9.0], &across[1..]),
        ([0.0, 6.0], &across[..3]),
        ([4.5, 5.5], &across[..0]),
        ([6.0, 6.0], &across[2..3]),
    ] {
        assert_eq!(intersections_in(&block, origin, DVec3::X, range), expected);
    }
}

#[test]
fn points_are_where_the_operations_say() {
    let block = drilled_block();
    for (point, expected) in [
        (at(1.5, 0.0, 0.0), Location::Inside),
        (at(0.5, 0.0, 0.0), Location::Outside),
        (at(1.0, 0.0, 0.0), Location::Boundary),
        (at(1.0_f64.next_up(), 0.0, 0.0), Location::Inside),
        (at(1.0_f64.next_down(), 0.0, 0.0), Location::Outside),
        (at(2.0, 1.0, 1.0), Location::Boundary),
        (at(2.0_f64.next_up(), 1.0, 1.0), Location::Outside),
        (at(f64::NAN, 0.0, 0.0), Location::Outside),
    ] {
        assert_eq!(block.locate(point), expected, "{point}");
        assert_eq!(block.contains(point), expected != Location::Outside);
    }
    let lens =
        Composition::Intersection(vec![sphere(DVec3::ZERO, 5.0), sphere(DVec3::X * 8.0, 5.0)]);
    assert_eq!(lens.locate(at(4.0, 3.0, 0.0)), Location::Boundary);
    assert_eq!(lens.locate(at(4.0, 2.0, 0.0)), Location::Inside);
    let both = Composition::Union(vec![sphere(DVec3::ZERO, 5.0), sphere(DVec3::X * 8.0, 5.0)]);
    assert_eq!(both.locate(at(13.0, 0.0, 0.0)), Location::Boundary);
    assert_eq!(both.locate(at(3.0, 0.0, 0.0)), Location::Inside);
    let cone = Cone::new(DVec3::ZERO, DVec3::Z * 4.0, 4.0, 0.0, Caps::Both).expect("a cone");
    let rounded = RoundedCone::new(DVec3::ZERO, DVec3::Z * 5.0, 4.0, 1.0).expect("a hull");
    for (solid, point, expected) in [
        (AnySolid::from(cone), at(0.0, 0.0, 4.0), Location::Boundary),
        (cone.into(), at(3.0, 0.0, 0.5), Location::Inside),
        (cone.into(), at(3.0, 0.0, 1.0), Location::Boundary),
        (cone.into(), at(1.0, 0.0, 0.0), Location::Boundary),
        (rounded.into(), at(0.0, 0.0, 6.0), Location::Boundary),
        (rounded.into(), at(0.0, 0.0, -4.0), Location::Boundary),
        (rounded.into(), at(0.0, 0.0, 2.4), Location::Inside),
        (rounded.into(), at(0.0, 4.0, -0.5), Location::Outside),
    ] {
        assert_eq!(solid.locate(point), expected, "{solid:?} {point}");
    }
}

#[test]
fn tangents_are_two_intersections_also_of_holes() {
    let pipe = Composition::Difference(vec![
        cylinder(DVec3::ZERO, DVec3::Z * 8.0, 3.0),
        cylinder(DVec3::ZERO, DVec3::Z * 8.0, 1.0),
    ]);
    let touched = told(&intersections(&pipe, at(-10.0, 1.0, 4.0), DVec3::X));
    let half = 8.0_f64.sqrt();
    let expected = [
        (10.0 - half, Enter, Part::Side, 0),
        (10.0, Leave, Part::Side, 1),
        (10.0, Enter, Part::Side, 1),
        (10.0 + half, Leave, Part::Side, 0),
    ];
    assert_eq!(touched, expected);
    let outside = told(&intersections(&pipe, at(-10.0, 3.0, 4.0), DVec3::X));
    let expected = [(10.0, Enter, Part::Side, 0), (10.0, Leave, Part::Side, 0)];
    assert_eq!(outside, expected);
    // Of a union too, but not where the other part is.
    let (ball, block) = (sphere(DVec3::ZERO, 1.0), cuboid(DVec3::X * 5.0, DVec3::ONE));
    let union = Composition::Union(vec![ball.clone(), block]);
    let touched = told(&intersections(&union, at(-2.0, 0.0, 1.0), DVec3::X));
    assert_eq!(
        touched[..2],
        [(2.0, Enter, Part::Side, 0), (2.0, Leave, Part::Side, 0)]
    );
    let hidden = Composition::Union(vec![ball.clone(), cuboid(DVec3::ZERO, DVec3::splat(2.0))]);
    assert_eq!(
        intersections(&hidden, at(-4.0, 0.0, 1.0), DVec3::X).len(),
        2
    );
    // A point of an intersection that is touched by one and inside of the other.
    let common = Composition::Intersection(vec![cuboid(DVec3::ZERO, DVec3::splat(2.0)), ball]);
    let touched = told(&intersections(&common, at(-4.0, 0.0, 1.0), DVec3::X));
    assert_eq!(
        touched,
        [(4.0, Enter, Part::Side, 1), (4.0, Leave, Part::Side, 1)]
    );
}

#[test]
fn intersection_with_an_empty_box_is_empty() {
    // The needle ends 2^-62 before the plane x = 0, where the drum begins.
    let tiny = power_of_two(-61);
    let tip = DVec3::splat(-tiny);
    let needle = || cylinder(at(-0.0625, 1.375, 1.375), tip, tiny);
    let drum = || cylinder(DVec3::ZERO, DVec3::X, 1.0);
    let apart = Composition::Intersection(vec![drum(), needle(), drum()]);
    assert!(apart.bounds().is_empty());
    let ball = || sphere(DVec3::X * 9.0, 1.0);
    let beside = Composition::Union(vec![ball(), apart.clone()]);
    let bitten = Composition::Difference(vec![ball(), apart.clone()]);
    let both = Composition::Intersection(vec![apart.clone(), drum()]);
    for origin in [DVec3::ZERO, tip, tip * 0.5] {
        for direction in [DVec3::X, DVec3::Y, DVec3::ONE, at(-0.0625, 1.375, 1.375)] {
            for empty in [&apart, &both] {
                assert_eq!(
                    intersections(empty, origin, direction),
                    [],
                    "{origin} {direction}"
                );
            }
            let alone = intersections(&ball(), origin, direction).len();
            for solid in [&beside, &bitten] {
                let found = intersections(solid, origin, direction);
                assert_eq!(found.len(), alone, "{origin} {direction}");
            }
        }
    }
}

#[test]
fn nothing_of_no_length_is_left() {
    let block = || cuboid(DVec3::ZERO, DVec3::ONE);
    let beside = || cuboid(DVec3::X * 2.0, DVec3::ONE);
    let apart = || cuboid(DVec3::X * 9.0, DVec3::ONE);
    for empty in [
        Composition::Difference(vec![block(), block()]),
        Composition::Difference(vec![block(), cuboid(DVec3::ZERO, DVec3::splat(3.0))]),
        Composition::Intersection(vec![block(), beside()]),
        Composition::Intersection(vec![block(), apart()]),
        Composition::Difference(vec![
            Composition::Union(vec![block(), beside()]),
            Composition::Union(vec![block(), beside()]),
        ]),
        Composition::Union(Vec::new()),
        Composition::Intersection(Vec::new()),
        Composition::Difference(Vec::new()),
    ] {
        for direction in [DVec3::X, at(1.0, 0.1, 0.03), at(1.0, 0.0, 1e-9)] {
            assert_eq!(
                intersections(&empty, at(-5.0, 0.25, 0.5), direction),
                [],
                "{empty:?}"
            );
        }
    }
    assert!(
        Composition::Intersection(vec![block(), apart()])
            .bounds()
            .is_empty()
    );
    // Two blocks side by side are one.
    let union = Composition::Union(vec![block(), beside()]);
    let through = told(&intersections(&union, at(-5.0, 0.25, 0.5), DVec3::X));
    assert_eq!(
        through,
        [(4.0, Enter, Part::XMin, 0), (8.0, Leave, Part::XMax, 1)]
    );
    // And what is left of them without the one is the other.
    let rest = Composition::Difference(vec![union, block()]);
    let through = told(&intersections(&rest, at(-5.0, 0.25, 0.5), DVec3::X));
    assert_eq!(through.len(), 2);
    assert_eq!((through[0].0, through[1].0), (6.0, 8.0));
}

#[test]
fn line_within_a_face_follows_the_sets() {
    let block = || cuboid(DVec3::ZERO, DVec3::ONE);
    let above = cuboid(DVec3::Z * 2.0, at(0.5, 0.5, 1.0));
    let through = cuboid(DVec3::ZERO, at(0.5, 0.5, 9.0));
    let (origin, direction) = (at(-4.0, 0.0, 1.0), DVec3::X);
    let spans = |composition: &Composition| {
        let all = intersections(composition, origin, direction);
        all.iter().map(|met| met.intersection.t).collect::<Vec<_>>()
    };
    assert_eq!(spans(&block()), [3.0, 5.0]);
    // What stands upon the face takes nothing of it; a hole does.
    assert_eq!(
        spans(&Composition::Difference(vec![block(), above])),
        [3.0, 5.0]
    );
    let drilled = Composition::Difference(vec![block(), through]);
    assert_eq!(spans(&drilled), [3.0, 3.5, 4.5, 5.0]);
    // From within the face the ray meets it where it starts.
    for (start, expected) in [(3.25, vec![3.25, 3.5, 4.5, 5.0]), (4.0, vec![4.5, 5.0])] {
        let found = intersections_in(&drilled, origin, direction, [start, 9.0]);
        let found: Vec<_> = found.iter().map(|met| met.intersection.t).collect();
        assert_eq!(found, expected);
    }
}
