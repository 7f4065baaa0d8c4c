//! What a ray crosses of closed solids: it comes out of all that it goes into, one
//! after the other, and is inside in between.

use std::collections::BTreeMap;

use cyltrace::math::{Random, Ray};
use cyltrace::solid::{AnySolid, Caps, Crossing};
use cyltrace::tracer::Hit;
use rayon::prelude::*;

use crate::support::bits;
use crate::support::solids::{any_solid, prototype_of, ray_through};
use crate::{SEED, all_hits, tracer_of};

/// Closed solids that overlap: all kinds but the disk.
fn overlapping(seed: u64) -> Vec<AnySolid> {
    let mut random = Random::new(seed, 5);
    (0..50)
        .map(|number| any_solid(&mut random, number % 5, Caps::Both, true))
        .collect()
}

/// The hits of a ray turned round, as those of the ray: in its order, with its
/// crossings and parameters.
fn turned_back(mut hits: Vec<Hit>) -> Vec<(f64, u32, Crossing)> {
    hits.reverse();
    hits.iter()
        .map(|hit| {
            let crossing = match hit.crossing {
                Crossing::Enter => Crossing::Leave,
                Crossing::Leave => Crossing::Enter,
            };
            (-hit.t, hit.primitive, crossing)
        })
        .collect()
}

#[test]
fn what_is_entered_is_left_and_held_in_between() {
    let tallies: Vec<(u64, u64)> = (0..20)
        .into_par_iter()
        .map(|scene| {
            let tracer = tracer_of(vec![prototype_of(&overlapping(SEED + scene))]);
            let (mut hits, mut points) = (0, 0);
            for number in 0..300 {
                let mut random = Random::new(SEED, 500_000 + 1_000 * scene + number);
                let ray = Ray {
                    t_min: f64::NEG_INFINITY,
                    ..ray_through(&mut random)
                };
                let found = all_hits(&tracer, &ray);
                let case = || format!("seed {SEED}, scene {scene}: {}", bits(&ray));

                let mut crossings: BTreeMap<u32, Vec<Crossing>> = BTreeMap::new();
                for hit in &found {
                    crossings
                        .entry(hit.primitive)
                        .or_default()
                        .push(hit.crossing);
                }
                for of_solid in crossings.values() {
                    assert_eq!(
                        of_solid[..],
                        [Crossing::Enter, Crossing::Leave],
                        "{}",
                        case()
                    );
                }

                let mut inside = Vec::new();
                for pair in found.windows(2) {
                    match pair[0].crossing {
                        Crossing::Enter => inside.push(pair[0].primitive),
                        Crossing::Leave => inside.retain(|one| *one != pair[0].primitive),
                    }
                    // In a shorter chord the point, once rounded, might be outside.
                    if (pair[1].t - pair[0].t) * ray.direction.length() > 1e-5 {
                        let t = pair[0].t.midpoint(pair[1].t);
                        let holding = tracer.contains(ray.origin + ray.direction * t);
                        let holding: Vec<u32> = holding.iter().map(|one| one.primitive).collect();
                        inside.sort_unstable();
                        assert_eq!(holding, inside, "at {t}: {}", case());
                        points += 1;
                    }
                }

                let back = Ray {
                    direction: -ray.direction,
                    ..ray
                };
                let mut back = turned_back(tracer.all_hits(&back, 32).collect());
                let mut forth: Vec<_> = found
                    .iter()
                    .map(|hit| (hit.t, hit.primitive, hit.crossing))
                    .collect();
                for list in [&mut back, &mut forth] {
                    list.sort_by(|one, other| {
                        (one.1, one.2)
                            .cmp(&(other.1, other.2))
                            .then(one.0.total_cmp(&other.0))
                    });
                }
                assert_eq!(back, forth, "turned round: {}", case());
                hits += found.len() as u64;
            }
            (hits, points)
        })
        .collect();
    let hits: u64 = tallies.iter().map(|tally| tally.0).sum();
    let points: u64 = tallies.iter().map(|tally| tally.1).sum();
    println!("{hits} crossings, {points} points in between");
    assert!(hits > 10_000 && points > 5_000, "{hits} {points}");
}
