//! Samples until an error is reached: no bias, the same picture for any number of threads, and
//! the promise kept.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::{self, Background, Integrator, Projection, Scene, Sky, load};
use cyltrace::solid::Caps;
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_render::{Picture, Settings, Target, render};
use glam::DVec3;

use super::stage;

fn picture(tracer: &Tracer, settings: &Settings, threads: usize) -> Picture {
    let pool = workers(NonZeroUsize::new(threads)).expect("threads");
    render(tracer, settings, &pool, &|_| {}, &AtomicBool::new(false)).expect("rendered")
}

fn until(error: f64) -> Option<Target> {
    Some(Target { error, time: None })
}

/// The bottom of a tube, seen from above: little of the sky is visible from there, so most
/// samples are black and few are white. What has too few white ones looks done.
pub fn tube() -> Scene {
    let ground = (DVec3::NEG_Z, DVec3::ZERO, 9.0, Caps::Both);
    let tube = (DVec3::NEG_Z, DVec3::new(0.0, 0.0, 6.0), 1.5, Caps::None);
    let mut scene = stage::scene(&[ground, tube]);
    scene.camera.projection = Projection::Orthographic { height: Some(1.0) };
    Scene {
        materials: Scene::new(Vec::new()).materials,
        film: scene::Film {
            width: 6,
            height: 5,
        },
        background: Background::Color(DVec3::ZERO),
        sky: Some(Sky {
            color: DVec3::ONE,
            strength: 1.0,
        }),
        ..scene
    }
}

/// The visible part of the sky at a point of the bottom at the distance `r` from the axis, of a
/// tube of radius `a` and height `h`: the form factor of a disk that is parallel to it (J. R.
/// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-13).
fn open_sky(r: f64, a: f64, h: f64) -> f64 {
    let (h, a) = (h / r, a / r);
    let z = 1.0 + h * h + a * a;
    0.5 * (1.0 - (1.0 + h * h - a * a) / (z * z - 4.0 * a * a).sqrt())
}

/// The mean over the picture, integrated by midpoints.
fn true_mean() -> f64 {
    let (across, down) = (240, 200);
    let mut sum = 0.0;
    for (x, y) in (0..across).flat_map(|x| (0..down).map(move |y| (x, y))) {
        let x = ((f64::from(x) + 0.5) / f64::from(across) - 0.5) * 1.2;
        let y = (f64::from(y) + 0.5) / f64::from(down) - 0.5;
        sum += open_sky(x.hypot(y), 1.5, 6.0);
    }
    sum / f64::from(across * down)
}

#[test]
fn mean_over_many_seeds_has_no_bias() {
    let tracer = Tracer::new(Arc::new(tube()), &Options::default()).expect("built");
    let seeds = 1500;
    let mut stopped_after = [0_u64; 2];
    let means: Vec<f64> = (0..seeds)
        .map(|seed| {
            let settings = Settings {
                spp: 64,
                integrator: Integrator::Ao,
                seed,
                target: until(0.6),
                ..Settings::of(tracer.scene())
            };
            let made = picture(&tracer, &settings, 1);
            let samples = made.reached.expect("a target").samples;
            assert!(
                samples <= 30 * 64,
                "{samples}: more than the greatest number"
            );
            stopped_after[usize::from(samples > 30 * 30)] += 1;
            let values = made.film.pixels().as_flattened().iter();
            values.map(|&value| f64::from(value)).sum::<f64>() / 90.0
        })
        .collect();
    assert!(
        stopped_after.iter().all(|&count| count > seeds / 20),
        "some stop early and some do not: {stopped_after:?}"
    );
    let count = seeds as f64;
    let mean = means.iter().sum::<f64>() / count;
    let squares: f64 = means.iter().map(|one| (one - mean) * (one - mean)).sum();
    let deviation = (squares / (count - 1.0) / count).sqrt();
    let expected = true_mean();
    let z = (mean - expected) / deviation;
    assert!(z.abs() < 4.0, "{mean}, not {expected}: z = {z:.2}");
    // A bias of 2 % would be seen.
    assert!(deviation < expected * 0.005, "{deviation}");
}

/// A pixel stops by the samples of others, so that one alone does not stop.
#[test]
fn tiles_of_one_pixel_get_all_samples_and_of_two_may_stop() {
    let tracer = Tracer::new(Arc::new(tube()), &Options::default()).expect("built");
    let samples = |width, seed| {
        let settings = Settings {
            film: scene::Film { width, height: 1 },
            spp: 64,
            integrator: Integrator::Ao,
            seed,
            target: until(0.6),
            ..Settings::of(tracer.scene())
        };
        let reached = picture(&tracer, &settings, 1).reached;
        reached.expect("a target").samples
    };
    assert!((0..20).all(|seed| samples(1, seed) == 64));
    let of_two: Vec<_> = (0..20).map(|seed| samples(2, seed)).collect();
    assert!(of_two.iter().any(|&count| count < 64), "{of_two:?}");
    // With both in one half, neither would stop.
    assert!(of_two.iter().all(|&count| count < 128), "{of_two:?}");
}

#[test]
fn picture_does_not_depend_on_threads() {
    let scenes = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenes");
    let scene = Arc::new(load(&scenes.join("lattice.toml")).expect("a scene"));
    let tracer = Tracer::new(Arc::clone(&scene), &Options::default()).expect("built");
    let settings = Settings {
        film: scene::Film {
            width: 57,
            height: 41,
        },
        spp: 256,
        target: until(0.15),
        ..Settings::of(&scene)
    };
    let one = picture(&tracer, &settings, 1);
    for threads in [2, 7] {
        let other = picture(&tracer, &settings, threads);
        assert!(other.film == one.film, "{threads} threads");
        assert_eq!((other.reached, other.rays), (one.reached, one.rays));
    }
    let samples = one.reached.expect("a target").samples / (57 * 41);
    assert!((8..128).contains(&samples), "{samples} samples a pixel");
    // Half of a tile's pixels may be sampled on, to decide for the others, but not for long.
    let (taken, kept) = (one.rays.camera, one.reached.expect("a target").samples);
    assert!(
        taken >= kept && taken * 50 < kept * 51,
        "{taken} for {kept}"
    );

    // The error of each tile, from a picture of an independent one with 16 times the samples.
    let settings = Settings {
        spp: 8192,
        seed: 1,
        target: until(0.15 / 4.0),
        ..settings
    };
    let reference = picture(&tracer, &settings, 2);
    let tiles = (0..3).flat_map(|row| (0..4).map(move |column| (16 * column, 16 * row)));
    let errors = tiles.map(|(left, top)| {
        let rows = top..(top + 16).min(41);
        let pixels = rows.flat_map(|y| (left..(left + 16).min(57)).map(move |x| y * 57 + x));
        let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
        for place in pixels {
            let [made, wanted] = [&one, &reference].map(|one| one.film.pixels()[place]);
            for (made, wanted) in made.into_iter().zip(wanted) {
                sum += f64::from(wanted);
                let apart = f64::from(made - wanted);
                squares += apart * apart;
                count += 1.0;
            }
        }
        (squares / count).sqrt() / (sum / count)
    });
    let errors: Vec<f64> = errors.collect();
    let kept = errors.iter().filter(|&&error| error <= 0.15).count();
    assert!(kept >= 11, "{errors:?}");
    assert!(
        errors.iter().any(|&error| error > 0.075),
        "not far more than the target: {errors:?}"
    );
}
