//! A square seen from straight above, and the light that comes from it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use cyltrace::scene::{
    self, Background, Camera, CylinderRecord, Frame, Material, MaterialIndex, Projection,
    Prototype, Scene, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_output::Film;
use cyltrace_render::{Settings, render};
use glam::DVec3;

pub const SIZE: u32 = 24;

/// Cylinders of reflectance (0.5, 0.25, 1), seen from straight above in a
/// square of 2 x 2 about the z axis.
pub fn scene(cylinders: &[(DVec3, DVec3, f64, Caps)]) -> Scene {
    let records = (0..)
        .zip(cylinders)
        .map(|(primitive, &(p0, p1, radius, caps))| {
            let cylinder = Cylinder::new(p0, p1, radius, caps).expect("a cylinder");
            CylinderRecord::new(&cylinder, primitive, MaterialIndex(0))
        });
    let root = Prototype {
        solids: Solids::of_cylinders(records),
        ..Prototype::default()
    };
    Scene {
        materials: vec![Material::diffuse("", DVec3::new(0.5, 0.25, 1.0))],
        camera: Camera {
            projection: Projection::Orthographic { height: Some(2.0) },
            frame: Frame::LookAt {
                position: DVec3::new(0.0, 0.0, 50.0),
                look_at: DVec3::ZERO,
                up: DVec3::Y,
            },
            lens: None,
        },
        film: scene::Film {
            width: SIZE,
            height: SIZE,
        },
        background: Background::Color(DVec3::new(0.0, 0.5, 0.25)),
        ..Scene::new(vec![root])
    }
}

/// A disk of radius 100 whose top is at z = 0: a plane, from near.
pub const GROUND: (DVec3, DVec3, f64, Caps) =
    (DVec3::new(0.0, 0.0, -1.0), DVec3::ZERO, 100.0, Caps::Both);

/// The picture of any scene.
pub fn film_of(scene: Scene, spp: u32) -> Film {
    rendered(scene, spp).0
}

pub fn picture(scene: Scene, spp: u32) -> Film {
    let (film, done) = rendered(scene, spp);
    assert_eq!(done, u64::from(SIZE * SIZE), "all pixels reported");
    film
}

/// The picture, and the number of pixels that were reported.
fn rendered(scene: Scene, spp: u32) -> (Film, u64) {
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let settings = Settings {
        spp,
        ..Settings::of(tracer.scene())
    };
    let pool = workers(None).expect("threads");
    let done = AtomicU64::new(0);
    let count = |pixels| {
        done.fetch_add(pixels, Ordering::Relaxed);
    };
    let picture = render(&tracer, &settings, &pool, &count, &AtomicBool::new(false));
    (picture.expect("rendered").film, done.into_inner())
}

pub fn mean(film: &Film) -> DVec3 {
    let sum: DVec3 = film
        .pixels()
        .iter()
        .map(|p| DVec3::from(p.map(f64::from)))
        .sum();
    sum / film.pixels().len() as f64
}

pub fn assert_all_pixels(film: &Film, expected: DVec3) {
    for (number, pixel) in film.pixels().iter().enumerate() {
        let apart = (DVec3::from(pixel.map(f64::from)) - expected)
            .abs()
            .max_element();
        assert!(apart < 1e-6, "pixel {number}: {pixel:?}, not {expected}");
    }
}
