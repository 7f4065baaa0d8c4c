//! The deepest nesting that is promised loads and can be traced.

use std::fs;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::thread;

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, GREATEST_DEPTH, MaterialIndex, Scene, load};
use cyltrace::solid::{Caps, Cylinder, SolidKind};
use cyltrace::tracer::{Options, Tracer, workers};
use glam::DVec3;

/// Placements of a cylinder inside each other, each of which turns by 90
/// degrees about z and lifts by 1.
fn nested(levels: usize) -> String {
    let mut text = "[[prototype]]\nname = \"0\"\n[[prototype.cylinder]]\n\
         p0 = [2, 0, 0]\np1 = [2, 0, 1]\nradius = 0.5\n"
        .to_owned();
    let place = |inner: usize| {
        format!(
            "of = \"{inner}\"\nrotate = [{{ axis = [0, 0, 1], degrees = 90 }}]\ntranslate = [0, 0, 1]\n"
        )
    };
    for level in 1..levels {
        text += &format!(
            "[[prototype]]\nname = \"{level}\"\n[[prototype.instance]]\n{}",
            place(level - 1)
        );
    }
    text + "[[instance]]\n" + &place(levels - 1)
}

/// As many levels as load, and in the innermost cylinder so many small ones that
/// it takes a while to build.
fn deepest() -> Arc<Scene> {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), nested(GREATEST_DEPTH)).expect("writing the scene");
    let mut scene = load(file.path()).unwrap_or_else(|error| panic!("{error}"));
    let innermost = scene.prototypes.iter_mut().find(|one| one.name == "0");
    let cylinders = &mut innermost
        .expect("a prototype of that name")
        .solids
        .cylinders;
    let mut random = Random::new(61, 0);
    for primitive in 1..5_000 {
        let p0 = DVec3::new(2.0, 0.0, 0.5) + random.direction() * 0.3;
        let p1 = p0 + random.direction() * 0.01;
        let one = Cylinder::new(p0, p1, 0.001, Caps::Both).expect("a cylinder");
        cylinders
            .push(CylinderRecord::new(&one, primitive, MaterialIndex(0)))
            .expect("f64 records hold every cylinder");
    }
    Arc::new(scene)
}

/// A ray to the head of the cylinder in [`deepest`], where it is at t = 35: 64
/// quarter turns are none, and the cylinder's foot is lifted to z = 64.
fn down() -> Ray {
    Ray::new(DVec3::new(2.0, 0.0, 100.0), DVec3::NEG_Z)
}

#[test]
fn deepest_nesting_is_traced() {
    let tracer = Tracer::new(deepest(), &Options::default()).expect("a tracer");
    let hit = tracer.closest(&down()).expect("the head of the cylinder");
    assert_eq!(hit.t, 35.0);
    assert_eq!(hit.instance, vec![0; GREATEST_DEPTH]);
}

/// Rays that are traced together take more of the stack than one; still the
/// deepest scene can be traced, and built on the way, on a thread as Rust makes
/// them, which has 2 MB.
#[test]
fn deepest_nesting_is_traced_in_packets_on_any_thread() {
    let scene = deepest();
    let trace = |tracer: &Tracer| {
        let rays = [down(); 16];
        let (mut hits, mut blocked) = (Vec::new(), Vec::new());
        tracer.closest_batch(&rays, &mut hits);
        assert_eq!(hits, vec![tracer.closest_exhaustive(&down()); 16]);
        assert_eq!(hits[15].as_ref().map(|hit| hit.t), Some(35.0));
        tracer.occluded_batch(&rays, &mut blocked);
        assert_eq!(blocked, [true; 16]);
    };
    for options in test_support::ways_to_trace() {
        let tracer = || Tracer::new(Arc::clone(&scene), &options).expect("a tracer");
        workers(NonZeroUsize::new(1))
            .expect("a thread")
            .install(|| trace(&tracer()));
        let thread = thread::Builder::new().stack_size(2 << 20);
        thread::scope(|scope| {
            let traced = thread.spawn_scoped(scope, || trace(&tracer()));
            traced.expect("a thread").join().expect("the right answer");
        });
    }
}

/// 4^64 cylinders are more than u128 can count: the counts stop there instead of
/// starting over.
#[test]
fn counts_beyond_u128_stay_at_its_greatest_number() {
    let mut text = nested(GREATEST_DEPTH);
    let places: Vec<String> = text.split("[[").skip(1).map(|t| format!("[[{t}")).collect();
    text = places
        .iter()
        .map(|entry| match entry.contains("instance]]") {
            true => entry.repeat(4),
            false => entry.clone(),
        })
        .collect();
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), text).expect("writing the scene");
    let scene = load(file.path()).unwrap_or_else(|error| panic!("{error}"));
    let scene_stats = scene.scene_stats();
    assert_eq!(scene_stats.instanced[SolidKind::Cylinder], u128::MAX);
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("a tracer");
    let built = tracer.statistics();
    assert_eq!(built.instanced, scene_stats.instanced);
    assert_eq!(built.instances, scene_stats.instances);
}
