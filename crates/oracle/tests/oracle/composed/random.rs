//! The oracle on the families of set operations, against points near by.
//!
//! A point that is displaced at random is off all surfaces, so what the operations say
//! there is a matter of exact membership alone. What is inside has only points
//! of the set around it, what is outside has none, and the boundary has both, but for
//! slivers that a displacement seldom finds.

use cyltrace::math::Random;
use cyltrace::solid::{Crossing, Location};
use cyltrace_oracle::cases::{ComposedFamily, Inputs};
use cyltrace_oracle::{ComposedTruth, to_f64};
use glam::DVec3;

use super::closed;
use test_support::trees::holds;

const SEED: u64 = 5;
/// Displacements: far above the rounding of points, far below the grid.
const NEAR: f64 = 1e-7;

fn cases() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(100, |count| count.parse().expect("a number"))
}

#[test]
fn locations_agree_with_points_near_by() {
    for family in ComposedFamily::ALL {
        let (mut boundary, mut both, mut kept_by_closed_sets) = (0, 0, 0);
        for index in 0..cases() {
            let case = family.case(SEED, index, Inputs::F32);
            let truth = ComposedTruth::new(&case.composition);
            let mut random = Random::new(SEED, index);
            for point in case.points {
                let location = truth.locate(point);
                kept_by_closed_sets += u64::from(closed(&case.composition, point) != location);
                let near: Vec<bool> = (0..24)
                    .map(|_| point + random.direction() * (NEAR * point.length().max(1.0)))
                    .map(|near| holds(&case.composition, near))
                    .collect();
                let is_right = match location {
                    Location::Inside => !near.contains(&false),
                    Location::Outside => !near.contains(&true),
                    Location::Boundary => true,
                };
                let replay = format!("{}:f32:{SEED}:{index}", family.name());
                assert!(is_right, "{replay}: {point} is {location:?}, not near by");
                if location == Location::Boundary {
                    boundary += 1;
                    both += u64::from(near.contains(&true) && near.contains(&false));
                }
            }
        }
        println!(
            "{}: {boundary} points in the boundary, {both} between points of both kinds; \
             closed sets are wrong at {kept_by_closed_sets}",
            family.name()
        );
        assert!(both * 10 >= boundary * 9 && both > 0, "{}", family.name());
        // The planted fault: operations on closed sets.
        let touches = family != ComposedFamily::Mixed;
        assert!(kept_by_closed_sets > 0 || !touches, "{}", family.name());
    }
}

#[test]
fn hits_are_in_order_and_between_both_sides() {
    let (mut hits, mut touches, mut both) = (0, 0, 0);
    for family in ComposedFamily::ALL {
        for index in 0..cases() {
            let case = family.case(SEED, index, Inputs::F32);
            let replay = format!("{}:f32:{SEED}:{index}", family.name());
            let found = ComposedTruth::new(&case.composition).hits(&case.ray);
            assert!(
                found.is_sorted_by(|one, other| one.t <= other.t),
                "{replay}"
            );
            let alternate =
                |pair: &[cyltrace_oracle::ComposedHit]| pair[0].crossing != pair[1].crossing;
            // The start of a range within the boundary counts as the entry before it.
            assert!(found.windows(2).all(alternate), "{replay}");
            let mut random = Random::new(SEED, index);
            for hit in &found {
                assert!(
                    !hit.faces.is_empty(),
                    "{replay}: no face at {}",
                    to_f64(&hit.t)
                );
                let point = case.ray.origin + case.ray.direction * to_f64(&hit.t);
                let mut near = |_| {
                    let off: DVec3 = random.direction() * (NEAR * point.length().max(1.0));
                    holds(&case.composition, point + off)
                };
                let near: Vec<bool> = (0..24).map(&mut near).collect();
                both += u64::from(near.contains(&true) && near.contains(&false));
                hits += 1;
            }
            let is_touch = |pair: &[cyltrace_oracle::ComposedHit]| {
                pair[0].t == pair[1].t && pair[0].crossing == Crossing::Enter
            };
            touches += found.windows(2).filter(|pair| is_touch(pair)).count();
        }
    }
    println!("{hits} hits, {both} between points of both kinds, {touches} touches");
    assert!(both * 10 >= hits * 9 && touches > 0);
}
