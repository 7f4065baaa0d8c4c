//! Hulls of a whole scene, and their memory.

use std::path::Path;

use super::*;
use crate::bounding_meshes::hull::tests::random_window;
use crate::bounding_meshes::placed::{Budget, windows};
use crate::solids::tests::random_solid;
use cyltrace::embree::{Device, DeviceOptions, SceneBuilder};
use cyltrace::math::{Bounds, Random};

const BOTH: [Fit; 2] = [Fit::Inscribed, Fit::Circumscribed];

/// All solids of a scene.
fn whole(scene: &cyltrace::scene::Scene) -> Window {
    let budget = Budget {
        triangles: 1 << 22,
        segments: 8,
    };
    windows(scene, budget, 0).remove(0)
}

/// Solids too small for f32 at their distance have no hulls, and are listed as missing.
#[test]
fn solids_below_the_last_bit_are_unwitnessed() {
    let mut random = Random::new(73, 0);
    for _ in 0..100 {
        let solid = random_solid(&mut random);
        let mut window = random_window(solid, &mut random);
        let bounds = window.extent();
        let size = bounds.extent().length();
        let far = bounds.center() + random.direction() * (size * 1e9);
        window.bounds = Some(Bounds::at(far).grown(size));
        let frame = MeshFrame::new(&window);
        assert_eq!(hulls(&window, &frame, 16, Fit::Inscribed).missing, [0]);
        let outer = hulls(&window, &frame, 16, Fit::Circumscribed);
        assert_eq!(outer.triangles_of(0).is_empty(), outer.missing == [0]);
    }
}

/// `scenes/lattice.toml` at 64 sides.
#[test]
fn lattice_has_all_hulls() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenes/lattice.toml");
    let scene = cyltrace::scene::load(&path).expect("the scene is there");
    let window = whole(&scene);
    let frame = MeshFrame::new(&window);
    for side in BOTH {
        let hulls = hulls(&window, &frame, 64, side);
        assert!(hulls.missing.is_empty());
        assert_eq!(hulls.hull.triangles.len(), window.solids.len() * 4 * 64);
    }
}

/// The estimate against the memory of the lists and of Embree.
#[test]
fn memory_is_near_the_estimate() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenes/lattice.toml");
    let scene = cyltrace::scene::load(&path).expect("the scene is there");
    let window = &mut whole(&scene);
    for (solids, segments) in [(10_000, 16), (3_000, 64), (300, 512)] {
        window.solids.truncate(solids);
        let frame = MeshFrame::new(window);
        let device = Device::new(&DeviceOptions::default()).expect("a device");
        let mut used = 0;
        let scenes = BOTH.map(|side| {
            let hulls = hulls(window, &frame, segments, side);
            used += size_of_val(&*hulls.hull.vertices) + size_of_val(&*hulls.hull.triangles);
            let mut builder = SceneBuilder::<()>::new(&device).expect("a scene");
            let attached = builder.attach_triangles(&hulls.hull.vertices, &hulls.hull.triangles);
            attached.expect("a legal mesh");
            builder.commit().expect("built")
        });
        let used = used + device.memory_bytes();
        drop(scenes);
        let estimate = bytes_needed(solids as u64 * 4 * u64::from(segments));
        let ratio = used as f64 / estimate as f64;
        assert!(
            (0.9..1.1).contains(&ratio),
            "{solids} solids of {segments} sides: {ratio} of the estimate"
        );
    }
}
