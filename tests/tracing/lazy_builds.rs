//! Prototypes are built when a ray first reaches them: only those, once, also
//! when many threads get there at a time, and with the right answers.

use std::hint::black_box;
use std::sync::{Arc, Barrier};
use std::thread;

use cyltrace::embree::with_flushed_denormals;
use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, MaterialIndex, Prototype, Scene, Solids};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{BuildTime, Layout, Options, Tracer};
use glam::{DAffine3, DVec3};
use test_support::aim::{carried, ray_at};
use test_support::{cylinders_in_a_box, placed, placing, scene_of};

const SEED: u64 = 20_261_124;

/// Cylinders of a box.
const COUNT: u32 = 4_000;

/// Where the second box is.
const ASIDE: f64 = 1_000.0;

/// A box of cylinders at the origin and another one [`ASIDE`] along x, each
/// behind a placement within a placement.
fn two_boxes() -> Arc<Scene> {
    let named = |name: &str, prototype: Prototype| Prototype {
        name: name.to_owned(),
        ..prototype
    };
    let here = |of| placed(of, DAffine3::IDENTITY);
    let aside = DAffine3::from_translation(DVec3::X * ASIDE);
    let leaf = |seed| Prototype {
        solids: Solids::of_cylinders(cylinders_in_a_box(seed, COUNT)),
        ..Default::default()
    };
    scene_of(vec![
        placing(vec![here(1), placed(2, aside)]),
        named("around near", placing(vec![here(3)])),
        named("around far", placing(vec![here(4)])),
        named("near", leaf(SEED)),
        named("far", leaf(SEED + 1)),
    ])
}

fn tracer(scene: &Arc<Scene>, layout: Layout, build: BuildTime) -> Tracer {
    let options = Options {
        layout,
        build,
        ..Default::default()
    };
    Tracer::new(Arc::clone(scene), &options).unwrap()
}

/// The names of the prototypes that are not built, the root's being empty.
fn unbuilt(tracer: &Tracer) -> Vec<String> {
    let skipped = tracer.statistics().skipped;
    let name = |sentence: &String| {
        assert!(sentence.contains("reached by no ray"), "{sentence}");
        let name = sentence.split('"').nth(1);
        name.unwrap_or_else(|| {
            assert!(sentence.starts_with("the scene itself"), "{sentence}");
            ""
        })
        .to_owned()
    };
    skipped.iter().map(name).collect()
}

/// A ray that meets a box, placed `offset` along x.
fn ray_at_box(scene: &Scene, offset: f64) -> Ray {
    let index = if offset == 0.0 { 3 } else { 4 };
    let cylinder = scene.prototypes[index].solids.cylinders.get(0).cylinder();
    let middle = cylinder.p0().lerp(cylinder.p1(), 0.5) + DVec3::X * offset;
    Ray::new(middle + DVec3::Z * 10.0, DVec3::NEG_Z)
}

#[test]
fn prototype_that_no_ray_reaches_is_not_built() {
    let scene = two_boxes();
    for layout in [Layout::Single, Layout::Block] {
        let tracer = tracer(&scene, layout, BuildTime::WhenReached);
        let everything = ["", "around near", "around far", "near", "far"];
        assert_eq!(unbuilt(&tracer), everything);
        let bytes = || tracer.statistics().embree_bytes;
        assert_eq!(bytes(), 0);

        // Past everything.
        assert_eq!(tracer.closest(&Ray::new(DVec3::Y * 9.0, DVec3::Y)), None);
        assert_eq!(unbuilt(&tracer), everything);

        let near = ray_at_box(&scene, 0.0);
        assert_eq!(tracer.closest(&near), tracer.closest_exhaustive(&near));
        assert_eq!(unbuilt(&tracer), ["around far", "far"]);
        let one_box = bytes();
        // At the far box, but the range ends before it.
        let along = Ray::new(DVec3::new(2.0, 0.5, 0.5), DVec3::X);
        let short = Ray {
            t_max: ASIDE / 2.0,
            ..along
        };
        assert_eq!(tracer.closest_batch_of(&[short; 16]), vec![None; 16]);
        assert_eq!(unbuilt(&tracer), ["around far", "far"]);
        assert_eq!(bytes(), one_box);

        let far = ray_at_box(&scene, ASIDE);
        let hits = tracer.closest_batch_of(&[far; 16]);
        assert_eq!(hits, vec![tracer.closest_exhaustive(&far); 16]);
        assert_eq!(unbuilt(&tracer), [""; 0]);
        // The boxes are of as many cylinders, and little else takes memory.
        let two_boxes = bytes() as f64 / one_box as f64;
        assert!((1.7..2.3).contains(&two_boxes), "{layout:?}: {two_boxes}");
    }
}

/// The hits of a batch as a value.
trait ClosestBatchOf {
    fn closest_batch_of(&self, rays: &[Ray]) -> Vec<Option<cyltrace::tracer::Hit>>;
}

impl ClosestBatchOf for Tracer {
    fn closest_batch_of(&self, rays: &[Ray]) -> Vec<Option<cyltrace::tracer::Hit>> {
        let mut hits = Vec::new();
        self.closest_batch(rays, &mut hits);
        hits
    }
}

#[test]
fn question_whether_anything_is_hit_builds_too() {
    let scene = two_boxes();
    for layout in [Layout::Single, Layout::Block] {
        let tracer = tracer(&scene, layout, BuildTime::WhenReached);
        assert!(tracer.occluded(&ray_at_box(&scene, 0.0)));
        assert_eq!(unbuilt(&tracer), ["around far", "far"]);
        let mut blocked = Vec::new();
        tracer.occluded_batch(&[ray_at_box(&scene, ASIDE); 16], &mut blocked);
        assert_eq!(blocked, [true; 16]);
        assert_eq!(unbuilt(&tracer), [""; 0]);
    }
}

#[test]
fn everything_is_built_at_once_if_asked_for() {
    let scene = two_boxes();
    for layout in [Layout::Single, Layout::Block] {
        let tracer = tracer(&scene, layout, BuildTime::AtOnce);
        assert_eq!(unbuilt(&tracer), [""; 0]);
        let built = tracer.statistics();
        assert!(built.embree_bytes > 0);
        for offset in [0.0, ASIDE] {
            let ray = ray_at_box(&scene, offset);
            assert_eq!(tracer.closest(&ray), tracer.closest_exhaustive(&ray));
        }
        assert_eq!(tracer.statistics().embree_bytes, built.embree_bytes);
    }
}

/// Eight cylinders a primitive leave Embree with less to hold, and the blocks, a filter of 64
/// bytes and eight numbers of records each, are counted when they are made.
#[test]
fn memory_of_blocks_is_counted_where_they_are_built() {
    let scene = two_boxes();
    let [single, block] = [Layout::Single, Layout::Block].map(|layout| {
        let tracer = tracer(&scene, layout, BuildTime::WhenReached);
        let unbuilt = tracer.statistics().records_bytes;
        assert!(tracer.occluded(&ray_at_box(&scene, 0.0)));
        let one_box = tracer.statistics();
        assert!(tracer.occluded(&ray_at_box(&scene, ASIDE)));
        let all = tracer.statistics();
        (unbuilt, one_box, all)
    });
    let described = 2 * COUNT as usize * size_of::<CylinderRecord>() + 4 * 104;
    let (unbuilt, one_box, all) = &single;
    assert_eq!(
        [*unbuilt, one_box.records_bytes, all.records_bytes],
        [described; 3]
    );
    let in_blocks = (COUNT as usize).div_ceil(8) * 64 + COUNT as usize * 4;
    let (unbuilt, one_box, all) = &block;
    assert_eq!(*unbuilt, described);
    assert_eq!(one_box.records_bytes, described + in_blocks);
    assert_eq!(all.records_bytes, described + 2 * in_blocks);
    let [single, block] = [&single.2, &block.2].map(|all| all.embree_bytes);
    // An eighth of the primitives; what remains is what Embree rounds up.
    assert!(block * 3 < single, "{block} against {single} bytes");
}

/// Threads that get to an unbuilt prototype at the same time, in every way, all
/// get the right answers.
#[test]
fn threads_that_reach_a_prototype_together_get_the_right_answers() {
    const THREADS: u64 = 8;
    const ROUNDS: u64 = 12;
    const RAYS: u64 = 48;
    let nested = test_support::nested_placements(SEED).swap_remove(1);
    let in_nested = nested.cylinders();
    let boxes = two_boxes();
    let ray_of = |round: u64, number: u64| {
        let random = &mut Random::new(SEED, round * RAYS + number);
        let image = nested.any_image(random);
        carried(&image, &ray_at(random, &in_nested, 1e3))
    };
    let near: Vec<_> = boxes.prototypes[3].solids.cylinders.iter().collect();
    for round in 0..ROUNDS {
        let layout = [Layout::Single, Layout::Block][(round % 2) as usize];
        let (scene, rays): (_, Vec<Ray>) = if round % 4 < 2 {
            (&nested.scene, (0..RAYS).map(|n| ray_of(round, n)).collect())
        } else {
            let aimed = |n| ray_at(&mut Random::new(SEED, round * RAYS + n), &near, 1e2);
            (&boxes, (0..RAYS).map(aimed).collect())
        };
        let tracer = tracer(scene, layout, BuildTime::WhenReached);
        let witness = rays.iter().map(|ray| tracer.closest_exhaustive(ray));
        let witness: Vec<_> = witness.collect();
        assert!(unbuilt(&tracer).len() >= 4, "the witness builds nothing");
        let barrier = Barrier::new(THREADS as usize);
        thread::scope(|scope| {
            for number in 0..THREADS {
                let (tracer, barrier, rays, witness) = (&tracer, &barrier, &rays, &witness);
                scope.spawn(move || {
                    barrier.wait();
                    for (ray, wanted) in rays.iter().zip(witness) {
                        let replay = || format!("round {round}: {}", test_support::bits(ray));
                        match number % 3 {
                            0 => assert_eq!(&tracer.closest(ray), wanted, "{}", replay()),
                            1 => {
                                let hits = tracer.closest_batch_of(&[*ray; 16]);
                                assert_eq!(hits, vec![wanted.clone(); 16], "{}", replay());
                            }
                            _ => {
                                let blocked = tracer.occluded(ray);
                                assert_eq!(blocked, wanted.is_some(), "{}", replay());
                            }
                        }
                    }
                });
            }
        });
    }
}

/// A tracer gives everything back, whether its prototypes were built or not.
#[test]
fn dropped_tracer_keeps_no_scene() {
    let scene = two_boxes();
    for layout in [Layout::Single, Layout::Block] {
        let untouched = tracer(&scene, layout, BuildTime::WhenReached);
        let partly = tracer(&scene, layout, BuildTime::WhenReached);
        assert!(partly.closest(&ray_at_box(&scene, 0.0)).is_some());
        let wholly = tracer(&scene, layout, BuildTime::AtOnce);
        assert!(Arc::strong_count(&scene) > 3);
        drop((untouched, partly));
        thread::scope(|scope| scope.spawn(move || drop(wholly)).join().unwrap());
        assert_eq!(Arc::strong_count(&scene), 1, "{layout:?}");
    }
}

/// Embree builds with denormal numbers flushed; the thread whose ray makes it
/// build is none the wiser, in either mode.
#[test]
fn build_on_the_way_of_a_ray_leaves_the_float_mode() {
    let flushes = || black_box(f64::MIN_POSITIVE) * black_box(0.5) == 0.0;
    let scene = two_boxes();
    for layout in [Layout::Single, Layout::Block] {
        let build = |wanted: bool| {
            let tracer = tracer(&scene, layout, BuildTime::WhenReached);
            assert_eq!(flushes(), wanted);
            assert!(tracer.closest(&ray_at_box(&scene, 0.0)).is_some());
            assert_eq!(flushes(), wanted);
            let hits = tracer.closest_batch_of(&[ray_at_box(&scene, ASIDE); 16]);
            assert!(hits.iter().all(Option::is_some));
            assert_eq!(flushes(), wanted);
        };
        build(false);
        with_flushed_denormals(|| build(true));
    }
}

/// A placed prototype that holds nothing is told as placed, but is never there
/// to be built.
#[test]
fn empty_prototype_is_neither_built_nor_told() {
    let cylinder = Cylinder::new(DVec3::ZERO, DVec3::X, 0.5, Caps::Both).unwrap();
    let root = Prototype {
        solids: Solids::of_cylinders(vec![CylinderRecord::new(&cylinder, 0, MaterialIndex(0))]),
        ..placing(vec![placed(1, DAffine3::IDENTITY)])
    };
    let scene = scene_of(vec![root, Prototype::default()]);
    for build in [BuildTime::WhenReached, BuildTime::AtOnce] {
        let tracer = tracer(&scene, Layout::Block, build);
        let ray = Ray::new(DVec3::new(0.5, 0.0, 9.0), DVec3::NEG_Z);
        let hits = tracer.closest_batch_of(&[ray; 16]);
        assert!(
            hits.iter()
                .all(|hit| hit.as_ref().is_some_and(|hit| hit.t == 8.5))
        );
        assert_eq!(unbuilt(&tracer), [""; 0]);
    }
}
