//! Rays that are traced together get the answers that they get one by one, bit
//! for bit: for every instruction set, layout and time of building, and as
//! trying every placement and every cylinder answers.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test tracing batches` is the full run;
//! the default is a tenth of it.

use std::sync::Arc;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, MaterialIndex, Prototype, Scene, Solids};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{DEFAULT_BATCH, Hit, Layout, Options, Tracer};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;
use test_support::aim::{carried, farthest_point, range};
use test_support::{cylinders_in_a_box, placed, placing, ray_count, scene_of, ways_to_trace};

const SEED: u64 = 20_261_123;

/// The most rays of a bundle: two packets and half of one.
const GREATEST_BUNDLE: u64 = 40;

/// Bundles of a test.
fn bundle_count() -> u64 {
    ray_count() / 400
}

/// Rays that go about the same way, each to the cylinder of a box that is
/// drawn for it, so that most of them become packets.
///
/// Some start at one point and some go side by side from anywhere up to `reach`
/// away. Those that go side by side may go along a face of their cylinders'
/// boxes, just inside it, where a box that is too small loses them first.
fn bundle(random: &mut Random, cylinders: &[CylinderRecord], reach: f64) -> Vec<Ray> {
    let outward = DVec3::AXES[random.below(3) as usize];
    let heading = {
        let any = random.direction();
        match random.below(3) {
            0 => any,
            1 => outward.any_orthonormal_vector(),
            _ => (any - outward * any.dot(outward)).normalize(),
        }
    };
    // Seen from 20 away, the box is 5 degrees wide.
    let eye = DVec3::splat(0.5) - heading * random.log_uniform(20.0, reach.max(40.0));
    let starts_at_eye = random.below(3) == 0;
    let across = heading.cross(outward).normalize_or(outward);
    let spread = [0.0, 1e-6, 0.06][random.below(3) as usize];

    let count = 1 + random.below(GREATEST_BUNDLE);
    let mut rays: Vec<Ray> = (0..count)
        .map(|_| {
            let cylinder = cylinders[random.below(cylinders.len() as u64) as usize].cylinder();
            let middle = cylinder.p0().lerp(cylinder.p1(), random.unit());
            let target = match random.below(2) {
                0 => {
                    let off = random.direction() * random.uniform(0.0, 1.2);
                    middle + off * cylinder.radius()
                }
                _ => {
                    let depth = random.log_uniform(1e-15, 1e-3);
                    farthest_point(&cylinder, outward).lerp(middle, depth)
                }
            };
            let (origin, direction, t) = if starts_at_eye {
                (eye, target - eye, 1.0)
            } else {
                let direction = heading + across * random.uniform(-spread, spread);
                let distance = random.log_uniform(1e-3, reach);
                (target - direction * distance, direction, distance)
            };
            let scale = match random.below(20) {
                0 => random.log_uniform(1e-300, 1e-150),
                1 => random.log_uniform(1e100, 1e150),
                2 => random.log_uniform(1e-30, 1e30),
                _ => 1.0,
            };
            let (t_min, t_max) = range(random, t / scale);
            Ray {
                origin,
                direction: direction * scale,
                t_min,
                t_max,
            }
        })
        .collect();
    // What makes no packet, or part of one only, among what does.
    if random.below(5) == 0 {
        let odd = &mut rays[random.below(count) as usize];
        match random.below(8) {
            0 => odd.direction.y = f64::NAN,
            1 => odd.origin.x = f64::INFINITY,
            2 => odd.direction = DVec3::ZERO,
            3 => odd.t_min = f64::NAN,
            4 => odd.t_max = f64::NAN,
            5 => (odd.t_min, odd.t_max) = (odd.t_max, odd.t_min),
            6 => odd.direction = -odd.direction,
            _ => (odd.t_min, odd.t_max) = (f64::NEG_INFINITY, f64::INFINITY),
        }
    }
    rays
}

/// All bits of an answer.
fn bits(hit: Option<&Hit>) -> Vec<u64> {
    let Some(hit) = hit else { return Vec::new() };
    let spawned = hit.spawn(DVec3::ONE).origin;
    let vectors = [hit.point, hit.normal, spawned]
        .map(|v| v.to_array())
        .concat();
    let numbers = [hit.t, hit.error, hit.u, hit.v];
    let numbers = vectors.into_iter().chain(numbers).map(f64::to_bits);
    let names = [
        hit.prototype.0,
        hit.primitive,
        hit.material.0.into(),
        hit.part as u32,
        hit.crossing as u32,
    ];
    let names = names.iter().chain(&hit.instance).map(|&name| name.into());
    numbers.chain(names).collect()
}

/// A tracer for each way to trace, with a name. Exact decisions are tried with one set
/// of instructions: they take rays one by one.
fn tracers(scene: &Arc<Scene>, exact: bool) -> Vec<(String, Tracer)> {
    let named = |options: Options| {
        let tracer = Tracer::new(Arc::clone(scene), &options).unwrap();
        (format!("{options:?}"), tracer)
    };
    let mut ways = ways_to_trace();
    if exact {
        ways.drain(..ways.len() - 4);
    }
    let ways = ways.into_iter().map(|way| Options { exact, ..way });
    ways.map(named).collect()
}

/// Traces bundles in every way and compares the answers with those of every
/// ray to every cylinder.
fn assert_same_answers(
    name: &str,
    scene: &Arc<Scene>,
    bundle_of: impl Fn(&mut Random) -> Vec<Ray> + Sync,
) {
    for exact in [false, true] {
        assert_same_answers_of(name, &tracers(scene, exact), &bundle_of);
    }
}

fn assert_same_answers_of(
    name: &str,
    tracers: &[(String, Tracer)],
    bundle_of: impl Fn(&mut Random) -> Vec<Ray> + Sync,
) {
    let (_, witness) = &tracers[0];
    let counted = (0..bundle_count()).into_par_iter().map(|number| {
        let rays = bundle_of(&mut Random::new(SEED, 1000 + number));
        let truth = rays.iter().map(|ray| witness.closest_exhaustive(ray));
        let truth: Vec<Option<Hit>> = truth.collect();
        for (way, tracer) in tracers {
            let replay = |ray: usize| {
                let bits = test_support::bits(&rays[ray]);
                format!("{name}, {way}, seed {SEED}, bundle {number}, ray {ray}: {bits}")
            };
            let (mut first, mut hits, mut blocked) = (Vec::new(), Vec::new(), Vec::new());
            tracer.first_hits(&rays, &mut first);
            tracer.closest_batch(&rays, &mut hits);
            tracer.occluded_batch(&rays, &mut blocked);
            assert_eq!([first.len(), hits.len(), blocked.len()], [rays.len(); 3]);
            for (ray, truth) in truth.iter().enumerate() {
                let wanted = bits(truth.as_ref());
                assert_eq!(bits(hits[ray].as_ref()), wanted, "{}", replay(ray));
                assert_eq!(blocked[ray], truth.is_some(), "{}", replay(ray));
                assert_eq!(first[ray], tracer.first_hit(&rays[ray]), "{}", replay(ray));
                let from_first = first[ray].as_ref().map(|first| {
                    let hit = tracer.hit(&rays[ray], first);
                    assert_eq!(first.t.to_bits(), hit.t.to_bits(), "{}", replay(ray));
                    hit
                });
                assert_eq!(bits(from_first.as_ref()), wanted, "{}", replay(ray));
                let alone = tracer.closest(&rays[ray]);
                assert_eq!(bits(alone.as_ref()), wanted, "{}", replay(ray));
                assert_eq!(tracer.occluded(&rays[ray]), blocked[ray], "{}", replay(ray));
            }
        }
        (rays.len(), truth.iter().flatten().count())
    });
    let (rays, hits) = counted.reduce(|| (0, 0), |one, other| (one.0 + other.0, one.1 + other.1));
    println!("{name}: {rays} rays, {hits} hits, {} ways", tracers.len());
    assert!(hits * 4 > rays, "{name}: only {hits} hits of {rays} rays");
    assert!(hits < rays, "{name}: no ray misses");
}

/// A scene of these cylinders and nothing else.
fn scene_of_cylinders(cylinders: Vec<CylinderRecord>) -> Arc<Scene> {
    scene_of(vec![Prototype {
        solids: Solids::of_cylinders(cylinders),
        ..Default::default()
    }])
}

#[test]
fn bundles_at_a_box_of_cylinders() {
    let mixed = cylinders_in_a_box(SEED, 500);
    let with = |caps| {
        let changed = |record: &CylinderRecord| {
            let (p0, p1) = (record.cylinder().p0(), record.cylinder().p1());
            let cylinder = Cylinder::new(p0, p1, record.cylinder().radius(), caps).unwrap();
            CylinderRecord::new(&cylinder, record.primitive(), record.material())
        };
        mixed.iter().map(changed).collect::<Vec<_>>()
    };
    let kinds = [
        ("open", with(Caps::None)),
        ("capped", with(Caps::Both)),
        ("mixed", mixed.clone()),
    ];
    for (kind, cylinders) in kinds {
        let scene = scene_of_cylinders(cylinders.clone());
        for reach in [1e2, 1e8] {
            let name = format!("{kind} ends, from {reach:e} away");
            assert_same_answers(&name, &scene, |random| bundle(random, &cylinders, reach));
        }
    }
}

#[test]
fn bundles_at_nested_placements() {
    for nested in test_support::nested_placements(SEED) {
        let name = format!("nested, translated by {:e}", nested.translation);
        let cylinders = nested.cylinders();
        assert_same_answers(&name, &nested.scene, |random| {
            let image = nested.any_image(random);
            let rays = bundle(random, &cylinders, 1e6);
            rays.iter().map(|ray| carried(&image, ray)).collect()
        });
    }
}

/// Rays that have nothing in common enter together, and are then traced one by one: here
/// each is of a bundle of its own, from near or far.
#[test]
fn scattered_rays() {
    let cylinders = cylinders_in_a_box(SEED, 500);
    let scattered = |random: &mut Random, cylinders: &[CylinderRecord]| -> Vec<Ray> {
        (0..GREATEST_BUNDLE)
            .map(|_| {
                let reach = [1e2, 1e8][random.below(2) as usize];
                bundle(random, cylinders, reach)[0]
            })
            .collect()
    };
    let scene = scene_of_cylinders(cylinders.clone());
    assert_same_answers("scattered", &scene, |random| scattered(random, &cylinders));
    for nested in test_support::nested_placements(SEED) {
        let name = format!("scattered, nested, translated by {:e}", nested.translation);
        let cylinders = nested.cylinders();
        assert_same_answers(&name, &nested.scene, |random| {
            let rays = scattered(random, &cylinders);
            let rays = rays.iter();
            rays.map(|ray| carried(&nested.any_image(random), ray))
                .collect()
        });
    }
}

/// Copies of each cylinder, whose numbers do not go with their places.
const COPIES: u32 = 3;

/// Rays along an axis, but for roundings as placements make them: components of all sizes
/// around 1e-18, below which Embree forgets the sign, with either sign.
#[test]
fn bundles_with_tiny_components_of_either_sign() {
    let cylinders = cylinders_in_a_box(SEED + 7, 100);
    let scene = scene_of_cylinders(cylinders.clone());
    assert_same_answers("tiny components", &scene, |random| {
        let axis = random.below(3) as usize;
        let sign = [-1.0, 1.0][random.below(2) as usize];
        let count = 4 + random.below(13);
        (0..count)
            .map(|_| {
                let cylinder = cylinders[random.below(cylinders.len() as u64) as usize].cylinder();
                let target = cylinder.p0().lerp(cylinder.p1(), random.unit());
                let mut tiny = || random.direction() * random.log_uniform(1e-21, 1e-15);
                let mut direction = tiny();
                direction[axis] = sign;
                Ray::new(target - direction * 3.0, direction)
            })
            .collect()
    });
}

/// Cylinders that each stand there three times.
fn copies() -> Vec<CylinderRecord> {
    let cylinders = cylinders_in_a_box(SEED, 50);
    let count = COPIES * cylinders.len() as u32;
    let records = (0..count).map(|place| {
        let cylinder = cylinders[place as usize % cylinders.len()].cylinder();
        // 37 has no factor in common with the count.
        CylinderRecord::new(&cylinder, place * 37 % count, MaterialIndex(0))
    });
    records.collect()
}

/// Of solids that coincide, the one of the least path and then the least number
/// is hit, in whichever order and with whichever rays they are traced.
#[test]
fn bundles_at_coinciding_solids() {
    let records = copies();
    let leaf = Prototype {
        solids: Solids::of_cylinders(records.clone()),
        ..Default::default()
    };
    let (root, between, in_leaf) = (0, 1, 2);
    let here = |of| placed(of, DAffine3::IDENTITY);
    let aside = DAffine3::from_translation(DVec3::new(0.3, 0.2, 0.1));
    let mut prototypes = vec![Prototype::default(); 3];
    prototypes[root] = placing(
        [between, in_leaf, between, in_leaf]
            .map(|of| here(of as u32))
            .into(),
    );
    prototypes[between] = placing(vec![here(2), placed(2, aside), here(2)]);
    prototypes[in_leaf] = leaf;
    let scene = scene_of(prototypes);
    let aim = |random: &mut Random| bundle(random, &records, 1e2);
    assert_same_answers("coinciding", &scene, aim);

    // The least number of each cylinder's copies, worked out without a tracer.
    let same = |one: &CylinderRecord, other: &CylinderRecord| one.cylinder() == other.cylinder();
    for (way, tracer) in tracers(&scene, false) {
        for number in 0..50 {
            let rays = aim(&mut Random::new(SEED, number));
            let mut hits = Vec::new();
            tracer.closest_batch(&rays, &mut hits);
            for hit in hits.into_iter().flatten() {
                let is_hit = |record: &&CylinderRecord| record.primitive() == hit.primitive;
                let of_hit = records.iter().find(is_hit).expect("a record's number");
                let copies = records.iter().filter(|record| same(record, of_hit));
                let least = copies.map(CylinderRecord::primitive).min();
                assert_eq!(Some(hit.primitive), least, "{way}, bundle {number}");
                let first_path = matches!(hit.instance[..], [0, 0] | [0, 1]);
                assert!(first_path, "{way}, bundle {number}: {:?}", hit.instance);
            }
        }
    }
}

#[test]
fn all_hits_of_blocks_are_those_of_single_cylinders() {
    let scenes = [
        ("copies", scene_of_cylinders(copies())),
        ("a box", scene_of_cylinders(cylinders_in_a_box(SEED, 500))),
    ];
    for (name, scene) in scenes {
        let [single, block] = [Layout::Single, Layout::Block].map(|layout| {
            let options = Options {
                layout,
                ..Default::default()
            };
            Tracer::new(Arc::clone(&scene), &options).unwrap()
        });
        let cylinders: Vec<_> = scene.prototypes[0].solids.cylinders.iter().collect();
        let hits = (0..bundle_count()).into_par_iter().map(|number| {
            let rays = bundle(&mut Random::new(SEED, number), &cylinders, 1e2);
            let mut found = 0;
            for ray in &rays {
                let wanted: Vec<Hit> = single.all_hits(ray, DEFAULT_BATCH).collect();
                for batch in [1, 3, DEFAULT_BATCH] {
                    let hits: Vec<Hit> = block.all_hits(ray, batch).collect();
                    assert_eq!(hits, wanted, "{name}, {}", test_support::bits(ray));
                }
                found += wanted.len();
            }
            found
        });
        assert!(hits.sum::<usize>() > 1000, "{name}: next to no hits");
    }
}

/// Without anything to hit, and without rays.
#[test]
fn batches_of_nothing_answer_for_every_ray() {
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    let cylinder = Cylinder::new(DVec3::Y, DVec3::Z, 0.1, Caps::Both).unwrap();
    let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
    for cylinders in [vec![], vec![record]] {
        let tracer = Tracer::new(scene_of_cylinders(cylinders), &Options::default()).unwrap();
        for count in [0, 1, 20] {
            let rays = vec![ray; count];
            // What was there before does not stay.
            let hit = tracer.closest(&Ray::new(DVec3::splat(9.0), DVec3::NEG_ONE));
            let (mut hits, mut first, mut blocked) = (vec![hit], vec![None; 3], vec![true; 30]);
            tracer.closest_batch(&rays, &mut hits);
            tracer.first_hits(&rays, &mut first);
            tracer.occluded_batch(&rays, &mut blocked);
            assert_eq!(hits, vec![None; count]);
            assert_eq!(first, vec![None; count]);
            assert_eq!(blocked, vec![false; count]);
        }
    }
}
