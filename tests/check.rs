//! Hits checked against meshes: the tracer passes, and whatever is wrong by
//! little does not.

use std::path::Path;
use std::sync::Arc;

use cyltrace::check::{self, Class, Outcome, Settings};
use cyltrace::scene::{self, Scene};
use cyltrace::tracer::{Options, Tracer};

fn sample(name: &str) -> Arc<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    Arc::new(scene::load(&path).unwrap_or_else(|error| panic!("{error}")))
}

fn tracer(scene: &Arc<Scene>) -> Tracer {
    Tracer::new(Arc::clone(scene), &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The outcome, printed.
fn checked(name: &str, scene: &Scene, tracer: &Tracer, settings: &Settings) -> Outcome {
    let start = std::time::Instant::now();
    let outcome =
        check::compare(scene, tracer, settings).unwrap_or_else(|error| panic!("{name}: {error}"));
    println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
    for window in &outcome.windows {
        println!("  {window}");
    }
    for row in &outcome.rows {
        println!("  {row:?}");
    }
    println!("  {:?}", outcome.convergence);
    for violation in &outcome.violations {
        println!("  {violation:?}");
    }
    outcome
}

fn sample_holds(name: &str, rays: u64) {
    let scene = sample(name);
    let settings = Settings {
        rays,
        classes: Class::ALL.to_vec(),
        ..Settings::default()
    };
    let outcome = checked(name, &scene, &tracer(&scene), &settings);
    assert_eq!(outcome.violation_count(), 0, "{name}");
    assert!(outcome.holds(), "{name}");
}

#[test]
fn minimal_scene_holds() {
    sample_holds("minimal.toml", 4_000);
}

#[test]
fn pathological_scene_holds() {
    sample_holds("pathological.toml", 4_000);
}

#[test]
fn lattice_holds() {
    sample_holds("lattice.toml", 4_000);
}

#[test]
fn forest_holds() {
    sample_holds("forest.toml", 4_000);
}
