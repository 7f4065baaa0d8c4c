//! Packets, and the tightness of copies; `tests/solids/filters.rs` searches for lost hits.

use std::array::from_fn;

use glam::DVec3;

use super::{Filter, FilterLosses, Filtered, NearPacket, survivors};
use crate::embree::{GREATEST_PACKET, RaySet, Rays32};
use crate::math::{Bounds, LANES, Random, Ray};
use crate::solid::{AnySolid, Caps, Cylinder, Sphere};
use crate::tracer::frame::{Frame, LocalRay};

const SEED: u64 = 20_261_129;

fn within(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array(from_fn(|_| random.uniform(-size, size)))
}

/// Sticks of length 1, a twentieth as thick, within a cube of side 2.
fn sticks(random: &mut Random) -> Vec<Cylinder> {
    let stick = |_| {
        let p0 = within(random, 1.0);
        let p1 = p0 + random.direction();
        Cylinder::new(p0, p1, 0.05, Caps::Both).expect("a stick")
    };
    (0..LANES).map(stick).collect()
}

/// A ray to near a point, from near a side.
fn ray_near(random: &mut Random, (target, side): (DVec3, DVec3), apart: f64) -> Ray {
    let target = target + within(random, apart);
    let direction = side + within(random, apart);
    Ray::new(target - direction * 5.0, direction)
}

/// A prototype much larger than the sticks.
fn whole() -> Bounds {
    Bounds::at(DVec3::ZERO).grown(20.0)
}

#[test]
fn most_near_cylinders_that_are_missed_do_not_survive() {
    let (mut spare, mut pairs) = (0, 0);
    for index in 0..500 {
        let mut random = Random::new(SEED, index);
        let sticks = sticks(&mut random);
        let rays: Vec<Ray> = (0..20)
            .map(|_| {
                let target = (within(&mut random, 1.0), random.direction());
                ray_near(&mut random, target, 0.0)
            })
            .collect();
        let solids: Vec<AnySolid> = sticks.iter().map(|&stick| stick.into()).collect();
        let losses = FilterLosses::of(&solids, &whole(), &rays, 1.0);
        assert_eq!(losses.lost, 0);
        spare += losses.spare;
        pairs += (rays.len() * sticks.len()) as u64 - losses.hits;
    }
    // A unit is a fifth of the radius, and about one is added at each side. A line through the
    // cube crosses a stick's middle plane within that with a probability of some 1 %.
    assert!(spare * 50 < pairs, "{spare} of {pairs} misses survive");
}

/// Balls with a radius of a quarter of a stick's length, within the same cube.
fn balls(random: &mut Random) -> Vec<Sphere> {
    let ball = |_| Sphere::new(within(random, 1.0), 0.25).expect("a ball");
    (0..LANES).map(ball).collect()
}

#[test]
fn packets_keep_of_cylinders_what_single_rays_keep() {
    assert_packets_keep(sticks);
}

#[test]
fn packets_keep_of_spheres_what_single_rays_keep() {
    assert_packets_keep(balls);
}

fn assert_packets_keep<S: Filtered>(solids: impl Fn(&mut Random) -> Vec<S>) {
    let frame = Frame::new(&whole());
    let mut kept = 0;
    for index in 0..300 {
        let mut random = Random::new(SEED, index);
        let filter = S::filter(&solids(&mut random), &frame, 1.0);
        let mut rays = Rays32 {
            origin: [[0.0; GREATEST_PACKET]; 3],
            direction: [[1.0; GREATEST_PACKET]; 3],
            t_far: [0.0; GREATEST_PACKET],
        };
        let target = (within(&mut random, 1.0), random.direction());
        let apart = random.log_uniform(1e-6, 0.5);
        for number in 0..GREATEST_PACKET {
            let ray = LocalRay::new(&ray_near(&mut random, target, apart));
            let (_, ray32) = frame.enter(&ray, 0.0, f64::INFINITY).expect("it enters");
            for axis in 0..3 {
                rays.origin[axis][number] = ray32.origin[axis];
                rays.direction[axis][number] = ray32.direction[axis];
            }
            rays.t_far[number] = ray32.t_far;
        }
        let wanted = RaySet::from_bits(random.bits() as u16);
        let packet = NearPacket::new(filter.cell(), &rays, wanted);
        for lane in 0..LANES {
            let alone = (0..GREATEST_PACKET)
                .filter(|&ray| survivors(&filter, &rays.ray(ray)) >> lane & 1 == 1);
            let alone = alone.collect::<RaySet>() & wanted;
            kept += alone.len();
            assert_eq!(packet.survivors(&filter, lane), alone, "{index}, {lane}");
            let passes = packet.lanes(&filter) >> lane & 1 == 1;
            assert!(passes || alone.is_empty(), "{index}, {lane}");
        }
    }
    assert!(kept > 100, "{kept} survive, the test sees nothing");
}
