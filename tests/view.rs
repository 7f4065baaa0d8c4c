//! What is left out because a camera does not see it is hit by none of the
//! camera's rays.

mod support;

use std::sync::Arc;

use cyltrace::math::Random;
use cyltrace::scene::{AimedCamera, Camera, Film, Frame, Projection, Prototype, Scene};
use cyltrace::tracer::{Options, Tracer};
use glam::{DAffine3, DVec2, DVec3};
use support::{cylinders_in_a_box, placed, placing, scene_of};

const SEED: u64 = 71;
const PLACEMENTS: usize = 300;
const CAMERAS: u64 = 60;
const RAYS: u64 = 400;

/// Boxes of cylinders all about the origin.
fn boxes() -> Arc<Scene> {
    let mut random = Random::new(SEED, 0);
    let place = |_| {
        let offset = random.direction() * random.uniform(5.0, 40.0);
        let scale = DAffine3::from_scale(DVec3::splat(4.0));
        placed(1, DAffine3::from_translation(offset) * scale)
    };
    let root = placing((0..PLACEMENTS).map(place).collect());
    let cylinders = cylinders_in_a_box(SEED, 300).into();
    scene_of(vec![
        root,
        Prototype {
            cylinders,
            ..Default::default()
        },
    ])
}

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
    }
}

#[test]
fn rays_of_a_camera_hit_the_same_with_what_it_sees_alone() {
    let scene = boxes();
    let whole = Tracer::new(Arc::clone(&scene), &Options::default()).unwrap();
    let (mut hits, mut left_out) = (0, 0);
    for number in 0..CAMERAS {
        let random = &mut Random::new(SEED, 1 + number);
        let film = Film {
            width: 1 + random.below(300) as u32,
            height: 1 + random.below(300) as u32,
        };
        let camera = AimedCamera::stated(&camera(random), film).unwrap();
        let options = Options {
            view: Some(camera.view_volume()),
            ..Default::default()
        };
        let seen = Tracer::new(Arc::clone(&scene), &options).unwrap();
        let size = DVec2::new(f64::from(film.width), f64::from(film.height));
        for ray_number in 0..RAYS {
            // The picture's very edges are where a plane that is too near cuts.
            let mut along = || match random.below(4) {
                0 => random.below(2) as f64,
                _ => random.unit(),
            };
            let ray = camera.ray(DVec2::new(along(), along()) * size);
            let hit = whole.closest(&ray);
            hits += usize::from(hit.is_some());
            let case = format!("seed {SEED}, camera {number}, ray {ray_number}: {ray:?}");
            assert_eq!(seen.closest(&ray), hit, "{case}");
        }
        let skipped = seen.statistics().skipped;
        let sentence = skipped
            .iter()
            .find(|one| one.contains("out of the camera's view"));
        left_out += sentence.map_or(0, |sentence| {
            let count = sentence.split(' ').next().unwrap();
            count.parse::<usize>().expect("a count")
        });
    }
    let rays = (CAMERAS * RAYS) as usize;
    println!("{hits} hits of {rays} rays, {left_out} placements left out");
    assert!(hits * 20 > rays, "{hits} hits");
    // A view of less than half of the space leaves out more than half of it.
    assert!(left_out * 2 > PLACEMENTS * CAMERAS as usize, "{left_out}");
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
        assert!(AimedCamera::stated(&Camera { projection, frame }, film).is_none());
    }
}
