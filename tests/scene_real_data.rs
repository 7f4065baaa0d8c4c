//! Files made by others: a tree model and four neurons, where they are there.
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
    let cylinders = &scene.prototypes[0].cylinders;
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
        let records = &scene.prototypes[0].cylinders;
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
        assert_eq!(scene.prototypes[0].cylinders.len(), 8);
    }
}
