//! Embree's own meshes witness the analytic hits of `scenes/minimal.toml`.
//!
//! The inscribed prism of N sides lies between the cylinder and the cylinder
//! of radius `r cos(π/N)` inside it, so where a ray meets the wall of both, its
//! hit with the mesh is between the two: the sagitta `r (1 - cos(π/N))`, turned
//! into `t` for this very ray. The mesh adds f32: corners, the ray and Embree's
//! `t` are rounded. A ray that meets the one but not the other is in the
//! silhouette band, whose share is bounded.

use std::path::Path;
use std::sync::Arc;

use cyltrace::embree::{Device, DeviceOptions, Ray32, SceneBuilder};
use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, Scene};
use cyltrace::solid::tessellation::{Mesh, inner_factor, inscribed_prism};
use cyltrace::solid::{Cylinder, Part};
use cyltrace::tracer::{Options, Tracer};
use glam::DVec3;

const SEED: u64 = 5;
const RAYS: u64 = 100_000;

/// The same scene with every radius times `factor`.
fn with_radii(scene: &Scene, factor: f64) -> Tracer {
    let mut scene = scene.clone();
    let thinner = scene.prototypes[0].solids.cylinders.iter().map(|record| {
        let one = record.cylinder();
        let thinner = Cylinder::new(one.p0(), one.p1(), one.radius() * factor, one.caps()).unwrap();
        CylinderRecord::new(&thinner, record.primitive(), record.material())
    });
    scene.prototypes[0].solids.cylinders = thinner.collect();
    Tracer::new(Arc::new(scene), &Options::default()).unwrap()
}

/// A ray with numbers that f32 holds, from around the scene into it.
fn ray_into(random: &mut Random, center: DVec3, extent: f64) -> Ray {
    let from = center + random.direction() * (extent * random.uniform(0.8, 2.0));
    let mut coordinate = || random.uniform(-0.5, 0.5);
    let to = center + DVec3::new(coordinate(), coordinate(), coordinate()) * extent;
    let direction = (to - from).normalize();
    Ray::new(from.as_vec3().as_dvec3(), direction.as_vec3().as_dvec3())
}

#[test]
fn hits_of_the_minimal_scene_lie_between_the_mesh_s_cylinders() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/minimal.toml");
    let scene = cyltrace::scene::load(&path).unwrap();
    let cylinders: Vec<Cylinder> = scene.prototypes[0]
        .solids
        .cylinders
        .iter()
        .map(|record| record.cylinder())
        .collect();
    let outer = with_radii(&scene, 1.0);
    let bounds = outer.bounds();
    let (center, extent) = (bounds.center(), bounds.extent().length());
    let device = Device::new(&DeviceOptions::default()).unwrap();

    for (segments, most_in_band) in [(64, 0.01), (256, 0.003)] {
        let inner = with_radii(&scene, inner_factor(segments));
        let mut mesh = Mesh::default();
        for cylinder in &cylinders {
            mesh.append(&inscribed_prism(cylinder, segments));
        }
        let vertices: Vec<[f32; 3]> = mesh
            .vertices
            .iter()
            .map(|vertex| vertex.as_vec3().to_array())
            .collect();
        let mut builder = SceneBuilder::<()>::new(&device).unwrap();
        builder
            .attach_triangles(&vertices, &mesh.triangles)
            .unwrap();
        let witness = builder.commit().unwrap();

        let (mut hits, mut in_band) = (0_u64, 0_u64);
        for number in 0..RAYS {
            let mut random = Random::new(SEED, number);
            let ray = ray_into(&mut random, center, extent);
            let ray32 = Ray32 {
                origin: ray.origin.as_vec3().to_array(),
                direction: ray.direction.as_vec3().to_array(),
                t_near: 0.0,
                t_far: f32::INFINITY,
            };
            let seen = witness.closest_native(&ray32, &mut ());
            let (first, second) = (outer.closest(&ray), inner.closest(&ray));
            hits += u64::from(first.is_some());
            let (first, second) = match (first, second) {
                (None, None) => {
                    assert!(
                        seen.is_none(),
                        "seed {SEED}, ray {number}: only the mesh is hit"
                    );
                    continue;
                }
                (Some(first), Some(second))
                    if (first.primitive, first.part, first.crossing)
                        == (second.primitive, second.part, second.crossing) =>
                {
                    (first, second)
                }
                _ => {
                    in_band += 1;
                    continue;
                }
            };
            let Some(seen) = seen else {
                panic!(
                    "seed {SEED}, ray {number}: the mesh with {segments} sides is missed, {first:?}"
                );
            };
            // f32 moves corners, ray and hit by an ulp or so of the greatest
            // number, 2^-23 of 2 extents; along the ray that grows with the
            // slope at which it meets the mesh.
            let slope = first
                .normal
                .dot(ray.direction)
                .abs()
                .min(second.normal.dot(ray.direction).abs());
            let rounding = 4.0 * f64::from(f32::EPSILON) * 3.0 * extent / slope.max(1e-3);
            let (low, high) = (
                first.t.min(second.t) - rounding,
                first.t.max(second.t) + rounding,
            );
            let t = f64::from(seen.t);
            assert!(
                (low..=high).contains(&t),
                "seed {SEED}, ray {number}: {segments} sides, {t} is not in {low}..{high}, {first:?}"
            );
            if first.part != Part::Side {
                continue;
            }
            let facet = DVec3::from_array(seen.normal.map(f64::from)).normalize();
            let tilt = facet.dot(first.normal).abs();
            let most = libm::cos(2.0 * std::f64::consts::PI / f64::from(segments));
            assert!(
                tilt >= most || slope < 0.1,
                "seed {SEED}, ray {number}: tilted by {tilt}"
            );
        }
        let share = in_band as f64 / hits as f64;
        println!(
            "{segments} sides: {RAYS} rays, {hits} hits, {:.3} % in the band",
            share * 100.0
        );
        assert!(
            hits > RAYS / 8 && share < most_in_band,
            "{hits} hits, {share} in the band"
        );
    }
}
