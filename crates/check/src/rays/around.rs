//! Rays that search for missing parts of a mesh.
//!
//! A ray to a random point of the scene's box hits large solids, and in a sparse scene
//! hardly any. So every other ray is aimed at a point of a solid, and all placed solids are
//! equally likely: a small one gets as many rays as a floor of a kilometer beside it.

use glam::{DAffine3, DVec3};

use super::target::any_point_of;
use cyltrace::math::{Bounds, Random, Ray};
use cyltrace::scene::{Prototype, PrototypeIndex, Scene};
use cyltrace::tracer::Tracer;

/// The rays of class `around`: from a sphere of twice the scene's radius to points of its box
/// and, every other one, to points of its solids.
#[must_use]
pub fn rays_around(tracer: &Tracer, seed: u64, count: u64) -> Vec<Ray> {
    let bounds = tracer.bounds();
    if bounds.is_empty() {
        return Vec::new();
    }
    let targets = Targets::new(tracer.scene());
    let (center, extent) = (bounds.center(), bounds.extent());
    (0..count)
        .map(|index| {
            let mut random = Random::new(seed, index);
            let origin = center + random.direction() * extent.length();
            let target = match index % 2 {
                0 => random_point(&bounds, &mut random),
                _ => targets.point(&mut random),
            };
            Ray::new(origin, target - origin)
        })
        .collect()
}

fn random_point(bounds: &Bounds, random: &mut Random) -> DVec3 {
    let part = DVec3::new(random.unit(), random.unit(), random.unit());
    bounds.lower + bounds.extent() * part
}

/// All solids of a scene, to choose among.
struct Targets<'a> {
    scene: &'a Scene,
    /// The contents of each prototype that the root contains.
    members: Vec<Option<Members>>,
}

/// The contents of a prototype.
struct Members {
    /// The boxes of compositions.
    composed: Vec<Bounds>,
    /// The number of solids up to and including each placement. Rounding makes some of
    /// them slightly more likely.
    placed: Vec<f64>,
}

impl Members {
    /// The solids that are the prototype's own.
    fn own(&self, prototype: &Prototype) -> usize {
        prototype.solids.len()
    }

    /// All solids, including placed ones.
    fn all(&self, prototype: &Prototype) -> f64 {
        self.own(prototype) as f64 + self.placed.last().unwrap_or(&0.0)
    }
}

impl<'a> Targets<'a> {
    fn new(scene: &'a Scene) -> Self {
        let members = scene.prototypes.iter().map(|_| None);
        let mut targets = Self {
            scene,
            members: members.collect(),
        };
        targets.count(PrototypeIndex::ROOT);
        targets
    }

    /// Counts the solids of a prototype.
    fn count(&mut self, index: PrototypeIndex) -> f64 {
        let number = index.0 as usize;
        let scene = self.scene;
        let prototype = &scene.prototypes[number];
        if let Some(known) = &self.members[number] {
            return known.all(prototype);
        }
        let mut sum = 0.0;
        let placed = prototype.placements.iter().map(|placement| {
            sum += self.count(placement.of);
            sum
        });
        let placed = placed.collect();
        let composed = prototype.solids.compositions.iter();
        let members = Members {
            composed: composed.map(|record| record.solid.bounds()).collect(),
            placed,
        };
        let all = members.all(prototype);
        self.members[number] = Some(members);
        all
    }

    /// A point of a solid in the world; for a composition, of its box.
    fn point(&self, random: &mut Random) -> DVec3 {
        let mut world_from_here = DAffine3::IDENTITY;
        let mut index = PrototypeIndex::ROOT;
        loop {
            let prototype = &self.scene.prototypes[index.0 as usize];
            let members = self.members[index.0 as usize].as_ref();
            let members = members.expect("what is placed has been counted");
            let chosen = random.unit() * members.all(prototype);
            let own = members.own(prototype);
            if chosen < own as f64 {
                let point = own_point(prototype, members, chosen as usize, random);
                return world_from_here.transform_point3(point);
            }
            let rest = chosen - own as f64;
            let after = members.placed.partition_point(|&sum| sum <= rest);
            let Some(placement) = prototype.placements.get(after) else {
                // Rounded beyond the last.
                continue;
            };
            world_from_here *= placement.parent_from_child;
            index = placement.of;
        }
    }
}

/// A point of one of a prototype's own solids.
fn own_point(
    prototype: &Prototype,
    members: &Members,
    chosen: usize,
    random: &mut Random,
) -> DVec3 {
    match prototype.solids.nth_simple(chosen) {
        Some((_, solid)) => any_point_of(&solid, random),
        None => {
            let simple = prototype.solids.len() - members.composed.len();
            random_point(&members.composed[chosen - simple], random)
        }
    }
}
