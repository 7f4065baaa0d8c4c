//! Light that is scattered any number of times.
//!
//! A path starts at the camera and scatters at surfaces. At each, the light of one sampled
//! direction to a light is added, and the path goes on in a direction that the surface chooses.
//! If that direction reaches a light that is also sampled, both find it, and each counts with the
//! weight `a² / (a² + b²)` of its density `a` and the other's density `b`, the power heuristic
//! (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2).
//!
//! From the third reflection on, a path goes on with the probability `q` of its throughput, at
//! most 0.95, and is divided by it. The mean stays the same.
//!
//! The index of refraction on each side of an interface is that of the solids of glass that
//! contain the start of a ray to that side, which
//! lies beyond all rounding errors of the surface. Where several contain it, the last in the order
//! of placements and primitives counts. So solids may overlap, touch and lie in each other, and a
//! surface within its own material has no effect.

use cyltrace::math::Ray;
use cyltrace::scene::MaterialKind;
use cyltrace::tracer::{HitFields, PartialHit};
use glam::DVec3;

use super::{Batch, RayCounts, Sample, View, facing_normal, spawn};
use crate::bsdf::{Bsdf, Local, Numbers, Scattered};
use crate::frame::Frame;
use crate::lights::{Arriving, Towards};

/// Reflections of a path that goes on for certain.
const CERTAIN: u32 = 2;

/// The greatest probability to go on, so that a path without losses ends, too.
const GREATEST_PROBABILITY: f64 = 0.95;

/// The least cosine of the direction to the viewer. Densities of rough surfaces are divided by
/// it, and a ray may touch a surface at 0. An angle of 10^-6 to the surface looks the same.
const LEAST_COSINE: f64 = 1e-6;

/// The dimensions of the numbers of each reflection; those before are of other purposes.
const DIRECTION: u32 = 0;
const LIGHT: u32 = 1;
const CHOICES: u32 = 2;
const END: u32 = 3;
const DIMENSIONS: u32 = 4;
const FIRST_DIMENSION: u32 = 4;

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

/// A path up to a ray.
#[derive(Clone, Copy)]
struct Path {
    /// The position in the batch.
    sample: usize,
    ray: Ray,
    throughput: DVec3,
    /// Where the ray's direction was chosen, and its density; `None` if no light could have been
    /// sampled in its place.
    point: DVec3,
    density: Option<f64>,
    /// The index of refraction around the ray.
    ior: f64,
    /// The surfaces that scattered it.
    depth: u32,
    /// Whether they were smooth, so that the viewer sees through or in a mirror.
    is_direct: bool,
}

/// A ray to a light that is a solid.
struct ToSolid {
    sample: usize,
    /// The light that arrives, over the radiance of the solid.
    factor: DVec3,
    number: usize,
}

/// A surface that scatters a path.
struct Vertex<'a> {
    path: &'a Path,
    hit: &'a PartialHit,
    bsdf: &'a dyn Bsdf,
    frame: Frame,
    local: Local,
    /// The direction to the viewer, in the frame.
    outgoing: DVec3,
    numbers: PathNumbers<'a>,
}

/// The numbers of a sample at one of its surfaces.
struct PathNumbers<'a> {
    sample: &'a Sample,
    depth: u32,
}

impl PathNumbers<'_> {
    fn pair(&self, dimension: u32) -> (f64, f64) {
        match (self.depth, dimension) {
            (0, DIRECTION) => self.sample.direction(),
            (depth, _) => {
                let before = FIRST_DIMENSION + depth * DIMENSIONS;
                self.sample.pair(before + dimension)
            }
        }
    }
}

impl Path {
    /// The light at the end of the ray that counts.
    fn weighted(&self, light: Arriving) -> DVec3 {
        let weight = self
            .density
            .map_or(1.0, |density| weight(density, light.density));
        self.throughput * (light.unsampled + light.sampled * weight)
    }
}

/// The power heuristic: the weight of a direction of a density that another way to sample finds
/// with the density `other`.
fn weight(density: f64, other: f64) -> f64 {
    let ratio = other / density;
    1.0 / (1.0 + ratio * ratio)
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
            ior: self.ior_at(ray.origin),
            depth: 0,
            is_direct: true,
        });
        batch.paths.paths.clear();
        batch.paths.paths.extend(first);
        batch.paths.are_hits.clear();
        batch.paths.are_hits.resize(samples.len(), false);
        let fields = self.path_fields();
        while !batch.paths.paths.is_empty() {
            batch.rays.clear();
            batch
                .rays
                .extend(batch.paths.paths.iter().map(|path| path.ray));
            self.closest(batch, fields);
            self.step(samples, batch);
            rays.shadow += batch.occlusion.add_to(&mut batch.colors, self.tracer);
            rays.shadow += self.add_solids(batch, fields);
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
            let t = hit.as_ref().map_or(f64::INFINITY, PartialHit::t);
            let color = &mut batch.colors[path.sample];
            let light = self.lights.on(&path.ray, t, path.point);
            paths.are_hits[path.sample] |= light.is_some() || hit.is_some();
            if let Some(light) = light {
                *color += path.weighted(light);
                continue;
            }
            let Some(hit) = hit else {
                *color += self.from_beyond(path);
                continue;
            };
            let Some(bsdf) = &self.bsdfs[usize::from(hit.material().0)] else {
                *color += self.from_solid(path, hit);
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
                    ray: spawn(hit, path.ray.direction),
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
    fn from_beyond(&self, path: &Path) -> DVec3 {
        let direction = path.ray.direction;
        let sun = path.weighted(self.lights.from_sun(direction));
        if path.is_direct {
            return sun + path.throughput * self.lights.miss(direction);
        }
        sun + path.weighted(self.lights.from_sky(direction))
    }

    /// The light of a path that ends on a solid that emits light.
    fn from_solid(&self, path: &Path, hit: &PartialHit) -> DVec3 {
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

    /// The surface at a hit, or `None` if it separates nothing.
    fn vertex<'v>(
        &self,
        path: &'v Path,
        hit: &'v PartialHit,
        bsdf: &'v dyn Bsdf,
        numbers: PathNumbers<'v>,
    ) -> Option<Vertex<'v>> {
        let normal = facing_normal(&path.ray, hit);
        let mut relative_ior = 1.0;
        if bsdf.transmits() {
            relative_ior = self.ior_at(spawn(hit, -normal).origin) / path.ior;
            if relative_ior == 1.0 {
                return None;
            }
        }
        let frame = Frame::about(normal);
        let mut outgoing = frame.from_world(-path.ray.direction);
        outgoing.z = outgoing.z.max(LEAST_COSINE);
        Some(Vertex {
            path,
            hit,
            bsdf,
            frame,
            local: Local {
                color: self.colors.at(hit),
                relative_ior,
            },
            outgoing,
            numbers,
        })
    }

    /// A ray towards a sampled light, the light that arrives along it if nothing is in between,
    /// and, if the light is a solid, the number of that and a factor in place of the light.
    fn towards_light(&self, vertex: &Vertex) -> Option<(Ray, DVec3, Option<usize>)> {
        if vertex.bsdf.is_smooth() || !self.lights.is_sampled() {
            return None;
        }
        let point = vertex.hit.point().expect("requested if lights are sampled");
        let (_, choice) = vertex.numbers.pair(CHOICES);
        let towards = self
            .lights
            .sample(point, choice, vertex.numbers.pair(LIGHT))?;
        let sample = towards.sample();
        let incoming = vertex.frame.from_world(sample.direction);
        let value = vertex
            .bsdf
            .evaluate(&vertex.local, vertex.outgoing, incoming);
        if value == DVec3::ZERO {
            return None;
        }
        let weight = sample.density.map_or(1.0, |density| {
            let other = vertex
                .bsdf
                .density(&vertex.local, vertex.outgoing, incoming);
            weight(density, other)
        });
        let light = vertex.path.throughput * value * sample.arriving * weight;
        let mut ray = spawn(vertex.hit, sample.direction);
        ray.t_max = sample.distance;
        let number = match towards {
            Towards::Solid(_, number) => Some(number),
            Towards::Open(..) => None,
        };
        (!self.lights.are_between(&ray, &towards)).then_some((ray, light, number))
    }

    /// The path after a surface.
    fn scattered(&self, vertex: &Vertex) -> Option<Path> {
        let path = vertex.path;
        let (choice, _) = vertex.numbers.pair(CHOICES);
        let numbers = Numbers {
            choice,
            direction: vertex.numbers.pair(DIRECTION),
        };
        let Scattered {
            incoming,
            weight,
            density,
        } = vertex
            .bsdf
            .sample(&vertex.local, vertex.outgoing, numbers)?;
        let ior = match incoming.z > 0.0 {
            true => path.ior,
            false => path.ior * vertex.local.relative_ior,
        };
        let mut throughput = path.throughput * weight;
        let depth = path.depth + 1;
        if depth > CERTAIN {
            // The factor of an interface is undone where the path leaves.
            let left = throughput.max_element() * ior * ior;
            let probability = left.min(GREATEST_PROBABILITY);
            if vertex.numbers.pair(END).0 >= probability {
                return None;
            }
            throughput /= probability;
        }
        let direction = vertex.frame.to_world(incoming);
        Some(Path {
            sample: path.sample,
            ray: spawn(vertex.hit, direction),
            throughput,
            point: vertex.hit.point().unwrap_or_default(),
            density,
            ior,
            depth,
            is_direct: path.is_direct && density.is_none(),
        })
    }

    /// Adds the light of solids that the rays to them reach, and returns the number of rays.
    fn add_solids(&self, batch: &mut Batch, fields: HitFields) -> u64 {
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

    /// The index of refraction at a point.
    fn ior_at(&self, point: DVec3) -> f64 {
        if !self.has_glass {
            return 1.0;
        }
        let scene = self.tracer.scene();
        let containing = self.tracer.contains(point);
        let iors = containing.iter().rev().filter_map(|solid| {
            let solids = &scene.prototypes[solid.prototype.0 as usize].solids;
            let material = solids.material(solid.solid, solid.primitive)?;
            match scene.materials[usize::from(material.0)].kind {
                MaterialKind::Glass { ior, .. } => Some(ior),
                _ => None,
            }
        });
        iors.into_iter().next().unwrap_or(1.0)
    }
}
