//! Filters of blocks lose no hit: every family of cases of every kind of solid, among
//! neighbours in frames of their own and far larger ones, with rays that are the last of
//! parallel ones to hit, and ranges that begin or end where a surface is hit. Smaller margins
//! do lose hits.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test solids filters` traces this many rays of each
//! family; the default is a two hundredth of it.

use std::array::from_fn;

use cyltrace::math::{Bounds, LANES, Random, Ray};
use cyltrace::solid::{AnySolid, Cone, Cuboid, Cylinder, Disk, RoundedCone, SolidKind, Sphere};
use cyltrace::tracer::FilterLosses;
use cyltrace_oracle::cases::{AnyFamily, Inputs};
use glam::DVec3;
use rayon::prelude::*;

const SEED: u64 = 20_261_129;

/// Rays for each block.
const RAYS: u64 = 32;

/// The kinds that have filters.
const KINDS: [SolidKind; 6] = [
    SolidKind::Cylinder,
    SolidKind::Cone,
    SolidKind::RoundedCone,
    SolidKind::Sphere,
    SolidKind::Cuboid,
    SolidKind::Disk,
];

/// Blocks for each family and kind of inputs.
fn blocks() -> u64 {
    let rays = std::env::var("CYLTRACE_RAYS").ok();
    let rays = rays.and_then(|rays| rays.parse::<u64>().ok());
    rays.unwrap_or(5_000).div_ceil(RAYS)
}

/// A block and the box of the prototype that it is in.
struct Block {
    solids: Vec<AnySolid>,
    whole: Bounds,
    ray: Ray,
}

/// A vector with no component larger than `size`.
fn within(random: &mut Random, size: f64) -> DVec3 {
    DVec3::from_array(from_fn(|_| random.uniform(-size, size)))
}

/// A solid of the same kind and about the same size, near another; `None` where the numbers
/// are out of range.
fn neighbour(of: &AnySolid, random: &mut Random) -> Option<AnySolid> {
    let distance = of.size() * random.log_uniform(1e-3, 4.0);
    let moved = within(random, distance);
    let share = random.log_uniform(1e-3, 1.0);
    let turned = within(random, of.size() * share);
    let larger = random.log_uniform(0.1, 2.0);
    match of {
        AnySolid::Cylinder(one) => {
            let (p0, p1) = (one.p0() + moved, one.p1() + moved + turned);
            let near = Cylinder::new(p0, p1, one.radius() * larger, one.caps());
            near.ok().map(AnySolid::from)
        }
        AnySolid::Cone(one) => {
            let (p0, p1) = (one.p0() + moved, one.p1() + moved + turned);
            let (r0, r1) = (one.radius0() * larger, one.radius1());
            Cone::new(p0, p1, r0, r1, one.caps())
                .ok()
                .map(AnySolid::from)
        }
        AnySolid::RoundedCone(one) => {
            let (p0, p1) = (one.p0() + moved, one.p1() + moved + turned);
            let near = RoundedCone::new(p0, p1, one.radius0() * larger, one.radius1());
            near.ok().map(AnySolid::from)
        }
        AnySolid::Sphere(one) => {
            let near = Sphere::new(one.center() + moved, one.radius() * larger);
            near.ok().map(AnySolid::from)
        }
        AnySolid::Cuboid(one) => {
            let turned = one.orientation().rotated(random.direction(), 180.0 * share);
            let near = Cuboid::new(one.center() + moved, one.half_widths() * larger, turned);
            near.ok().map(AnySolid::from)
        }
        AnySolid::Disk(one) => {
            let normal = one.normal() + within(random, one.normal().length() * share);
            let near = Disk::new(one.center() + moved, normal, one.radius() * larger);
            near.ok().map(AnySolid::from)
        }
    }
}

impl Block {
    /// A case with neighbours.
    fn new(random: &mut Random, family: AnyFamily, inputs: Inputs, index: u64) -> Self {
        let case = family.case(SEED, index, inputs);
        let mut solids = vec![case.solid];
        let count = 1 + random.below(LANES as u64) as usize;
        while solids.len() < count {
            solids.extend(neighbour(&case.solid, random));
        }
        let boxes = solids.iter().map(AnySolid::bounds);
        let around = boxes.fold(Bounds::EMPTY, |sum, one| sum.union(&one));
        // Others in the prototype make its box larger.
        let larger = match random.below(3) {
            0 => 1.0,
            _ => random.log_uniform(1.0, 1e4),
        };
        let middle = around.center() + within(random, around.extent().length() * (larger - 1.0));
        Self {
            solids,
            whole: around.union(&Bounds::at(middle)),
            ray: case.ray,
        }
    }

    fn any_solid(&self, random: &mut Random) -> &AnySolid {
        &self.solids[random.below(self.solids.len() as u64) as usize]
    }

    /// About the last of parallel rays that hits a solid, as the solver says. Its direction
    /// may be about that of the case, which is a hard one.
    fn grazing(&self, random: &mut Random) -> Ray {
        let solid = self.any_solid(random);
        let hard = self.ray.direction.normalize();
        let direction = match random.below(3) {
            0 => hard,
            1 => hard + random.direction() * random.log_uniform(1e-9, 1.0),
            _ => random.direction(),
        };
        let direction = direction.normalize();
        let across = direction.cross(random.direction()).normalize();
        let through = |shift: f64| solid.center() + across * shift;
        let [mut inside, mut outside] = [0.0, 2.0 * solid.size()];
        for _ in 0..random.below(50) {
            let between = 0.5 * (inside + outside);
            let hits = solid.chord(through(between) - solid.anchor(), direction);
            match hits {
                Some(_) => inside = between,
                None => outside = between,
            }
        }
        let way = solid.size() * random.log_uniform(1e-2, 1e6);
        let length = random.log_uniform(1e-3, 1e3);
        Ray::new(through(inside) - direction * way, direction * length)
    }

    /// The ray with a range that begins or ends where it hits the surface of a solid.
    fn ranged(&self, random: &mut Random, mut ray: Ray) -> Ray {
        let solid = self.any_solid(random);
        if let Some(chord) = solid.chord(ray.origin - solid.anchor(), ray.direction) {
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

/// The families of a kind with each kind of inputs.
fn families(kind: SolidKind) -> Vec<(AnyFamily, Inputs)> {
    let families = AnyFamily::all().into_iter();
    families
        .filter(|family| family.kind() == kind)
        .flat_map(|family| Inputs::ALL.map(|inputs| (family, inputs)))
        .collect()
}

/// The hits that the filter of a block loses with a share of the margins.
fn losses(family: AnyFamily, inputs: Inputs, index: u64, share: f64) -> FilterLosses {
    let mut random = Random::new(SEED, index);
    let block = Block::new(&mut random, family, inputs, index);
    let mut rays = vec![block.ray];
    rays.extend((1..RAYS).map(|_| block.grazing(&mut random)));
    let rays: Vec<Ray> = rays
        .into_iter()
        .map(|ray| block.ranged(&mut random, ray))
        .collect();
    FilterLosses::of(&block.solids, &block.whole, &rays, share)
}

fn plus(one: FilterLosses, other: FilterLosses) -> FilterLosses {
    FilterLosses {
        hits: one.hits + other.hits,
        lost: one.lost + other.lost,
        spare: one.spare + other.spare,
    }
}

#[test]
fn solids_that_are_hit_survive() {
    for kind in KINDS {
        let (families, name) = (families(kind), kind.name());
        let mut sum = FilterLosses::default();
        for &(family, inputs) in &families {
            let blocks = (0..blocks()).into_par_iter();
            let blocks = blocks.map(|index| losses(family, inputs, index, 1.0));
            let of_family = blocks.reduce(FilterLosses::default, plus);
            println!("{}, {}: {of_family:?}", family.name(), inputs.name());
            sum = plus(sum, of_family);
        }
        let rays = blocks() * RAYS * families.len() as u64;
        assert!(
            sum.hits > rays / 4,
            "{name}: {sum:?}: the test sees nothing"
        );
        assert_eq!(sum.lost, 0, "{name}: {sum:?}");
    }
}

/// One lost hit is enough to show that the margins are needed, so the search ends there.
#[test]
fn smaller_margins_lose_hits() {
    for kind in KINDS {
        let families = families(kind);
        for share in [0.0, 0.5, 0.8] {
            let loses = |&(family, inputs): &(AnyFamily, Inputs)| {
                (0..blocks())
                    .into_par_iter()
                    .any(|index| losses(family, inputs, index, share).lost > 0)
            };
            let name = kind.name();
            assert!(families.iter().any(loses), "{name}, {share} of the margins");
        }
    }
}
