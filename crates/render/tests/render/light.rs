//! Light on surfaces for which the answer is known in closed form.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::{Integrator, Sky, Sun};
use cyltrace::solid::Caps;
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_render::{RenderError, Settings, render};
use glam::DVec3;

use super::stage::*;

#[test]
fn open_ground_under_a_sky_reflects_the_whole_sky() {
    let mut scene = scene(&[GROUND]);
    scene.sky = Some(Sky {
        color: DVec3::new(1.0, 0.5, 0.25),
        strength: 2.0,
    });
    assert_all_pixels(&picture(scene, 4), DVec3::new(1.0, 0.25, 0.5));
}

#[test]
fn ground_under_a_slanting_sun_follows_lambert() {
    let mut scene = scene(&[GROUND]);
    scene.sun = Some(Sun {
        direction: DVec3::new(0.6, 0.0, 0.8),
        color: DVec3::ONE,
        strength: std::f64::consts::PI,
        angle_degrees: 0.0,
    });
    assert_all_pixels(&picture(scene, 4), DVec3::new(0.5, 0.25, 1.0) * 0.8);
}

#[test]
fn ground_in_the_shadow_of_a_disk_is_black() {
    let roof = (
        DVec3::new(40.0, 0.0, 40.0),
        DVec3::new(40.0, 0.0, 41.0),
        5.0,
        Caps::Both,
    );
    let mut scene = scene(&[GROUND, roof]);
    scene.sun = Some(Sun {
        direction: DVec3::new(1.0, 0.0, 1.0).normalize(),
        color: DVec3::ONE,
        strength: 3.0,
        angle_degrees: 0.0,
    });
    assert_all_pixels(&picture(scene, 4), DVec3::ZERO);
}

#[test]
fn ground_below_a_wide_disk_sees_the_sky_beside_it() {
    // A disk of radius R at height h covers R²/(R² + h²) of the sky as a
    // diffuse surface below its middle sees it. Seen from a camera under it.
    let (radius, height) = (60.0, 60.0);
    let roof = (
        DVec3::new(0.0, 0.0, height),
        DVec3::new(0.0, 0.0, height + 1e-3),
        radius,
        Caps::Both,
    );
    let mut scene = scene(&[GROUND, roof]);
    scene.render.integrator = Integrator::Ao;
    let seen = mean(&picture(scene, 256)).x;
    // 147 456 samples of variance 1/4: the deviation of plain sampling, which
    // stratified sampling does not exceed, is 0.0013; pixels up to 1.4 off the
    // middle differ by less than 0.0003.
    assert!((seen - 0.5).abs() < 0.006, "{seen}");
}

#[test]
fn inside_of_an_open_tube_is_lit_on_the_side_that_is_seen() {
    // The camera looks down into a tube wider than the picture at its lower
    // cap, which the sun above lights through the open end.
    let tube = (DVec3::new(0.0, 0.0, -3.0), DVec3::ZERO, 2.0, Caps::P0);
    let mut scene = scene(&[tube]);
    scene.sun = Some(Sun {
        direction: DVec3::Z,
        color: DVec3::ONE,
        strength: std::f64::consts::PI,
        angle_degrees: 0.0,
    });
    assert_all_pixels(&picture(scene, 4), DVec3::new(0.5, 0.25, 1.0));
}

#[test]
fn empty_view_shows_sky_or_background_by_integrator() {
    let beside = (
        DVec3::new(30.0, 0.0, 0.0),
        DVec3::new(31.0, 0.0, 0.0),
        1.0,
        Caps::Both,
    );
    let without_light = scene(&[beside]);
    assert_all_pixels(
        &picture(without_light.clone(), 1),
        DVec3::new(0.0, 0.5, 0.25),
    );
    let mut with_sky = without_light.clone();
    with_sky.sky = Some(Sky {
        color: DVec3::new(0.25, 0.5, 1.0),
        strength: 0.5,
    });
    assert_all_pixels(&picture(with_sky, 1), DVec3::new(0.125, 0.25, 0.5));
    let mut ao = without_light.clone();
    ao.render.integrator = Integrator::Ao;
    assert_all_pixels(&picture(ao, 1), DVec3::ONE);
    let mut normal = without_light;
    normal.render.integrator = Integrator::Normal;
    assert_all_pixels(&picture(normal, 1), DVec3::ZERO);
}

#[test]
fn normal_of_the_ground_is_its_colour() {
    let mut scene = scene(&[GROUND]);
    scene.render.integrator = Integrator::Normal;
    assert_all_pixels(&picture(scene, 1), DVec3::new(0.5, 0.5, 1.0));
}

#[test]
fn cancelled_or_impossible_rendering_is_an_error() {
    let tracer = Tracer::new(Arc::new(scene(&[GROUND])), &Options::default()).expect("built");
    let pool = workers(None).expect("threads");
    let settings = Settings::of(tracer.scene());
    let result = |settings: &Settings, cancelled| {
        let cancelled = AtomicBool::new(cancelled);
        render(&tracer, settings, &pool, &|_| (), &cancelled).map(|picture| picture.film.width())
    };
    assert_eq!(result(&settings, true), Err(RenderError::Cancelled));
    assert_eq!(result(&settings, false), Ok(SIZE));
    let mut too_large = settings.clone();
    too_large.film.width = u32::MAX;
    assert!(matches!(
        result(&too_large, false),
        Err(RenderError::Size { .. })
    ));
    let no_samples = Settings { spp: 0, ..settings };
    assert_eq!(result(&no_samples, false), Err(RenderError::NoSamples));
}
