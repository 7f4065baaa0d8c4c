//! What a camera does not see is left out, and nothing that it sees.

use std::sync::Arc;

use cyltrace::math::{Bounds, Random, Ray};
use cyltrace::scene::{
    AimedCamera, Camera, CylinderRecord, Film, Frame, Lens, MaterialIndex, Projection, Prototype,
    Scene, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{Options, Tracer};
use glam::{DAffine3, DVec2, DVec3};
use test_support::{placed, placing, scene_of};

const SEED: u64 = 71;
const CAMERAS: u64 = 60;
/// Solids just inside a picture's edges, and as many just outside.
const SOLIDS: usize = 100;

fn camera(random: &mut Random) -> Camera {
    let position = random.direction() * random.uniform(0.0, 20.0);
    Camera {
        projection: match random.below(2) {
            0 => Projection::Perspective {
                fov_degrees: random.uniform(5.0, 120.0),
            },
            _ => Projection::Orthographic {
                height: Some(random.uniform(1.0, 30.0)),
            },
        },
        frame: Frame::LookAt {
            position,
            look_at: position + random.direction(),
            up: random.direction(),
        },
        lens: None,
    }
}

/// A place in the picture, as shares of its sides: anywhere along an edge, and
/// `inward` of it.
fn at_edge(random: &mut Random, inward: f64) -> DVec2 {
    let along = random.uniform(0.01, 0.99);
    let across = [inward, 1.0 - inward][random.below(2) as usize];
    match random.below(2) {
        0 => DVec2::new(along, across),
        _ => DVec2::new(across, along),
    }
}

/// Rays of a camera and a scene with a small cylinder on each: the first ones
/// are a thousandth of the picture within its edges, the others a hundredth
/// outside. The cylinders are a hundredth and less of that in size.
fn at_edges(random: &mut Random, camera: &AimedCamera, size: DVec2) -> (Vec<Ray>, Arc<Scene>) {
    let inward = (0..2 * SOLIDS).map(|number| if number < SOLIDS { 1e-3 } else { -1e-2 });
    let rays: Vec<Ray> = inward
        .map(|inward| camera.ray(at_edge(random, inward) * size))
        .collect();
    let place = |ray: &Ray| {
        let t = random.uniform(1.0, 10.0);
        let scale = DAffine3::from_scale(DVec3::splat(1e-5 * t));
        placed(1, DAffine3::from_translation(ray.at(t)) * scale)
    };
    let root = placing(rays.iter().map(place).collect());
    let cylinder = Cylinder::new(-DVec3::Z, DVec3::Z, 1.0, Caps::Both).unwrap();
    let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
    let solid = Prototype {
        solids: Solids::of_cylinders(vec![record]),
        ..Default::default()
    };
    (rays, scene_of(vec![root, solid]))
}

#[test]
fn solids_at_the_edges_of_a_picture_are_left_out_if_they_are_outside() {
    for number in 0..CAMERAS {
        let random = &mut Random::new(SEED, number);
        let film = Film {
            width: 100 + random.below(200) as u32,
            height: 100 + random.below(200) as u32,
        };
        let camera = AimedCamera::stated(&camera(random), film).unwrap();
        let size = DVec2::new(f64::from(film.width), f64::from(film.height));
        let (rays, scene) = at_edges(random, &camera, size);
        let options = Options {
            view: camera.view_volume(),
            ..Default::default()
        };
        let seen = Tracer::new(Arc::clone(&scene), &options).unwrap();
        let whole = Tracer::new(scene, &Options::default()).unwrap();
        for (ray_number, ray) in rays.iter().enumerate() {
            let case = format!("seed {SEED}, camera {number}, ray {ray_number}: {ray:?}");
            let hit = whole.closest(ray);
            assert!(hit.is_some(), "{case}");
            let expected = hit.filter(|_| ray_number < SOLIDS);
            assert_eq!(seen.closest(ray), expected, "{case}");
        }
        let sentence = format!("{SOLIDS} placements are out of the camera's view: not built");
        let skipped = seen.statistics().skipped;
        assert!(skipped.contains(&sentence), "camera {number}: {skipped:?}");
    }
}

/// Solids on any ray through a lens are kept.
#[test]
fn solids_on_rays_through_a_lens_are_seen() {
    for number in 0..CAMERAS {
        let random = &mut Random::new(SEED + 1, number);
        let film = Film {
            width: 200,
            height: 100,
        };
        let lens = Lens {
            aperture: random.log_uniform(1e-3, 20.0),
            focus: Some(random.log_uniform(0.5, 50.0)),
        };
        let description = Camera {
            lens: Some(lens),
            ..camera(random)
        };
        let camera = AimedCamera::stated(&description, film).unwrap();
        let view = camera.view_volume().expect("a part of space");
        for ray_number in 0..300 {
            let position = DVec2::new(random.uniform(0.0, 200.0), random.uniform(0.0, 100.0));
            // Points of the rim reach farthest.
            let ray = camera.ray_through_lens(position, (1.0, random.unit()));
            let point = ray.at(random.log_uniform(1e-6, 1e3));
            let case = format!("seed {}, camera {number}, ray {ray_number}", SEED + 1);
            assert!(view.may_reach(&Bounds::at(point)), "{case}: {ray:?}");
        }
        // What is far beside the view is left out all the same.
        let beside = camera.ray(DVec2::new(1e9, 50.0)).at(1.0);
        assert!(!view.may_reach(&Bounds::at(beside)), "camera {number}");
    }
}

#[test]
fn a_frame_that_fits_the_scene_states_no_view() {
    let film = Film {
        width: 4,
        height: 3,
    };
    let perspective = Projection::Perspective { fov_degrees: 40.0 };
    let fitted = Projection::Orthographic { height: None };
    let here = Frame::LookAt {
        position: DVec3::ZERO,
        look_at: DVec3::X,
        up: DVec3::Z,
    };
    for (projection, frame) in [(perspective, Frame::Auto), (fitted, here)] {
        assert!(
            AimedCamera::stated(
                &Camera {
                    projection,
                    frame,
                    lens: None
                },
                film
            )
            .is_none()
        );
    }
}
