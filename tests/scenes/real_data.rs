//! Files made by others: a tree model, four neurons and two beam lattices, where
//! they are there.
//!
//! They are not part of the repository (their licences differ); without them
//! the tests say so and do nothing.

use std::fs;
use std::path::{Path, PathBuf};

use cyltrace::scene::{Scene, SceneError, load};

/// A file of the data beside the repository.
fn data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data")
        .join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped: there is no {}", path.display());
    None
}

fn scene(text: &str) -> Result<Scene, SceneError> {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), text).expect("writing the scene");
    load(file.path())
}

fn neuron(path: &Path, degenerate: &str) -> Result<Scene, SceneError> {
    scene(&format!(
        "[[swc]]\nfile = '{}'\ndegenerate = \"{degenerate}\"\n",
        path.display()
    ))
}

#[test]
fn tree_model_loads_in_three_lines() {
    let Some(path) = data("tree_qsm_rtwig.csv") else {
        return;
    };
    let scene = scene(&format!(
        "[[cylinder_table]]\nfile = '{}'\n\
         columns = {{ p0 = [\"startX\", \"startY\", \"startZ\"], p1 = [\"endX\", \"endY\", \"endZ\"], radius = \"radius\" }}\n",
        path.display()
    ))
    .expect("the tree");
    let cylinders = &scene.prototypes[0].solids.cylinders;
    assert_eq!(cylinders.len(), 1_149);
    let first = cylinders.get(0).cylinder();
    assert_eq!(first.p0().to_array(), [0.760564, -16.356802, 253.888632]);
    assert_eq!(first.p1().to_array(), [0.759141, -16.360725, 253.938184]);
    assert_eq!(first.radius(), 0.047199);
}

#[test]
fn neurons_load_with_their_degenerate_segments_counted() {
    for (name, cylinders, skipped) in [
        ("neurom_Neuron.swc", 842, 4),
        ("neurom_Neuron_small_radius.swc", 838, 8),
        ("neurom_Neuron_zero_length_segments.swc", 838, 8),
    ] {
        let Some(path) = data(name) else {
            continue;
        };
        let scene = neuron(&path, "skip").expect(name);
        let records = &scene.prototypes[0].solids.cylinders;
        assert_eq!(records.len(), cylinders, "{name}");
        assert_eq!(scene.skipped_rows, skipped, "{name}");
        let last = records.iter().last().expect("a segment").primitive();
        assert_eq!(u64::from(last) + 1, cylinders as u64 + skipped, "{name}");

        let message = neuron(&path, "error").expect_err(name).to_string();
        let after_name = message
            .split_once(&format!("{name}:"))
            .map(|(_, rest)| rest);
        assert!(
            after_name.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())),
            "{message}"
        );
        assert!(message.contains("degenerate = \"skip\""), "{message}");
    }
}

#[test]
fn neuron_without_degenerate_segments_loads_as_it_is() {
    if let Some(path) = data("neurom_Neuron_zero_radius.swc") {
        let scene = neuron(&path, "error").expect("the neuron");
        assert_eq!(scene.prototypes[0].solids.cylinders.len(), 8);
    }
}

#[test]
fn neurons_load_with_their_tapers() {
    for (name, segments, without_length) in [
        ("neurom_Neuron.swc", 846, 4),
        ("neurom_Neuron_small_radius.swc", 846, 8),
        ("neurom_Neuron_zero_length_segments.swc", 846, 8),
    ] {
        let Some(path) = data(name) else {
            continue;
        };
        let path = path.display();
        let with = |keys: &str| scene(&format!("[[swc]]\nfile = '{path}'\n{keys}\n"));
        let flat = with("joints = \"flat\"\ndegenerate = \"skip\"").expect(name);
        let cones = &flat.prototypes[0].solids.cones;
        assert_eq!(flat.skipped_rows, without_length, "{name}");
        assert_eq!(cones.len() as u64, segments - without_length, "{name}");
        // Segments share the radii of their samples.
        let tapered = cones
            .iter()
            .filter(|one| one.solid.radius0() != one.solid.radius1());
        let tapered = tapered.count();
        assert!(
            tapered > 0 || name.contains("small_radius"),
            "{name}: {tapered} tapered"
        );

        // A rounded cone without length is a ball: nothing is degenerate.
        let round = with("joints = \"round\"").expect(name);
        assert_eq!(round.skipped_rows, 0, "{name}");
        assert_eq!(
            round.prototypes[0].solids.rounded_cones.len() as u64,
            segments,
            "{name}"
        );
        assert!(round.prototypes[0].solids.cylinders.is_empty(), "{name}");
    }
}

#[test]
fn lattice_of_a_pyramid_loads_as_it_is() {
    let Some(path) = data("3mf_pyramid.3mf") else {
        return;
    };
    let scene =
        scene(&format!("[[beam_lattice]]\nfile = '{}'\n", path.display())).expect("the pyramid");
    let root = &scene.prototypes[0];
    // 391 beams, of which 156 state a second radius; all ends are spheres, so that
    // each of the 123 vertices at which one ends has a ball.
    assert_eq!(root.solids.cylinders.len() + root.solids.cones.len(), 391);
    assert!(
        root.solids.cones.len() <= 156,
        "{}",
        root.solids.cones.len()
    );
    assert_eq!(root.solids.spheres.len(), 123);
    assert_eq!(root.solids.len(), 391 + 123);
    let first = root.solids.cylinders.get(0).cylinder();
    assert_eq!(first.p0().to_array(), [89.44272, 152.16904, 0.0]);
    assert_eq!(first.radius(), 2.29999);
}

#[test]
fn lattice_that_is_clipped_loads_where_that_is_left_out() {
    let Some(path) = data("3mf_variable_voronoi.3mf") else {
        return;
    };
    let with = |keys: &str| {
        scene(&format!(
            "[[beam_lattice]]\nfile = '{}'\n{keys}\n",
            path.display()
        ))
    };
    let message = with("").expect_err("a clipped lattice").to_string();
    assert!(
        message.contains("3dmodel.model:730: this lattice is clipped"),
        "{message}"
    );
    let millimeters = with("meshes = \"skip\"").expect("the lattice");
    let meters = with("meshes = \"skip\"\nunit = \"meter\"").expect("the lattice");
    for scene in [&millimeters, &meters] {
        let root = &scene.prototypes[0];
        assert_eq!(root.solids.cylinders.len() + root.solids.cones.len(), 1_291);
        assert_eq!(scene.skipped_rows, 0);
    }
    let first = |scene: &Scene| scene.prototypes[0].solids.cylinders.get(0).cylinder();
    assert_eq!(first(&millimeters).radius(), 0.5);
    assert_eq!(first(&meters).radius(), 0.5 / 1000.0);
    assert_eq!(first(&meters).p0(), first(&millimeters).p0() / 1000.0);
}
