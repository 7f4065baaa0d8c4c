//! Embree's cone curves as a witness: how often they agree with the tracer, and
//! that the oracle decides where they do not.

use std::path::Path;
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::scene;
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{Class, Intersector, Outcome, ReportedHit, Settings, Witness};

/// A tracer whose hits lie this many lengths of the direction too far.
struct Late {
    tracer: Tracer,
    by: f64,
}

impl Intersector for Late {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        let finding = Intersector::closest(&self.tracer, ray)?;
        Some(ReportedHit {
            t: finding.t + self.by,
            ..finding
        })
    }
}

/// The outcome with the simplest prisms: the others take most of the time.
fn outcome(name: &str, rays: u64, by: f64) -> Outcome {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .join("scenes")
        .join(name);
    let scene = Arc::new(scene::load(&path).unwrap());
    let tracer = Tracer::new(Arc::clone(&scene), &Options::default()).unwrap();
    let settings = Settings {
        segments: vec![3],
        rays,
        ..Settings::default()
    };
    let start = std::time::Instant::now();
    let outcome = cyltrace_check::compare(&scene, &Late { tracer, by }, &settings).unwrap();
    println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
    for window in &outcome.windows {
        println!("  {window}");
    }
    for row in &outcome.rows {
        let share = |count: u64| 100.0 * count as f64 / row.rays as f64;
        println!(
            "  {} {}: {} rays, {} hits, {:.3} % agree, {:.3} % unwitnessed, {:.3} % cleared, {} violations",
            row.witness.name(),
            row.class,
            row.rays,
            row.hits,
            share(row.witnessed),
            share(row.unwitnessed),
            share(row.triangle_errors),
            row.violations,
        );
    }
    outcome
}

/// The least share of rays from around the scene, in percent, that agree. Other
/// classes reach what cone curves get wrong (`crates/bench/tests/bench/rival_defects.rs`).
fn agrees(name: &str, rays: u64, least: f64) {
    let outcome = outcome(name, rays, 0.0);
    assert_eq!(outcome.violation_count(), 0, "{:?}", outcome.violations);
    for row in &outcome.rows {
        let share = 100.0 * row.witnessed as f64 / row.rays as f64;
        let is_held = (row.witness, row.class) == (Witness::ConeCurve, Class::Sphere);
        assert!(!is_held || share >= least, "{row:?}");
    }
}

#[test]
fn curves_agree_on_the_minimal_scene() {
    agrees("minimal.toml", 4_000, 99.0);
}

#[test]
fn curves_agree_on_the_lattice() {
    agrees("lattice.toml", 4_000, 99.0);
}

#[test]
fn curves_agree_on_the_forest() {
    agrees("forest.toml", 4_000, 90.0);
}

#[test]
fn curves_agree_on_the_pathological_scene() {
    agrees("pathological.toml", 4_000, 90.0);
}

#[test]
fn late_hits_are_violations_by_curves_and_oracle() {
    // Some of the four questions of a block are about open ends, which excuse more.
    let outcome = outcome("minimal.toml", 40_000, 0.05);
    assert!(!outcome.holds());
    for row in &outcome.rows {
        if row.witness == Witness::ConeCurve && row.hits > 0 {
            assert!(row.violations > 0, "{row:?}");
        }
    }
    assert!(!outcome.violations.is_empty());
}
