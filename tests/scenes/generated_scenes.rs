//! The committed tables of `scenes/` are what the generator makes.

#[path = "../../examples/generate_scenes/tables/mod.rs"]
mod tables;

use std::path::Path;

/// Small enough to keep a clone quick; the largest table has two thirds of it.
const LARGEST_TABLE: usize = 600_000;

#[test]
fn committed_tables_compared_with_generator_are_identical() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for table in tables::all() {
        let committed = std::fs::read_to_string(folder.join(table.file))
            .unwrap_or_else(|error| panic!("{}: {error}", table.file));
        let differing = committed
            .lines()
            .zip(table.text.lines())
            .position(|(committed, generated)| committed != generated);
        assert!(
            committed == table.text,
            "{} differs from the generator's, first in line {:?} of {} rows; \
             run: cargo run --release --example generate_scenes",
            table.file,
            differing.map(|index| index + 1),
            table.rows,
        );
    }
}

#[test]
fn generated_tables_measured_are_small() {
    for table in tables::all() {
        assert!(
            table.text.len() < LARGEST_TABLE,
            "{} has {} bytes",
            table.file,
            table.text.len()
        );
    }
}
