//! Scenes with set operations through the tracer: every query agrees with the
//! exhaustive search and with the intervals, through placements too.

use std::collections::HashMap;

use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::scene::{
    Composition, MaterialIndex, Placement, Prototype, PrototypeIndex, SolidRecord, Solids,
};
use cyltrace::solid::{AnySolid, Caps, Crossing, Cuboid, Cylinder, Part, SolidKind, Sphere};
use cyltrace::tracer::{Hit, Options, Tracer};
use glam::{DAffine3, DMat3, DVec3};
use test_support::trees::{draw_solid, draw_tree};

const SEED: u64 = 67;

fn rays() -> u64 {
    std::env::var("CYLTRACE_RAYS").map_or(3_000, |count| count.parse().expect("a number"))
}

/// A composition in the list of a prototype.
fn record(solid: Composition, primitive: u32) -> SolidRecord<Composition> {
    SolidRecord::new(solid, primitive, MaterialIndex(0))
}

/// Twenty random compositions, some twice, with ordinary spheres between them; every
/// other one is of coarse numbers, so that faces coincide.
fn crowd(seed: u64) -> Solids {
    let mut solids = Solids::default();
    for primitive in 0..24 {
        let mut random = Random::new(seed, u64::from(primitive));
        let (is_coarse, turn) = (primitive % 2 == 0, Orientation::IDENTITY);
        if primitive % 6 == 5 {
            let center = random.direction() * random.uniform(0.0, 3.0);
            let sphere = Sphere::new(center, random.uniform(0.2, 1.0)).expect("a sphere");
            let record = SolidRecord::new(sphere, primitive, MaterialIndex(0));
            solids.spheres.push(record);
            continue;
        }
        let tree = match solids.compositions.last() {
            Some(last) if primitive % 8 == 7 => last.solid.clone(),
            _ => draw_tree(&mut random, 3, &mut |random| {
                draw_solid(random, is_coarse, turn)
            }),
        };
        solids.compositions.push(record(tree, primitive));
    }
    solids
}

/// A root of compositions and of three placements of a prototype of others, one of
/// which stretches and one of which is nested.
fn scene() -> Tracer {
    let place = |of, matrix3: DMat3, translation: DVec3| Placement {
        of: PrototypeIndex(of),
        parent_from_child: DAffine3 {
            matrix3,
            translation,
        },
    };
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    let stretch = DMat3::from_diagonal(DVec3::new(0.5, 1.5, 0.8));
    let root = Prototype {
        solids: crowd(SEED),
        placements: vec![
            place(1, turn, DVec3::new(2.0, 0.5, -1.0)),
            place(2, turn * stretch, DVec3::new(-1.0, 1.0, 0.5)),
        ],
        ..Default::default()
    };
    let inner = Prototype {
        solids: crowd(SEED + 1),
        ..Default::default()
    };
    let outer = Prototype {
        placements: vec![place(1, stretch, DVec3::new(0.3, -0.2, 0.1))],
        ..Default::default()
    };
    let scene = test_support::scene_of(vec![root, inner, outer]);
    Tracer::new(scene, &Options::default()).expect("a tracer")
}

/// A ray from outside through the crowd.
fn ray(index: u64) -> Ray {
    let mut random = Random::new(SEED + 2, index);
    let through = random.direction() * random.uniform(0.0, 3.0);
    let direction = random.direction();
    Ray::new(
        through - direction * random.log_uniform(20.0, 1e3),
        direction * random.log_uniform(1e-3, 1e3),
    )
}

fn all(tracer: &Tracer, ray: &Ray, batch: usize) -> Vec<Hit> {
    let hits: Vec<_> = tracer.all_hits(ray, batch).take(2_000).collect();
    assert!(hits.len() < 2_000, "{ray:?}");
    hits
}

/// Which solid of the scene.
fn key(hit: &Hit) -> (Vec<u32>, u32) {
    (hit.instance.clone(), hit.primitive)
}

#[test]
fn queries_agree_with_each_other_and_with_the_exhaustive_search() {
    let tracer = scene();
    let rays: Vec<_> = (0..rays()).map(ray).collect();
    let (mut batch, mut blocked) = (Vec::new(), Vec::new());
    tracer.closest_batch(&rays, &mut batch);
    tracer.occluded_batch(&rays, &mut blocked);
    let mut composed = 0;
    for (index, ray) in rays.iter().enumerate() {
        let closest = tracer.closest(ray);
        assert_eq!(closest, tracer.closest_exhaustive(ray), "{ray:?}");
        assert_eq!(closest, batch[index], "{ray:?}");
        assert_eq!(closest.is_some(), tracer.occluded(ray), "{ray:?}");
        assert_eq!(closest.is_some(), blocked[index], "{ray:?}");
        let hits = all(&tracer, ray, 32);
        assert_eq!(closest.as_ref(), hits.first(), "{ray:?}");
        assert_eq!(hits, all(&tracer, ray, 3), "{ray:?}");
        composed += hits
            .iter()
            .filter(|hit| hit.solid != SolidKind::Sphere)
            .count();
    }
    println!("{} rays, {composed} hits of compositions", rays.len());
    assert!(composed > rays.len() * 4);
}

#[test]
fn crossings_alternate_agree_with_contains_and_are_the_same_backwards() {
    let tracer = scene();
    let (mut points, mut held, mut intersections) = (0_u64, 0_u64, 0);
    for index in 0..rays() {
        let ray = ray(index);
        let hits = all(&tracer, &ray, 32);
        intersections += hits.len();
        let mut inside: HashMap<_, bool> = HashMap::new();
        for hit in &hits {
            let is_inside = inside.entry(key(hit)).or_default();
            assert_eq!(
                hit.crossing == Crossing::Leave,
                *is_inside,
                "{hit:?}\n{ray:?}"
            );
            *is_inside = !*is_inside;
        }
        assert!(inside.values().all(|is_inside| !is_inside), "{ray:?}");

        // From the other side, over the same stretch.
        let length = 2.0 * ray.direction.length().recip() * 1e3;
        let turned = Ray::new(ray.origin + ray.direction * length, -ray.direction);
        let backwards = all(&tracer, &turned, 32);
        let known = |hits: &[Hit]| {
            let mut known: Vec<_> = hits.iter().map(|hit| (key(hit), hit.part)).collect();
            known.sort();
            known
        };
        assert_eq!(known(&hits), known(&backwards), "{ray:?}");

        // What was entered and not left holds the points between.
        let speed = ray.direction.length();
        let mut open: Vec<(Vec<u32>, u32)> = Vec::new();
        for pair in hits.windows(2) {
            match pair[0].crossing {
                Crossing::Enter => open.push(key(&pair[0])),
                Crossing::Leave => open.retain(|one| *one != key(&pair[0])),
            }
            if (pair[1].t - pair[0].t) * speed < 1e-6 {
                continue;
            }
            let point = ray.origin + ray.direction * (0.5 * (pair[0].t + pair[1].t));
            let holding = tracer.contains(point).into_iter();
            let holding: Vec<_> = holding.map(|one| (one.instance, one.primitive)).collect();
            open.sort();
            assert_eq!(holding, open, "{ray:?} {point}");
            points += 1;
            held += holding.len() as u64;
        }
    }
    println!("{intersections} intersections, {points} points, {held} times held");
    assert!(held > points / 2);
}

#[test]
fn points_and_normals_are_of_the_composed_surface() {
    let tracer = scene();
    let (mut hits, mut at_edges) = (0_u64, 0_u64);
    for index in 0..rays() {
        let ray = ray(index);
        for hit in all(&tracer, &ray, 32) {
            // Near an edge another leaf may be within a step.
            let holds = |side: f64| {
                let beside = hit.point + hit.normal * (side * 1e-7);
                let mut holding = tracer.contains(beside).into_iter();
                holding.any(|one| (one.instance, one.primitive) == key(&hit))
            };
            let is_right = holds(-1.0) && !holds(1.0);
            at_edges += u64::from(!is_right);
            hits += 1;
            assert!((hit.normal.length() - 1.0).abs() < 1e-14);
            assert!(hit.error < 1e-12, "{hit:?}");
            let into = hit.normal.dot(ray.direction.normalize());
            match hit.crossing {
                Crossing::Enter => assert!(into < 1e-6, "{hit:?}"),
                Crossing::Leave => assert!(into > -1e-6, "{hit:?}"),
            }
            // A new ray that leaves here starts outside of what was hit.
            let spawned = hit.spawn(hit.normal).origin;
            let mut holding = tracer.contains(spawned).into_iter();
            let is_inside = holding.any(|one| (one.instance, one.primitive) == key(&hit));
            assert!(!(is_inside && is_right), "{hit:?}");
        }
    }
    println!("{hits} hits, {at_edges} at edges");
    assert!(at_edges * 10_000 <= hits, "{at_edges} of {hits}");
}

#[test]
fn drilled_block_through_a_placement() {
    let block = Cuboid::new(
        DVec3::ZERO,
        DVec3::new(2.0, 2.0, 1.0),
        Orientation::IDENTITY,
    );
    let bore = Cylinder::new(DVec3::NEG_Z, DVec3::Z, 1.0, Caps::Both);
    let far = Sphere::new(DVec3::X * 50.0, 1.0).expect("a sphere");
    let leaf = |solid: AnySolid| Composition::Solid(solid);
    let drilled = Composition::Difference(vec![
        leaf(block.expect("a block").into()),
        leaf(bore.expect("a bore").into()),
    ]);
    // Nothing is left of the second, which is no reason to refuse it.
    let nothing = Composition::Intersection(vec![drilled.clone(), leaf(far.into())]);
    let solids = Solids {
        compositions: vec![record(nothing, 4), record(drilled, 9)],
        ..Default::default()
    };
    let parent_from_child = DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 4.0)),
        translation: DVec3::new(10.0, 0.0, 0.0),
    };
    let root = Prototype {
        placements: vec![Placement {
            of: PrototypeIndex(1),
            parent_from_child,
        }],
        ..Default::default()
    };
    let block = Prototype {
        solids,
        ..Default::default()
    };
    let scene = test_support::scene_of(vec![root, block]);
    let tracer = Tracer::new(scene, &Options::default()).expect("a tracer");
    let told = |ray: &Ray| {
        let hits = all(&tracer, ray, 32).into_iter();
        hits.map(|hit| (hit.t, hit.part, hit.crossing, hit.normal, hit.primitive))
            .collect::<Vec<_>>()
    };
    let across = Ray::new(DVec3::new(5.0, 0.0, 2.0), DVec3::X);
    let (enter, leave) = (Crossing::Enter, Crossing::Leave);
    let expected = [
        (3.0, Part::XMin, enter, DVec3::NEG_X, 9),
        (4.0, Part::Side, leave, DVec3::X, 9),
        (6.0, Part::Side, enter, DVec3::NEG_X, 9),
        (7.0, Part::XMax, leave, DVec3::X, 9),
    ];
    assert_eq!(told(&across), expected);
    let first = tracer.closest(&across).expect("a hit");
    assert_eq!(
        (first.solid, first.instance),
        (SolidKind::Difference, vec![0])
    );
    let down = Ray::new(DVec3::new(10.1, 0.2, 9.0), DVec3::NEG_Z);
    assert_eq!(told(&down), []);
    for (point, count) in [
        (DVec3::new(11.0, 0.0, 0.0), 1),
        (DVec3::new(10.5, 0.0, 0.0), 0),
        (DVec3::new(12.0, 4.0, 4.0), 1),
        (DVec3::new(12.0, 4.0, 4.0 + 1e-15), 0),
    ] {
        let holding = tracer.contains(point);
        assert_eq!(holding, tracer.contains_exhaustive(point));
        assert_eq!(holding.len(), count, "{point}");
        assert!(holding.iter().all(|one| one.solid == SolidKind::Difference));
    }
}

#[test]
fn sample_scene_holds_what_its_header_says() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/set_operations.toml");
    let scene = cyltrace::scene::load(path.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let [root] = scene.prototypes.as_slice() else {
        panic!("{} prototypes", scene.prototypes.len());
    };
    assert!(root.placements.is_empty());
    assert_eq!((root.solids.len(), root.solids.compositions.len()), (5, 4));
    let kinds = root.solids.compositions.iter();
    let kinds: Vec<_> = kinds.map(|one| one.solid.kind()).collect();
    use SolidKind::{Difference, Intersection};
    assert_eq!(kinds, [Intersection, Difference, Difference, Difference]);
}
