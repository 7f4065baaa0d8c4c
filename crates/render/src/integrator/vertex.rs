//! A surface that scatters a path: the light that is sampled there, and how the path goes on.
//!
//! From the third reflection on, a path goes on with the probability `q` of its throughput, at
//! most 0.95, and is divided by it. The mean stays the same.

use cyltrace::math::Ray;
use cyltrace::tracer::PartialHit;
use glam::DVec3;

use super::segment::{Path, weight};
use super::{Sample, View, facing_normal};
use crate::bsdf::{Bsdf, Local, Numbers, Scattered};
use crate::frame::Frame;
use crate::lights::Towards;

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

/// A surface that scatters a path.
pub(super) struct Vertex<'a> {
    path: &'a Path,
    hit: &'a PartialHit,
    bsdf: &'a dyn Bsdf,
    frame: Frame,
    local: Local,
    /// The index of refraction behind it.
    far_ior: f64,
    /// The direction to the viewer, in the frame.
    outgoing: DVec3,
    numbers: PathNumbers<'a>,
}

/// The numbers of a sample at one of its surfaces.
pub(super) struct PathNumbers<'a> {
    pub sample: &'a Sample,
    pub depth: u32,
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

impl View<'_> {
    /// The surface at a hit, or `None` if it separates nothing.
    pub(super) fn vertex<'v>(
        &self,
        path: &'v Path,
        hit: &'v PartialHit,
        bsdf: &'v dyn Bsdf,
        numbers: PathNumbers<'v>,
    ) -> Option<Vertex<'v>> {
        let normal = facing_normal(&path.ray, hit);
        let mut far_ior = path.ior;
        if bsdf.transmits() {
            far_ior = self.ior_behind(path, hit);
            if far_ior == path.ior {
                return None;
            }
        }
        let frame = Frame::about(normal);
        let mut outgoing = frame.in_frame(-path.ray.direction);
        outgoing.z = outgoing.z.max(LEAST_COSINE);
        Some(Vertex {
            path,
            hit,
            bsdf,
            frame,
            local: Local {
                color: self.colors.at(hit),
                relative_ior: far_ior / path.ior,
            },
            far_ior,
            outgoing,
            numbers,
        })
    }

    /// A ray towards a sampled light, the light that arrives along it if nothing is in between,
    /// and, if the light is a solid, the number of that and a factor in place of the light.
    pub(super) fn towards_light(&self, vertex: &Vertex) -> Option<(Ray, DVec3, Option<usize>)> {
        if vertex.bsdf.is_smooth() || !self.lights.is_sampled() {
            return None;
        }
        let point = vertex.hit.point().expect("requested if lights are sampled");
        let (_, choice) = vertex.numbers.pair(CHOICES);
        let towards = self
            .lights
            .sample(point, choice, vertex.numbers.pair(LIGHT))?;
        let sample = towards.sample();
        let incoming = vertex.frame.in_frame(sample.direction);
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
        let mut ray = self.spawn(vertex.hit, sample.direction);
        ray.t_max = ray.t_max.min(sample.distance);
        let number = match towards {
            Towards::Solid(_, number) => Some(number),
            Towards::Open(..) => None,
        };
        (!self.lights.are_between(&ray, &towards)).then_some((ray, light, number))
    }

    /// The path after a surface.
    pub(super) fn scattered(&self, vertex: &Vertex) -> Option<Path> {
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
            false => vertex.far_ior,
        };
        let mut throughput = path.throughput * weight;
        if throughput == DVec3::ZERO {
            return None;
        }
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
        let direction = vertex.frame.in_world(incoming);
        Some(Path {
            sample: path.sample,
            ray: self.spawn(vertex.hit, direction),
            throughput,
            point: vertex.hit.point().unwrap_or_default(),
            density,
            ior,
            depth,
            is_direct: path.is_direct && density.is_none(),
        })
    }
}
