//! Outlines have the places and widths of closed forms, and surfaces fade by their distance.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::math::Orientation;
use cyltrace::scene::{
    self, Background, Camera, DepthCue, Frame, Integrator, Light, LightShape, MaterialIndex,
    Outlines, Projection, Prototype, Scene, SolidRecord, Solids,
};
use cyltrace::solid::{AnySolid, Cuboid, Sphere};
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_render::{Channels, Picture, Settings, Target, Tiles, Watch, render, render_tiles};
use glam::DVec3;

/// Light of which surfaces and background are half, so that black lines are what is less.
const GRAY: f64 = 0.5;

/// Solids seen from above, in a square of 2 x 2, under a white sky.
fn scene(solids: &[AnySolid], side: u32) -> Scene {
    let mut all = Solids::default();
    for (number, solid) in (0..).zip(solids) {
        let record = SolidRecord::new(*solid, number, MaterialIndex(0));
        all.push(record).expect("a solid");
    }
    let root = Prototype {
        solids: all,
        ..Prototype::default()
    };
    Scene {
        camera: Camera {
            projection: Projection::Orthographic { height: Some(2.0) },
            frame: Frame::LookAt {
                position: DVec3::new(0.0, 0.0, 5.0),
                look_at: DVec3::ZERO,
                up: DVec3::Y,
            },
            lens: None,
        },
        film: scene::Film {
            width: side,
            height: side,
        },
        background: Background::Color(DVec3::splat(GRAY)),
        ..Scene::new(vec![root])
    }
}

pub fn outlines(width: f64) -> Outlines {
    Outlines {
        width,
        color: DVec3::X,
        crease_degrees: 30.0,
        between_solids: true,
    }
}

pub fn rendered(scene: Scene, change: impl Fn(&mut Settings)) -> Picture {
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let mut settings = Settings::of(tracer.scene());
    settings.spp = 1;
    settings.integrator = Integrator::Ao;
    change(&mut settings);
    let pool = workers(None).expect("threads");
    let picture = render(&tracer, &settings, &pool, &|_| (), &AtomicBool::new(false));
    picture.expect("rendered")
}

/// The parts of the pixels that lines cover, from red lines over what has no noise.
fn cover(scene: &Scene, width: f64) -> Vec<f64> {
    let mut with = scene.clone();
    with.illustration.outlines = Some(outlines(width));
    let (with, without) = (rendered(with, |_| ()), rendered(scene.clone(), |_| ()));
    let pixels = with.film.pixels().iter().zip(without.film.pixels());
    let parts = pixels.map(|(with, without)| match without[1] {
        // A dark sample: the red of the line shows.
        0.0 => f64::from(with[0]),
        below => 1.0 - f64::from(with[1] / below),
    });
    parts.collect()
}

fn cuboid(low: DVec3, high: DVec3) -> AnySolid {
    let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
    let solid = Cuboid::new(center, half, Orientation::IDENTITY);
    solid.expect("a box").into()
}

fn sphere(center: DVec3, radius: f64) -> AnySolid {
    Sphere::new(center, radius).expect("a sphere").into()
}

/// A place of the grid is a quarter of a pixel, and the middle between two places is within half
/// of that of the circle. So the line is within `width/2 + 1/4` of the circle, covers all up to
/// `width/2 - 1/4 - 1/8` of it, and has the area of the ring to within that of a ring of a
/// quarter of a pixel.
#[test]
fn outline_of_a_sphere_is_a_ring() {
    for (side, width) in [(64_u32, 1.0), (128, 2.0), (128, 1.0), (64, 3.5), (64, 0.3)] {
        let scene = scene(&[sphere(DVec3::new(0.01, 0.02, 0.0), 0.7)], side);
        let cover = cover(&scene, width);
        let per_unit = f64::from(side) / 2.0;
        let radius = 0.7 * per_unit;
        let middle = [1.01 * per_unit, 0.98 * per_unit];
        let mut area = 0.0;
        for (pixel, part) in cover.iter().enumerate() {
            let x = (pixel as u32 % side) as f64 + 0.5 - middle[0];
            let y = (pixel as u32 / side) as f64 + 0.5 - middle[1];
            let beside = (libm::hypot(x, y) - radius).abs();
            let half_diagonal = 0.5_f64.sqrt();
            if beside > width.max(0.5) / 2.0 + 0.25 + half_diagonal {
                assert_eq!(*part, 0.0, "{side} {width} {x} {y}");
            }
            if beside < width / 2.0 - 0.375 - half_diagonal {
                assert!(*part > 1.0 - 1e-6, "{side} {width} {x} {y}: {part}");
            }
            area += part;
        }
        let ring = std::f64::consts::TAU * radius;
        let error = area / ring - width;
        assert!(
            error.abs() < 0.25 * width.min(1.0),
            "{side} {width}: {error}"
        );
    }
}

/// A box seen so that three faces show: lines along its edges, none on its faces.
#[test]
fn outlines_of_a_box_are_at_its_edges() {
    let solid = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let mut scene = scene(&[solid], 96);
    let position = DVec3::new(2.0, 1.2, 1.5);
    scene.camera.frame = Frame::LookAt {
        position,
        look_at: DVec3::ZERO,
        up: DVec3::Z,
    };
    let camera = cyltrace::scene::AimedCamera::stated(&scene.camera, scene.film).expect("stated");
    let project = |corner: DVec3| camera.project(corner).expect("in view");
    // The nine edges of the three faces that face the viewer.
    let mut edges = Vec::new();
    for axis in 0..3 {
        for (one, two) in [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5)] {
            let (mut from, mut to) = (DVec3::ZERO, DVec3::ZERO);
            (from[axis], to[axis]) = (-0.5, 0.5);
            for corner in [&mut from, &mut to] {
                (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (one, two);
            }
            edges.push([project(from), project(to)]);
        }
    }
    let cover = cover(&scene, 1.0);
    for (pixel, part) in cover.iter().enumerate() {
        let place = glam::DVec2::new((pixel % 96) as f64 + 0.5, (pixel / 96) as f64 + 0.5);
        let distance = |[from, to]: &[glam::DVec2; 2]| {
            let along = *to - *from;
            let share = (place - *from).dot(along) / along.length_squared();
            place.distance(*from + along * share.clamp(0.0, 1.0))
        };
        let nearest = edges.iter().map(distance).fold(f64::INFINITY, f64::min);
        if nearest > 0.75 + 0.5_f64.sqrt() {
            assert_eq!(*part, 0.0, "{place} is on a face");
        }
        if nearest < 0.2 {
            assert!(*part > 0.4, "{place} is on an edge: {part}");
        }
    }
}

/// A plane that fills the picture has no line, at any angle.
#[test]
fn flat_faces_have_no_outlines() {
    let low = DVec3::new(-1e3, -1e3, -1.0);
    let solid = cuboid(low, DVec3::new(1e3, 1e3, 0.0));
    for tilt in [0.0, 1.0, 80.0] {
        let mut scene = scene(&[solid], 32);
        scene.camera.frame = Frame::LookAt {
            position: DVec3::new(tilt, 0.3 * tilt, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
        };
        assert!(cover(&scene, 2.0).iter().all(|part| *part == 0.0), "{tilt}");
    }
}

/// Two steps with the same normals, and a jump of depth between them.
#[test]
fn jumps_of_depth_on_one_solid_have_a_line_and_smooth_joints_only_between_solids() {
    // Two boxes beside each other whose tops are one plane.
    let left = cuboid(DVec3::new(-9.0, -9.0, -1.0), DVec3::new(0.0, 9.0, 0.0));
    let right = cuboid(DVec3::new(0.0, -9.0, -1.0), DVec3::new(9.0, 9.0, 0.0));
    let mut joined = scene(&[left, right], 32);
    let line = |scene: &Scene, between_solids| {
        let mut scene = scene.clone();
        scene.illustration.outlines = Some(Outlines {
            between_solids,
            ..outlines(1.0)
        });
        let picture = rendered(scene, |_| ());
        // An open plane under a sky is white.
        let ink = picture
            .film
            .pixels()
            .iter()
            .map(|pixel| f64::from(1.0 - pixel[1]));
        ink.sum::<f64>() / 32.0
    };
    assert!((line(&joined, true) - 1.0).abs() < 1e-6);
    assert_eq!(line(&joined, false), 0.0);
    // The right one is lower.
    let right = cuboid(DVec3::new(0.0, -9.0, -1.0), DVec3::new(9.0, 9.0, -0.1));
    joined = scene(&[left, right], 32);
    let mut plain = joined.clone();
    plain.illustration.outlines = None;
    let shadow = rendered(plain, |_| ());
    let shadow = shadow
        .film
        .pixels()
        .iter()
        .map(|pixel| f64::from(1.0 - pixel[1]));
    let shadow = shadow.sum::<f64>() / 32.0;
    // The line covers half a pixel beside the step with its half of 1 pixel, and the shadow there is
    // less than a pixel of the darkest.
    let line = line(&joined, false);
    assert!(line > 0.9 && line - shadow > 0.2, "{line} {shadow}");
}

/// The picture does not depend on the tiles that are rendered together, nor on `--error`, and
/// opacity is at least the cover.
#[test]
fn outlines_are_the_same_in_parts_and_cover_what_is_transparent() {
    let mut scene = scene(&[sphere(DVec3::ZERO, 0.7)], 50);
    scene.illustration.outlines = Some(outlines(5.0));
    scene.background = Background::Transparent;
    let opaque = |settings: &mut Settings| settings.channels = Channels::new([], true);
    let whole = rendered(scene.clone(), opaque);
    let adaptive = rendered(scene.clone(), |settings| {
        opaque(settings);
        settings.spp = 2;
        settings.target = Some(Target {
            error: 1.0,
            time: None,
        });
    });
    let pixels = whole.film.pixels().iter().zip(&whole.words);
    let pixels = pixels.zip(adaptive.film.pixels().iter().zip(&adaptive.words));
    for (number, ((color, word), (_, other))) in pixels.enumerate() {
        let (x, y) = ((number % 50) as f64 - 24.5, (number / 50) as f64 - 24.5);
        let beside = libm::hypot(x, y) - 17.5;
        let [opacity, of_adaptive] = [*word, *other].map(f32::from_bits);
        if beside.abs() < 1.4 {
            assert_eq!((opacity, of_adaptive), (1.0, 1.0), "{x} {y}");
            assert_eq!(*color, [1.0, 0.0, 0.0], "{x} {y}");
        }
        if beside > 3.5 {
            assert_eq!((opacity, of_adaptive), (0.0, 0.0), "{x} {y}");
        }
    }
    // 16 tiles of at most 16 x 16 pixels with a margin of 3 pixels, 16 rays each, and the samples.
    let sides = [22_u64, 22, 22, 8];
    let all: u64 = sides.iter().flat_map(|x| sides.map(|y| x * y)).sum();
    assert_eq!(whole.rays.camera, all * 16 + 2500);
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let mut settings = Settings::of(tracer.scene());
    (settings.spp, settings.integrator) = (1, Integrator::Ao);
    let pool = workers(None).expect("threads");
    let (count, mut parts) = (Tiles::of(settings.film).count(), Vec::new());
    for tile in 0..count {
        let never = AtomicBool::new(false);
        let watch = Watch {
            progress: &|_| (),
            cancelled: &never,
            kept: None,
        };
        let tile = render_tiles(&tracer, &settings, tile..tile + 1, &pool, &watch);
        parts.extend(tile.expect("rendered").pixels);
    }
    let mut arranged = Vec::new();
    Tiles::of(settings.film).arrange(0, 1, &parts, &mut arranged);
    assert!(arranged == whole.film.pixels());
}

/// Boxes whose tops are at known depths, of a color that is known.
#[test]
fn surfaces_fade_by_their_depth() {
    // Tops at the depths 4, 5 and 6 of a camera at z = 5.
    let tops = [1.0, 0.0, -1.0];
    let fade = DVec3::new(0.25, 0.5, 1.0);
    let cue = DepthCue {
        color: Some(fade),
        start: Some(4.5),
        end: Some(5.5),
        strength: 0.6,
    };
    for top in tops {
        let low = DVec3::new(-9.0, -9.0, -2.0);
        let solid = cuboid(low, DVec3::new(9.0, 9.0, top));
        for integrator in [Integrator::Ao, Integrator::Sun, Integrator::Path] {
            for perspective in [false, true] {
                let mut scene = scene(&[solid], 16);
                if perspective {
                    scene.camera.projection = Projection::Perspective { fov_degrees: 50.0 };
                }
                let choose = |settings: &mut Settings| settings.integrator = integrator;
                let plain = rendered(scene.clone(), choose);
                scene.illustration.depth_cue = Some(cue);
                let faded = rendered(scene, choose);
                let depth = 5.0 - top;
                let share = 0.6 * (depth - 4.5_f64).clamp(0.0, 1.0);
                for (plain, faded) in plain.film.pixels().iter().zip(faded.film.pixels()) {
                    let plain = DVec3::from(plain.map(f64::from));
                    let expected = plain * (1.0 - share) + fade * share;
                    let faded = DVec3::from(faded.map(f64::from));
                    assert!((faded - expected).length() < 1e-6, "{integrator:?} {top}");
                }
            }
        }
    }
}

/// The box of the sphere is from the depth 4.5 to 5.5, and rays that miss show the background as
/// it is.
#[test]
fn depth_cues_without_keys_fade_to_the_background_over_the_box() {
    let sun = |scene: &Scene| {
        let picture = rendered(scene.clone(), |settings| {
            settings.integrator = Integrator::Sun;
        });
        picture.film.pixels().to_vec()
    };
    let mut scene = scene(&[sphere(DVec3::ZERO, 0.5)], 32);
    // All pixels show the nearest point of the sphere.
    let near = Projection::Orthographic {
        height: Some(0.002),
    };
    scene.camera.projection = near;
    let plain = sun(&scene);
    for (start, share) in [(Some(0.0), 4.5 / 5.5), (None, 0.0)] {
        scene.illustration.depth_cue = Some(DepthCue {
            color: None,
            start,
            end: None,
            strength: 1.0,
        });
        scene.camera.projection = near;
        for (plain, faded) in plain.iter().zip(sun(&scene)) {
            let expected = f64::from(plain[0]) * (1.0 - share) + GRAY * share;
            assert!((f64::from(faded[0]) - expected).abs() < 1e-5, "{start:?}");
        }
        scene.camera.projection = Projection::Orthographic { height: Some(2.0) };
        assert_eq!(sun(&scene)[0], [0.5; 3]);
    }
}

/// What a light with a place hides has no line and does not fade it: the light fills the picture.
#[test]
fn lights_hide_lines_and_do_not_fade() {
    let solid = cuboid(DVec3::splat(-0.5), DVec3::new(0.5, 0.5, 0.0));
    let mut scene = scene(&[solid], 16);
    scene.lights = vec![Light {
        shape: LightShape::Sphere {
            center: DVec3::new(0.0, 0.0, 2.0),
            radius: 1.5,
        },
        color: DVec3::new(0.5, 0.75, 0.25),
        strength: 1.0,
    }];
    scene.illustration.outlines = Some(outlines(3.0));
    scene.illustration.depth_cue = Some(DepthCue {
        color: Some(DVec3::X),
        start: Some(0.0),
        end: Some(1.0),
        strength: 1.0,
    });
    let path = |settings: &mut Settings| settings.integrator = Integrator::Path;
    for pixel in rendered(scene, path).film.pixels() {
        assert_eq!(*pixel, [0.5, 0.75, 0.25]);
    }
}
