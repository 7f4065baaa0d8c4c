//! Every triangle of a ray, from one traversal.

use std::thread;

use cyltrace::embree::{
    Device, DeviceOptions, GeometryId, MeshHit, NativeHit, Ray32, Scene, SceneBuilder,
};
use cyltrace::math::Random;

const SEED: u64 = 71;

fn builder() -> SceneBuilder<Vec<MeshHit>> {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    SceneBuilder::new(&device).unwrap()
}

/// Triangles across the z axis at z = 1, 2, …; every other one faces up.
fn stack(count: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let corners = (1..=count).flat_map(|level| {
        let z = level as f32;
        [[-1.0, -1.0, z], [2.0, -1.0, z], [-1.0, 2.0, z]]
    });
    let triangles = (0..count).map(|triangle| {
        let first = 3 * triangle;
        match triangle % 2 {
            0 => [first, first + 1, first + 2],
            _ => [first, first + 2, first + 1],
        }
    });
    (corners.collect(), triangles.collect())
}

fn stack_scene(count: u32) -> (Scene<Vec<MeshHit>>, GeometryId) {
    let (vertices, triangles) = stack(count);
    let mut builder = builder();
    let mesh = builder
        .attach_collecting_triangles(&vertices, &triangles)
        .unwrap();
    (builder.commit().unwrap(), mesh)
}

fn up(t_near: f32, t_far: f32) -> Ray32 {
    Ray32 {
        origin: [0.1, 0.2, 0.0],
        direction: [0.0, 0.0, 1.0],
        t_near,
        t_far,
    }
}

#[test]
fn every_hit_of_a_stack_is_found_once_with_front_and_back() {
    for count in [1, 2, 5, 100, 10_000] {
        let (scene, mesh) = stack_scene(count);
        let mut hits = vec![];
        // Twice, so that what is left over would be seen.
        for _ in 0..2 {
            scene.every_hit(&up(0.0, f32::INFINITY), &mut hits);
            assert_eq!(hits.len(), count as usize);
        }
        for (hit, number) in hits.iter().zip(0_u32..) {
            assert_eq!((hit.geometry, hit.primitive), (mesh, number));
            let expected = number as f32 + 1.0;
            assert!((hit.t - expected).abs() <= 1e-6 * expected, "{hit:?}");
            let faces_up = if number % 2 == 0 { 1.0 } else { -1.0 };
            assert!(hit.normal[2] * faces_up > 0.0, "{hit:?}");
        }
        let mut seen = vec![];
        let closest = scene.closest_native(&up(0.0, f32::INFINITY), &mut seen);
        assert_eq!(closest, None, "collected hits are refused");
        assert_eq!(seen.len(), count as usize);
    }
}

#[test]
fn every_hit_keeps_to_the_ray_s_range() {
    let (scene, _) = stack_scene(100);
    let mut hits = vec![];
    let mut count = |t_near, t_far| {
        scene.every_hit(&up(t_near, t_far), &mut hits);
        hits.len()
    };
    assert_eq!(count(10.5, 20.5), 10);
    assert_eq!(count(0.0, 0.5), 0);
    assert_eq!(count(100.5, f32::INFINITY), 0);
    assert_eq!(count(99.5, f32::INFINITY), 1);
    // Both ends belong to it: these numbers are exact in the mesh and the ray.
    assert_eq!(count(16.0, 16.0), 1);
    assert_eq!(count(8.0, 16.0), 9);
}

#[test]
fn every_hit_of_several_meshes_names_them() {
    let (vertices, triangles) = stack(3);
    let mut builder = builder();
    let silent = builder.attach_triangles(&vertices, &triangles).unwrap();
    let first = builder
        .attach_collecting_triangles(&vertices, &triangles)
        .unwrap();
    let second = builder
        .attach_collecting_triangles(&vertices, &triangles)
        .unwrap();
    let scene = builder.commit().unwrap();
    let mut hits = vec![];
    scene.every_hit(&up(0.0, 1e3), &mut hits);
    // The mesh that does not collect ends the ray, at its first triangle.
    assert!(hits.iter().all(|hit| hit.geometry != silent));
    assert!(hits.iter().all(|hit| hit.t <= 1.0 + 1e-6), "{hits:?}");
    let named = |mesh| hits.iter().filter(|hit| hit.geometry == mesh).count();
    assert!(named(first) <= 1 && named(second) <= 1, "{hits:?}");
}

/// What a mesh without the filter tells when it is asked again and again from
/// behind the last hit.
fn one_by_one(scene: &Scene<()>, ray: &Ray32) -> Vec<NativeHit> {
    let mut found = vec![];
    let mut rest = *ray;
    while let Some(hit) = scene.closest_native(&rest, &mut ()) {
        rest.t_near = hit.t.next_up();
        found.push(hit);
    }
    found
}

/// A cloud of long, overlapping triangles, which spatial splits would cut.
fn cloud(count: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut random = Random::new(SEED, 0);
    let corners = (0..3 * count).map(|_| random.direction().as_vec3().to_array());
    let vertices = corners.collect();
    let triangles = (0..count).map(|number| [3 * number, 3 * number + 1, 3 * number + 2]);
    (vertices, triangles.collect())
}

#[test]
fn every_hit_from_many_threads_is_what_closest_hits_tell_one_by_one() {
    const TRIANGLES: u32 = 2_000;
    const RAYS: u64 = 500;
    let (vertices, triangles) = cloud(TRIANGLES);
    let mut collecting = builder();
    collecting
        .attach_collecting_triangles(&vertices, &triangles)
        .unwrap();
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let mut plain = SceneBuilder::<()>::new(&device).unwrap();
    plain.attach_triangles(&vertices, &triangles).unwrap();
    let (collecting, plain) = (collecting.commit().unwrap(), plain.commit().unwrap());

    let count = |thread: u64| -> usize {
        let mut hits = vec![];
        let mut total = 0;
        for index in 0..RAYS {
            let mut random = Random::new(SEED + 1, thread * RAYS + index);
            let origin = random.direction() * 2.0;
            let ray = Ray32 {
                origin: origin.as_vec3().to_array(),
                direction: (random.direction() * 0.5 - origin).as_vec3().to_array(),
                t_near: 0.0,
                t_far: f32::INFINITY,
            };
            collecting.every_hit(&ray, &mut hits);
            let sorted = hits.is_sorted_by(|a, b| a.primitive < b.primitive);
            assert!(sorted, "ray {index}: a triangle twice, or out of order");
            let expected = one_by_one(&plain, &ray);
            // Two triangles with the same t are one answer there.
            for hit in &expected {
                let at = hits.iter().find(|at| at.primitive == hit.primitive);
                let at = at.unwrap_or_else(|| panic!("ray {index}: {hit:?} is not collected"));
                assert_eq!((at.t, at.normal), (hit.t, hit.normal));
            }
            for hit in &hits {
                let told = expected.iter().any(|told| told.t == hit.t);
                assert!(told, "ray {index}: {hit:?} was only collected");
            }
            total += hits.len();
        }
        total
    };
    let totals: Vec<usize> = thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|n| {
                let count = &count;
                scope.spawn(move || count(n))
            })
            .collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert!(totals.iter().all(|&total| total > 10_000), "{totals:?}");
}

#[test]
fn collecting_triangles_bad_input_is_refused_before_embree_sees_it() {
    let mut builder = builder();
    let nowhere = builder.attach_collecting_triangles(&[[0.0; 3]; 3], &[[0, 1, 3]]);
    assert!(nowhere.unwrap_err().to_string().contains("vertex 3"));
    let empty = builder.attach_collecting_triangles(&[], &[]);
    assert_eq!(empty, Ok(GeometryId(0)));
    let mut hits = vec![];
    builder
        .commit()
        .unwrap()
        .every_hit(&up(0.0, 1.0), &mut hits);
    assert_eq!(hits, []);
}
