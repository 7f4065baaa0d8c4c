//! What a ray crosses of closed solids: it comes out of all that it goes into, one
//! after the other, and is inside in between.
//!
//! `CYLTRACE_PARITY_RAYS` sets how many rays are tried.

use std::collections::BTreeMap;

use cyltrace::math::{Random, Ray};
use cyltrace::solid::{AnySolid, Caps, Crossing};
use cyltrace::tracer::{Hit, Tracer};
use glam::DVec3;
use rayon::prelude::*;

use super::{SEED, all_hits, tracer_of};
use test_support::bits;
use test_support::solids::{any_solid, prototype_of, ray_through};

const RAYS_OF_A_SCENE: u64 = 250;
const POINTS_OF_A_RAY: u64 = 100;

fn ray_count() -> u64 {
    std::env::var("CYLTRACE_PARITY_RAYS").map_or(20_000, |count| count.parse().expect("a number"))
}

/// Closed solids that overlap: all kinds but the disk.
fn overlapping(seed: u64) -> Vec<AnySolid> {
    let mut random = Random::new(seed, 5);
    (0..50)
        .map(|number| any_solid(&mut random, number % 5, Caps::Both, true))
        .collect()
}

/// Where the line of a ray goes in and comes out, by solid.
fn intervals(found: &[Hit], case: &dyn Fn() -> String) -> BTreeMap<u32, [f64; 2]> {
    let mut crossings: BTreeMap<u32, Vec<(Crossing, f64)>> = BTreeMap::new();
    for hit in found {
        let of_solid = crossings.entry(hit.primitive).or_default();
        of_solid.push((hit.crossing, hit.t));
    }
    let ends = |of_solid: Vec<(Crossing, f64)>| match of_solid[..] {
        [(Crossing::Enter, enter), (Crossing::Leave, leave)] => [enter, leave],
        _ => panic!("{of_solid:?}: {}", case()),
    };
    crossings
        .into_iter()
        .map(|(primitive, of_solid)| (primitive, ends(of_solid)))
        .collect()
}

/// Checks that entries and exits alternate, holds `contains` at points along the ray
/// against the solids that are entered and not left there, and answers with how many of the points some solid holds.
fn judge_points(
    tracer: &Tracer,
    ray: &Ray,
    found: &[Hit],
    random: &mut Random,
    case: &dyn Fn() -> String,
) -> u64 {
    let intervals = intervals(found, case);
    let length = ray.direction.length();
    let middle = (DVec3::splat(0.5) - ray.origin).dot(ray.direction) / (length * length);
    let mut inside = 0;
    for _ in 0..POINTS_OF_A_RAY {
        // Anywhere in the cube and about it, or between neighbouring crossings.
        let t = match random.below(2 * found.len().max(1) as u64) as usize {
            first if first + 1 < found.len() => random.uniform(found[first].t, found[first + 1].t),
            _ => middle + random.uniform(-1.0, 1.0) / length,
        };
        let holding: Vec<u32> = tracer
            .contains(ray.at(t))
            .iter()
            .map(|one| one.primitive)
            .collect();
        // The point is off the line by its rounding, 1e-14, and s from an end of a chord it
        // is s² / 2 r off a wall of radius r, with s and r at most 0.3: 1e-5 is far more than
        // enough. A shallower angle to a plane than 1e-9 is not drawn.
        let is_clear = |end: &f64| (t - end).abs() * length > 1e-5;
        for (primitive, ends) in &intervals {
            if ends.iter().all(is_clear) {
                let is_between = ends[0] < t && t < ends[1];
                let is_held = holding.contains(primitive);
                assert_eq!(is_held, is_between, "{primitive} at {t}: {}", case());
            }
        }
        for primitive in &holding {
            assert!(intervals.contains_key(primitive), "at {t}: {}", case());
        }
        inside += u64::from(!holding.is_empty());
    }
    inside
}

/// Crossings by solid, entries first, with the parameters of the ray that `sign` turns.
fn sorted(hits: &[Hit], sign: f64) -> Vec<(u32, Crossing, f64)> {
    let crossing = |hit: &Hit| match hit.crossing {
        Crossing::Enter if sign < 0.0 => Crossing::Leave,
        Crossing::Leave if sign < 0.0 => Crossing::Enter,
        crossing => crossing,
    };
    let mut sorted: Vec<_> = hits
        .iter()
        .map(|hit| (hit.primitive, crossing(hit), sign * hit.t))
        .collect();
    sorted.sort_by(|one, other| {
        let by_solid = (one.0, one.1).cmp(&(other.0, other.1));
        by_solid.then(one.2.total_cmp(&other.2))
    });
    sorted
}

#[test]
fn what_is_entered_is_left_and_held_in_between() {
    let (hits, inside) = (0..ray_count() / RAYS_OF_A_SCENE)
        .into_par_iter()
        .map(|scene| {
            let tracer = tracer_of(vec![prototype_of(&overlapping(SEED + scene))]);
            let (mut hits, mut inside) = (0, 0);
            for number in 0..RAYS_OF_A_SCENE {
                let mut random = Random::new(SEED, 10_000_000 + RAYS_OF_A_SCENE * scene + number);
                let ray = Ray {
                    t_min: f64::NEG_INFINITY,
                    ..ray_through(&mut random)
                };
                let case = || format!("seed {SEED}, scene {scene}: {}", bits(&ray));
                let found = all_hits(&tracer, &ray);
                inside += judge_points(&tracer, &ray, &found, &mut random, &case);
                let back = Ray {
                    direction: -ray.direction,
                    ..ray
                };
                let back: Vec<Hit> = tracer.all_hits(&back, 32).collect();
                assert_eq!(sorted(&back, -1.0), sorted(&found, 1.0), "{}", case());
                hits += found.len() as u64;
            }
            (hits, inside)
        })
        .reduce(|| (0, 0), |one, other| (one.0 + other.0, one.1 + other.1));
    let rays = ray_count();
    let points = rays * POINTS_OF_A_RAY;
    println!("{rays} rays, {hits} crossings, {inside} of {points} points inside");
    assert!(hits > rays && 20 * inside > points, "{hits} {inside}");
}
