//! Pictures through a lens.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::{
    Camera, Film, Frame, Integrator, Lens, MaterialIndex, Projection, Prototype, Scene, SolidRecord,
};
use cyltrace::solid::{AnySolid, Sphere};
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_render::{Settings, render};
use glam::{DVec2, DVec3};

const SIDE: u32 = 64;

/// The camera is at the origin and looks along x; half of the picture is 1 wide at the distance 1.
fn picture(ball: DVec3, radius: f64, lens: Option<Lens>) -> cyltrace_output::Film {
    let mut root = Prototype::default();
    let solid: AnySolid = Sphere::new(ball, radius).expect("a sphere").into();
    let record = SolidRecord::new(solid, 0, MaterialIndex(0));
    root.solids.push(record).expect("pushed");
    let mut scene = Scene::new(vec![root]);
    scene.camera = Camera {
        projection: Projection::Perspective { fov_degrees: 90.0 },
        frame: Frame::LookAt {
            position: DVec3::ZERO,
            look_at: DVec3::X,
            up: DVec3::Z,
        },
        lens,
    };
    scene.film = Film {
        width: SIDE,
        height: SIDE,
    };
    scene.render.integrator = Integrator::Normal;
    scene.render.spp = 256;
    let settings = Settings::of(&scene);
    let options = Options {
        view: settings.view(&scene),
        ..Options::default()
    };
    let tracer = Tracer::new(Arc::new(scene), &options).expect("built");
    let pool = workers(None).expect("threads");
    let picture = render(&tracer, &settings, &pool, &|_| {}, &AtomicBool::new(false));
    picture.expect("rendered").film
}

/// The picture of a small ball beside the sharp plane is a disk, evenly covered in angle and with
/// the radius of the thin-lens formula: `R |1/z - 1/f|` at the distance 1.
#[test]
fn small_ball_beside_the_sharp_plane_is_a_disk() {
    let (depth, focus, aperture) = (3.0, 1.0, 0.6);
    let lens = Lens {
        aperture,
        focus: Some(focus),
    };
    let film = picture(DVec3::new(depth, 0.0, 0.0), 0.05, Some(lens));
    let pixels = f64::from(SIDE) / 2.0;
    let expected = 0.5 * aperture * (1.0 / depth - 1.0 / focus).abs() * pixels;
    let (mut weight, mut square, mut farthest) = (0.0, 0.0, 0.0_f64);
    for (index, pixel) in film.pixels().iter().enumerate() {
        let index = index as u32;
        let center = DVec2::new(f64::from(index % SIDE), f64::from(index / SIDE)) + 0.5;
        let distance = center.distance(DVec2::splat(pixels));
        let seen = f64::from(pixel.iter().sum::<f32>());
        weight += seen;
        square += seen * distance * distance;
        if seen > 0.0 {
            farthest = farthest.max(distance);
        }
    }
    // A uniform disk has the mean square distance r²/2. The ball adds its own size, 0.5 pixels.
    let radius = (2.0 * square / weight).sqrt();
    assert!(
        (radius - expected).abs() < 0.05 * expected,
        "{radius}, {expected}"
    );
    assert!(farthest < expected + 1.5, "{farthest}, {expected}");
}

/// A lens as good as closed gives the picture without one, up to its other random numbers: none are
/// drawn without a lens, so that the place in the pixel is the same.
#[test]
fn tiny_lens_shows_what_a_pinhole_shows() {
    let ball = DVec3::new(3.0, 0.5, 0.25);
    let lens = Lens {
        aperture: 1e-12,
        focus: None,
    };
    let [pinhole, tiny] = [None, Some(lens)].map(|lens| picture(ball, 0.7, lens));
    for (one, other) in pinhole.pixels().iter().zip(tiny.pixels()) {
        for (one, other) in one.iter().zip(other) {
            assert!((one - other).abs() < 1e-5, "{one} {other}");
        }
    }
}
