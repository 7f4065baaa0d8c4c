//! Counts and estimates of scenes, against what the tracer says it built.

use std::path::Path;
use std::sync::Arc;

use cyltrace::math::Random;
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Records, Scene,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{BuildTime, Layout, MemoryEstimate, Options, Tracer};
use glam::DAffine3;

const SEED: u64 = 41;

/// A tracer with nothing left to build, which is what is estimated.
fn built(scene: &Arc<Scene>, layout: Layout) -> Tracer {
    let options = Options {
        build: BuildTime::AtOnce,
        layout,
        ..Options::default()
    };
    Tracer::new(Arc::clone(scene), &options).expect("built")
}

fn scene(cylinders: u32, placements: u32) -> Scene {
    let mut random = Random::new(SEED, 0);
    let record = |primitive| {
        let p0 = random.direction() * random.uniform(0.0, 10.0);
        let p1 = p0 + random.direction();
        let cylinder = Cylinder::new(p0, p1, 0.02, Caps::Both).expect("a cylinder");
        CylinderRecord::new(&cylinder, primitive, MaterialIndex(0))
    };
    let prototype = Prototype {
        cylinders: (0..cylinders).map(record).collect(),
        ..Prototype::default()
    };
    let root = Prototype {
        placements: (0..placements)
            .map(|_| Placement {
                of: PrototypeIndex(1),
                parent_from_child: DAffine3::from_translation(random.direction() * 100.0),
            })
            .collect(),
        ..Prototype::default()
    };
    Scene::new(vec![root, prototype])
}

#[test]
fn census_and_estimate_of_a_nested_scene_agree_with_the_tracer() {
    let scene = Arc::new(scene(50_000, 20_000));
    let census = scene.census();
    assert_eq!(census.depth, 1);
    for layout in [Layout::Single, Layout::Block] {
        let tracer = built(&scene, layout);
        let statistics = tracer.statistics();
        assert_eq!(census.cylinders_unique, statistics.cylinders_unique);
        assert_eq!(census.cylinders_instanced, statistics.cylinders_instanced);
        assert_eq!(census.instances, statistics.instances);

        let estimate = MemoryEstimate::of(&scene.contents(), layout, None);
        assert_eq!(estimate.records_bytes, 50_000 * 64 + 20_000 * 104);
        let kept = estimate.records_bytes + estimate.copies_bytes;
        assert_eq!(kept, statistics.records_bytes as u64, "{layout:?}");
        let real = kept + statistics.embree_bytes as u64;
        let ratio = estimate.total_bytes() as f64 / real as f64;
        assert!((0.9..1.1).contains(&ratio), "{layout:?}: {ratio} of {real}");
    }
    let tracer = built(&scene, Layout::Single);

    let (counted, traced) = (census.bounds, tracer.bounds());
    let apart = (counted.lower - traced.lower).abs() + (counted.upper - traced.upper).abs();
    assert!(apart.max_element() < 1e-6, "{counted:?} {traced:?}");
}

#[test]
fn sample_scenes_counted_before_loading_hold_no_less_and_are_estimated_well() {
    for name in ["forest.toml", "lattice.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(name);
        let file = cyltrace::scene::SceneFile::read(&path).expect("a scene file");
        let before = file.contents();
        let scene = file.load().expect("a scene");
        let after = scene.contents();
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(&after) {
            assert_eq!((&before.name, before.is_used), (&after.name, after.is_used));
            assert_eq!(after.records, Records::F64);
            // Each table may end in a line end and hold a few comments.
            let spare = before.cylinders - after.cylinders;
            assert!(spare <= 20, "{name}: {before:?} {after:?}");
            let spare = before.placements() - after.placements();
            assert!(spare <= 20, "{name}: {before:?} {after:?}");
        }
        let estimate = MemoryEstimate::of(&after, Layout::Single, None);
        let tracer = built(&Arc::new(scene), Layout::Single);
        let real = estimate.records_bytes + tracer.statistics().embree_bytes as u64;
        let ratio = estimate.total_bytes() as f64 / real as f64;
        assert!((0.9..1.1).contains(&ratio), "{name}: {ratio} of {real}");
    }
}
