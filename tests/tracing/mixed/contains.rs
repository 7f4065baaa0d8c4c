//! Which solids hold a point: as exact arithmetic says, also on the surface, and as
//! the exhaustive search says, through placements.

use cyltrace::math::Random;
use cyltrace::scene::{MaterialIndex, Placement, Prototype, PrototypeIndex, SolidRecord};
use cyltrace::solid::{AnySolid, Caps, Cuboid, Sphere};
use cyltrace::tracer::{Containing, Tracer};
use cyltrace::{math::Orientation, solid::Cylinder};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::{SEED, traced, tracer_of};
use test_support::solids::{crowd, prototype_of, ray_through};
use test_support::{self, nested_placements};

fn numbers(found: &[Containing]) -> Vec<u32> {
    found.iter().map(|one| one.primitive).collect()
}

/// A point of the unit cube, or on a surface within the rounding.
fn point(random: &mut Random, tracer: &Tracer) -> DVec3 {
    let any = DVec3::new(random.unit(), random.unit(), random.unit());
    match random.below(3) {
        0 => tracer
            .closest(&ray_through(random))
            .map_or(any, |hit| hit.point),
        _ => any,
    }
}

#[test]
fn points_are_held_by_what_exact_arithmetic_says() {
    let solids = crowd(SEED + 4, 200);
    let prototype = prototype_of(&solids);
    for options in test_support::ways_to_trace() {
        let tracer = traced(vec![prototype.clone()], &options);
        let held: usize = (0..500_u64)
            .into_par_iter()
            .map(|number| {
                let mut random = Random::new(SEED, 600_000 + number);
                let point = point(&mut random, &tracer);
                let truth: Vec<u32> = (0..)
                    .zip(&solids)
                    .filter(|(_, solid)| cyltrace_oracle::truth(solid).truly_contains(point))
                    .map(|(number, _)| number)
                    .collect();
                let found = tracer.contains(point);
                assert_eq!(numbers(&found), truth, "{options:?}, {point:?}");
                for one in &found {
                    assert_eq!(one.solid, solids[one.primitive as usize].kind());
                }
                truth.len()
            })
            .sum();
        assert!(held > 150, "{held}");
    }
}

#[test]
fn points_of_the_surface_are_held_and_their_neighbours_are_not() {
    let solids: [AnySolid; 3] = [
        Cuboid::new(DVec3::ZERO, DVec3::splat(0.5), Orientation::IDENTITY)
            .unwrap()
            .into(),
        Sphere::new(DVec3::new(3.0, 0.0, 0.0), 0.625)
            .unwrap()
            .into(),
        // A tube: its ends are open, but what it surrounds is the solid.
        Cylinder::new(DVec3::ZERO, DVec3::Z, 0.25, Caps::None)
            .unwrap()
            .into(),
    ];
    let tracer = tracer_of(vec![prototype_of(&solids)]);
    let out = 0.5_f64.next_up();
    for (point, expected) in [
        (DVec3::splat(0.5), &[0][..]),
        (DVec3::new(-0.5, 0.5, -0.5), &[0]),
        (DVec3::new(out, 0.5, 0.5), &[]),
        (DVec3::new(0.0, -out, 0.0), &[]),
        (DVec3::new(0.0, 0.0, 0.5), &[0, 2]),
        (DVec3::new(0.0, 0.0, 1.0), &[2]),
        (DVec3::new(0.0, 0.0, 1.0_f64.next_up()), &[]),
        (DVec3::new(0.25, 0.0, 0.0), &[0, 2]),
        (DVec3::new(3.625, 0.0, 0.0), &[1]),
        (DVec3::new(3.625_f64.next_up(), 0.0, 0.0), &[]),
        (DVec3::new(3.0, 0.375, 0.5), &[1]),
        (DVec3::new(3.0, 0.375, out), &[]),
        (DVec3::new(1e300, 0.0, 0.0), &[]),
        (DVec3::new(f64::NAN, 0.0, 0.0), &[]),
        (DVec3::new(0.0, f64::INFINITY, 0.0), &[]),
    ] {
        assert_eq!(numbers(&tracer.contains(point)), expected, "{point:?}");
    }
}

#[test]
fn nested_placements_lose_no_point() {
    for nested in nested_placements(SEED + 5) {
        let mut prototypes = nested.scene.prototypes.clone();
        prototypes[3] = Prototype::default();
        for (number, solid) in (0..).zip(crowd(SEED + 6, 100)) {
            let material = MaterialIndex((number % 3) as u16);
            let record = SolidRecord::new(solid, number, material);
            prototypes[3].solids.push(record).expect("f64 keeps it");
        }
        let tracer = tracer_of(prototypes);
        let held: usize = (0..test_support::ray_count() / 50)
            .into_par_iter()
            .map(|number| {
                let mut random = Random::new(SEED, 700_000 + number);
                let inside = DVec3::new(random.unit(), random.unit(), random.unit());
                let point = nested.any_image(&mut random).transform_point3(inside);
                let found = tracer.contains(point);
                assert_eq!(found, tracer.contains_exhaustive(point), "{point:?}");
                assert!(found.is_sorted());
                let mut materials = found.iter().rev().filter_map(|one| {
                    let solids = &tracer.scene().prototypes[one.prototype.0 as usize].solids;
                    solids.material(one.solid, one.primitive)
                });
                let counts = |material: MaterialIndex| material.0 == 1;
                let last = materials.find(|one| counts(*one));
                assert_eq!(tracer.material_at(point, counts), last, "{point:?}");
                found.len()
            })
            .sum();
        assert!(held > 300, "{held} at {}", nested.translation);
    }
}

/// The last one counts, in the order of placements and numbers: a placed solid after those of the
/// root.
#[test]
fn material_at_is_that_of_the_last_solid_that_counts() {
    let balls = |materials: &[u16]| {
        let mut prototype = Prototype::default();
        for (number, &material) in (0..).zip(materials) {
            let ball = Sphere::new(DVec3::ZERO, 1.0 + f64::from(number)).expect("a ball");
            let record = SolidRecord::new(ball.into(), number, MaterialIndex(material));
            prototype.solids.push(record).expect("f64 keeps it");
        }
        prototype
    };
    let mut root = balls(&[1, 2, 1, 3]);
    root.placements.push(Placement {
        of: PrototypeIndex(1),
        parent_from_child: DAffine3::IDENTITY,
    });
    let tracer = tracer_of(vec![root, balls(&[5, 4])]);
    let at = |x: f64, counts: fn(u16) -> bool| {
        let material = tracer.material_at(DVec3::new(x, 0.0, 0.0), |one| counts(one.0));
        material.map(|one| one.0)
    };
    assert_eq!(at(0.5, |_| true), Some(4));
    assert_eq!(at(0.5, |one| one < 4), Some(3));
    assert_eq!(at(0.5, |one| one < 3), Some(1));
    assert_eq!(at(0.5, |one| one == 2), Some(2));
    assert_eq!(at(0.5, |_| false), None);
    // The inner balls do not contain these.
    assert_eq!(at(1.5, |one| one > 4), None);
    assert_eq!(at(3.5, |_| true), Some(3));
    assert_eq!(at(4.5, |_| true), None);
}
