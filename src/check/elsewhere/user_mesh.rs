//! A mesh of the scene that somebody made, traced by Embree, against the exact
//! hits.
//!
//! The mesh is moved to the middle of its box and scaled by a power of two to
//! about unit size before it is rounded to f32; a ray starts where it enters the
//! sphere around the box, at unit speed. So what f32 rounds is small against the
//! mesh wherever it lies: with the mesh's radius `R`, 1 unit of 2^-24 for a
//! vertex, 2 for the ray's origin, 2 for its direction over a way of 2 R, and
//! Embree's own edge and distance tests, which see numbers up to 2 R, some 8:
//! 16 R · 2^-24 are allowed beside the mesh's own deviation.

use glam::DVec3;

use super::agreement::{Agreement, F32_TOLERANCE};
use super::surfaces::Surfaces;
use super::user_hits::in_blocks;
use crate::check::{Progress, Witness};
use crate::embree::{self, Device, DeviceOptions, Ray32, SceneBuilder};
use crate::math::{Bounds, Random, Ray, power_of_two_below};
use crate::solid::tessellation::Mesh;
use crate::tracer::Tracer;

/// A mesh that Embree traces.
pub struct TracedMesh {
    scene: embree::Scene<()>,
    centre: DVec3,
    /// The scene's lengths times this are the mesh's.
    scale: f64,
    radius: f64,
}

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// The ray's parameter.
    pub t: f64,
    /// The triangle's unit normal, on the side of its winding; zero for a
    /// triangle without area.
    pub normal: DVec3,
    /// The triangle's number.
    pub triangle: u32,
}

impl TracedMesh {
    /// Builds the mesh; it must not be empty.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(mesh: &Mesh, options: &DeviceOptions) -> Result<Self, embree::Error> {
        let bounds = mesh.vertices.iter().fold(Bounds::EMPTY, |bounds, &point| {
            bounds.union(&Bounds::at(point))
        });
        let centre = bounds.centre();
        let radius = (0.5 * bounds.extent().length()).max(f64::MIN_POSITIVE);
        let scale = 1.0 / power_of_two_below(radius);
        let vertices: Vec<[f32; 3]> = mesh
            .vertices
            .iter()
            .map(|&point| ((point - centre) * scale).as_vec3().to_array())
            .collect();
        let device = Device::new(options)?;
        let mut builder = SceneBuilder::new(&device)?;
        builder.attach_triangles(&vertices, &mesh.triangles)?;
        Ok(Self {
            scene: builder.commit()?,
            centre,
            scale,
            radius,
        })
    }

    /// The first hit of a ray.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let speed = ray.direction.length();
        let heading = ray.direction / speed;
        let from_centre = ray.origin - self.centre;
        let nearest = -from_centre.dot(heading);
        // Rounded boxes and rays stay within a sphere that is this much larger.
        let reach = 1.001 * self.radius;
        let start = (nearest - reach).max(ray.t_min * speed);
        let end = (nearest + reach).min(ray.t_max * speed);
        if !(start <= end) {
            return None;
        }
        // Scaled to a tiny mesh, what passes far away is beyond f32.
        let beside = from_centre + heading * nearest;
        if !(beside.length() <= reach) {
            return None;
        }
        let origin = (from_centre + heading * start) * self.scale;
        let ray32 = Ray32 {
            origin: origin.as_vec3().to_array(),
            direction: heading.as_vec3().to_array(),
            t_near: 0.0,
            t_far: ((end - start) * self.scale) as f32,
        };
        let hit = self.scene.closest_native(&ray32, &mut ())?;
        Some(TriangleHit {
            t: (start + f64::from(hit.t) / self.scale) / speed,
            normal: DVec3::from_array(hit.normal.map(f64::from)).normalize_or_zero(),
            triangle: hit.primitive,
        })
    }

    /// What rounding to f32 may displace, as a length in the scene.
    fn rounding(&self) -> f64 {
        F32_TOLERANCE * self.radius
    }
}

/// Compares what Embree finds with a mesh with the exact hits, within
/// `deviation` (scene units), on the rays of a class of that name, in the rayon pool that this is called in. `None`
/// when `progress` asked to stop.
#[must_use]
pub fn compare_mesh(
    tracer: &Tracer,
    mesh: &TracedMesh,
    (class, rays): (&'static str, &[Ray]),
    deviation: f64,
    most_listed: usize,
    progress: &Progress,
) -> Option<Agreement> {
    let allowance = deviation + mesh.rounding();
    let surfaces = Surfaces::new(tracer.scene());
    in_blocks(
        Agreement::new(class, Witness::UserMesh),
        rays.len() as u64,
        most_listed,
        progress,
        |agreement, index| {
            let ray = &rays[index as usize];
            let told = mesh.closest(ray).map(|hit| hit.t);
            agreement.add((tracer, &surfaces), index, ray, told, most_listed, |_| {
                allowance
            });
        },
    )
}

/// The rays of class `around`: from a sphere of twice the scene's radius to points of its box.
#[must_use]
pub fn rays_around(tracer: &Tracer, seed: u64, count: u64) -> Vec<Ray> {
    let bounds = tracer.bounds();
    if bounds.is_empty() {
        return Vec::new();
    }
    let (centre, extent) = (bounds.centre(), bounds.extent());
    (0..count)
        .map(|index| {
            let mut random = Random::new(seed, index);
            let origin = centre + random.direction() * extent.length();
            let part = DVec3::new(random.unit(), random.unit(), random.unit());
            Ray::new(origin, bounds.lower + extent * part - origin)
        })
        .collect()
}
