//! User data lives as long as its scene, is dropped once, and Embree's memory
//! is counted.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use cyltrace::embree::{
    Box32, Device, DeviceOptions, NoPackets, Query, Ray32, Reached, Scene, SceneBuilder,
    UserGeometry,
};

use crate::balls::{Balls, no_packets, random_balls};

/// A query that must stay on its thread.
struct Local(#[expect(dead_code, reason = "its type counts")] std::rc::Rc<()>);

impl Query for Local {
    type Packet = std::rc::Rc<()>;
}

// Devices and scenes are for any thread, whatever the query is; builders may
// move. That they can't be shared is a doctest of `SceneBuilder`.
const _: fn() = || {
    fn any_thread<T: Send + Sync>() {}
    fn may_move<T: Send>() {}
    any_thread::<Device>();
    any_thread::<Scene<Local>>();
    may_move::<SceneBuilder<Local>>();
};

/// How many primitives were visited.
struct Visits(u32);

impl Query for Visits {
    type Packet = NoPackets;
}

/// Tells when it is dropped, and what Embree holds at that time.
struct Witness {
    device: Device,
    primitives: u32,
    bad: bool,
    /// Memory in use at each drop.
    drops: Arc<Mutex<Vec<usize>>>,
    calls: Arc<AtomicUsize>,
}

impl Drop for Witness {
    fn drop(&mut self) {
        self.drops.lock().unwrap().push(self.device.memory_bytes());
    }
}

impl UserGeometry for Witness {
    type Query = Visits;

    fn primitive_count(&self) -> u32 {
        self.primitives
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let x = if self.bad { f32::NAN } else { primitive as f32 };
        Box32 {
            lower: [x, 0.0, 0.0],
            upper: [x + 1.0, 1.0, 1.0],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, query: &mut Visits) -> Option<f32> {
        query.0 += 1;
        None
    }

    fn occluded(&self, _: Reached, _: &Ray32, _query: &mut Visits) -> bool {
        true
    }

    no_packets!();
}

struct Bench {
    device: Device,
    drops: Arc<Mutex<Vec<usize>>>,
    calls: Arc<AtomicUsize>,
}

impl Bench {
    fn new() -> Self {
        Self {
            device: Device::new(&DeviceOptions::default()).unwrap(),
            drops: Arc::default(),
            calls: Arc::default(),
        }
    }

    fn witness(&self, bad: bool) -> Witness {
        Witness {
            device: self.device.clone(),
            primitives: 10_000,
            bad,
            drops: Arc::clone(&self.drops),
            calls: Arc::clone(&self.calls),
        }
    }

    fn drops(&self) -> Vec<usize> {
        self.drops.lock().unwrap().clone()
    }
}

#[test]
fn user_data_of_committed_scene_is_dropped_once_after_the_scene() {
    let bench = Bench::new();
    let mut builder = SceneBuilder::new(&bench.device).unwrap();
    builder.attach_user(bench.witness(false)).unwrap();
    builder.attach_user(bench.witness(false)).unwrap();
    let scene = builder.commit().unwrap();
    assert!(bench.calls.load(Ordering::Relaxed) >= 20_000);
    assert!(bench.device.memory_bytes() > 100_000);
    assert!(bench.drops().is_empty(), "{:?}", bench.drops());

    let mut visits = Visits(0);
    let ray = Ray32 {
        origin: [7.5, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        t_near: 0.0,
        t_far: 10.0,
    };
    scene.closest(&ray, &mut visits);
    assert!(visits.0 >= 2);
    assert!(scene.any(&ray, &mut visits));

    drop(scene);
    // Embree had freed the scene before either witness went.
    assert_eq!(bench.drops(), [0, 0]);
}

#[test]
fn user_data_of_dropped_builder_is_dropped_once() {
    let bench = Bench::new();
    let mut builder = SceneBuilder::new(&bench.device).unwrap();
    builder.attach_user(bench.witness(false)).unwrap();
    drop(builder);
    assert_eq!(bench.drops(), [0]);
    assert_eq!(bench.calls.load(Ordering::Relaxed), 0);
}

#[test]
fn user_data_of_failed_commit_is_dropped_once_after_the_scene() {
    let bench = Bench::new();
    let mut builder = SceneBuilder::new(&bench.device).unwrap();
    builder.attach_user(bench.witness(false)).unwrap();
    builder.attach_user(bench.witness(true)).unwrap();
    assert!(builder.commit().is_err());
    assert_eq!(bench.drops(), [0, 0]);
}

#[test]
fn scene_outlives_the_device_value_it_was_built_on() {
    let bench = Bench::new();
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let mut builder = SceneBuilder::new(&device).unwrap();
    builder.attach_user(bench.witness(false)).unwrap();
    drop(device);
    let scene = builder.commit().unwrap();
    let mut visits = Visits(0);
    let ray = Ray32 {
        origin: [7.5, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        t_near: 0.0,
        t_far: 10.0,
    };
    scene.closest(&ray, &mut visits);
    assert!(visits.0 >= 1);
    drop(scene);
    assert_eq!(bench.drops().len(), 1);
}

#[test]
fn memory_bytes_grows_with_a_scene_and_returns_to_zero() {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let before = device.memory_bytes();
    let mut builder = SceneBuilder::new(&device).unwrap();
    builder.attach_user(Balls(random_balls(1, 50_000))).unwrap();
    let scene = builder.commit().unwrap();
    let during = device.memory_bytes();
    // A leaf holds a reference of 8 bytes at least.
    assert!(
        during > before + 8 * 50_000,
        "{before} before, {during} during"
    );
    assert!(device.peak_memory_bytes() >= during);
    drop(scene);
    assert_eq!(device.memory_bytes(), before);
}
