//! The scale bar is as long as the camera shows its length, and axes point where it sees them.

use std::sync::Arc;

use cyltrace::math::Random;
use cyltrace::scene::{
    self, AimedCamera, Axes, Camera, Corner, Frame, Inset, Projection, ScaleBar, Scene,
};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_output::{Band, with_overlays};
use cyltrace_render::{Settings, insets};
use glam::DVec3;

use super::stage;

fn inset(corner: Corner) -> Inset {
    Inset {
        corner,
        size: 0.03,
        color: DVec3::ZERO,
        background: DVec3::ONE,
        opacity: 1.0,
    }
}

/// The length of the bar over a gray picture, in pixels.
fn drawn_length(scene: &Scene) -> f64 {
    let tracer = Tracer::new(Arc::new(scene.clone()), &Options::default()).expect("built");
    let settings = Settings::of(scene);
    let insets = insets(&tracer, &settings).expect("room");
    let (width, height) = (scene.film.width, scene.film.height);
    let mut bands = with_overlays(
        insets.overlays((width, height)),
        width,
        false,
        |band: &mut Band| {
            band.colors = vec![[2.0; 3]; (width * height) as usize];
            Ok(())
        },
    );
    let mut band = Band::default();
    bands(&mut band).expect("a band");
    let rows = band.colors.chunks(width as usize);
    let dark = rows.map(|row| {
        let ink = row.iter().filter(|pixel| pixel[0] <= 1.0);
        ink.map(|pixel| f64::from(1.0 - pixel[0])).sum()
    });
    dark.fold(0.0, f64::max)
}

#[test]
fn scale_bars_are_as_long_as_the_camera_shows_their_length() {
    let mut random = Random::new(71, 0);
    for case in 0..12 {
        let scale = 1 + case / 6;
        let projection = match case % 3 {
            0 => Projection::Orthographic { height: Some(3.0) },
            1 => Projection::Orthographic { height: None },
            _ => Projection::Perspective { fov_degrees: 35.0 },
        };
        let position = random.direction() * 6.0;
        let look_at = random.direction();
        let frame = Frame::LookAt {
            position,
            look_at,
            up: random.direction(),
        };
        let mut scene = stage::scene(&[stage::GROUND]);
        scene.camera = Camera {
            projection,
            frame,
            lens: None,
        };
        scene.film = scene::Film {
            width: 360 * scale,
            height: 240 * scale,
        };
        let bounds = Tracer::new(Arc::new(scene.clone()), &Options::default());
        let bounds = bounds.expect("built").bounds();
        let camera = AimedCamera::new(&scene.camera, &bounds, scene.film);
        let length = match projection {
            Projection::Orthographic { height: None } => 40.0,
            _ => 0.7,
        };
        scene.illustration.scale_bar = Some(ScaleBar {
            length: Some(length),
            unit: String::new(),
            inset: inset(Corner::TopLeft),
        });
        // Two points across the view, a length apart.
        let across = (look_at - position).cross(random.direction()).normalize();
        let ends = [-0.5, 0.5].map(|side| look_at + across * (side * length));
        let [one, other] = ends.map(|end| camera.project(end).expect("before the eye"));
        let (expected, drawn) = (one.distance(other), drawn_length(&scene));
        assert!(
            (drawn - expected).abs() < 0.01,
            "case {case}: {drawn}, {expected}"
        );
    }
}

#[test]
fn axes_are_the_unit_vectors_in_camera_coordinates() {
    let mut scene = stage::scene(&[stage::GROUND]);
    scene.illustration.axes = Some(Axes {
        labels: true,
        inset: inset(Corner::TopRight),
    });
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let of = |turn_degrees| {
        let settings = Settings {
            turn_degrees,
            ..Settings::of(tracer.scene())
        };
        let insets = insets(&tracer, &settings).expect("drawn");
        insets.axes.expect("axes").directions
    };
    // From above, with y upward: x to the right, and z to the viewer.
    assert_eq!(
        of(0.0),
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]
    );
    // The camera turned about y to the side of the positive x axis.
    assert_eq!(
        of(90.0),
        [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
    );
}
