//! The callbacks that outliers cost other rays, and which solids count as outliers.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{Outlier, outliers};
use crate::math::{Orientation, Random, Ray};
use crate::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord, Solids,
};
use crate::solid::{Caps, Cuboid, Cylinder, SolidKind, Sphere};
use crate::tracer::{Options, Tracer};

const SEED: u64 = 20_261_128;

fn record(number: u32, p0: DVec3, p1: DVec3, radius: f64) -> CylinderRecord {
    let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).expect("a cylinder");
    CylinderRecord::new(&cylinder, number, MaterialIndex(0))
}

/// Twigs of a millimetre within 2 m of a point, each 5 cm long.
fn twigs(center: DVec3, count: u32) -> Vec<CylinderRecord> {
    let twig = |number: u32| {
        let mut random = Random::new(SEED, u64::from(number));
        let p0 = center + DVec3::from_array([(); 3].map(|()| random.uniform(-2.0, 2.0)));
        record(number, p0, p0 + random.direction() * 0.05, 0.001)
    };
    (0..count).map(twig).collect()
}

/// The mean number of callbacks of rays at twigs, the first hits and occlusion together.
fn callbacks(prototypes: Vec<Prototype>, center: DVec3) -> f64 {
    let scene = Arc::new(Scene::new(prototypes));
    let tracer = Tracer::new(scene, &Options::default()).expect("a tracer");
    let rays = 500;
    let counts = (0..rays).map(|number| {
        let mut random = Random::new(SEED, 1_000_000 + number);
        let mut near = || center + random.direction() * 1.5;
        let (origin, target) = (near(), near());
        let ray = Ray::new(origin, target - origin);
        let (first, occluded) = (
            tracer.first_hit_and_callbacks(&ray).1,
            tracer.occluded_and_callbacks(&ray).1,
        );
        u64::from(first + occluded)
    });
    counts.sum::<u64>() as f64 / rays as f64
}

fn root(cylinders: Vec<CylinderRecord>) -> Prototype {
    Prototype {
        solids: Solids::of_cylinders(cylinders),
        ..Prototype::default()
    }
}

/// Placements of the second prototype.
fn placing(translations: &[DVec3]) -> Prototype {
    let placement = |&translation: &DVec3| Placement {
        of: PrototypeIndex(1),
        parent_from_child: DAffine3::from_translation(translation),
    };
    Prototype {
        placements: translations.iter().map(placement).collect(),
        ..Prototype::default()
    }
}

const COUNT: u32 = 3_000;

/// Each outlier costs a ray at most one callback at each level of placements, at which the ray
/// enters its box.
fn assert_few_more(name: &str, with: f64, without: f64) {
    assert!(
        with <= without + 2.0,
        "{name}: {with} callbacks a ray, {without} without the outlier"
    );
}

#[test]
fn outliers_cost_no_callbacks_for_each_solid() {
    let center = DVec3::ZERO;
    let near = twigs(center, COUNT);
    let without = callbacks(vec![root(near.clone())], center);
    for distance in [1e5, 1e7, 1e12] {
        let far = DVec3::X * distance;
        let mut cylinders = near.clone();
        cylinders.push(record(COUNT, far, far + DVec3::Z, 1.0));
        let with = callbacks(vec![root(cylinders)], center);
        assert_few_more(&format!("far {distance:e}"), with, without);
    }
    let mut plate = root(near.clone());
    let sides = DVec3::new(5e5, 5e5, 1.0);
    let ground = Cuboid::new(DVec3::Z * -5.0, sides, Orientation::IDENTITY).expect("a cuboid");
    plate
        .solids
        .cuboids
        .push(SolidRecord::new(ground, COUNT, MaterialIndex(0)));
    assert_few_more("plate", callbacks(vec![plate], center), without);

    let utm = DVec3::new(5e5, 5e6, 100.0);
    let mut cylinders = twigs(utm, COUNT);
    let without = callbacks(vec![root(cylinders.clone())], utm);
    cylinders.push(record(COUNT, DVec3::ZERO, DVec3::Z * 0.1, 0.1));
    assert_few_more("UTM", callbacks(vec![root(cylinders)], utm), without);
}

#[test]
fn outliers_of_placed_prototypes_and_far_placements_cost_no_callbacks_for_each_solid() {
    let center = DVec3::ZERO;
    let near = twigs(center, COUNT / 10);
    let many: Vec<DVec3> = (0..COUNT)
        .map(|number| {
            let mut random = Random::new(SEED, 2_000_000 + u64::from(number));
            random.direction() * random.uniform(0.0, 200.0)
        })
        .chain([center])
        .collect();
    let without = callbacks(vec![placing(&many), root(near.clone())], center);

    let mut cylinders = near.clone();
    cylinders.push(record(
        COUNT,
        DVec3::X * 1e7,
        DVec3::X * 1e7 + DVec3::Z,
        1.0,
    ));
    let with = callbacks(vec![placing(&many), root(cylinders)], center);
    assert_few_more("in a prototype", with, without);

    let mut places = many;
    places.push(DVec3::Y * 1e8);
    let with = callbacks(vec![placing(&places), root(near)], center);
    assert_few_more("a placement", with, without);
}

#[test]
fn outliers_are_named_with_their_distance_and_size() {
    let mut one = root(twigs(DVec3::ZERO, COUNT));
    let far = Sphere::new(DVec3::X * 1e7, 1.0).expect("a sphere");
    one.solids
        .spheres
        .push(SolidRecord::new(far, COUNT + 7, MaterialIndex(0)));
    let found = outliers(&Scene::new(vec![one]));
    let [
        Outlier {
            prototype: PrototypeIndex::ROOT,
            kind: Some(SolidKind::Sphere),
            number,
            distance,
            size,
        },
    ] = found[..]
    else {
        panic!("{found:?}");
    };
    assert_eq!(number, COUNT + 7);
    // The twigs fill a cube of 4 m, whose half diagonal is 3.46 m, to within some millimetres.
    assert!((distance / (1e7 / 3.46) - 1.0).abs() < 0.03, "{distance}");
    assert!((size / (3_f64.sqrt() / 3.46) - 1.0).abs() < 0.03, "{size}");

    let ordinary = root(twigs(DVec3::ZERO, COUNT));
    assert_eq!(outliers(&Scene::new(vec![ordinary])), []);
}
