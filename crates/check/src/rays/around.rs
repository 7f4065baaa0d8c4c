//! Rays that search for missing parts of a mesh.
//!
//! A ray to a random point of the scene's box hits large solids, and in a sparse scene
//! hardly any. So every other ray is aimed at a point of a solid, and all placed solids are
//! equally likely: a small one gets as many rays as a floor of a kilometer beside it.

use glam::{DAffine3, DVec3};

use super::target::any_point_of;
use crate::solids::scene_solid::{SceneSolid, nth};
use cyltrace::math::{Bounds, Random, Ray};
use cyltrace::scene::{PrototypeIndex, Scene};
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
    /// For each prototype that the root contains, the number of solids up to and including
    /// each placement. Rounding makes some of them slightly more likely.
    placed: Vec<Option<Vec<f64>>>,
}

impl<'a> Targets<'a> {
    fn new(scene: &'a Scene) -> Self {
        let placed = vec![None; scene.prototypes.len()];
        let mut targets = Self { scene, placed };
        targets.count(PrototypeIndex::ROOT);
        targets
    }

    /// Counts the solids of a prototype, including placed ones.
    fn count(&mut self, index: PrototypeIndex) -> f64 {
        let number = index.0 as usize;
        let prototype = &self.scene.prototypes[number];
        if self.placed[number].is_none() {
            let mut sum = 0.0;
            let placed = prototype.placements.iter().map(|placement| {
                sum += self.count(placement.of);
                sum
            });
            self.placed[number] = Some(placed.collect());
        }
        let placed = self.placed[number].as_ref().and_then(|sums| sums.last());
        prototype.solids.len() as f64 + placed.unwrap_or(&0.0)
    }

    /// A point of a solid in the world; for a composition, of its box.
    fn point(&self, random: &mut Random) -> DVec3 {
        let mut world_from_here = DAffine3::IDENTITY;
        let mut index = PrototypeIndex::ROOT;
        loop {
            let prototype = &self.scene.prototypes[index.0 as usize];
            let placed = self.placed[index.0 as usize].as_ref();
            let placed = placed.expect("placements have been counted");
            let own = prototype.solids.len() as f64;
            let chosen = random.unit() * (own + placed.last().unwrap_or(&0.0));
            if chosen < own {
                let point = match nth(prototype, chosen as usize).1 {
                    SceneSolid::Single(solid) => any_point_of(&solid, random),
                    SceneSolid::Composed(solid) => random_point(&solid.bounds(), random),
                };
                return world_from_here.transform_point3(point);
            }
            let after = placed.partition_point(|&sum| sum <= chosen - own);
            let Some(placement) = prototype.placements.get(after) else {
                // Rounded beyond the last.
                continue;
            };
            world_from_here *= placement.parent_from_child;
            index = placement.of;
        }
    }
}
