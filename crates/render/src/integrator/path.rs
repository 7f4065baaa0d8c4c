//! Light that is scattered any number of times.
//!
//! A path starts at the camera and scatters at surfaces. At each, the light of one sampled
//! direction to a light is added, and the path goes on in a direction that the surface chooses.
//! If that direction reaches a light that is also sampled, both find it, and each counts with the
//! weight `a² / (a² + b²)` of its density `a` and the other's density `b`, the power heuristic
//! (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2).

use cyltrace::math::Ray;
use cyltrace::tracer::{HitFields, PartialHit};
use glam::DVec3;

use super::segment::Path;
use super::vertex::PathNumbers;
use super::{Batch, RayCounts, Sample, View};
use crate::lights::Arriving;

/// The paths of a batch that go on.
#[derive(Default)]
pub(super) struct Paths {
    paths: Vec<Path>,
    next: Vec<Path>,
    /// Rays to lights that are solids, and what they are for.
    to_solids: Vec<ToSolid>,
    rays: Vec<Ray>,
    hits: Vec<Option<PartialHit>>,
    /// Whether the camera rays hit something.
    are_hits: Vec<bool>,
}

impl Paths {
    /// Whether the camera ray of a sample hit something; `None` without paths.
    pub fn is_hit(&self, sample: usize) -> Option<bool> {
        self.are_hits.get(sample).copied()
    }
}

/// A ray to a light that is a solid.
struct ToSolid {
    sample: usize,
    /// The light that arrives, over the radiance of the solid.
    factor: DVec3,
    number: usize,
}

impl View<'_> {
    pub(super) fn paths(&self, samples: &[Sample], batch: &mut Batch, rays: &mut RayCounts) {
        batch.colors.resize(samples.len(), DVec3::ZERO);
        let first = batch.rays.iter().enumerate().map(|(sample, ray)| Path {
            sample,
            ray: Ray {
                direction: ray.direction.normalize(),
                ..*ray
            },
            throughput: DVec3::ONE,
            point: ray.origin,
            density: None,
            ior: self.ior_before(ray),
            depth: 0,
            is_direct: true,
        });
        batch.paths.paths.clear();
        batch.paths.paths.extend(first);
        batch.paths.are_hits.clear();
        batch.paths.are_hits.resize(samples.len(), false);
        let fields = self.path_fields();
        let mut is_first = true;
        while !batch.paths.paths.is_empty() {
            batch.rays.clear();
            batch
                .rays
                .extend(batch.paths.paths.iter().map(|path| path.ray));
            match is_first {
                true => {
                    self.closest_to_camera(batch, fields);
                    // Lights in front of clip planes are seen, so that rays keep their start.
                    for (path, ray) in batch.paths.paths.iter_mut().zip(&batch.rays) {
                        path.ray.t_max = ray.t_max;
                    }
                }
                false => self.closest(batch, fields),
            }
            is_first = false;
            self.step(samples, batch);
            rays.shadow += batch.occlusion.add_to(&mut batch.colors, self.tracer);
            rays.shadow += self.add_solids(batch);
            let Paths { paths, next, .. } = &mut batch.paths;
            std::mem::swap(paths, next);
            rays.scattered += paths.len() as u64;
        }
    }

    /// The fields of hits that paths of this scene need.
    fn path_fields(&self) -> HitFields {
        let mut fields = HitFields::NORMAL | HitFields::SPAWN | self.colors.fields();
        fields.set(HitFields::POINT, self.lights.is_sampled());
        if self.lights.has_emitters() {
            fields |= HitFields::PATH;
        }
        fields
    }

    /// Adds the light at the ends of the rays, samples lights, and continues the paths.
    fn step(&self, samples: &[Sample], batch: &mut Batch) {
        batch.occlusion.clear();
        let mut paths = std::mem::take(&mut batch.paths);
        paths.next.clear();
        paths.to_solids.clear();
        paths.rays.clear();
        for (path, hit) in paths.paths.iter().zip(&batch.hits) {
            let cut = self.cut_from_inside(path, hit.as_ref());
            let hit = hit.as_ref().or(cut.as_ref());
            let t = hit.map_or(f64::INFINITY, PartialHit::t);
            let color = &mut batch.colors[path.sample];
            let light = self.lights.on(&path.ray, t, path.point);
            paths.are_hits[path.sample] |= light.is_some() || hit.is_some();
            if let Some(light) = light {
                *color += path.weighted(light);
                continue;
            }
            let Some(hit) = hit else {
                *color += self.light_beyond(path);
                continue;
            };
            let Some(bsdf) = &self.bsdfs[usize::from(hit.material().0)] else {
                *color += self.light_of_solid(path, hit);
                continue;
            };
            if path.depth + 1 == self.settings.max_depth {
                continue;
            }
            let numbers = PathNumbers {
                sample: &samples[path.sample],
                depth: path.depth,
            };
            let Some(vertex) = self.vertex(path, hit, &**bsdf, numbers) else {
                // The same glass is on both sides.
                paths.next.push(Path {
                    ray: self.spawn(hit, path.ray.direction),
                    density: None,
                    ..*path
                });
                continue;
            };
            match self.towards_light(&vertex) {
                Some((ray, light, None)) => batch.occlusion.push(path.sample, ray, light),
                Some((ray, factor, Some(number))) => {
                    paths.rays.push(ray);
                    let sample = path.sample;
                    paths.to_solids.push(ToSolid {
                        sample,
                        factor,
                        number,
                    });
                }
                None => {}
            }
            paths.next.extend(self.scattered(&vertex));
        }
        batch.paths = paths;
    }

    /// The light of a path that leaves the scene.
    fn light_beyond(&self, path: &Path) -> DVec3 {
        let direction = path.ray.direction;
        let sun = path.weighted(self.lights.sunlight(direction));
        if path.is_direct {
            return sun + path.throughput * self.lights.miss(direction);
        }
        sun + path.weighted(self.lights.skylight(direction))
    }

    /// The light of a path that ends on a solid that emits light.
    fn light_of_solid(&self, path: &Path, hit: &PartialHit) -> DVec3 {
        let direction = path.ray.direction;
        let density = path
            .density
            .map_or(0.0, |_| self.lights.density_of(hit, path.point, direction));
        path.weighted(Arriving {
            unsampled: DVec3::ZERO,
            sampled: self.emitted(hit).unwrap_or_default(),
            density,
        })
    }

    /// Adds the light of solids that the rays to them reach, and returns the number of rays.
    fn add_solids(&self, batch: &mut Batch) -> u64 {
        let fields = HitFields::PATH | self.colors.fields();
        let Paths {
            to_solids,
            rays,
            hits,
            ..
        } = &mut batch.paths;
        if rays.is_empty() {
            return 0;
        }
        self.tracer.closest_batch_with(rays, fields, hits);
        for ((to_solid, ray), hit) in to_solids.iter().zip(&*rays).zip(hits) {
            let Some(hit) = hit else {
                continue;
            };
            let before = Ray {
                t_max: hit.t(),
                ..*ray
            };
            let is_reached = self.lights.number_of(hit) == Some(to_solid.number);
            if is_reached && !self.lights.is_on(&before) {
                batch.colors[to_solid.sample] +=
                    to_solid.factor * self.emitted(hit).unwrap_or_default();
            }
        }
        rays.len() as u64
    }
}
