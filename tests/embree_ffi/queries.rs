//! User geometry: right answers, from any thread, nested, with few or many
//! primitives, for every instruction set.

use std::hint::black_box;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;

use cyltrace::embree::{
    Box32, Device, DeviceOptions, Error, MaxIsa, Ray32, Reached, Scene, SceneBuilder, UserGeometry,
    Version,
};
use glam::DVec3;

use crate::balls::{Ball, BallQuery, Balls, no_packets, one_by_one, random_balls, random_query};

const SEED: u64 = 0xE3B;

fn device() -> Device {
    Device::new(&DeviceOptions::default()).unwrap()
}

pub fn scene_of(device: &Device, balls: &[Ball]) -> Scene<BallQuery> {
    let mut builder = SceneBuilder::new(device).unwrap();
    builder.attach_user(Balls(balls.to_vec())).unwrap();
    builder.commit().unwrap()
}

/// Compares `closest` and `any` with brute force for the rays `numbers`.
pub fn check_against_brute_force(
    scene: &Scene<BallQuery>,
    balls: &[Ball],
    numbers: impl Iterator<Item = u64>,
) -> usize {
    let mut hits = 0;
    for number in numbers {
        let mut query = random_query(SEED, number);
        let expected = query.brute_force(balls);
        scene.closest(&query.ray(), &mut query);
        assert_eq!(
            query.best, expected,
            "seed {SEED:#x}, ray {number}: {query:?}"
        );
        let any = scene.any(&query.ray(), &mut query);
        assert_eq!(
            any,
            expected.is_some(),
            "seed {SEED:#x}, ray {number}: {query:?}"
        );
        hits += usize::from(any);
    }
    hits
}

#[test]
fn closest_and_any_random_balls_agree_with_brute_force_for_every_isa() {
    let balls = random_balls(SEED, 500);
    for isa in MaxIsa::available().into_iter().map(Some).chain([None]) {
        let device = Device::new(&DeviceOptions {
            threads: NonZeroUsize::new(2),
            max_isa: isa,
        })
        .unwrap();
        let scene = scene_of(&device, &balls);
        let hits = check_against_brute_force(&scene, &balls, 0..5000);
        assert!(
            (500..4500).contains(&hits),
            "{hits} of 5000 rays hit with {isa:?}"
        );
    }
}

#[test]
fn closest_from_eight_threads_agrees_with_brute_force() {
    let balls = random_balls(SEED, 500);
    let scene = scene_of(&device(), &balls);
    thread::scope(|scope| {
        for first in 0..8 {
            let (scene, balls) = (&scene, &balls);
            scope
                .spawn(move || check_against_brute_force(scene, balls, (first..16_000).step_by(8)));
        }
    });
}

#[test]
fn scenes_built_on_eight_threads_at_once_are_right() {
    let device = device();
    thread::scope(|scope| {
        for seed in 0..8 {
            let device = &device;
            scope.spawn(move || {
                let balls = random_balls(seed, 2000);
                let scene = scene_of(device, &balls);
                check_against_brute_force(&scene, &balls, 0..50);
            });
        }
    });
}

#[test]
fn queries_of_empty_scenes_miss() {
    let device = device();
    let without_geometry = SceneBuilder::<BallQuery>::new(&device)
        .unwrap()
        .commit()
        .unwrap();
    for scene in [without_geometry, scene_of(&device, &[])] {
        let mut query = random_query(SEED, 0);
        scene.closest(&query.ray(), &mut query);
        assert!(!scene.any(&query.ray(), &mut query));
        assert_eq!(scene.closest_native(&query.ray(), &mut query), None);
        assert_eq!((query.best, query.visits), (None, 0));
        assert_eq!(scene.bounds(), None);
    }
}

#[test]
fn closest_one_primitive_is_hit_missed_and_bounded() {
    let ball = Ball {
        center: DVec3::new(1.0, 2.0, 3.0),
        radius: 0.5,
    };
    let scene = scene_of(&device(), &[ball]);
    assert_eq!(scene.bounds(), Some(ball.bounds()));
    let mut query = BallQuery::new(DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.0, 0.0, 0.25));
    scene.closest(&query.ray(), &mut query);
    assert_eq!(query.best, Some((10.0, 0)));
    let mut query = BallQuery::new(DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.0, 0.0, -0.25));
    scene.closest(&query.ray(), &mut query);
    assert_eq!(query.best, None);
}

#[test]
fn closest_many_geometries_names_the_one_that_was_hit() {
    let mut builder = SceneBuilder::new(&device()).unwrap();
    let balls: Vec<Ball> = (0..1000)
        .map(|number| Ball {
            center: DVec3::new(f64::from(number), 0.0, 0.0),
            radius: 0.25,
        })
        .collect();
    for (number, ball) in (0..).zip(&balls) {
        let id = builder.attach_user(Balls(vec![*ball])).unwrap();
        assert_eq!(id.0, number);
    }
    let scene = builder.commit().unwrap();
    for (number, ball) in (0..).zip(&balls) {
        let mut query = BallQuery::new(ball.center - DVec3::Z, DVec3::Z);
        let hit = scene.closest_native(&query.ray(), &mut query).unwrap();
        assert_eq!(
            (hit.geometry.0, hit.primitive, hit.normal),
            (number, 0, [0.0; 3])
        );
        assert_eq!(query.best, Some((0.75, 0)));
        assert_eq!(hit.t, 0.75_f32.next_up());
    }
}

#[test]
fn closest_accepted_hit_shortens_the_ray() {
    let balls: Vec<Ball> = (0..1000)
        .map(|number| Ball {
            center: DVec3::new(0.0, 0.0, f64::from(number)),
            radius: 0.25,
        })
        .collect();
    let scene = scene_of(&device(), &balls);
    let mut query = BallQuery::new(DVec3::new(0.0, 0.0, -1.0), DVec3::Z);
    scene.closest(&query.ray(), &mut query);
    assert_eq!(query.best, Some((0.75, 0)));
    assert!(
        query.visits < 100,
        "{} of 1000 balls were visited",
        query.visits
    );

    let mut query = BallQuery::new(DVec3::new(0.0, 0.0, -1.0), DVec3::Z);
    let short = Ray32 {
        t_far: 0.5,
        ..query.ray()
    };
    scene.closest(&short, &mut query);
    assert_eq!((query.best, query.visits), (None, 0));
}

/// A ball that is seen through as many scenes as there are levels: the only
/// primitive of each level passes the query on to the next one.
struct Level {
    inner: Option<Scene<BallQuery>>,
    ball: Ball,
}

impl Level {
    fn nested(device: &Device, ball: Ball, levels: u32) -> Scene<BallQuery> {
        let inner = (levels > 1).then(|| Self::nested(device, ball, levels - 1));
        let mut builder = SceneBuilder::new(device).unwrap();
        builder.attach_user(Self { inner, ball }).unwrap();
        builder.commit().unwrap()
    }
}

impl UserGeometry for Level {
    type Query = BallQuery;

    fn primitive_count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Box32 {
        self.ball.bounds()
    }

    fn intersect(&self, at: Reached, _: &Ray32, query: &mut BallQuery) -> Option<f32> {
        query.visits += 1;
        match &self.inner {
            Some(scene) => scene.closest(&query.ray(), query),
            None => query.best = Some((self.ball.enter(query)?, at.primitive)),
        }
        query.best.map(|(t, _)| t as f32)
    }

    fn occluded(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> bool {
        match &self.inner {
            Some(scene) => scene.any(&query.ray(), query),
            None => self.ball.enter(query).is_some(),
        }
    }

    one_by_one!();
}

#[test]
fn nested_queries_64_levels_reach_the_innermost_scene() {
    let ball = Ball {
        center: DVec3::ZERO,
        radius: 0.5,
    };
    let check = move || {
        let scene = Level::nested(&device(), ball, 64);
        let mut query = BallQuery::new(DVec3::new(0.0, 0.0, -1.0), DVec3::Z);
        scene.closest(&query.ray(), &mut query);
        assert_eq!((query.best, query.visits), (Some((0.5, 0)), 64));
        assert!(scene.any(&query.ray(), &mut query));

        // In the corner of the box, outside the ball.
        let mut query = BallQuery::new(DVec3::new(0.49, 0.49, -1.0), DVec3::Z);
        scene.closest(&query.ray(), &mut query);
        assert_eq!((query.best, query.visits), (None, 64));
        assert!(!scene.any(&query.ray(), &mut query));
    };
    // About 11 kB a level, and as much again in an unoptimised build.
    let thread = thread::Builder::new().stack_size(8 << 20).spawn(check);
    thread.unwrap().join().unwrap();
}

/// A scene that is built when a ray first touches its box.
struct Lazy {
    device: Device,
    balls: Vec<Ball>,
    inner: OnceLock<Scene<BallQuery>>,
    builds: Arc<AtomicUsize>,
}

impl Lazy {
    fn scene(&self) -> &Scene<BallQuery> {
        self.inner.get_or_init(|| {
            self.builds.fetch_add(1, Ordering::Relaxed);
            scene_of(&self.device, &self.balls)
        })
    }
}

impl UserGeometry for Lazy {
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
        self.scene().closest(&query.ray(), query);
        query.best.map(|(t, _)| (t as f32).next_up())
    }

    fn occluded(&self, _: Reached, _: &Ray32, query: &mut BallQuery) -> bool {
        self.scene().any(&query.ray(), query)
    }

    one_by_one!();
}

#[test]
fn scene_built_within_a_query_from_eight_threads_is_built_once_and_right() {
    let device = device();
    let balls = random_balls(SEED, 20_000);
    let builds = Arc::new(AtomicUsize::new(0));
    let lazy = Lazy {
        device: device.clone(),
        balls: balls.clone(),
        inner: OnceLock::new(),
        builds: Arc::clone(&builds),
    };
    let mut builder = SceneBuilder::new(&device).unwrap();
    builder.attach_user(lazy).unwrap();
    let scene = builder.commit().unwrap();
    assert_eq!(builds.load(Ordering::Relaxed), 0);
    thread::scope(|scope| {
        for first in 0..8 {
            let (scene, balls) = (&scene, &balls);
            scope.spawn(move || check_against_brute_force(scene, balls, (first..80).step_by(8)));
        }
    });
    assert_eq!(builds.load(Ordering::Relaxed), 1);
    assert_eq!(flushes_denormals(), (false, false));
}

/// Whether denormal results, and denormal operands, are taken for zero.
pub fn flushes_denormals() -> (bool, bool) {
    (
        black_box(f32::MIN_POSITIVE) * black_box(0.5) == 0.0,
        black_box(f32::MIN_POSITIVE * 0.5) * black_box(2.0) == 0.0,
    )
}

/// Notes the floating-point mode of its callbacks.
struct ModeWitness(Arc<Mutex<Vec<(bool, bool)>>>);

impl UserGeometry for ModeWitness {
    type Query = Vec<(bool, bool)>;

    fn primitive_count(&self) -> u32 {
        20_000
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.0.lock().unwrap().push(flushes_denormals());
        let x = primitive as f32;
        Box32 {
            lower: [x, 0.0, 0.0],
            upper: [x + 1.0, 1.0, 1.0],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, query: &mut Self::Query) -> Option<f32> {
        query.push(flushes_denormals());
        None
    }

    fn occluded(&self, _: Reached, _: &Ray32, query: &mut Self::Query) -> bool {
        query.push(flushes_denormals());
        false
    }

    no_packets!();
}

#[test]
fn float_mode_commit_and_queries_never_flush_denormals() {
    let default = (false, false);
    assert_eq!(flushes_denormals(), default);
    let modes = Arc::default();
    let mut builder = SceneBuilder::new(&device()).unwrap();
    builder
        .attach_user(ModeWitness(Arc::clone(&modes)))
        .unwrap();
    let scene = builder.commit().unwrap();
    assert_eq!(flushes_denormals(), default, "after the commit");
    let modes = modes.lock().unwrap();
    assert!(modes.len() >= 20_000);
    assert!(
        modes.iter().all(|&mode| mode == default),
        "in bounds callbacks"
    );

    let ray = Ray32 {
        origin: [0.5, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        t_near: 0.0,
        t_far: f32::INFINITY,
    };
    let mut seen = Vec::new();
    scene.closest(&ray, &mut seen);
    assert!(!scene.any(&ray, &mut seen));
    assert!(
        seen.len() >= 2 && seen.iter().all(|&mode| mode == default),
        "{seen:?}"
    );
    assert_eq!(flushes_denormals(), default, "after queries");
}

#[test]
fn commit_bounds_embree_would_leave_out_names_the_first_primitive() {
    let mut balls = random_balls(SEED, 100);
    for (bad, radius) in [(57, -1.0), (31, f64::NAN), (80, 1e19)] {
        balls[bad].radius = radius;
    }
    let mut builder = SceneBuilder::new(&device()).unwrap();
    builder.attach_user(Balls(random_balls(SEED, 10))).unwrap();
    let id = builder.attach_user(Balls(balls)).unwrap();
    assert_eq!(
        builder.commit().err(),
        Some(Error::Bounds {
            geometry: id,
            primitive: 31
        })
    );
}

#[test]
fn version_of_library_is_that_of_headers_up_to_patch() {
    let version = device().version();
    assert_eq!(
        (version.major, version.minor),
        (Version::BUILT_FOR.major, Version::BUILT_FOR.minor)
    );
    let text = version.to_string();
    assert_eq!(text.split('.').count(), 3, "{text}");
}

#[test]
fn isa_names_read_back_and_unknown_ones_are_refused() {
    for isa in MaxIsa::ALL {
        assert_eq!(isa.name().parse(), Ok(isa));
    }
    let message = "avx3".parse::<MaxIsa>().unwrap_err().to_string();
    assert!(
        message.contains("avx3") && message.contains("avx512"),
        "{message}"
    );
    assert_eq!(MaxIsa::best(), MaxIsa::available().last().copied());
}
