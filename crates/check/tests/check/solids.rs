//! Solids of all kinds, single and composed, are checked, and slightly wrong answers
//! are found.

use std::sync::Arc;

use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::scene::{
    CompositionRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene,
};
use cyltrace::solid::{AnySolid, Caps, Composition, Part};
use cyltrace::tracer::Tracer;
use cyltrace_check::{Class, Intersector, Outcome, ReportedHit, Settings};

use super::bites::Tampered;
use super::scenes::random_scene;
use super::{checked, tracer};
use test_support::solids::{KIND_NAMES, any_solid, prototype_of};
use test_support::trees::{draw_solid, draw_tree};

/// Solids of a kind with all caps, most of them placed several times.
fn scene_of_kind(kind: u64, seed: u64) -> Scene {
    let mut random = Random::new(seed, kind);
    let mut solids = |count: u64| -> Vec<AnySolid> {
        (0..count)
            .map(|_| {
                let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
                any_solid(&mut random, kind, caps, true)
            })
            .collect()
    };
    placed(prototype_of(&solids(30)), prototype_of(&solids(20)))
}

/// Ten compositions and another ten that are placed several times.
fn scene_of_compositions(seed: u64) -> Scene {
    let mut random = Random::new(seed, 71);
    let mut prototype = || {
        let mut prototype = Prototype::default();
        for number in 0..10 {
            let turn = Orientation::IDENTITY.rotated(random.direction(), 360.0 * random.unit());
            let is_coarse = random.below(2) == 0;
            let mut draw = |random: &mut Random| draw_solid(random, is_coarse, turn);
            let tree = draw_tree(&mut random, 3, &mut draw);
            let record = CompositionRecord::new(tree, number, MaterialIndex(0));
            prototype.solids.compositions.push(record);
        }
        prototype
    };
    placed(prototype(), prototype())
}

fn placed(mut root: Prototype, inner: Prototype) -> Scene {
    let places = &random_scene(3).prototypes[0].placements;
    root.placements = places
        .iter()
        .map(|place| Placement {
            of: PrototypeIndex(1),
            ..*place
        })
        .collect();
    Scene::new(vec![root, inner])
}

fn settings(rays: u64, seed: u64) -> Settings {
    Settings {
        segments: vec![8, 32],
        rays,
        seed,
        ..Settings::default()
    }
}

fn holds(name: &str, scene: Scene, rays: u64, seed: u64) -> Outcome {
    let scene = Arc::new(scene);
    let outcome = checked(name, &scene, &tracer(&scene), &settings(rays, seed));
    assert_eq!(outcome.violation_count(), 0, "{name}");
    assert!(outcome.holds(), "{name}");
    outcome
}

#[test]
fn every_kind_of_solid_holds() {
    for (kind, name) in (0..).zip(KIND_NAMES) {
        for seed in 0..3 {
            let outcome = holds(name.name(), scene_of_kind(kind, seed), 600, seed);
            let hits: u64 = outcome.rows.iter().map(|row| row.hits).sum();
            assert!(5 * hits > outcome.rays(), "{}: {hits}", name.name());
        }
    }
}

#[test]
fn compositions_hold() {
    for seed in 0..4 {
        holds("compositions", scene_of_compositions(seed), 600, seed);
    }
}

/// Of a solid that is smaller by a ten thousandth, or displaced by as much.
fn shrunk(solid: &AnySolid) -> AnySolid {
    use cyltrace::solid::{Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
    const LESS: f64 = 1.0 - 1e-4;
    match solid {
        AnySolid::Cylinder(one) => {
            let (p0, p1) = (one.p0(), one.p1());
            Cylinder::new(p0, p1, one.radius() * LESS, one.caps())
                .unwrap()
                .into()
        }
        AnySolid::Cone(one) => {
            let [radius0, radius1] = [one.radius0(), one.radius1()].map(|radius| radius * LESS);
            Cone::new(one.p0(), one.p1(), radius0, radius1, one.caps())
                .unwrap()
                .into()
        }
        AnySolid::RoundedCone(one) => {
            let [radius0, radius1] = [one.radius0(), one.radius1()].map(|radius| radius * LESS);
            RoundedCone::new(one.p0(), one.p1(), radius0, radius1)
                .unwrap()
                .into()
        }
        AnySolid::Sphere(one) => Sphere::new(one.center(), one.radius() * LESS)
            .unwrap()
            .into(),
        AnySolid::Cuboid(one) => {
            let half_widths = one.half_widths() * LESS;
            Cuboid::new(one.center(), half_widths, one.orientation())
                .unwrap()
                .into()
        }
        AnySolid::Disk(one) => {
            let off = one.normal().normalize() * (1e-4 * one.radius());
            Disk::new(one.center() + off, one.normal(), one.radius())
                .unwrap()
                .into()
        }
    }
}

fn shrunk_composition(composition: &Composition) -> Composition {
    let all = |parts: &[Composition]| parts.iter().map(shrunk_composition).collect();
    match composition {
        Composition::Solid(solid) => Composition::Solid(shrunk(solid)),
        Composition::Union(parts) => Composition::Union(all(parts)),
        Composition::Intersection(parts) => Composition::Intersection(all(parts)),
        Composition::Difference(parts) => Composition::Difference(all(parts)),
    }
}

fn shrunk_scene(scene: &Scene) -> Tracer {
    let mut scene = scene.clone();
    for prototype in &mut scene.prototypes {
        let singles: Vec<AnySolid> = prototype.singles().map(|(_, solid)| solid).collect();
        let mut solids = prototype_of(&singles.iter().map(shrunk).collect::<Vec<_>>());
        for record in &prototype.solids.compositions {
            solids.solids.compositions.push(CompositionRecord {
                solid: shrunk_composition(&record.solid),
                ..record.clone()
            });
        }
        prototype.solids = solids.solids;
    }
    tracer(&Arc::new(scene))
}

/// The meshes find the wrong intersector.
fn bites(name: &str, scene: &Scene, wrong: &impl Intersector, rays: u64) -> Outcome {
    let outcome = checked(name, scene, wrong, &settings(rays, 0));
    assert!(!outcome.holds(), "{name} went through");
    outcome
}

#[test]
fn sizes_off_by_a_ten_thousandth_are_caught() {
    for (kind, name) in (0..).zip(KIND_NAMES) {
        let scene = scene_of_kind(kind, 7);
        bites(name.name(), &scene, &shrunk_scene(&scene), 2_000);
    }
    let scene = scene_of_compositions(7);
    bites("compositions", &scene, &shrunk_scene(&scene), 2_000);
}

/// The tracer with changed hits.
fn tampered(scene: &Scene, change: impl Fn(&mut ReportedHit) + Sync) -> impl Intersector {
    let tracer = tracer(&Arc::new(scene.clone()));
    Tampered(move |ray: &Ray| {
        let mut finding = Intersector::closest(&tracer, ray)?;
        change(&mut finding);
        Some(finding)
    })
}

#[test]
fn flipped_normals_are_caught() {
    let flip = |finding: &mut ReportedHit| finding.normal = finding.normal.map(|normal| -normal);
    let scenes = (0..KIND_NAMES.len() as u64).map(|kind| scene_of_kind(kind, 8));
    for scene in scenes.chain([scene_of_compositions(8)]) {
        let outcome = bites("flipped", &scene, &tampered(&scene, flip), 400);
        let normals: u64 = outcome.rows.iter().map(|row| row.wrong_normals).sum();
        let hits: u64 = outcome
            .rows
            .iter()
            .filter(|row| row.segments.is_some())
            .map(|row| row.hits)
            .sum();
        // A thin solid may be hit with either normal.
        assert!(3 * normals > hits, "{normals} of {hits}");
    }
}

#[test]
fn wrong_parts_are_caught() {
    let change = |finding: &mut ReportedHit| {
        let place = finding.place.as_mut().expect("a place");
        place.part = match place.part {
            Part::Side => Part::Cap0,
            Part::Cap0 => Part::Cap1,
            Part::Cap1 => Part::Side,
            Part::XMin => Part::XMax,
            Part::XMax => Part::YMin,
            Part::YMin => Part::YMax,
            Part::YMax => Part::ZMin,
            Part::ZMin => Part::ZMax,
            _ => Part::XMin,
        };
        finding.normal = None;
    };
    for kind in 0..KIND_NAMES.len() as u64 {
        let scene = scene_of_kind(kind, 9);
        let outcome = bites("part", &scene, &tampered(&scene, change), 400);
        let classes = outcome
            .rows
            .iter()
            .filter(|row| row.class == Class::Sphere.name());
        assert!(classes.map(|row| row.violations).sum::<u64>() > 0);
    }
}
