//! What cannot be saved is an error, and never another scene.

use std::io;

use cyltrace::scene::{
    Background, Color, Composition, CylinderList, CylinderRecord, Material, MaterialIndex,
    Placement, Prototype, PrototypeIndex, Records, Scene, SolidRecord, Sun, save,
};
use cyltrace::solid::{Caps, Cylinder, Disk, Sphere};
use glam::{DAffine3, DVec3};

use super::{assert_same, of_solids, sample, saved};

fn error(scene: &Scene) -> String {
    let error = save(scene, "x", |_| Ok(io::sink()), |_| Ok(())).expect_err("no scene of a file");
    error.to_string()
}

fn ball() -> Composition {
    Composition::Solid(Sphere::new(DVec3::ZERO, 1.0).expect("a sphere").into())
}

fn of_composition(solid: Composition) -> Scene {
    let mut scene = of_solids([]);
    let record = SolidRecord::new(solid, 0, MaterialIndex(0));
    scene.prototypes[0].solids.compositions.push(record);
    scene
}

#[test]
fn what_scene_files_cannot_state_is_an_error() {
    let cylinder = |radius| Cylinder::from_valid(DVec3::ZERO, DVec3::X, radius, Caps::None);
    let changed = |change: fn(&mut Scene)| {
        let mut scene = sample("minimal.toml");
        change(&mut scene);
        scene
    };
    let many = [cylinder(f64::NAN); 20].map(Into::into);
    let mixed = [Records::F64, Records::F32].map(|records| {
        let mut prototype = Prototype::default();
        prototype.solids.cylinders = CylinderList::new(records);
        let record = CylinderRecord::new(&cylinder(1.0), 0, MaterialIndex(0));
        prototype.solids.cylinders.push(record).expect("a cylinder");
        prototype.name = "a".to_owned();
        prototype
    });
    let disk = Disk::new(DVec3::ZERO, DVec3::X, 1.0).expect("a disk");
    let cases = [
        (Scene::new(Vec::new()), "no prototypes"),
        (
            Scene::new(vec![Prototype::default(); 2]),
            "prototype 1 has the name \"\"",
        ),
        (Scene::new(mixed.to_vec()), "in f64 and in f32"),
        (
            of_solids([cylinder(f64::NAN).into()]),
            "radius of [[cylinder]] is NaN",
        ),
        (of_solids(many), "a number of the cylinder 0 is NaN"),
        (of_composition(ball()), "is a single solid"),
        (
            of_composition(Composition::Union(Vec::new())),
            "has no operands",
        ),
        (
            of_composition(Composition::Union(vec![Composition::Solid(disk.into())])),
            "not closed",
        ),
        (
            of_composition(Composition::Union(vec![Composition::Solid(
                cylinder(1.0).into(),
            )])),
            "not closed",
        ),
        (changed(|scene| scene.materials.clear()), "default one"),
        (
            changed(|scene| scene.materials[0].color = Color::Constant(DVec3::splat(0.4))),
            "default one",
        ),
        (
            changed(|scene| scene.background = Background::Color(DVec3::INFINITY)),
            "background is inf",
        ),
        (
            changed(|scene| {
                scene.materials.push(Material::diffuse("", DVec3::ZERO));
            }),
            "has the name \"\"",
        ),
        (
            changed(|scene| {
                scene.sun = Some(Sun {
                    direction: DVec3::splat(1.0),
                    color: DVec3::ONE,
                    strength: 1.0,
                    angle_degrees: 0.5,
                });
            }),
            "the length 1.73",
        ),
        (
            changed(|scene| {
                let record = SolidRecord::new(ball_solid(), 99, MaterialIndex(77));
                scene.prototypes[0].solids.push(record).expect("a sphere");
            }),
            "no material 77",
        ),
        (
            changed(|scene| {
                scene.prototypes[0].placements.push(Placement {
                    of: PrototypeIndex(5),
                    parent_from_child: DAffine3::IDENTITY,
                });
            }),
            "no prototype 5",
        ),
    ];
    for (scene, text) in cases {
        let message = error(&scene);
        assert!(message.contains(text), "{message}\nis not: {text}");
    }
}

fn ball_solid() -> cyltrace::solid::AnySolid {
    Sphere::new(DVec3::ZERO, 1.0).expect("a sphere").into()
}

#[test]
fn operations_are_saved_as_deep_as_they_are_read() {
    use cyltrace::math::Orientation;
    use cyltrace::solid::Cuboid;

    let turned = Orientation::IDENTITY.rotated_x(30.0);
    let cuboid = Cuboid::new(DVec3::ZERO, DVec3::ONE, turned).expect("a cuboid");
    let nested = |levels| {
        let innermost = Composition::Solid(cuboid.into());
        of_composition((0..levels).fold(innermost, |part, _| Composition::Union(vec![part])))
    };
    let scene = nested(26);
    assert_same(&scene, &saved(&scene), "26 levels");
    let message = error(&nested(27));
    assert!(message.contains("26 levels"), "{message}");
}

#[test]
fn outputs_that_fail_and_names_of_folders_are_errors() {
    let scene = sample("minimal.toml");
    let full = |_: &str| Err::<Vec<u8>, _>(io::Error::other("the disk is full"));
    let message = save(&scene, "x", full, |_| Ok(()))
        .expect_err("no output")
        .to_string();
    assert_eq!(message, "cannot write x.toml: the disk is full");
    for stem in ["", "a/b", "..\\a"] {
        let error = save(&scene, stem, |_| Ok(Vec::new()), |_| Ok(())).expect_err("no stem");
        assert!(error.to_string().contains("names of files"), "{error}");
    }
}

/// A scene file has a limit, which solids without tables reach.
#[test]
fn scene_files_that_are_too_large_are_an_error() {
    let solid = Sphere::new(DVec3::splat(-1.0 / 3.0), 1.0 / 3.0).expect("a sphere");
    let scene = of_solids(std::iter::repeat_n(solid.into(), 700_000));
    let message = error(&scene);
    assert!(message.contains("67108864 bytes"), "{message}");
}
