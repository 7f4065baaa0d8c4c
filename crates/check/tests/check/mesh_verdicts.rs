//! Verdicts on meshes and on hits of other programs: none is false, and real defects
//! are found.

use std::path::Path;
use std::sync::Arc;

use crate::meshes::{compared_with, go_on, row};
use cyltrace::scene::{Scene, load};
use cyltrace::solid::tessellation::{Fit, Mesh, deviation_of, mesh_of};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{compare_hits, rays_around};
use glam::DVec3;

const RAYS: u64 = 20_000;

fn scene() -> Arc<Scene> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenes/minimal.toml");
    Arc::new(load(&path).expect("a scene"))
}

fn tracer(scene: &Arc<Scene>) -> Tracer {
    Tracer::new(scene.clone(), &Options::default()).expect("a tracer")
}

/// The meshes of the scene's solids, and their greatest deviation.
fn meshes(scene: &Scene, segments: u32, fit: Fit) -> (Vec<Mesh>, f64) {
    let solids: Vec<_> = scene.prototypes[0]
        .singles()
        .map(|(_, solid)| solid)
        .collect();
    let meshes = solids.iter().map(|one| mesh_of(one, segments, fit));
    let deviations = solids.iter().map(|one| deviation_of(one, segments, fit));
    (meshes.collect(), deviations.fold(0.0, f64::max))
}

#[test]
fn right_meshes_are_never_called_wrong() {
    let scene = scene();
    let tracer = tracer(&scene);
    for segments in [8, 16, 32, 64] {
        for fit in [Fit::Inscribed, Fit::Circumscribed] {
            let (meshes, deviation) = meshes(&scene, segments, fit);
            for seed in 0..3 {
                let found = compared_with(&tracer, &meshes, (seed, RAYS), deviation);
                assert_eq!(found.rays, RAYS);
                assert_eq!(found.violations, 0, "{segments} {fit:?} {seed}");
                let share = found.band as f64 / RAYS as f64;
                println!("{segments} {fit:?} {seed}: band {share}");
                assert!(share < 0.05, "{segments} {fit:?} {seed}: band {share}");
            }
        }
    }
}

#[test]
fn moved_vertex_is_found() {
    let scene = scene();
    let tracer = tracer(&scene);
    let (mut meshes, deviation) = meshes(&scene, 32, Fit::Inscribed);
    // Of the drum, outward.
    meshes[3].vertices[0] += DVec3::new(10.0 * deviation, 0.0, 0.0);
    let found = compared_with(&tracer, &meshes, (0, RAYS), deviation);
    assert!(found.violations > 0);
    println!("moved vertex: {}", found.violations);
}

#[test]
fn missing_cylinder_is_found() {
    let scene = scene();
    let tracer = tracer(&scene);
    for missing in 0..4 {
        let (mut meshes, deviation) = meshes(&scene, 32, Fit::Inscribed);
        meshes.remove(missing);
        let found = compared_with(&tracer, &meshes, (0, RAYS), deviation);
        println!("without {missing}: {}", found.violations);
        assert!(found.violations > RAYS / 100, "{missing}");
    }
}

#[test]
fn hits_off_by_a_thousandth_are_found() {
    let scene = scene();
    let tracer = tracer(&scene);
    let rays = rays_around(&tracer, 0, RAYS);
    let reported = |factor: f64| -> Vec<Option<f64>> {
        let hits = rays.iter().map(|ray| tracer.closest(ray));
        hits.map(|hit| hit.map(|hit| hit.t * factor)).collect()
    };
    for factor in [1.0 - 1e-3, 1.0 + 1e-3] {
        let found = compare_hits(
            &tracer,
            &rays,
            &reported(factor),
            16.0 / 16_777_216.0,
            3,
            &go_on,
        );
        let found = row(found);
        println!("{factor}: {} of {}", found.violations, found.hits);
        assert!(100 * found.violations > 99 * found.hits);
    }
}
