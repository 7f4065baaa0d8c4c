//! One far or huge solid changes nothing for the others: they have the hits, bit for bit,
//! of the scene without it, and those that trying every solid finds.

use std::sync::Arc;

use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::scene::{
    Composition, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord,
};
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use cyltrace::tracer::{BuildTime, DEFAULT_BATCH, Hit, Layout, Options, Tracer};
use glam::{DAffine3, DVec3};
use test_support::solids::{KINDS, any_solid, prototype_of};
use test_support::{placed, placing, scene_of};

const SEED: u64 = 20_261_129;
const COUNT: u32 = 200;
const RAYS: u64 = 400;

fn tracer(scene: &Arc<Scene>, layout: Layout) -> Tracer {
    let options = Options {
        layout,
        ..Options::default()
    };
    Tracer::new(Arc::clone(scene), &options).expect("a tracer")
}

/// Solids in the unit cube, moved; of one kind, or of all kinds by turns.
fn solids(kind: Option<u64>, offset: DVec3) -> Vec<AnySolid> {
    let solid = |number: u64| {
        let mut random = Random::new(SEED, number);
        let kind = kind.unwrap_or(number % KINDS);
        moved(&any_solid(&mut random, kind, Caps::Both, true), offset)
    };
    (0..u64::from(COUNT)).map(solid).collect()
}

fn moved(solid: &AnySolid, by: DVec3) -> AnySolid {
    match *solid {
        AnySolid::Cylinder(one) => {
            Cylinder::new(one.p0() + by, one.p1() + by, one.radius(), one.caps())
                .unwrap()
                .into()
        }
        AnySolid::Cone(one) => Cone::new(
            one.p0() + by,
            one.p1() + by,
            one.radius0(),
            one.radius1(),
            one.caps(),
        )
        .unwrap()
        .into(),
        AnySolid::RoundedCone(one) => {
            RoundedCone::new(one.p0() + by, one.p1() + by, one.radius0(), one.radius1())
                .unwrap()
                .into()
        }
        AnySolid::Sphere(one) => Sphere::new(one.center() + by, one.radius()).unwrap().into(),
        AnySolid::Cuboid(one) => {
            let (half_widths, orientation) = (one.half_widths(), one.orientation());
            Cuboid::new(one.center() + by, half_widths, orientation)
                .unwrap()
                .into()
        }
        AnySolid::Disk(one) => Disk::new(one.center() + by, one.normal(), one.radius())
            .unwrap()
            .into(),
    }
}

/// Outliers by name: each kind of solid far away, and huge ones around and below.
fn outliers() -> Vec<(String, Vec<AnySolid>)> {
    let far = |kind| {
        let mut random = Random::new(SEED, 1_000 + kind);
        let offset = random.direction() * 1e7;
        moved(&any_solid(&mut random, kind, Caps::Both, true), offset)
    };
    let plate = |z: f64| {
        let half_widths = DVec3::new(5e5, 5e5, 0.5);
        let center = DVec3::new(0.5, 0.5, z);
        AnySolid::from(Cuboid::new(center, half_widths, Orientation::IDENTITY).unwrap())
    };
    let shell = Sphere::new(DVec3::splat(0.5), 1e6).unwrap().into();
    let rod = Cylinder::new(DVec3::X * -1e6, DVec3::X * 1e6, 1e-3, Caps::Both)
        .unwrap()
        .into();
    let mut outliers: Vec<_> = (0..KINDS)
        .map(|kind| (format!("far, kind {kind}"), vec![far(kind)]))
        .collect();
    outliers.push(("plate".to_owned(), vec![plate(-2.0)]));
    outliers.push(("shell".to_owned(), vec![shell]));
    outliers.push(("rod".to_owned(), vec![rod]));
    let mut all: Vec<AnySolid> = (0..KINDS).map(far).collect();
    all.extend([plate(-2.0), plate(1e6), shell]);
    outliers.push(("all together".to_owned(), all));
    outliers
}

/// A ray at the unit cube, moved, from near or far, or somewhere else.
fn ray(number: u64, offset: DVec3) -> Ray {
    let mut random = Random::new(SEED, 10_000 + number);
    let target = DVec3::new(random.unit(), random.unit(), random.unit()) + offset;
    let distance = match number % 4 {
        0 => random.log_uniform(1e-3, 1.0),
        1 => random.log_uniform(1.0, 1e3),
        _ => random.log_uniform(1e3, 1e9),
    };
    let heading = random.direction();
    let direction = if number % 16 == 5 {
        random.direction()
    } else {
        heading
    };
    Ray::new(
        target - heading * distance,
        direction * random.log_uniform(1e-3, 1e3),
    )
}

/// Compares a scene with the same without outliers. `is_outlier` knows their hits.
fn assert_same(
    name: &str,
    with: &Tracer,
    without: &Tracer,
    offset: DVec3,
    is_outlier: impl Fn(&Hit) -> bool,
) {
    let rays: Vec<Ray> = (0..RAYS).map(|number| ray(number, offset)).collect();
    let (mut batch, mut blocked) = (Vec::new(), Vec::new());
    with.closest_batch(&rays, &mut batch);
    with.occluded_batch(&rays, &mut blocked);
    let mut found = 0;
    for (number, ray) in rays.iter().enumerate() {
        let replay = || format!("{name}, ray {number}: {}", test_support::bits(ray));
        let hits: Vec<Hit> = with.all_hits(ray, DEFAULT_BATCH).collect();
        let others = hits.iter().filter(|hit| !is_outlier(hit));
        let expected: Vec<Hit> = without.all_hits(ray, DEFAULT_BATCH).collect();
        assert!(others.eq(&expected), "{}: {hits:?}, {expected:?}", replay());

        let first = with.closest(ray);
        assert_eq!(first, with.closest_exhaustive(ray), "{}", replay());
        assert_eq!(first.as_ref(), hits.first(), "{}", replay());
        assert_eq!(first, batch[number], "{}", replay());
        assert_eq!(first.is_some(), with.occluded(ray), "{}", replay());
        assert_eq!(first.is_some(), blocked[number], "{}", replay());
        let point = first.as_ref().map_or(ray.origin, |hit| hit.point);
        assert_eq!(
            with.contains(point),
            with.contains_exhaustive(point),
            "{}",
            replay()
        );
        found += usize::from(!expected.is_empty());
    }
    assert!(
        found > 50,
        "{name}: only {found} rays meet what is no outlier"
    );
}

fn with_outliers(solids: &[AnySolid], outliers: &[AnySolid]) -> Prototype {
    prototype_of(&[solids, outliers].concat())
}

#[test]
fn outliers_change_no_hit_of_any_kind_of_solid() {
    for kind in (0..KINDS).map(Some).chain([None]) {
        let solids = solids(kind, DVec3::ZERO);
        for layout in [Layout::Single, Layout::Block] {
            let without = tracer(&scene_of(vec![prototype_of(&solids)]), layout);
            for (name, outliers) in outliers() {
                let with = tracer(&scene_of(vec![with_outliers(&solids, &outliers)]), layout);
                let name = format!("kind {kind:?}, {name}, {layout:?}");
                assert_same(&name, &with, &without, DVec3::ZERO, |hit| {
                    hit.primitive >= COUNT
                });
            }
        }
    }
}

#[test]
fn row_of_zeros_among_large_coordinates_changes_no_hit() {
    let offset = DVec3::new(500_000.0, 5_000_000.0, 300.0);
    let solids = solids(None, offset);
    let zero = Cylinder::new(DVec3::ZERO, DVec3::Z * 0.5, 0.25, Caps::Both).unwrap();
    let without = tracer(&scene_of(vec![prototype_of(&solids)]), Layout::Single);
    let with = scene_of(vec![with_outliers(&solids, &[zero.into()])]);
    let with = tracer(&with, Layout::Single);
    assert_same("zeros", &with, &without, offset, |hit| {
        hit.primitive >= COUNT
    });
}

#[test]
fn composed_outlier_changes_no_hit() {
    let solids = solids(None, DVec3::ZERO);
    let without = tracer(&scene_of(vec![prototype_of(&solids)]), Layout::Single);
    let part = |x| Composition::Solid(Sphere::new(DVec3::new(x, 3e6, 0.0), 4.0).unwrap().into());
    let mut prototype = prototype_of(&solids);
    let number = COUNT;
    let solid = Composition::Difference(vec![part(0.0), part(3.0)]);
    let record = SolidRecord::new(solid, number, MaterialIndex(0));
    prototype.solids.compositions.push(record);
    let with = tracer(&scene_of(vec![prototype]), Layout::Single);
    assert_same("composed", &with, &without, DVec3::ZERO, |hit| {
        hit.primitive >= COUNT
    });
}

/// Poses around the unit cube, one of them the identity.
fn poses(count: u64) -> Vec<DAffine3> {
    let pose = |number| {
        let mut random = Random::new(SEED, 5_000 + number);
        let rotation = glam::DQuat::from_axis_angle(random.direction(), random.unit());
        let scale = DVec3::splat(random.log_uniform(0.5, 2.0));
        let translation = random.direction() * random.uniform(0.0, 20.0);
        DAffine3::from_scale_rotation_translation(scale, rotation, translation)
    };
    (1..count).map(pose).chain([DAffine3::IDENTITY]).collect()
}

#[test]
fn outliers_of_placed_prototypes_change_no_hit() {
    let solids = solids(None, DVec3::ZERO);
    let around: Vec<Placement> = poses(50).into_iter().map(|pose| placed(2, pose)).collect();
    let scene = |leaf: Prototype| {
        let here = placed(1, DAffine3::from_translation(DVec3::X * 0.25));
        scene_of(vec![placing(vec![here]), placing(around.clone()), leaf])
    };
    let without = tracer(&scene(prototype_of(&solids)), Layout::Single);
    for (name, outliers) in outliers() {
        let with = tracer(&scene(with_outliers(&solids, &outliers)), Layout::Single);
        let name = format!("placed, {name}");
        assert_same(&name, &with, &without, DVec3::ZERO, |hit| {
            hit.primitive >= COUNT
        });
    }
}

#[test]
fn far_and_huge_placements_change_no_hit() {
    let leaf = || prototype_of(&solids(None, DVec3::ZERO));
    let near: Vec<Placement> = poses(50).into_iter().map(|pose| placed(1, pose)).collect();
    let without = tracer(
        &scene_of(vec![placing(near.clone()), leaf()]),
        Layout::Single,
    );
    let far = DAffine3::from_translation(DVec3::new(1e7, 3e6, -2e7));
    let huge = DAffine3::from_scale_rotation_translation(
        DVec3::splat(1e6),
        glam::DQuat::IDENTITY,
        DVec3::splat(-5e5),
    );
    for (name, poses) in [
        ("far", vec![far]),
        ("huge", vec![huge]),
        ("both", vec![far, huge]),
    ] {
        let outliers = poses.into_iter().map(|pose| placed(1, pose));
        let all = placing(near.iter().copied().chain(outliers).collect());
        let with = tracer(&scene_of(vec![all, leaf()]), Layout::Single);
        let name = format!("placement, {name}");
        assert_same(&name, &with, &without, DVec3::ZERO, |hit| {
            hit.instance[0] >= 50
        });
    }
}

/// Clusters and single solids at all distances and of all sizes, placed at all
/// distances: no hit is lost in any grouping.
#[test]
fn scenes_of_all_scales_lose_no_hit() {
    let scales = |seed: u64| {
        let mut random = Random::new(SEED, 20_000 + seed);
        let mut all = Vec::new();
        for _ in 0..1 + random.below(6) {
            let offset = random.direction() * random.log_uniform(1e-3, 1e10);
            let count = if random.below(2) == 0 { 1 } else { 60 };
            let size = random.log_uniform(1e-3, 1e3);
            for _ in 0..count {
                let kind = random.below(KINDS);
                let solid = any_solid(&mut random, kind, Caps::Both, true);
                all.push(moved(&solid, offset * size));
            }
        }
        all
    };
    for seed in 0..30 {
        let leaf = scales(seed);
        let mut random = Random::new(SEED, 30_000 + seed);
        let mut pose = || {
            let rotation = glam::DQuat::from_axis_angle(random.direction(), random.unit());
            let scale = DVec3::splat(random.log_uniform(1e-4, 1e4));
            let translation = random.direction() * random.log_uniform(1e-3, 1e8);
            DAffine3::from_scale_rotation_translation(scale, rotation, translation)
        };
        let poses: Vec<DAffine3> = (0..8).map(|_| pose()).collect();
        let root = Prototype {
            placements: poses.iter().map(|&pose| placed(1, pose)).collect(),
            ..prototype_of(&scales(100 + seed))
        };
        let leaf_scene = prototype_of(&leaf);
        let scene = scene_of(vec![root, leaf_scene]);
        let tracer = tracer(&scene, Layout::Single);
        let mut found = 0;
        for number in 0..RAYS {
            let mut random = Random::new(SEED, 40_000 + RAYS * seed + number);
            let solid = &leaf[random.below(leaf.len() as u64) as usize];
            let pose = poses[random.below(8) as usize];
            let bounds = solid.bounds();
            let target = pose.transform_point3(bounds.center());
            let size = pose.transform_vector3(bounds.extent()).length();
            let origin = target + random.direction() * size * random.log_uniform(0.1, 1e8);
            let ray = Ray::new(origin, target - origin);
            let replay = || format!("scene {seed}, ray {number}: {}", test_support::bits(&ray));
            let first = tracer.closest(&ray);
            assert_eq!(first, tracer.closest_exhaustive(&ray), "{}", replay());
            assert_eq!(first.is_some(), tracer.occluded(&ray), "{}", replay());
            let all = tracer.all_hits(&ray, 2).next();
            assert_eq!(first, all, "{}", replay());
            found += u64::from(first.is_some());
        }
        assert!(found > RAYS / 4, "scene {seed}: only {found} hits");
    }
}

#[test]
fn outlier_that_no_ray_reaches_is_not_built() {
    let solids = solids(None, DVec3::ZERO);
    let far = Sphere::new(DVec3::X * 1e7, 1.0).unwrap();
    let bytes = |prototype: Prototype, build| {
        let options = Options {
            build,
            ..Options::default()
        };
        let tracer = Tracer::new(scene_of(vec![prototype]), &options).unwrap();
        let _ = tracer.closest(&Ray::new(DVec3::new(0.5, 0.5, 5.0), DVec3::NEG_Z));
        tracer.statistics().embree_bytes
    };
    let with = || with_outliers(&solids, &[far.into()]);
    let without = bytes(prototype_of(&solids), BuildTime::WhenReached);
    assert_eq!(bytes(with(), BuildTime::WhenReached), without);
    assert!(bytes(with(), BuildTime::AtOnce) > without);
    assert_eq!(
        PrototypeIndex::ROOT,
        cyltrace::tracer::outliers(&scene_of(vec![with()]))[0].prototype
    );
}
