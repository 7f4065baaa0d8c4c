//! Solids of all kinds through the tracer: what exact arithmetic says, by every way
//! to trace, through placements, with ties settled by number.

mod contains;
mod nested;
mod parity;
mod placed;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::Prototype;
use cyltrace::solid::{AnySolid, Caps, Cone, Crossing, Cylinder, SolidKind};
use cyltrace::tracer::{BuildTime, Hit, Layout, MemoryEstimate, Options, Tracer};
use cyltrace_oracle::hits_of_any;
use glam::DVec3;
use rayon::prelude::*;
use test_support::solids::{KIND_NAMES, crowd, prototype_of, ray_through};

const SEED: u64 = 61;

fn tracer_of(prototypes: Vec<Prototype>) -> Tracer {
    traced(prototypes, &Options::default())
}

fn traced(prototypes: Vec<Prototype>, options: &Options) -> Tracer {
    Tracer::new(test_support::scene_of(prototypes), options).unwrap()
}

/// All hits, and that the first of them is the closest, by whichever batches.
fn all_hits(tracer: &Tracer, ray: &Ray) -> Vec<Hit> {
    let hits: Vec<Hit> = tracer.all_hits(ray, 32).collect();
    for batch in [1, 3] {
        let again: Vec<Hit> = tracer.all_hits(ray, batch).take(hits.len() + 1).collect();
        assert_eq!(again, hits, "batch {batch}: {}", test_support::bits(ray));
    }
    assert_eq!(
        tracer.closest(ray).as_ref(),
        hits.first(),
        "{}",
        test_support::bits(ray)
    );
    assert_eq!(tracer.occluded(ray), !hits.is_empty());
    hits
}

/// Holds what was found of a ray against exact arithmetic, solid by solid, and
/// answers with how many hits there were of each kind.
fn judge(solids: &[AnySolid], ray: &Ray, found: &[Hit]) -> [u64; 6] {
    let mut hits = [0; 6];
    for (number, solid) in (0..).zip(solids) {
        let truth = hits_of_any(solid, ray);
        let of_solid: Vec<&Hit> = found.iter().filter(|hit| hit.primitive == number).collect();
        let case = || {
            format!(
                "seed {SEED}, {solid:?}, {}: {of_solid:?}",
                test_support::bits(ray)
            )
        };
        let keys: Vec<_> = of_solid
            .iter()
            .map(|hit| (hit.crossing, hit.part))
            .collect();
        let true_keys: Vec<_> = truth.iter().map(|hit| (hit.crossing, hit.part)).collect();
        assert_eq!(keys, true_keys, "{}", case());
        for (hit, truth) in of_solid.iter().zip(&truth) {
            let t = truth.t_f64();
            assert!((hit.t - t).abs() <= 1e-9 * t.abs(), "{t}: {}", case());
            assert_eq!(hit.solid, solid.kind(), "{}", case());
            assert!((hit.normal.length() - 1.0).abs() < 1e-14, "{}", case());
            let on_ray = ray.origin + ray.direction * hit.t;
            let along = 1e-9 * (ray.direction * t).length();
            assert!(hit.point.distance(on_ray) <= along, "{}", case());
            let slope = ray.direction.normalize().dot(hit.normal);
            let is_turned = match hit.crossing {
                Crossing::Enter => slope > 1e-4,
                Crossing::Leave => slope < -1e-4,
            };
            // A disk has one normal, whichever side the ray comes from.
            assert!(!is_turned || hit.solid == SolidKind::Disk, "{}", case());
            let kind = KIND_NAMES
                .iter()
                .position(|kind| *kind == hit.solid)
                .unwrap();
            hits[kind] += 1;
        }
    }
    hits
}

#[test]
fn hits_of_every_kind_are_those_of_exact_arithmetic() {
    let solids = crowd(SEED, 90);
    let tracer = tracer_of(vec![prototype_of(&solids)]);
    let hits = (0..test_support::ray_count() / 50)
        .into_par_iter()
        .map(|number| {
            let ray = ray_through(&mut Random::new(SEED, 1_000 + number));
            judge(&solids, &ray, &all_hits(&tracer, &ray))
        })
        .reduce(
            || [0; 6],
            |one, other| std::array::from_fn(|kind| one[kind] + other[kind]),
        );
    println!("hits of {KIND_NAMES:?}: {hits:?}");
    assert!(hits.iter().all(|&hits| hits > 100), "{hits:?}");
}

/// Sixteen rays that go about the same way, and some that do not.
fn rays_of_a_batch(random: &mut Random) -> Vec<Ray> {
    let first = ray_through(random);
    let count = 1 + random.below(40);
    (0..count)
        .map(|_| {
            if random.below(20) == 0 {
                return ray_through(random);
            }
            let aside = random.direction() * (0.05 * first.direction.length());
            let mut ray = Ray::new(
                first.origin + random.direction() * 0.1,
                first.direction + aside,
            );
            if random.below(3) == 0 {
                ray.t_max = random.log_uniform(1.0, 200.0) / ray.direction.length();
            }
            ray
        })
        .collect()
}

#[test]
fn every_way_to_trace_answers_alike() {
    let prototype = prototype_of(&crowd(SEED + 1, 300));
    let mut batches = Vec::new();
    for number in 0..150 {
        batches.push(rays_of_a_batch(&mut Random::new(SEED, 50_000 + number)));
    }
    let (mut hits, mut rays) = (0, 0);
    for options in test_support::ways_to_trace() {
        let tracer = traced(vec![prototype.clone()], &options);
        rays += batches.iter().map(Vec::len).sum::<usize>();
        let of_batch = |rays: &Vec<Ray>| {
            let (mut first, mut closest, mut blocked) = (Vec::new(), Vec::new(), Vec::new());
            tracer.first_hits(rays, &mut first);
            tracer.closest_batch(rays, &mut closest);
            tracer.occluded_batch(rays, &mut blocked);
            for (number, ray) in rays.iter().enumerate() {
                let case = || format!("{options:?}: {}", test_support::bits(ray));
                let expected = tracer.closest_exhaustive(ray);
                assert_eq!(tracer.closest(ray), expected, "{}", case());
                assert_eq!(closest[number], expected, "{}", case());
                assert_eq!(first[number], tracer.first_hit(ray), "{}", case());
                assert_eq!(blocked[number], expected.is_some(), "{}", case());
                let told = first[number].as_ref();
                let told = told.map(|hit| (hit.t, hit.solid(), hit.primitive(tracer.scene())));
                let expected = expected.map(|hit| (hit.t, hit.solid, hit.primitive));
                assert_eq!(told, expected, "{}", case());
            }
            blocked.iter().filter(|&&is_blocked| is_blocked).count()
        };
        hits += batches.par_iter().map(of_batch).sum::<usize>();
    }
    assert!(5 * hits > rays, "{hits} of {rays}");
}

#[test]
fn of_equal_solids_in_different_lists_the_least_number_wins() {
    let (p0, p1) = (DVec3::ZERO, DVec3::new(0.0, 0.0, 1.0));
    let cylinder = AnySolid::from(Cylinder::new(p0, p1, 0.5, Caps::Both).unwrap());
    let cone = AnySolid::from(Cone::new(p0, p1, 0.5, 0.5, Caps::Both).unwrap());
    let ray = Ray::new(DVec3::new(-3.0, 0.1, 0.3), DVec3::X);
    for solids in [[cylinder, cone], [cone, cylinder]] {
        for options in test_support::ways_to_trace() {
            let tracer = traced(vec![prototype_of(&solids)], &options);
            let mut closest = Vec::new();
            tracer.closest_batch(&[ray; 16], &mut closest);
            closest.push(tracer.closest(&ray));
            for hit in closest {
                let hit = hit.expect("both are hit");
                assert_eq!((hit.primitive, hit.solid), (0, solids[0].kind()));
            }
            let numbers: Vec<u32> = all_hits(&tracer, &ray)
                .iter()
                .map(|hit| hit.primitive)
                .collect();
            assert_eq!(numbers, [0, 1, 0, 1]);
        }
    }
}

#[test]
fn spawned_rays_do_not_meet_the_solid_they_left() {
    let solids = crowd(SEED + 2, 90);
    let tracer = tracer_of(vec![prototype_of(&solids)]);
    let spawned: u64 = (0..test_support::ray_count() / 5)
        .into_par_iter()
        .map(|number| {
            let mut random = Random::new(SEED, 200_000 + number);
            let ray = ray_through(&mut random);
            let Some(hit) = tracer.closest(&ray) else {
                return 0;
            };
            let side = if ray.direction.dot(hit.normal) < 0.0 {
                1.0
            } else {
                -1.0
            };
            let solid = &solids[hit.primitive as usize];
            if side < 0.0 && hit.solid != SolidKind::Disk {
                // Through an open end, from inside.
                return 0;
            }
            let outward = hit.normal * side;
            let flat = random.direction();
            let flat = flat - outward * flat.dot(outward);
            let direction = flat + outward * random.log_uniform(1e-17, 1.0);
            if direction.dot(outward) <= 0.0 {
                return 0;
            }
            let next = hit.spawn(direction);
            let case = || {
                format!(
                    "seed {SEED}, {solid:?}, {hit:?}: {}",
                    test_support::bits(&next)
                )
            };
            assert!(
                hits_of_any(solid, &next).is_empty(),
                "starts below: {}",
                case()
            );
            let again = tracer
                .all_hits(&next, 32)
                .any(|again| again.primitive == hit.primitive);
            assert!(!again, "{}", case());
            1
        })
        .sum();
    assert!(spawned > test_support::ray_count() / 50, "{spawned}");
}

#[test]
fn statistics_count_each_kind() {
    let solids = crowd(SEED, 60);
    let root = test_support::placing(vec![
        test_support::placed(1, glam::DAffine3::IDENTITY),
        test_support::placed(1, glam::DAffine3::from_translation(DVec3::X)),
    ]);
    let tracer = tracer_of(vec![root, prototype_of(&solids)]);
    let statistics = tracer.statistics();
    for &kind in SolidKind::SIMPLE {
        assert_eq!(statistics.unique[kind], 10, "{kind}");
        assert_eq!(statistics.instanced[kind], 20, "{kind}");
    }
    assert_eq!(statistics.unique.total(), 60);
    let contents = tracer.scene().contents();
    assert_eq!(contents[1].solids.counts, statistics.unique);
    for layout in [Layout::Single, Layout::Block] {
        let options = Options {
            layout,
            build: BuildTime::AtOnce,
            ..Options::default()
        };
        let statistics = traced(tracer.scene().prototypes.clone(), &options).statistics();
        let estimate = MemoryEstimate::of(&contents, layout, None);
        let kept = estimate.records_bytes + estimate.copies_bytes;
        assert_eq!(kept, statistics.records_bytes as u64, "{layout:?}");
    }
}
