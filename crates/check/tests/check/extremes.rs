//! Solids of every kind as small, large, thin and far as numbers go: a check has a verdict or
//! an error, and never calls an answer wrong.

use std::sync::Arc;

use cyltrace::math::Orientation;
use cyltrace::scene::Scene;
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{CheckError, Settings};
use glam::DVec3;

use test_support::solids::prototype_of;

/// A solid of each kind about a line, if these numbers make a valid one.
fn kinds(p0: DVec3, p1: DVec3, radius: f64) -> Vec<AnySolid> {
    let middle = 0.5 * (p0 + p1);
    let half_widths = DVec3::new(radius, 0.5 * radius, 0.5 * (p1 - p0).length());
    let solids: [Option<AnySolid>; 7] = [
        Cylinder::new(p0, p1, radius, Caps::Both)
            .ok()
            .map(Into::into),
        Cylinder::new(p0, p1, radius, Caps::None)
            .ok()
            .map(Into::into),
        Cone::new(p0, p1, 0.0, radius, Caps::P1)
            .ok()
            .map(Into::into),
        RoundedCone::new(p0, p1, 0.5 * radius, radius)
            .ok()
            .map(Into::into),
        Sphere::new(middle, radius).ok().map(Into::into),
        Cuboid::new(middle, half_widths, Orientation::IDENTITY)
            .ok()
            .map(Into::into),
        Disk::new(middle, p1 - p0, radius).ok().map(Into::into),
    ];
    solids.into_iter().flatten().collect()
}

/// The outcome in a word, for a scene that the tracer accepts.
fn outcome(solids: &[AnySolid], what: &str) -> &'static str {
    let scene = Arc::new(Scene::new(vec![prototype_of(solids)]));
    let Ok(tracer) = Tracer::new(scene.clone(), &Options::default()) else {
        return "not traced";
    };
    let settings = Settings {
        rays: 40,
        segments: vec![8],
        ..Settings::default()
    };
    match cyltrace_check::compare(&scene, &tracer, &settings) {
        Ok(outcome) => {
            assert_eq!(
                outcome.violation_count(),
                0,
                "{what}: {:?}",
                outcome.violations
            );
            if outcome.holds() {
                "holds"
            } else {
                "says too little"
            }
        }
        Err(CheckError::Embree(error)) => panic!("{what}: {error}"),
        Err(_) => "an error",
    }
}

#[test]
fn extreme_solids_have_a_verdict() {
    const SIZES: [f64; 7] = [1e-45, 1e-20, 1e-3, 1.0, 1e7, 1e20, 1e45];
    let mut words = std::collections::BTreeMap::<&str, u32>::new();
    for length in SIZES {
        for radius in SIZES {
            for far in [0.0, 1e20, 1e45] {
                let p0 = DVec3::new(far, -far, 0.0);
                let p1 = p0 + DVec3::new(0.8, 0.0, 0.6) * length;
                for solid in kinds(p0, p1, radius) {
                    let what = format!("{solid:?}");
                    *words.entry(outcome(&[solid], &what)).or_default() += 1;
                }
            }
        }
    }
    println!("{words:?}");
    assert!(
        words.get("holds").is_some_and(|&count| count > 100),
        "{words:?}"
    );
}

/// The far end is 10^20 away and the radius a tenth: f64 has no numbers near the wall there.
#[test]
fn thin_cylinder_to_far_away_has_a_verdict() {
    for (p1, radius) in [
        (DVec3::new(1e20, 0.0, 2.0), 0.1),
        (DVec3::new(1e20, 1e20, 1e20), 1e-20),
        (DVec3::new(1e44, 0.0, -1e44), 1e-44),
    ] {
        let kinds = kinds(DVec3::ZERO, p1, radius);
        for solid in &kinds {
            outcome(&[*solid], &format!("{solid:?}"));
        }
        outcome(&kinds, "all of them");
    }
}
