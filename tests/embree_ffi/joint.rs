//! Scenes that several threads build together: once, rightly, with one answer
//! for all, and without a trace of Embree's floating-point mode.

use std::sync::Barrier;
use std::thread;

use cyltrace::embree::{
    Box32, Device, DeviceOptions, Error, JointCommit, Ray32, Reached, SceneBuilder, UserGeometry,
    with_flushed_denormals,
};

use crate::balls::{BallQuery, Balls, one_by_one, random_balls, random_query};
use crate::queries::{check_against_brute_force, flushes_denormals};

const THREADS: usize = 4;

fn joint(device: &Device, seed: u64, count: usize) -> JointCommit<BallQuery> {
    let mut builder = SceneBuilder::new(device).unwrap();
    builder
        .attach_user(Balls(random_balls(seed, count)))
        .unwrap();
    builder.into_joint()
}

fn device() -> Device {
    Device::new(&DeviceOptions::default()).unwrap()
}

#[test]
fn joint_scene_from_four_threads_is_one_and_right() {
    let device = device();
    for (seed, count) in (0..40).zip([0, 1, 500, 20_000].into_iter().cycle()) {
        let (joint, barrier) = (joint(&device, seed, count), Barrier::new(THREADS));
        let balls = random_balls(seed, count);
        thread::scope(|scope| {
            let join = || {
                barrier.wait();
                let scene = joint.join().unwrap();
                check_against_brute_force(scene, &balls, 0..10);
                std::ptr::from_ref(scene).addr()
            };
            let threads = [(); THREADS].map(|()| scope.spawn(join));
            let scenes = threads.map(|thread| thread.join().unwrap());
            assert_eq!(scenes, [scenes[0]; THREADS]);
        });
        let late = joint.join().unwrap();
        check_against_brute_force(late, &balls, 10..20);
    }
}

#[test]
fn joint_threads_get_their_float_mode_back() {
    let device = device();
    let (joint, barrier) = (joint(&device, 1, 50_000), Barrier::new(THREADS));
    thread::scope(|scope| {
        for thread in 0..THREADS {
            let (joint, barrier) = (&joint, &barrier);
            scope.spawn(move || {
                let join = || {
                    let before = flushes_denormals();
                    barrier.wait();
                    joint.join().unwrap();
                    assert_eq!(flushes_denormals(), before);
                    before.0
                };
                let flushed = if thread % 2 == 0 {
                    join()
                } else {
                    with_flushed_denormals(join)
                };
                assert_eq!(flushed, thread % 2 == 1);
            });
        }
    });
}

#[test]
fn joint_scene_that_cannot_be_built_gives_every_thread_the_error() {
    let device = device();
    for seed in 0..10 {
        let mut balls = random_balls(seed, 2000);
        balls[1234].radius = f64::NAN;
        let mut builder = SceneBuilder::new(&device).unwrap();
        let geometry = builder.attach_user(Balls(balls)).unwrap();
        let (joint, barrier) = (builder.into_joint(), Barrier::new(THREADS));
        let expected = Error::Bounds {
            geometry,
            primitive: 1234,
        };
        thread::scope(|scope| {
            for _ in 0..THREADS {
                scope.spawn(|| {
                    barrier.wait();
                    assert_eq!(joint.join().err().as_ref(), Some(&expected));
                });
            }
        });
        assert_eq!(joint.join().err(), Some(expected));
    }
}

/// A scene that is built by the rays that first touch its box.
struct OnTouch(JointCommit<BallQuery>);

impl UserGeometry for OnTouch {
    type Query = BallQuery;

    fn primitive_count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Box32 {
        Box32 {
            lower: [-2.0; 3],
            upper: [2.0; 3],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> Option<f32> {
        let scene = self.0.join().unwrap();
        scene.closest(&query.ray(), query);
        query.best.map(|(t, _)| (t as f32).next_up())
    }

    fn occluded(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> bool {
        self.0.join().unwrap().any(&query.ray(), query)
    }

    one_by_one!();
}

#[test]
fn joint_scenes_within_queries_are_built_by_the_rays_that_need_them() {
    let device = device();
    for seed in 0..10 {
        let mut builder = SceneBuilder::new(&device).unwrap();
        builder
            .attach_user(OnTouch(joint(&device, seed, 20_000)))
            .unwrap();
        let scene = builder.commit().unwrap();
        let (balls, barrier) = (random_balls(seed, 20_000), Barrier::new(THREADS));
        thread::scope(|scope| {
            for first in 0..THREADS as u64 {
                let (scene, balls, barrier) = (&scene, &balls, &barrier);
                scope.spawn(move || {
                    barrier.wait();
                    check_against_brute_force(scene, balls, (first..20).step_by(THREADS));
                });
            }
        });
    }
}

#[test]
fn joint_build_that_nobody_joined_is_dropped_whole() {
    let device = device();
    let before = device.memory_bytes();
    drop(joint(&device, 1, 1000));
    let joined = joint(&device, 2, 1000);
    let mut query = random_query(1, 1);
    joined.join().unwrap().closest(&query.ray(), &mut query);
    drop(joined);
    assert_eq!(device.memory_bytes(), before);
}
