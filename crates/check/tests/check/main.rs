//! Hits checked against meshes: the tracer passes, and slightly wrong intersectors fail.

mod bites;
mod external_kinds;
mod extremes;
mod mesh_verdicts;
mod meshes;
mod parts;
mod scenes;
mod solids;

use std::path::Path;
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::scene::{self, Scene};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{Class, Intersector, Outcome, Replay, ReportedHit, Settings, replay};

use scenes::{random_scene, single_cylinder};

fn sample(name: &str) -> Arc<Scene> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .join("scenes")
        .join(name);
    Arc::new(scene::load(&path).unwrap_or_else(|error| panic!("{error}")))
}

fn tracer(scene: &Arc<Scene>) -> Tracer {
    Tracer::new(Arc::clone(scene), &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The outcome; what was found is printed, for when a test fails.
fn checked(
    name: &str,
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
) -> Outcome {
    let outcome = cyltrace_check::compare(scene, intersector, settings)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    for window in &outcome.windows {
        println!("{name}: {window}");
    }
    for row in &outcome.rows {
        println!("{name}: {row:?}");
    }
    for violation in &outcome.violations {
        println!("{name}: {violation:?}");
    }
    outcome
}

fn sample_holds(name: &str, rays: u64) {
    let scene = sample(name);
    let settings = Settings {
        rays,
        ..Settings::default()
    };
    let outcome = checked(name, &scene, &tracer(&scene), &settings);
    assert_eq!(outcome.violation_count(), 0, "{name}");
    assert!(outcome.holds(), "{name}");
    // What is as deep as the arc of two sides is at most 4 sagittas deep.
    for row in &outcome.rows {
        assert!(
            name == "pathological.toml" || row.max_dt_over_chord <= 4.1,
            "{name}: {row:?}"
        );
    }
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
    sample_holds("lattice.toml", 3_000);
}

#[test]
fn forest_holds() {
    sample_holds("forest.toml", 2_000);
}

/// Overlapping cylinders under nested placements of all kinds, with all caps.
#[test]
fn random_scenes_hold() {
    for seed in 0..20 {
        let scene = Arc::new(random_scene(seed));
        let settings = Settings {
            rays: 1_000,
            seed,
            ..Settings::default()
        };
        let name = format!("random scene {seed}");
        let outcome = checked(&name, &scene, &tracer(&scene), &settings);
        assert_eq!(outcome.violation_count(), 0, "{name}");
    }
}

/// The share of rays between the prisms falls as their distance does, as N^-2.
///
/// With rays as N^2, so that some 100 are in the band for every number of sides and
/// each share is known to a tenth; the slope then to 0.03. The cylinder is as
/// large as the meshes' space: its margins of f32 are 5 % of the distance at
/// 512 sides.
#[test]
fn silhouette_band_falls_with_the_square_of_the_sides() {
    let scene = Arc::new(single_cylinder());
    let tracer = tracer(&scene);
    let points = [8_u32, 16, 32, 64, 128, 256, 512].map(|segments| {
        let settings = Settings {
            segments: vec![segments],
            rays: 30 * u64::from(segments).pow(2),
            classes: vec![Class::Sphere],
            ..Settings::default()
        };
        let name = format!("band of {segments} sides");
        let outcome = checked(&name, &scene, &tracer, &settings);
        assert!(outcome.holds());
        let percent = outcome.convergence[0].band_percent;
        println!("{segments} sides: {percent} %");
        (libm::log(f64::from(segments)), libm::log(percent))
    });
    let mean =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    println!("slope {slope}");
    assert!((-2.1..=-1.9).contains(&slope), "slope {slope}");
}

/// The outcome does not depend on the number of threads.
#[test]
fn threads_do_not_change_the_outcome() {
    let scene = sample("minimal.toml");
    let tracer = tracer(&scene);
    let settings = Settings {
        rays: 3_000,
        ..Settings::default()
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.expect("threads");
        let outcome = pool.install(|| cyltrace_check::compare(&scene, &tracer, &settings));
        format!("{:?}", outcome.expect("an outcome"))
    };
    assert_eq!(with(1), with(3));
}

/// The tracer, with the greatest number of rays of a call.
struct Batched<'a>(&'a Tracer, u64);

impl Intersector for Batched<'_> {
    fn closest(&self, _: &Ray) -> Option<ReportedHit> {
        panic!("a check calls with many rays at a time");
    }

    fn closest_of_each(&self, rays: &[Ray]) -> Vec<Option<ReportedHit>> {
        assert!((1..=self.1.max(8)).contains(&(rays.len() as u64)));
        self.0.closest_of_each(rays)
    }

    fn batch(&self) -> u64 {
        self.1
    }
}

/// The outcome does not depend on the size of batches.
#[test]
fn batches_do_not_change_the_outcome() {
    let scene = sample("minimal.toml");
    let tracer = tracer(&scene);
    let settings = Settings {
        rays: 9_001,
        segments: vec![16],
        ..Settings::default()
    };
    let outcome_of = |outcome| format!("{:?}", Result::expect(outcome, "an outcome"));
    let own = outcome_of(cyltrace_check::compare(&scene, &tracer, &settings));
    for batch in [7, 4096] {
        let batched = Batched(&tracer, batch);
        let outcome = cyltrace_check::compare(&scene, &batched, &settings);
        assert_eq!(outcome_of(outcome), own, "{batch}");
    }
}

/// A ray is found again by its number and by its bits.
#[test]
fn replayed_rays_are_the_same() {
    let scene = sample("lattice.toml");
    let tracer = tracer(&scene);
    let settings = Settings {
        segments: vec![8],
        ..Settings::default()
    };
    let replayed = |text: &str| {
        let which: Replay = text.parse().expect("a ray");
        assert_eq!(which.to_string(), text);
        replay(&scene, &tracer, &settings, &which).expect("replayed")
    };
    let drawn = replayed("grazing:17");
    assert!(drawn.violations.is_empty());
    let bits = drawn.lines[0].strip_prefix("ray ").expect("a ray");
    assert_eq!(replayed(bits).lines, drawn.lines);
    assert!("grazing".parse::<Replay>().is_err());
    assert!("0:0:0:0:0:0:0:0".parse::<Replay>().is_err());
}
