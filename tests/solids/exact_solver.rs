//! The exact solver against the oracle, which shares no code with it: random
//! cases, and ties that must come out right.

use cyltrace::math::{Random, Ray};
use cyltrace::solid::exact::{self, Stage};
use cyltrace::solid::{Caps, Cylinder};
use glam::DVec3;

const SEED: u64 = 41;

fn assert_agrees(cylinder: &Cylinder, ray: &Ray, case: &str) -> Stage {
    let (hit, stage) = exact::first(cylinder, ray);
    let truth = cyltrace_oracle::first_hit(cylinder, ray).hit;
    let found = hit.as_ref().map(|hit| (hit.part, hit.crossing));
    let expected = truth.as_ref().map(|truth| (truth.part, truth.crossing));
    assert_eq!(found, expected, "{case}, {stage:?}: {cylinder:?} {ray:?}");
    if let (Some(hit), Some(truth)) = (hit, truth) {
        let off = cyltrace_oracle::to_f64(&(cyltrace_oracle::exact(hit.t) - &truth.t)).abs();
        assert!(
            off <= hit.t_error,
            "{case}: t {:e} off by {off:e}, bound {:e}",
            hit.t,
            hit.t_error
        );
        let t: f64 = exact::rounded_t(cylinder, ray, &hit);
        assert_eq!(t, truth.t_f64(), "{case}, {stage:?}: {cylinder:?} {ray:?}");
    }
    stage
}

/// Numbers with few bits, so that ties are frequent.
fn coarse(random: &mut Random) -> f64 {
    (random.below(17) as f64 - 8.0) * 0.25
}

fn coarse_vector(random: &mut Random) -> DVec3 {
    DVec3::new(coarse(random), coarse(random), coarse(random))
}

/// A case on the coarse grid, lengths times `size` and the direction times
/// `stretch`, or `None` where it is no case.
fn coarse_case(case: u64, size: f64, stretch: f64) -> Option<(Cylinder, Ray)> {
    let mut random = Random::new(SEED, case);
    let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
    let radius = size * 0.25 * (1 + random.below(8)) as f64;
    let (p0, p1) = (coarse_vector(&mut random), coarse_vector(&mut random));
    let cylinder = Cylinder::new(p0 * size, p1 * size, radius, caps).ok()?;
    let by_t = size / stretch;
    let t_min = [0.0, -by_t, 0.5 * by_t, f64::NEG_INFINITY][random.below(4) as usize];
    let t_max = [f64::INFINITY, by_t, 2.0 * by_t][random.below(3) as usize];
    let (origin, direction) = (coarse_vector(&mut random), coarse_vector(&mut random));
    let ray = Ray {
        t_min,
        t_max,
        ..Ray::new(origin * size, direction * stretch)
    };
    ray.is_valid().then_some((cylinder, ray))
}

#[test]
fn ties_on_a_coarse_grid_are_decided_exactly() {
    let mut stages = [0_u64; 3];
    for case in 0..50_000 {
        if let Some((cylinder, ray)) = coarse_case(case, 1.0, 1.0) {
            let stage = assert_agrees(&cylinder, &ray, &format!("seed {SEED}, case {case}"));
            stages[stage as usize] += 1;
        }
    }
    println!("settled in f64, double-double, any length: {stages:?}");
    assert!(stages[0] > 20_000 && stages[1] > 100, "{stages:?}");
}

/// Products of the double-double stage overflow or vanish there.
#[test]
fn ties_at_the_ends_of_the_range_are_decided_exactly() {
    let mut decided = 0;
    for (size, stretch) in [(148, 98), (148, -98), (-147, 98), (-147, -98)] {
        let power = |exponent| 2.0_f64.powi(exponent);
        for case in 0..10_000 {
            if let Some((cylinder, ray)) = coarse_case(case, power(size), power(stretch)) {
                let name = format!("seed {SEED}, case {case}, sizes 2^{size}, 2^{stretch}");
                assert_agrees(&cylinder, &ray, &name);
                decided += 1;
            }
        }
    }
    assert!(decided > 30_000, "{decided}");
}

#[test]
fn random_cases_are_decided_exactly() {
    let mut stages = [0_u64; 3];
    for case in 0..40_000 {
        let mut random = Random::new(SEED + 1, case);
        let mut point = |low, high| {
            let size = random.log_uniform(low, high);
            random.direction() * size
        };
        let (p0, along, towards) = (point(1e-3, 1e3), point(1e-3, 1e3), point(1e-3, 1e3));
        let away = point(1e-3, 1e6);
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let radius = random.log_uniform(1e-6, 1e3);
        let cylinder = Cylinder::new(p0, p0 + along, radius, caps).unwrap();
        let outward = along.cross(towards).normalize();
        let graze = 1.0 + random.log_uniform(1e-18, 1.0) * (random.unit() - 0.5);
        let target = p0 + along * random.uniform(-0.1, 1.1) + outward * (radius * graze);
        let origin = match random.below(4) {
            0 => target,
            _ => target + away,
        };
        let direction = match random.below(4) {
            0 => along * random.log_uniform(1e-3, 1e3) + away * random.log_uniform(1e-20, 1e-3),
            1 => along.cross(outward),
            _ => target - origin + towards * random.log_uniform(1e-18, 1e-3),
        };
        let ray = Ray::new(origin, direction);
        if ray.is_valid() {
            let stage = assert_agrees(&cylinder, &ray, &format!("seed {SEED}, case {case}"));
            stages[stage as usize] += 1;
        }
    }
    println!("settled in f64, double-double, any length: {stages:?}");
    assert!(
        stages[0] > 20_000 && stages[1] > 100 && stages[2] > 10,
        "{stages:?}"
    );
}
