//! Calls as C makes them: results are the tracer's, and misuse is an error with a message.

use std::collections::HashSet;
use std::ffi::c_void;
use std::ptr::{null, null_mut};
use std::slice;
use std::sync::Mutex;
use std::thread::{self, ThreadId};

use cyltrace::math::{Random, Ray};
use cyltrace::scene;
use cyltrace::solid::{Crossing, Part, SolidKind};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_c::*;
use glam::DVec3;

use super::loaded::{Loaded, last_error, scene_path, text};

#[test]
fn rays_get_the_tracer_s_answers() {
    let loaded = Loaded::new("minimal.toml");
    let path = scene_path("minimal.toml");
    let scene = std::sync::Arc::new(scene::load(&path).expect("loads"));
    let tracer = Tracer::new(scene, &Options::default()).expect("builds");
    let center = tracer.bounds().center();
    let mut rays: Vec<Ray> = (0..500)
        .map(|number| {
            let mut random = Random::new(1, number);
            let from = center + random.direction() * 9.0;
            Ray::new(from, center + random.direction() * 2.0 - from)
        })
        .collect();
    rays[7].direction.x = f64::NAN;
    let given: Vec<CyltraceRay> = rays.iter().map(CyltraceRay::from).collect();
    let mut hits = vec![CyltraceHit::MISS; rays.len()];
    let mut occluded = vec![7_u8; rays.len()];
    let count = rays.len();
    // SAFETY: the arrays have `count` elements.
    let codes = unsafe {
        [
            cyltrace_closest(loaded.0, given.as_ptr(), count, hits.as_mut_ptr()),
            cyltrace_occluded(loaded.0, given.as_ptr(), count, occluded.as_mut_ptr()),
            cyltrace_closest(loaded.0, null(), 0, null_mut()),
        ]
    };
    assert_eq!(codes, [CYLTRACE_OK; 3]);
    let mut seen = 0;
    for ((ray, hit), occluded) in rays.iter().zip(&hits).zip(occluded) {
        let expected = tracer.closest(ray);
        assert_eq!(
            (hit.is_hit == 1, occluded),
            (expected.is_some(), u8::from(expected.is_some()))
        );
        let Some(expected) = expected else {
            assert_eq!(*hit, CyltraceHit::MISS);
            continue;
        };
        seen += 1;
        let parts = [Part::Side, Part::Cap0, Part::Cap1];
        let crossings = [Crossing::Enter, Crossing::Leave];
        assert_eq!(hit.t.to_bits(), expected.t.to_bits());
        assert_eq!(hit.point, expected.point.to_array());
        assert_eq!(hit.normal, expected.normal.to_array());
        assert_eq!(
            (hit.u, hit.v, hit.error),
            (expected.u, expected.v, expected.error)
        );
        assert_eq!(
            (hit.primitive, hit.prototype),
            (expected.primitive, expected.prototype.0)
        );
        assert_eq!(parts[hit.part as usize], expected.part);
        assert_eq!(crossings[hit.crossing as usize], expected.crossing);
        assert_eq!(
            hit.instance[..hit.instance_count as usize],
            expected.instance
        );
    }
    assert!((50..490).contains(&seen), "{seen}");
}

/// A rod that is placed twice.
const PLACED: &str = r#"
[[prototype]]
name = "rod"
[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [1, 2, 3]
radius = 0.7
[[instance]]
of = "rod"
translate = [-1, 0, 0]
[[instance]]
of = "rod"
rotate_x = 30
scale = 1.5
"#;

#[test]
fn rays_get_the_fields_that_are_requested_and_no_others() {
    let folder = tempfile::tempdir().expect("directory");
    let path = folder.path().join("placed.toml");
    std::fs::write(&path, PLACED).expect("written");
    let loaded = Loaded::at(&path);
    // Down onto the scene, so that some rays hit and some miss.
    let rays: Vec<CyltraceRay> = (0..200)
        .map(|number| {
            let mut random = Random::new(2, number);
            let from = DVec3::new(random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0), 9.0);
            CyltraceRay::from(&Ray::new(from, random.direction() - DVec3::Z * 3.0))
        })
        .collect();
    let closest_with = |fields: u32| {
        let mut hits = vec![CyltraceHit::MISS; rays.len()];
        let (given, found) = (rays.as_ptr(), hits.as_mut_ptr());
        // SAFETY: both arrays have as many elements as there are rays.
        let code = unsafe { cyltrace_closest_with(loaded.0, given, rays.len(), fields, found) };
        (code, hits)
    };
    let mut whole = vec![CyltraceHit::MISS; rays.len()];
    // SAFETY: both arrays have as many elements as there are rays.
    let code = unsafe { cyltrace_closest(loaded.0, rays.as_ptr(), rays.len(), whole.as_mut_ptr()) };
    assert_eq!(code, CYLTRACE_OK);
    let hit_count = whole.iter().filter(|hit| hit.is_hit == 1).count();
    assert!((20..190).contains(&hit_count), "{hit_count}");
    assert!(whole.iter().any(|hit| hit.instance[0] == 1));

    for fields in 0..=CYLTRACE_FIELD_ALL {
        let (code, hits) = closest_with(fields);
        assert_eq!(code, CYLTRACE_OK);
        let is_requested = |field: u32| fields & field != 0;
        for (hit, whole) in hits.iter().zip(&whole) {
            // What the header says of the whole hit without the other fields.
            let mut expected = *whole;
            if whole.is_hit == 1 {
                if !is_requested(CYLTRACE_FIELD_POINT) {
                    expected.point = [f64::NAN; 3];
                }
                if !is_requested(CYLTRACE_FIELD_NORMAL) {
                    expected.normal = [f64::NAN; 3];
                    expected.valid_fields &= !CYLTRACE_VALID_NORMAL;
                }
                if !is_requested(CYLTRACE_FIELD_UV) {
                    (expected.u, expected.v) = (f64::NAN, f64::NAN);
                }
                if !is_requested(CYLTRACE_FIELD_ERROR) {
                    expected.error = f64::NAN;
                }
                if !is_requested(CYLTRACE_FIELD_PATH) {
                    expected.instance_count = 0;
                    expected.instance = [0; CYLTRACE_GREATEST_DEPTH];
                    expected.valid_fields &= !CYLTRACE_VALID_PLACE;
                }
            }
            // The text of a number names its bits; all NaN are the same.
            assert_eq!(format!("{hit:?}"), format!("{expected:?}"), "{fields}");
        }
    }

    let (code, _) = closest_with(CYLTRACE_FIELD_ALL + 1);
    assert_eq!(code, CYLTRACE_ERROR);
    let refusal = "cyltrace_closest_with: fields is 32: ";
    assert!(last_error().starts_with(refusal), "{}", last_error());
}

/// One of each kind at x = 0, 10, 20 ...
const KINDS: &str = r#"
[[cuboid]]
half_widths = [1, 1, 1]
[[cylinder]]
p0 = [10, 0, -1]
p1 = [10, 0, 1]
radius = 1
[[cone]]
p0 = [20, 0, -1]
p1 = [20, 0, 1]
radius0 = 1
radius1 = 0.5
[[rounded_cone]]
p0 = [30, 0, 0]
p1 = [30, 0, 1]
radius0 = 1
radius1 = 0.5
[[sphere]]
center = [40, 0, 0]
radius = 1
[[disk]]
center = [50, 0, 0]
normal = [0, 0, 1]
radius = 1
"#;

#[test]
fn every_kind_of_solid_and_every_face_has_its_code() {
    let folder = tempfile::tempdir().expect("directory");
    let path = folder.path().join("kinds.toml");
    std::fs::write(&path, KINDS).expect("written");
    let loaded = Loaded::at(&path);
    let towards = |x: f64, from: [f64; 3]| CyltraceRay {
        origin: [x + 5.0 * from[0], 5.0 * from[1], 5.0 * from[2]],
        direction: from.map(|x| -x),
        t_min: 0.0,
        t_max: f64::INFINITY,
    };
    let down = [0.0, 0.0, 1.0];
    for (ray, solid, part) in [
        (
            towards(0.0, [-1.0, 0.0, 0.0]),
            SolidKind::Cuboid,
            CYLTRACE_X_MIN,
        ),
        (
            towards(0.0, [1.0, 0.0, 0.0]),
            SolidKind::Cuboid,
            CYLTRACE_X_MAX,
        ),
        (
            towards(0.0, [0.0, -1.0, 0.0]),
            SolidKind::Cuboid,
            CYLTRACE_Y_MIN,
        ),
        (
            towards(0.0, [0.0, 1.0, 0.0]),
            SolidKind::Cuboid,
            CYLTRACE_Y_MAX,
        ),
        (
            towards(0.0, [0.0, 0.0, -1.0]),
            SolidKind::Cuboid,
            CYLTRACE_Z_MIN,
        ),
        (towards(0.0, down), SolidKind::Cuboid, CYLTRACE_Z_MAX),
        (towards(10.0, down), SolidKind::Cylinder, CYLTRACE_CAP1),
        (towards(20.0, down), SolidKind::Cone, CYLTRACE_CAP1),
        (towards(30.0, down), SolidKind::RoundedCone, CYLTRACE_CAP1),
        (towards(40.0, down), SolidKind::Sphere, CYLTRACE_SIDE),
        (towards(50.0, down), SolidKind::Disk, CYLTRACE_SIDE),
    ] {
        let mut hit = CyltraceHit::MISS;
        // SAFETY: one ray and one hit.
        let code = unsafe { cyltrace_closest(loaded.0, &raw const ray, 1, &raw mut hit) };
        assert_eq!((code, hit.is_hit), (CYLTRACE_OK, 1), "{ray:?}");
        assert_eq!((hit.solid, hit.part), (solid.code(), part), "{ray:?}");
    }
}

/// What the intersector of these tests does and has seen.
struct User {
    scene: *const CyltraceScene,
    part: Option<u32>,
    threads: Mutex<HashSet<ThreadId>>,
}

/// The library's own answers, of a part that may be wrong.
unsafe extern "C" fn answer(
    user: *mut c_void,
    rays: *const CyltraceRay,
    count: usize,
    hits: *mut CyltraceHit,
) {
    // SAFETY: `check` passes a user that lives through the check, and the library
    // `count` rays and hits.
    unsafe {
        let user = &*user.cast::<User>();
        user.threads.lock().unwrap().insert(thread::current().id());
        assert_eq!(cyltrace_closest(user.scene, rays, count, hits), CYLTRACE_OK);
        if let Some(part) = user.part {
            for hit in slice::from_raw_parts_mut(hits, count) {
                hit.part = part;
            }
        }
    }
}

fn check(
    scene: &Loaded,
    settings: &CyltraceCheckSettings,
    part: Option<u32>,
) -> (i32, CyltraceCheckOutcome, usize) {
    let user = User {
        scene: scene.0,
        part,
        threads: Mutex::default(),
    };
    let mut outcome = CyltraceCheckOutcome::NOTHING;
    // SAFETY: all of them are locals; `user` is shared by its mutex.
    let code = unsafe {
        let user = (&raw const user).cast_mut().cast();
        cyltrace_check(scene.0, settings, Some(answer), user, &raw mut outcome)
    };
    (code, outcome, user.threads.lock().unwrap().len())
}

const SETTINGS: CyltraceCheckSettings = CyltraceCheckSettings {
    rays: 2_000,
    seed: 0,
    max_memory: 0,
    most_listed: 3,
    segments: null(),
    segment_count: 0,
    classes: CYLTRACE_SPHERE | CYLTRACE_INSIDE,
    threads: 1,
};

#[test]
fn tracer_checked_through_c_holds_and_wrong_parts_do_not() {
    let loaded = Loaded::new("minimal.toml");
    let segments = [24];
    let settings = CyltraceCheckSettings {
        segments: segments.as_ptr(),
        segment_count: 1,
        ..SETTINGS
    };
    let (code, mut outcome, threads) = check(&loaded, &settings, None);
    assert_eq!((code, threads), (CYLTRACE_OK, 1), "{}", text(outcome.text));
    assert_eq!((outcome.violations, outcome.unwitnessed_rows), (0, 0));
    assert!(outcome.rays >= 4_000);
    let json: serde_json::Value = serde_json::from_str(&text(outcome.json)).expect("JSON");
    assert_eq!(json["holds"], true);
    assert_eq!(json["rays"], outcome.rays);
    let classes = json["classes"].as_array().expect("a list");
    let has = |class: &str| {
        classes
            .iter()
            .any(|row| row["name"] == class && row["segments"] == 24)
    };
    assert!(has("sphere") && has("inside") && !has("axial"), "{json}");
    // Freed twice: the second time there is nothing left.
    for _ in 0..2 {
        // SAFETY: of the check, and a local.
        unsafe { cyltrace_check_outcome_free(&raw mut outcome) };
        assert!(outcome.text.is_null() && outcome.json.is_null());
    }

    // Every hit told to be of the disk at p0.
    let (code, mut outcome, _) = check(&loaded, &SETTINGS, Some(CYLTRACE_CAP0));
    assert_eq!(code, CYLTRACE_VIOLATIONS);
    assert!(outcome.violations > 100, "{}", text(outcome.text));
    let json: serde_json::Value = serde_json::from_str(&text(outcome.json)).expect("JSON");
    assert_eq!(json["holds"], false);
    assert!(!json["listed"].as_array().expect("a list").is_empty());
    // SAFETY: of the check, and a local.
    unsafe { cyltrace_check_outcome_free(&raw mut outcome) };
}

#[test]
fn what_cannot_be_checked_is_refused_with_its_reason() {
    let loaded = Loaded::new("minimal.toml");
    let two = [2];
    for (settings, part, reason) in [
        (SETTINGS, Some(9), "a hit's part is 9"),
        (
            CyltraceCheckSettings {
                classes: 64,
                ..SETTINGS
            },
            None,
            "classes is 64",
        ),
        (
            CyltraceCheckSettings {
                segments: two.as_ptr(),
                segment_count: 1,
                ..SETTINGS
            },
            None,
            "2 segments",
        ),
        (
            CyltraceCheckSettings {
                max_memory: 1,
                ..SETTINGS
            },
            None,
            "bytes",
        ),
    ] {
        let (code, outcome, _) = check(&loaded, &settings, part);
        assert_eq!(code, CYLTRACE_ERROR, "{reason}");
        assert!(last_error().contains(reason), "{reason}: {}", last_error());
        assert!(outcome.text.is_null() && outcome.json.is_null());
    }
}

#[test]
fn settings_beyond_their_limits_are_refused() {
    let loaded = Loaded::new("minimal.toml");
    let segments = [8_u32; 65];
    let misaligned = segments.as_ptr().cast::<u8>().wrapping_add(1).cast();
    for (settings, reason) in [
        (
            CyltraceCheckSettings {
                threads: 4_000_000_000,
                ..SETTINGS
            },
            "threads is 4000000000: it is at most 1024",
        ),
        (
            CyltraceCheckSettings {
                rays: u64::MAX,
                ..SETTINGS
            },
            "rays is 18446744073709551615: it is at most 1000000000",
        ),
        (
            CyltraceCheckSettings {
                most_listed: u64::MAX,
                ..SETTINGS
            },
            "most_listed is 18446744073709551615: it is at most 1000000",
        ),
        (
            CyltraceCheckSettings {
                segments: segments.as_ptr(),
                segment_count: 65,
                ..SETTINGS
            },
            "segment_count is 65: it is at most 64",
        ),
        (
            CyltraceCheckSettings {
                segments: segments.as_ptr(),
                segment_count: usize::MAX,
                ..SETTINGS
            },
            "segment_count is 18446744073709551615: it is at most 64",
        ),
        (
            CyltraceCheckSettings {
                segments: misaligned,
                segment_count: 1,
                ..SETTINGS
            },
            "segments is not aligned",
        ),
    ] {
        let (code, outcome, threads) = check(&loaded, &settings, None);
        assert_eq!((code, threads), (CYLTRACE_ERROR, 0), "{reason}");
        assert_eq!(last_error(), format!("cyltrace_check: {reason}"));
        assert!(outcome.text.is_null() && outcome.json.is_null());
    }
}

#[test]
fn arrays_that_no_program_can_have_are_refused() {
    let loaded = Loaded::new("minimal.toml");
    let rays = [CyltraceRay::from(&Ray::new(DVec3::ZERO, DVec3::X)); 2];
    let mut hits = [CyltraceHit::MISS; 2];
    let mut occluded = [0_u8; 2];
    let greatest = isize::MAX as usize;
    // The first count of rays whose bytes are more than a slice may have.
    let too_many = greatest / size_of::<CyltraceRay>() + 1;
    let misaligned = rays.as_ptr().cast::<u8>().wrapping_add(4).cast();
    for count in [usize::MAX, greatest, too_many] {
        // SAFETY: refused by the count, before anything is read or written.
        let codes = unsafe {
            [
                cyltrace_closest(loaded.0, rays.as_ptr(), count, hits.as_mut_ptr()),
                cyltrace_occluded(loaded.0, rays.as_ptr(), count, occluded.as_mut_ptr()),
            ]
        };
        assert_eq!(codes, [CYLTRACE_ERROR; 2], "{count}");
        let reason = format!("cyltrace_occluded: count is {count}: an array has at most ");
        assert!(last_error().starts_with(&reason), "{}", last_error());
    }
    // SAFETY: refused by the address, before anything is read or written.
    let code = unsafe { cyltrace_closest(loaded.0, misaligned, 1, hits.as_mut_ptr()) };
    assert_eq!(code, CYLTRACE_ERROR);
    assert_eq!(last_error(), "cyltrace_closest: an array is not aligned");
}

#[test]
fn rays_of_sizes_that_are_not_supported_are_misses() {
    let loaded = Loaded::new("minimal.toml");
    let ray = |origin: f64, direction: f64| CyltraceRay {
        origin: [origin, 0.0, 0.5],
        direction: [direction, 0.0, 0.0],
        t_min: f64::NEG_INFINITY,
        t_max: f64::INFINITY,
    };
    let rays = [
        ray(1e61, 1.0),
        ray(0.0, 1e-152),
        ray(0.0, 1e152),
        ray(0.0, f64::NAN),
        ray(f64::INFINITY, 1.0),
    ];
    let mut hits = [CyltraceHit::MISS; 5];
    // SAFETY: the arrays have five elements.
    let code = unsafe { cyltrace_closest(loaded.0, rays.as_ptr(), 5, hits.as_mut_ptr()) };
    assert_eq!(code, CYLTRACE_OK);
    assert!(hits.iter().all(|hit| hit.is_hit == 0));
}

#[test]
fn null_pointers_and_missing_files_are_refused() {
    let loaded = Loaded::new("minimal.toml");
    let ray = CyltraceRay::from(&Ray::new(DVec3::ZERO, DVec3::X));
    let mut outcome = CyltraceCheckOutcome::NOTHING;
    // SAFETY: null, or locals.
    unsafe {
        assert!(cyltrace_scene_load_checked(null(), &CyltraceLayout::LIBRARY).is_null());
        assert_eq!(last_error(), "cyltrace_scene_load: path is null");
        assert!(cyltrace_scene_load_checked(c"a.toml".as_ptr(), null()).is_null());
        assert_eq!(last_error(), "cyltrace_scene_load: program is null");
        assert!(
            cyltrace_scene_load_checked(c"nowhere/a.toml".as_ptr(), &CyltraceLayout::LIBRARY)
                .is_null()
        );
        assert!(last_error().contains("nowhere/a.toml"), "{}", last_error());
        let hits = null_mut();
        for (code, reason) in [
            (cyltrace_closest(null(), &raw const ray, 1, hits), "scene"),
            (
                cyltrace_closest(loaded.0, &raw const ray, 1, hits),
                "an array",
            ),
            (cyltrace_closest(loaded.0, null(), 1, hits), "an array"),
            (
                cyltrace_occluded(loaded.0, &raw const ray, 1, null_mut()),
                "an array",
            ),
        ] {
            assert_eq!(code, CYLTRACE_ERROR, "{reason}");
        }
        assert!(last_error().starts_with("cyltrace_occluded: an array is null"));
        let user = null_mut();
        for (scene, closest, outcome, reason) in [
            (
                null(),
                Some(answer as CyltraceClosestFunction),
                &raw mut outcome,
                "scene",
            ),
            (loaded.0.cast_const(), None, &raw mut outcome, "closest"),
            (
                loaded.0.cast_const(),
                Some(answer as _),
                null_mut(),
                "outcome",
            ),
        ] {
            let code = cyltrace_check(scene, null(), closest, user, outcome);
            assert_eq!(code, CYLTRACE_ERROR);
            assert_eq!(last_error(), format!("cyltrace_check: {reason} is null"));
        }
        cyltrace_scene_free(null_mut());
        cyltrace_check_outcome_free(null_mut());
    }
}
