//! Filters of blocks lose no hit: every family of cases, among neighbours in frames of their
//! own and far larger ones, with rays that graze walls, edges and discs, and ranges that
//! begin or end where a surface is met. Smaller margins do lose hits.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test filters` puts so many rays of each family
//! to filters; the default is a hundredth of it.

use std::array::from_fn;

use cyltrace::cases::{Family, Inputs};
use cyltrace::math::{Bounds, LANES, Random, Ray};
use cyltrace::solid::{Cylinder, triple_product};
use cyltrace::tracer::FilterLosses;
use glam::DVec3;
use rayon::prelude::*;

const SEED: u64 = 20_261_129;

/// Rays for each block.
const RAYS: u64 = 32;

/// Blocks for each family and kind of inputs.
fn blocks() -> u64 {
    let rays = std::env::var("CYLTRACE_RAYS").ok();
    let rays = rays.and_then(|rays| rays.parse::<u64>().ok());
    rays.unwrap_or(10_000).div_ceil(RAYS)
}

/// A block and the box of the prototype that it is in.
struct Block {
    cylinders: Vec<Cylinder>,
    whole: Bounds,
    ray: Ray,
}

/// A vector with no component larger than `size`.
fn within(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array(from_fn(|_| random.uniform(-size, size)))
}

impl Block {
    /// A case with neighbours of about its size.
    fn new(random: &mut Random, family: Family, inputs: Inputs, index: u64) -> Self {
        let problem = family.case(SEED, index, inputs);
        let one = problem.cylinder;
        let size = (one.p1() - one.p0()).length() + one.radius();
        let mut cylinders = vec![one];
        let count = 1 + random.below(LANES as u64) as usize;
        while cylinders.len() < count {
            let far = size * random.log_uniform(1e-3, 4.0);
            let moved = within(random, far);
            let long = size * random.log_uniform(1e-3, 1.0);
            let turned = within(random, long);
            let radius = one.radius() * random.log_uniform(0.1, 2.0);
            let (p0, p1) = (one.p0() + moved, one.p1() + moved + turned);
            cylinders.extend(Cylinder::new(p0, p1, radius, one.caps()).ok());
        }
        let boxes = cylinders.iter().map(Cylinder::bounds);
        let around = boxes.fold(Bounds::EMPTY, |sum, one| sum.union(&one));
        // Others in the prototype make its box larger.
        let larger = match random.below(3) {
            0 => 1.0,
            _ => random.log_uniform(1.0, 1e4),
        };
        let middle = around.centre() + within(random, around.extent().length() * (larger - 1.0));
        Self {
            cylinders,
            whole: around.union(&Bounds::at(middle)),
            ray: problem.ray,
        }
    }

    /// A ray that leaves a cylinder's surface at a point about as it touches it there, or
    /// through an edge, with a range that may begin or end there.
    fn grazing(&self, random: &mut Random) -> Ray {
        let cylinder = &self.cylinders[random.below(self.cylinders.len() as u64) as usize];
        let whole_axis = cylinder.p1() - cylinder.p0();
        let (axis, length) = (whole_axis.normalize(), whole_axis.length());
        let outward = axis.cross(random.direction()).normalize();
        let depth = random.log_uniform(1e-12, 1e-2);
        let side = cylinder.radius() * (1.0 - depth) * outward;
        let near_end = match random.below(3) {
            0 => random.unit(),
            1 => random.log_uniform(1e-12, 1e-2),
            _ => 1.0 - random.log_uniform(1e-12, 1e-2),
        };
        let target = cylinder.p0() + whole_axis * near_end + side;
        let across = outward.cross(axis);
        let along = random.uniform(-1.0, 1.0);
        let tangent = match random.below(4) {
            0 => axis + across * random.log_uniform(1e-9, 1.0),
            1 => random.direction(),
            // About in the plane of a disc.
            2 => across + outward * along + axis * random.log_uniform(1e-9, 1e-2),
            _ => across + axis * along,
        };
        let way = (length + cylinder.radius()) * random.log_uniform(1e-2, 1e6);
        let direction = tangent.normalize() * random.log_uniform(1e-3, 1e3);
        Ray::new(target - tangent.normalize() * way, direction)
    }

    /// The ray with a range that begins or ends where it meets a cylinder's surface.
    fn ranged(&self, random: &mut Random, mut ray: Ray) -> Ray {
        let cylinder = &self.cylinders[random.below(self.cylinders.len() as u64) as usize];
        let from_p0 = ray.origin - cylinder.p0();
        if let Some(chord) = triple_product::chord(cylinder, from_p0, ray.direction) {
            match random.below(4) {
                0 => ray.t_min = chord.leave.t,
                1 => ray.t_max = chord.enter.t,
                2 => (ray.t_min, ray.t_max) = (chord.enter.t, chord.enter.t),
                _ => {}
            }
        }
        ray
    }
}

/// What filters with a share of the margins lose of all families.
fn losses(share: f64) -> FilterLosses {
    let mut sum = FilterLosses::default();
    for family in Family::ALL {
        for inputs in Inputs::ALL {
            let blocks = (0..blocks()).into_par_iter().map(|index| {
                let mut random = Random::new(SEED, index);
                let block = Block::new(&mut random, family, inputs, index);
                let mut rays = vec![block.ray];
                rays.extend((1..RAYS).map(|_| block.grazing(&mut random)));
                let rays: Vec<Ray> = rays
                    .into_iter()
                    .map(|ray| block.ranged(&mut random, ray))
                    .collect();
                FilterLosses::of_cylinders(&block.cylinders, &block.whole, &rays, share)
            });
            let of_family = blocks.reduce(FilterLosses::default, plus);
            println!("{}, {}: {of_family:?}", family.name(), inputs.name());
            sum = plus(sum, of_family);
        }
    }
    println!("{share} of the margins: {sum:?}");
    sum
}

fn plus(one: FilterLosses, other: FilterLosses) -> FilterLosses {
    FilterLosses {
        hits: one.hits + other.hits,
        lost: one.lost + other.lost,
        spare: one.spare + other.spare,
    }
}

#[test]
fn cylinders_that_are_hit_survive() {
    let losses = losses(1.0);
    let rays = blocks() * RAYS * 2 * Family::ALL.len() as u64;
    assert!(losses.hits > rays / 2, "{losses:?}: the test sees nothing");
    assert_eq!(losses.lost, 0, "{losses:?}");
}

#[test]
fn smaller_margins_lose_hits() {
    for share in [0.0, 0.5, 0.8] {
        let losses = losses(share);
        assert!(losses.lost > 0, "{share} of the margins: {losses:?}");
    }
}
