//! All hits of a ray: complete, in order, none doubled, the same for every
//! batch, and in agreement with the exhaustive search and exact arithmetic.

use std::cmp::Ordering;
use std::sync::Arc;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Solids,
};
use cyltrace::solid::{Caps, Crossing, Cylinder, Part};
use cyltrace::tracer::{Hit, Options, Tracer};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

const SEED: u64 = 12;

fn tracer_of(prototypes: Vec<Prototype>) -> Tracer {
    Tracer::new(test_support::scene_of(prototypes), &Options::default()).unwrap()
}

fn root_of(cylinders: &[Cylinder]) -> Prototype {
    let records = cylinders.iter().enumerate();
    let record = |(i, cylinder)| CylinderRecord::new(cylinder, i as u32, MaterialIndex(0));
    Prototype {
        solids: Solids::of_cylinders(records.map(record)),
        ..Default::default()
    }
}

/// Cylinders of a crowded cube: thick enough that most rays meet several.
fn crowd(seed: u64, count: u32, caps: Option<Caps>) -> Vec<CylinderRecord> {
    let thicker = |record: &CylinderRecord| {
        let one = record.cylinder();
        let caps = caps.unwrap_or(one.caps());
        let cylinder = Cylinder::new(one.p0(), one.p1(), one.radius() + 0.05, caps).unwrap();
        CylinderRecord::new(&cylinder, record.primitive(), record.material())
    };
    let thin = test_support::cylinders_in_a_box(seed, count);
    thin.iter().map(thicker).collect()
}

fn all(tracer: &Tracer, ray: &Ray) -> Vec<Hit> {
    all_by(tracer, ray, 32)
}

/// All hits, a batch at a time; fails where there are more than two a cylinder,
/// so that a search that finds a hit again does not go on for ever.
fn all_by(tracer: &Tracer, ray: &Ray, batch: usize) -> Vec<Hit> {
    let most = 2 * tracer.statistics().instanced.total() as usize;
    let hits: Vec<Hit> = tracer.all_hits(ray, batch).take(most + 1).collect();
    assert!(
        hits.len() <= most,
        "more than {most} hits in batches of {batch}, the last {:?}: {}",
        hits.last(),
        test_support::bits(ray)
    );
    hits
}

/// A ray through the unit cube.
fn ray_through(random: &mut Random) -> Ray {
    let mut inside = || DVec3::new(random.unit(), random.unit(), random.unit());
    let (from, to) = (inside(), inside());
    let back = random.log_uniform(1e-2, 10.0);
    let direction = (to - from) * random.log_uniform(1e-3, 1e3);
    Ray::new(from - (to - from).normalize() * back, direction)
}

/// The order that hits are promised in.
fn order(one: &Hit, other: &Hit) -> Ordering {
    one.t.partial_cmp(&other.t).unwrap().then_with(|| {
        let key = |hit: &Hit| (hit.instance.clone(), hit.primitive, hit.crossing, hit.part);
        key(one).cmp(&key(other))
    })
}

/// What exact arithmetic finds on one cylinder after another, by asking again
/// from behind each hit: parts and crossings in order of the true `t`. Rays
/// with two hits nearer than f64 tells apart are left out by the caller.
fn true_hits(cylinders: &[CylinderRecord], ray: &Ray) -> Vec<(f64, u32, Part, Crossing)> {
    let mut found = Vec::new();
    for record in cylinders {
        let mut rest = *ray;
        while let Some(hit) = cyltrace_oracle::first_hit(&record.cylinder(), &rest).hit {
            let t = hit.t_f64();
            found.push((t, record.primitive(), hit.part, hit.crossing));
            rest.t_min = t + t.abs() * 1e-9;
        }
    }
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    found
}

#[test]
fn hits_are_those_of_exact_arithmetic() {
    let cylinders = crowd(SEED, 60, None);
    let root = Prototype {
        solids: Solids::of_cylinders(cylinders.clone()),
        ..Default::default()
    };
    let tracer = tracer_of(vec![root]);
    let hits: usize = (0..3_000_u64)
        .into_par_iter()
        .map(|number| {
            let ray = ray_through(&mut Random::new(SEED, 1_000 + number));
            let expected = true_hits(&cylinders, &ray);
            let found = all(&tracer, &ray);
            let case = || format!("seed {SEED}, ray {number}: {}", test_support::bits(&ray));
            assert_eq!(found.len(), expected.len(), "{}", case());
            // Twins and touching ends share their t up to rounding; compare as sets there.
            let mut keys: Vec<_> = found
                .iter()
                .map(|hit| (hit.primitive, hit.crossing, hit.part))
                .collect();
            let mut expected_keys: Vec<_> = expected
                .iter()
                .map(|&(_, primitive, part, crossing)| (primitive, crossing, part))
                .collect();
            keys.sort();
            expected_keys.sort();
            assert_eq!(keys, expected_keys, "{}", case());
            for (hit, truth) in found.iter().zip(&expected) {
                assert!(
                    (hit.t - truth.0).abs() <= 1e-9 * truth.0.abs(),
                    "{}",
                    case()
                );
            }
            found.len()
        })
        .sum();
    assert!(hits > 3_000, "only {hits} hits");
}

#[test]
fn hits_are_ordered_and_the_same_for_every_batch() {
    let mut random = Random::new(SEED, 1);
    let mut place = |of: u32| Placement {
        of: PrototypeIndex(of),
        parent_from_child: DAffine3::from_mat3_translation(
            test_support::random_rotation(&mut random)
                * DMat3::from_diagonal(DVec3::new(1.0, 0.7, 1.4)),
            DVec3::new(random.unit(), random.unit(), random.unit()) * 0.5,
        ),
    };
    let leaf = Prototype {
        solids: Solids::of_cylinders(crowd(SEED, 100, None)),
        ..Default::default()
    };
    let same = place(1);
    let root = Prototype {
        // The last two are the same placement: every hit of theirs is a tie.
        placements: vec![place(1), place(1), same, same],
        solids: Solids::of_cylinders(crowd(SEED + 1, 100, None)),
        ..Default::default()
    };
    let tracer = tracer_of(vec![root, leaf]);
    let hits: usize = (0..2_000_u64)
        .into_par_iter()
        .map(|number| {
            let ray = ray_through(&mut Random::new(SEED, 5_000 + number));
            let hits = all(&tracer, &ray);
            let case = || format!("seed {SEED}, ray {number}: {}", test_support::bits(&ray));
            assert!(
                hits.windows(2)
                    .all(|pair| order(&pair[0], &pair[1]).is_lt()),
                "out of order or doubled: {}",
                case()
            );
            for batch in [1, 2, 3, 7, 1_000] {
                let again = all_by(&tracer, &ray, batch);
                assert_eq!(again, hits, "batch {batch}: {}", case());
            }
            assert_eq!(hits.first(), tracer.closest(&ray).as_ref(), "{}", case());
            hits.len()
        })
        .sum();
    assert!(hits > 5_000, "only {hits} hits");
}

#[test]
fn capped_solids_are_entered_and_left_in_turn() {
    let cylinders = crowd(SEED, 200, Some(Caps::Both));
    let count = cylinders.len();
    let tracer = tracer_of(vec![Prototype {
        solids: Solids::of_cylinders(cylinders),
        ..Default::default()
    }]);
    for number in 0..5_000 {
        let ray = ray_through(&mut Random::new(SEED, 20_000 + number));
        let back = ray.direction.normalize() * 100.0;
        let ray = Ray::new(ray.origin - back, ray.direction);
        let mut is_inside = vec![false; count];
        for hit in all(&tracer, &ray) {
            let inside = &mut is_inside[hit.primitive as usize];
            assert_eq!(
                hit.crossing == Crossing::Leave,
                *inside,
                "ray {number}: {hit:?}"
            );
            *inside = !*inside;
        }
        assert!(
            is_inside.iter().all(|inside| !inside),
            "ray {number} ends inside"
        );
    }
}

#[test]
fn ranges_tangents_and_coincident_ends_follow_the_rule() {
    let upright =
        |z0: f64, z1: f64| Cylinder::new(DVec3::Z * z0, DVec3::Z * z1, 1.0, Caps::Both).unwrap();
    let tracer = tracer_of(vec![root_of(&[upright(0.0, 1.0), upright(1.0, 2.0)])]);
    let rows = |ray: &Ray| -> Vec<(f64, u32, Part, Crossing)> {
        all(&tracer, ray)
            .iter()
            .map(|hit| (hit.t, hit.primitive, hit.part, hit.crossing))
            .collect()
    };
    // Along the axis, through the shared disk: out of one and into the other.
    let axial = Ray::new(DVec3::new(0.5, 0.0, -1.0), DVec3::Z);
    let expected = [
        (1.0, 0, Part::Cap0, Crossing::Enter),
        (2.0, 0, Part::Cap1, Crossing::Leave),
        (2.0, 1, Part::Cap0, Crossing::Enter),
        (3.0, 1, Part::Cap1, Crossing::Leave),
    ];
    assert_eq!(rows(&axial), expected);
    // The range is closed, and may hold nothing or one.
    let of_range = |t_min, t_max| {
        rows(&Ray {
            t_min,
            t_max,
            ..axial
        })
    };
    assert_eq!(of_range(2.0, 2.0), expected[1..3]);
    assert_eq!(of_range(1.5, 1.9), []);
    assert_eq!(of_range(f64::NEG_INFINITY, 1.0), expected[..1]);
    // A tangent enters and leaves at the same t.
    let tangent = Ray::new(DVec3::new(-3.0, 1.0, 0.5), DVec3::X);
    let touch = |crossing| (3.0, 0, Part::Side, crossing);
    assert_eq!(
        rows(&tangent),
        [touch(Crossing::Enter), touch(Crossing::Leave)]
    );
    // Nothing for rays that are none, and for empty scenes.
    assert_eq!(rows(&Ray::new(DVec3::ZERO, DVec3::ZERO)), []);
    let empty = tracer_of(vec![Prototype::default()]);
    assert_eq!(all(&empty, &axial), []);
}

#[test]
fn thousands_of_ties_are_all_found() {
    let one = Cylinder::new(DVec3::ZERO, DVec3::Z, 1.0, Caps::Both).unwrap();
    let tracer = Arc::new(tracer_of(vec![root_of(&vec![one; 3_000])]));
    let ray = Ray::new(DVec3::new(-2.0, 0.0, 0.5), DVec3::X);
    for batch in [1, 32, 4_000] {
        let hits: Vec<_> = all_by(&tracer, &ray, batch)
            .iter()
            .map(|hit| (hit.t, hit.primitive))
            .collect();
        let expected: Vec<_> = (0..6_000)
            .map(|i| (if i < 3_000 { 1.0 } else { 3.0 }, i % 3_000))
            .collect();
        assert_eq!(hits, expected, "batch {batch}");
    }
}

/// A ray within a disk meets it where it gets onto it, or where its range
/// begins, and where it leaves it: not where a batch begins.
#[test]
fn ray_within_coinciding_disks_meets_each_twice_in_any_batch() {
    let one = Cylinder::new(DVec3::ZERO, DVec3::Z, 1.0, Caps::Both).unwrap();
    let aside = Cylinder::new(DVec3::X * 0.5, DVec3::new(0.5, 0.0, 1.0), 1.0, Caps::Both);
    let tracer = tracer_of(vec![root_of(&[one, aside.unwrap(), one, one])]);
    let along = Ray::new(DVec3::new(-3.0, 0.25, 1.0), DVec3::X);
    for t_min in [0.0, 3.0] {
        let ray = Ray { t_min, ..along };
        let hits = all_by(&tracer, &ray, 32);
        assert_eq!(hits.len(), 8);
        let least = hits.iter().map(|hit| hit.t).fold(f64::INFINITY, f64::min);
        assert!(least > 2.0 && hits.iter().all(|hit| hit.part == Part::Cap1));
        assert_eq!(least == t_min, t_min > 0.0);
        for batch in 1..9 {
            assert_eq!(all_by(&tracer, &ray, batch), hits, "batches of {batch}");
        }
    }
}
