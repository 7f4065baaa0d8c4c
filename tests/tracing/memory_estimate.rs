//! Counts and estimates of scenes, against what the tracer says it built.

use test_support::three_mf;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use cyltrace::math::Random;
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SceneFile, Solids,
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
        solids: Solids::of_cylinders((0..cylinders).map(record)),
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
    let scene_stats = scene.scene_stats();
    assert_eq!(scene_stats.depth, 1);
    for layout in [Layout::Single, Layout::Block] {
        let tracer = built(&scene, layout);
        let statistics = tracer.statistics();
        assert_eq!(scene_stats.unique, statistics.unique);
        assert_eq!(scene_stats.instanced, statistics.instanced);
        assert_eq!(scene_stats.instances, statistics.instances);

        let estimate = MemoryEstimate::of(&scene.contents(), layout, None);
        assert_eq!(estimate.records_bytes, 50_000 * 64 + 20_000 * 104);
        let kept = estimate.records_bytes + estimate.copies_bytes;
        assert_eq!(kept, statistics.records_bytes as u64, "{layout:?}");
        let real = kept + statistics.embree_bytes as u64;
        let ratio = estimate.total_bytes() as f64 / real as f64;
        assert!((0.9..1.1).contains(&ratio), "{layout:?}: {ratio} of {real}");
    }
    let tracer = built(&scene, Layout::Single);

    let (counted, traced) = (scene_stats.bounds, tracer.bounds());
    let apart = (counted.lower - traced.lower).abs() + (counted.upper - traced.upper).abs();
    assert!(apart.max_element() < 1e-6, "{counted:?} {traced:?}");
}

#[test]
fn sample_scenes_counted_before_loading_hold_no_less_and_are_estimated_well() {
    for name in ["forest.toml", "lattice.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(name);
        let file = SceneFile::read(&path).expect("a scene file");
        let before = file.contents();
        let scene = file.load().expect("a scene");
        let after = scene.contents();
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(&after) {
            assert_eq!((&before.name, before.is_used), (&after.name, after.is_used));
            // Each table may end in a line end and hold a few comments.
            let [before_all, after_all] = [before, after].map(|one| one.solids.counts.total());
            let spare = before_all - after_all;
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

/// Two segments.
const NEURON: &str = "1 1 0 0 0 1 -1\n2 3 0 0 5 0.5 1\n3 3 0 5 5 0.25 2";

const SOLIDS: &str = r#"
[[swc]]
file = "neuron.swc"
[[swc]]
file = "neuron.swc"
joints = "flat"
[[swc]]
file = "neuron.swc"
joints = "round"
[[beam_lattice]]
file = "lattice.3mf"

[[sphere]]
center = [9, 9, 9]
radius = 1
[[union]]
of = [
    { sphere = { center = [0, 0, 0], radius = 1 } },
    { cuboid = { half_widths = [1, 2, 0.5] } },
    { difference = { of = [
        { cuboid = { half_widths = [1, 1, 1] } },
        { intersection = { of = [{ sphere = { center = [1, 0, 0], radius = 1 } }] } },
    ] } },
]
[[intersection]]
of = [
    { sphere = { center = [0, 0, 0], radius = 1 } },
    { cuboid = { half_widths = [1, 1, 1] } },
]
"#;

/// Three objects in five places. The first has cylinders, cones, balls and, at the
/// last beam, which is shorter than it is thick, two halves.
fn lattice() -> Vec<u8> {
    let object = |id: u32, beams: &str| {
        let vertices: String = [0.0, 4.0, 6.0, 6.5]
            .iter()
            .map(|x| format!("<vertex x=\"{x}\" y=\"0\" z=\"0\"/>"))
            .collect();
        format!(
            "<object id=\"{id}\"><mesh><vertices>{vertices}</vertices><triangles/>\
             <b:beamlattice radius=\"0.5\" minlength=\"0.1\" cap=\"sphere\"><b:beams>{beams}\
             </b:beams></b:beamlattice></mesh></object>"
        )
    };
    let first = object(
        1,
        "<b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"1\" v2=\"2\" r1=\"0.25\" r2=\"0.5\"/>\
         <b:beam v1=\"2\" v2=\"3\" r1=\"0.75\" cap1=\"hemisphere\" cap2=\"hemisphere\"/>",
    );
    let second = object(2, "<b:beam v1=\"0\" v2=\"3\" cap1=\"butt\" cap2=\"butt\"/>");
    let both = "<object id=\"3\"><components><component objectid=\"1\"/>\
        <component objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 9 0\"/></components></object>";
    let model = three_mf::model(
        "requiredextensions=\"b\"",
        &format!(
            "<resources>{first}{second}{both}</resources><build><item objectid=\"3\"/>\
             <item objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 0 0 9\"/>\
             <item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 -9\"/></build>"
        ),
    );
    three_mf::three_mf(&model)
}

/// Three trees, two of which have a soma that joins a segment of another type: each of
/// the two is a ball at the end of a segment.
#[test]
fn neurons_of_several_somata_are_counted_before_loading_as_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("a file is written");
    };
    write(
        "neurons.swc",
        "1 3 0 0 0 1 -1\n2 1.0 0 0 5 2 1\n3 1 0 5 5 2 1\n4 3 9 9 9 1 3",
    );
    write("scene.toml", "[[swc]]\nfile = \"neurons.swc\"\n");
    let file = SceneFile::read(&folder.path().join("scene.toml")).expect("a scene file");
    let before = file.contents();
    let scene = file.load().expect("a scene");
    assert_eq!(scene.prototypes[0].solids.spheres.len(), 2);
    assert_eq!(before, scene.contents());
}

#[test]
fn neurons_lattices_and_compositions_are_counted_before_loading_as_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).expect("a file is written");
    };
    write("neuron.swc", NEURON.as_bytes());
    write("lattice.3mf", &lattice());
    write("scene.toml", SOLIDS.as_bytes());
    let file = SceneFile::read(&folder.path().join("scene.toml")).expect("a scene file");
    let before = file.contents();
    let scene = Arc::new(file.load().expect("a scene"));
    assert_eq!(before, scene.contents());

    // Each neuron has a ball for its soma. Of the lattice: two cylinders and a cone, three balls of different sizes at the ends
    // of the first two beams, two halves; and in the second object a cylinder.
    let [prototype] = &scene.prototypes[..] else {
        panic!("one prototype");
    };
    let solids = &prototype.solids;
    assert_eq!(prototype.solids.cylinders.len(), 2 + 3 * 2 + 2);
    assert_eq!((solids.cones.len(), solids.rounded_cones.len()), (2 + 3, 2));
    assert_eq!(
        (solids.spheres.len(), solids.compositions.len()),
        (1 + 3 + 3 * 3, 2 + 3 * 2)
    );

    let estimate = MemoryEstimate::of(&before, Layout::Single, None);
    let statistics = built(&scene, Layout::Single).statistics();
    assert_eq!(estimate.records_bytes, statistics.records_bytes as u64);
}
