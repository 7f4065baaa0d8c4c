//! Verdicts on meshes and on hits of other programs, for solids of every kind and
//! compositions: none is false, and real defects are found.

use std::sync::Arc;

use crate::meshes::{compared_with, go_on, row};
use cyltrace::math::{Orientation, Ray};
use cyltrace::scene::{MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord};
use cyltrace::solid::tessellation::{Fit, Mesh, deviation_of, mesh_of};
use cyltrace::solid::{
    AnySolid, Caps, Composition, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere,
};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{F32_TOLERANCE, Row, compare_hits, rays_around};
use glam::{DAffine3, DMat3, DVec3};
use test_support::solids::prototype_of;

const RAYS: u64 = 5_000;

/// How much the placed solids of a scene are stretched at most.
const STRETCH: f64 = 1.5;

/// Two solids of each kind, beside one another.
fn kinds() -> [[AnySolid; 2]; 6] {
    let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let cylinder = |x, caps| Cylinder::new(at(x, -1.0), at(x + 0.5, 1.0), 0.7, caps).unwrap();
    let cone = |x, r0, r1, caps| Cone::new(at(x, -1.0), at(x + 0.5, 1.0), r0, r1, caps).unwrap();
    let rounded = |x, r0, r1| RoundedCone::new(at(x, -0.6), at(x, 0.6), r0, r1).unwrap();
    let turned = Orientation::IDENTITY.rotated(DVec3::new(1.0, 2.0, 3.0), 40.0);
    let cuboid = |x| Cuboid::new(at(x, 0.0), DVec3::new(0.6, 0.5, 0.9), turned).unwrap();
    let sphere = |x, radius| Sphere::new(at(x, 0.0), radius).unwrap();
    let disk = |x, y| Disk::new(at(x, 0.0), DVec3::new(0.3, y, 0.2), 0.8).unwrap();
    [
        [
            cylinder(0.0, Caps::Both).into(),
            cylinder(3.0, Caps::P0).into(),
        ],
        [
            cone(0.0, 0.9, 0.2, Caps::None).into(),
            cone(3.0, 0.0, 0.9, Caps::P1).into(),
        ],
        [rounded(0.0, 0.7, 0.3).into(), rounded(3.0, 0.1, 0.9).into()],
        [sphere(0.0, 1.0).into(), sphere(3.0, 0.7).into()],
        [cuboid(0.0).into(), cuboid(3.0).into()],
        [disk(0.0, 1.0).into(), disk(3.0, -1.0).into()],
    ]
}

/// A drilled block, a lens, and two balls in one with a bite.
fn composed() -> Vec<Composition> {
    let sphere = |x, radius| {
        let center = DVec3::new(x, 0.0, 0.0);
        Composition::Solid(Sphere::new(center, radius).unwrap().into())
    };
    let block = Cuboid::new(DVec3::ZERO, DVec3::splat(0.8), Orientation::IDENTITY).unwrap();
    let drill = Cylinder::new(DVec3::Z * -2.0, DVec3::Z * 2.0, 0.5, Caps::Both).unwrap();
    let solid = |solid: AnySolid| Composition::Solid(solid);
    vec![
        Composition::Difference(vec![solid(block.into()), solid(drill.into())]),
        Composition::Intersection(vec![sphere(2.6, 1.0), sphere(3.4, 1.0)]),
        Composition::Difference(vec![
            Composition::Union(vec![sphere(6.0, 0.8), sphere(7.0, 0.6)]),
            sphere(6.6, 0.5),
        ]),
    ]
}

/// A prototype as the scene, and once more above, stretched and mirrored.
fn scene(mut root: Prototype) -> Arc<Scene> {
    let mut leaf = root.clone();
    leaf.name = "leaf".into();
    let scale = DVec3::new(-1.0, 0.8, STRETCH);
    root.placements = vec![Placement {
        of: PrototypeIndex(1),
        parent_from_child: DAffine3::from_mat3_translation(
            DMat3::from_rotation_x(0.3) * DMat3::from_diagonal(scale),
            DVec3::new(3.0, 0.0, 4.0),
        ),
    }];
    Arc::new(Scene::new(vec![root, leaf]))
}

fn scene_of_composed() -> Arc<Scene> {
    let mut prototype = Prototype::default();
    let records = (0..).zip(composed());
    prototype.solids.compositions = records
        .map(|(number, solid)| SolidRecord::new(solid, number, MaterialIndex(0)))
        .collect();
    scene(prototype)
}

fn tracer(scene: Arc<Scene>) -> Tracer {
    Tracer::new(scene, &Options::default()).expect("a tracer")
}

/// The row of the exact answers after a change.
fn compared(tracer: &Tracer, rays: &[Ray], change: impl Fn(Option<f64>) -> Option<f64>) -> Row {
    let answers = rays.iter().map(|ray| tracer.closest(ray).map(|hit| hit.t));
    let reported: Vec<_> = answers.map(change).collect();
    row(compare_hits(
        tracer,
        rays,
        &reported,
        F32_TOLERANCE,
        3,
        &go_on,
    ))
}

/// Hits of a renderer in f32 are never called wrong, and wrong ones are found.
fn judge_hits(scene: Arc<Scene>, what: &str) {
    let tracer = tracer(scene);
    let rays = rays_around(&tracer, 7, RAYS);
    let right = compared(&tracer, &rays, |t| t);
    assert!(right.hits > RAYS / 10, "{what}: {}", right.hits);
    assert_eq!((right.violations, right.band), (0, 0), "{what}");
    let rounded = compared(&tracer, &rays, |t| t.map(|t| f64::from(t as f32)));
    assert_eq!((rounded.violations, rounded.band), (0, 0), "{what}");
    for factor in [1.0 - 1e-3, 1.0 + 1e-3] {
        let moved = compared(&tracer, &rays, |t| t.map(|t| t * factor));
        let [found, all] = [moved.violations, moved.hits];
        println!("{what}: {found} of {all} at {factor}");
        assert!(
            100 * found > 98 * all,
            "{what}: {found} of {all} at {factor}"
        );
    }
    let lost = compared(&tracer, &rays, |_| None);
    println!("{what}: {} of {} lost", lost.violations, lost.hits);
    assert!(
        10 * lost.violations > 8 * lost.hits,
        "{what}: {}",
        lost.violations
    );
    let invented = compared(&tracer, &rays, |t| t.or(Some(1.0)));
    let [found, all] = [invented.violations, invented.rays - invented.hits];
    println!("{what}: {found} of {all} invented");
    assert!(100 * found > 98 * all, "{what}: {found} of {all} invented");
}

#[test]
fn wrong_hits_of_every_kind_are_found_and_right_ones_agree() {
    for solids in kinds() {
        let what = solids[0].kind().name();
        judge_hits(scene(prototype_of(&solids)), what);
    }
}

#[test]
fn wrong_hits_of_composed_solids_are_found_and_right_ones_agree() {
    judge_hits(scene_of_composed(), "composed");
}

/// On the wall of the drill, out of the block, there is nothing; but near it something
/// may be, as far as is known.
#[test]
fn hits_on_what_is_taken_away_are_never_said_to_agree() {
    let tracer = tracer(scene_of_composed());
    let at = |ray: Ray, t: f64| {
        let reported = [Some(t)];
        row(compare_hits(
            &tracer,
            &[ray],
            &reported,
            F32_TOLERANCE,
            3,
            &go_on,
        ))
    };
    // Past the block, and through the drill above it to its top.
    let past = Ray::new(DVec3::new(-5.0, 0.0, 1.5), DVec3::X);
    assert!(tracer.closest(&past).is_none());
    let above = Ray::new(DVec3::new(-5.0, 0.0, 2.5), DVec3::new(5.65, 0.0, -1.7));
    let t = tracer.closest(&above).expect("the top").t;
    assert!((t - 1.0).abs() < 1e-12, "{t}");
    for (ray, at_drill, before) in [(past, 4.5, 4.4), (above, 4.5 / 5.65, 0.7)] {
        let found = at(ray, at_drill);
        assert_eq!((found.violations, found.band), (0, 1));
        assert_eq!(at(ray, before).violations, 1);
    }
}

/// The meshes of all single solids of a scene, and by how much they may be off.
fn meshes(scene: &Scene, segments: u32, fit: Fit) -> (Vec<Mesh>, f64) {
    let [root, leaf] = &scene.prototypes[..] else {
        panic!("two prototypes");
    };
    let map = root.placements[0].parent_from_child;
    let mut deviation: f64 = 0.0;
    let mut all = Vec::new();
    for (prototype, map) in [(root, DAffine3::IDENTITY), (leaf, map)] {
        for (_, solid) in prototype.singles() {
            let mut mesh = mesh_of(&solid, segments, fit);
            for vertex in &mut mesh.vertices {
                *vertex = map.transform_point3(*vertex);
            }
            all.push(mesh);
            deviation = deviation.max(STRETCH * deviation_of(&solid, segments, fit));
        }
    }
    (all, deviation)
}

#[test]
fn right_meshes_of_every_kind_agree_and_wrong_ones_do_not() {
    for solids in kinds() {
        let what = solids[0].kind().name();
        let scene = scene(prototype_of(&solids));
        let tracer = tracer(scene.clone());
        for segments in [12, 48] {
            for fit in [Fit::Inscribed, Fit::Circumscribed] {
                let (meshes, deviation) = meshes(&scene, segments, fit);
                let found = compared_with(&tracer, &meshes, (0, RAYS), deviation);
                let what = format!("{what} {segments} {fit:?}");
                assert_eq!(found.violations, 0, "{what}");
                let share = found.band as f64 / RAYS as f64;
                println!("{what}: band {share}");
                assert!(share < 1.5 / f64::from(segments), "{what}: band {share}");
            }
        }
        let (right, deviation) = meshes(&scene, 48, Fit::Inscribed);
        for missing in 0..right.len() {
            let mut some = right.clone();
            some.remove(missing);
            let found = compared_with(&tracer, &some, (0, RAYS), deviation).violations;
            println!("{what} without {missing}: {found}");
            assert!(found > RAYS / 100, "{what} without {missing}: {found}");
            // A solid that is moved by some deviations is found as well.
            let mut moved = right.clone();
            for vertex in &mut moved[missing].vertices {
                *vertex += DVec3::new(0.1, 0.1, 0.1);
            }
            let found = compared_with(&tracer, &moved, (0, RAYS), deviation).violations;
            assert!(found > RAYS / 100, "{what}: {missing} moved: {found}");
        }
    }
}
