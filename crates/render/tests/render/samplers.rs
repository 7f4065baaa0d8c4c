//! Both samplers show the same picture.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::{Integrator, Sampler, Scene};
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_render::{Settings, Target, render};
use glam::DVec3;

use super::stage;
use super::until_error::tube;

/// Pictures of each sampler, of different seeds.
const PICTURES: u64 = 48;

/// The mean of the pictures' means, and its variance.
fn mean(tracer: &Tracer, settings: &Settings) -> (DVec3, DVec3) {
    let pool = workers(None).expect("threads");
    let means = (0..PICTURES).map(|seed| {
        let settings = Settings {
            seed,
            ..settings.clone()
        };
        let never = AtomicBool::new(false);
        let picture = render(tracer, &settings, &pool, &|_| {}, &never);
        stage::mean(&picture.expect("rendered").film)
    });
    let means: Vec<DVec3> = means.collect();
    let count = PICTURES as f64;
    let mean = means.iter().sum::<DVec3>() / count;
    let squares: DVec3 = means.iter().map(|one| (*one - mean) * (*one - mean)).sum();
    (mean, squares / (count - 1.0) / count)
}

/// Welch's statistic with some 90 degrees of freedom, for 4 integrators, with and without a target,
/// and 3 colors: 4.5 happens by chance in 5 of 10 000 runs of all 24.
#[test]
fn means_of_both_samplers_agree() {
    let scene = Scene {
        film: cyltrace::scene::Film {
            width: 7,
            height: 6,
        },
        ..tube()
    };
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let mut noise = [[0.0; 2]; 4];
    for (number, integrator) in Integrator::ALL.into_iter().enumerate() {
        for error in [None, Some(0.2)] {
            let settings = Settings {
                spp: if error.is_some() { 256 } else { 16 },
                integrator,
                target: error.map(|error| Target { error, time: None }),
                ..Settings::of(tracer.scene())
            };
            let [sobol, random] = Sampler::ALL.map(|sampler| {
                let settings = Settings {
                    sampler,
                    ..settings.clone()
                };
                mean(&tracer, &settings)
            });
            let deviation = (sobol.1 + random.1).max(DVec3::splat(1e-14));
            let apart = (sobol.0 - random.0).abs() / deviation.map(f64::sqrt);
            assert!(
                apart.max_element() < 4.5,
                "{integrator:?}, {error:?}: {apart} deviations of {sobol:?} and {random:?}"
            );
            if error.is_none() {
                noise[number] = [sobol, random].map(|(_, variance)| variance.element_sum());
            }
        }
    }
    // Samples that are spread evenly have less noise, with ambient occlusion and light of the sky:
    // their error falls as the power 0.67 or so (docs/performance.md), not as the root, and so the
    // variance of 16 samples is 16^(1 - 2 * 0.67) = 0.4 of that of random ones.
    for (number, integrator) in Integrator::ALL.into_iter().enumerate() {
        let [sobol, random] = noise[number];
        let is_noisy = matches!(integrator, Integrator::Ao | Integrator::Sun);
        assert!(
            !is_noisy || sobol < 0.7 * random,
            "{integrator:?}: {sobol}, {random}"
        );
    }
}
