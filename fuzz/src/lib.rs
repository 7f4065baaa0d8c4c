//! What the fuzz targets do with their bytes.
//!
//! Each target is a function of bytes that panics when something is wrong. The same
//! functions run under libFuzzer (`fuzz/targets`) and, over the inputs of
//! `fuzz/corpus`, in a plain test (`crates/cli/tests/cli/fuzz_corpus.rs`).

mod command_line;
mod composed;
mod drawing;
mod drawn_scene;
mod meshes;
mod number_tables;
mod parts;
mod scene_files;
mod traced_scene;
mod truth;

use arbitrary::Unstructured;
pub use command_line::numbers as command_line_numbers;
use drawn_scene::DrawnScene;
pub use meshes::{obj, ply, stl};
pub use number_tables::{hits, point_ranges, points, rays};
pub use parts::part_file;
pub use scene_files::{cylinder_table, scene_file, swc, three_mf_model, three_mf_package};

/// What a target does with its bytes.
pub type Target = fn(&[u8]);

/// All targets by their names, which are those of their files in `fuzz/targets` and of
/// their folders in `fuzz/corpus`.
pub const TARGETS: &[(&str, Target)] = &[
    ("command_line_numbers", command_line_numbers),
    ("cylinder_table", cylinder_table),
    ("hits", hits),
    ("obj", obj),
    ("part_file", part_file),
    ("ply", ply),
    ("point_ranges", point_ranges),
    ("points", points),
    ("rays", rays),
    ("scene_file", scene_file),
    ("stl", stl),
    ("swc", swc),
    ("three_mf_model", three_mf_model),
    ("three_mf_package", three_mf_package),
    ("traced_scene", traced_scene),
];

/// A scene that the bytes describe answers alike by every query, and rightly.
///
/// # Panics
/// When it does not.
pub fn traced_scene(bytes: &[u8]) {
    // Bytes that run out are no failure.
    if let Ok(drawn) = DrawnScene::new(&mut Unstructured::new(bytes)) {
        traced_scene::check(&drawn);
    }
}
