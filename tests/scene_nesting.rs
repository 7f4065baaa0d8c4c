//! The deepest nesting that is promised loads and can be traced.

use std::fs;
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::scene::{GREATEST_DEPTH, load};
use cyltrace::tracer::{Options, Tracer};
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

#[test]
fn deepest_nesting_is_traced() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    fs::write(file.path(), nested(GREATEST_DEPTH)).expect("writing the scene");
    let scene = load(file.path()).unwrap_or_else(|error| panic!("{error}"));
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("a tracer");
    // 64 quarter turns are none; the cylinder's foot is lifted to z = 64.
    let down = Ray::new(DVec3::new(2.0, 0.0, 100.0), DVec3::NEG_Z);
    let hit = tracer.closest(&down).expect("the head of the cylinder");
    assert_eq!(hit.t, 35.0);
    assert_eq!(hit.instance, vec![0; GREATEST_DEPTH]);
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
    let census = scene.census();
    assert_eq!(census.cylinders_instanced, u128::MAX);
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("a tracer");
    let built = tracer.statistics();
    assert_eq!(built.cylinders_instanced, census.cylinders_instanced);
    assert_eq!(built.instances, census.instances);
}
