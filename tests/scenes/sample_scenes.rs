//! The sample scenes load, and hold what their header comments say.

use std::path::Path;
use std::sync::Arc;

use cyltrace::solid::SolidKind;
use cyltrace::tracer::{BuildTime, Options, Tracer};

/// Loads and builds a scene; answers with the cylinders stored, those in the
/// scene, and its placements.
fn counts(name: &str) -> (u128, u128, u128) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    let scene = cyltrace::scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.skipped_rows, 0, "{name} skips rows");
    let options = Options {
        build: BuildTime::AtOnce,
        ..Options::default()
    };
    let tracer =
        Tracer::new(Arc::new(scene), &options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let statistics = tracer.statistics();
    assert!(
        statistics.skipped.is_empty(),
        "{name}: {:?}",
        statistics.skipped
    );
    (
        statistics.unique[SolidKind::Cylinder],
        statistics.instanced[SolidKind::Cylinder],
        statistics.instances,
    )
}

#[test]
fn forest_counted_holds_ten_thousand_trees() {
    assert_eq!(counts("forest.toml"), (59_355, 129_004_045, 10_000));
}

#[test]
fn forest_huge_loaded_holds_ten_thousand_million_cylinders() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/forest_huge.toml");
    let scene = cyltrace::scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let scene_stats = scene.scene_stats();
    assert_eq!(scene.prototypes[1].solids.cylinders.len(), 10_000);
    assert_eq!(scene_stats.placements, 1_000_000);
    assert_eq!(scene_stats.unique[SolidKind::Cylinder], 10_005);
    assert_eq!(scene_stats.instanced[SolidKind::Cylinder], 10_000_000_005);
}

#[test]
fn lattice_counted_holds_sixty_thousand_struts() {
    assert_eq!(counts("lattice.toml"), (13_749, 61_061, 7));
}

#[test]
fn minimal_counted_holds_four_cylinders() {
    assert_eq!(counts("minimal.toml"), (4, 4, 0));
}

#[test]
fn pathological_counted_holds_what_its_header_says() {
    assert_eq!(counts("pathological.toml"), (41, 44, 5));
}

/// The scenes of the gallery: nothing is missing.
#[test]
fn gallery_loaded_has_what_its_comments_say() {
    assert_eq!(counts("gallery/forest.toml"), (59_355, 129_004_045, 10_000));
    assert_eq!(counts("gallery/lattice.toml"), (13_749, 61_061, 7));
    assert_eq!(counts("gallery/pipes.toml"), (1023, 1023, 0));
    let (unique, bonds, _) = counts("gallery/crystal.toml");
    assert_eq!((unique, bonds), (16, 16 << 27));
    let neuron = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/gallery/neuron.toml");
    let scene = cyltrace::scene::load(&neuron).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.prototypes[0].solids.len(), 1423);
    assert!(scene.legend.is_some());
}
