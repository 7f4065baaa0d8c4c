//! The tables of solids, their poses and the set operations of solids, as
//! `docs/scene-file.md` has them.

use std::fs;

use cyltrace::math::Orientation;
use cyltrace::scene::{Composition, Prototype, Scene, load};
use cyltrace::solid::{
    AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, SolidKind, Sphere,
};
use glam::{DMat3, DVec3};

const NEURON: &str = "1 1 0 0 0 2 -1\n2 3 0 0 5 0.5 1\n3 3 0 0 5 0.25 2\n4 3 0 4 5 0 2\n";

fn scene(text: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("neuron.swc"), NEURON).expect("writing the neuron");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("writing the scene");
    load(&path).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

fn root(text: &str) -> Prototype {
    scene(text).prototypes.remove(0)
}

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn cylinder(p0: DVec3, p1: DVec3, radius: f64) -> Cylinder {
    Cylinder::new(p0, p1, radius, Caps::Both).expect("a cylinder")
}

fn sphere(center: DVec3, radius: f64) -> Sphere {
    Sphere::new(center, radius).expect("a sphere")
}

fn cuboid(center: DVec3, half_widths: DVec3, orientation: Orientation) -> Cuboid {
    Cuboid::new(center, half_widths, orientation).expect("a cuboid")
}

fn leaf(solid: impl Into<AnySolid>) -> Composition {
    Composition::Solid(solid.into())
}

#[test]
fn each_kind_has_its_table_and_its_number() {
    let solids = "[[union]]\nof = [{ sphere = { center = [9, 9, 9], radius = 1 } }]\nmaterial = \"m\"\n\
         [[disk]]\ncenter = [0, 0, 1]\nnormal = [0, 3, 4]\nradius = 2\nmaterial = \"m\"\n\
         [[rounded_cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 2]\nradius0 = 1\nradius1 = 0\nmaterial = \"m\"\n\
         [[cone]]\np0 = [0, 0, 0]\np1 = [0, 0, 2]\nradius0 = 1\nradius1 = 0.5\ncaps = \"p1\"\nmaterial = \"m\"\n\
         [[cuboid]]\nhalf_widths = [1, 2, 3]\nmaterial = \"m\"\n\
         [[cuboid]]\ncenter = [7, 8, 9]\nhalf_widths = [1, 2, 3]\nmaterial = \"m\"\n\
         [[sphere]]\ncenter = [1, 2, 3]\nradius = 4\nmaterial = \"m\"\n\
         [[intersection]]\nof = [{ sphere = { center = [9, 9, 9], radius = 1 } }]\nmaterial = \"m\"\n\
         [[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\nmaterial = \"m\"\n\
         [[difference]]\nof = [{ sphere = { center = [9, 9, 9], radius = 1 } }]\nmaterial = \"m\"\n";
    let material = "[[material]]\nname = \"m\"\ncolor = [1, 0, 0]\n";
    let prototype = solids.replace("[[", "[[prototype.");
    let scene = scene(&format!(
        "{solids}{material}[[prototype]]\nname = \"a\"\n{prototype}"
    ));
    for prototype in &scene.prototypes {
        let all = &prototype.solids;
        assert_eq!(prototype.solids.cylinders.primitive(0), 0);
        let [one] = all.spheres.as_slice() else {
            panic!("{:?}", all.spheres)
        };
        assert_eq!(
            (one.primitive, one.solid),
            (1, sphere(at(1.0, 2.0, 3.0), 4.0))
        );
        let boxes: Vec<_> = all
            .cuboids
            .iter()
            .map(|one| (one.primitive, one.solid))
            .collect();
        let half_widths = at(1.0, 2.0, 3.0);
        let turned = Orientation::IDENTITY;
        let expected = [
            (2, cuboid(DVec3::ZERO, half_widths, turned)),
            (3, cuboid(at(7.0, 8.0, 9.0), half_widths, turned)),
        ];
        assert_eq!(boxes, expected);
        let top = at(0.0, 0.0, 2.0);
        let cone = Cone::new(DVec3::ZERO, top, 1.0, 0.5, Caps::P1).expect("a cone");
        assert_eq!((all.cones[0].primitive, all.cones[0].solid), (4, cone));
        let rounded = RoundedCone::new(DVec3::ZERO, top, 1.0, 0.0).expect("a rounded cone");
        let found = &all.rounded_cones[0];
        assert_eq!((found.primitive, found.solid), (5, rounded));
        let disk = Disk::new(DVec3::Z, at(0.0, 3.0, 4.0), 2.0).expect("a disk");
        assert_eq!((all.disks[0].primitive, all.disks[0].solid), (6, disk));
        let parts = || vec![leaf(sphere(DVec3::splat(9.0), 1.0))];
        let compositions: Vec<_> = all
            .compositions
            .iter()
            .map(|one| (one.primitive, one.solid.clone()))
            .collect();
        let expected = [
            (7, Composition::Union(parts())),
            (8, Composition::Intersection(parts())),
            (9, Composition::Difference(parts())),
        ];
        assert_eq!(compositions, expected);
        assert_eq!(all.len(), 10);
        assert_eq!(prototype.solids.cylinders.get(0).material().0, 1);
        assert!(all.cuboids.iter().all(|one| one.material.0 == 1));
        assert!(all.compositions.iter().all(|one| one.material.0 == 1));
    }
}

#[test]
fn poses_apply_x_then_y_then_z_then_the_list_then_the_translation() {
    let all = "rotate_x = 90\nrotate_y = 90\nrotate_z = 90\nrotate = [{ axis = [0, 0, 2], degrees = 90 }]\ntranslate = [10, 20, 30]\n";
    // x to x, -z, -z, -z; y to z, x, y, -x; z to -y, -y, x, y.
    let turn = DMat3::from_cols(DVec3::NEG_Z, DVec3::NEG_X, DVec3::Y);
    let cuboids = root(&format!(
        "[[cuboid]]\ncenter = [1, 2, 3]\nhalf_widths = [4, 5, 6]\n{all}"
    ));
    let found = cuboids.solids.cuboids[0].solid;
    assert_eq!(found.center(), at(11.0, 22.0, 33.0));
    assert_eq!(found.half_widths(), at(4.0, 5.0, 6.0));
    assert_eq!(found.orientation().world_from_object(), turn);

    // The middle is (1, 2, 5), from where the ends are 2 up and down.
    let ends = "p0 = [1, 2, 3]\np1 = [1, 2, 7]\n";
    let (p0, p1) = (at(11.0, 20.0, 35.0), at(11.0, 24.0, 35.0));
    let turned = root(&format!("[[cylinder]]\n{ends}radius = 1\n{all}"));
    assert_eq!(
        turned.solids.cylinders.get(0).cylinder(),
        cylinder(p0, p1, 1.0)
    );
    let radii = "radius0 = 1\nradius1 = 2\n";
    let turned = root(&format!("[[cone]]\n{ends}{radii}{all}"));
    let cone = Cone::new(p0, p1, 1.0, 2.0, Caps::Both).expect("a cone");
    assert_eq!(turned.solids.cones[0].solid, cone);
    let turned = root(&format!("[[rounded_cone]]\n{ends}{radii}{all}"));
    let cone = RoundedCone::new(p0, p1, 1.0, 2.0).expect("a rounded cone");
    assert_eq!(turned.solids.rounded_cones[0].solid, cone);

    let center = "center = [1, 2, 3]\nradius = 1\n";
    let moved = root(&format!("[[sphere]]\n{center}{all}"));
    assert_eq!(
        moved.solids.spheres[0].solid,
        sphere(at(11.0, 22.0, 33.0), 1.0)
    );
    let turned = root(&format!("[[disk]]\n{center}normal = [0, 0, 5]\n{all}"));
    let disk = Disk::new(at(11.0, 22.0, 33.0), at(0.0, 5.0, 0.0), 1.0).expect("a disk");
    assert_eq!(turned.solids.disks[0].solid, disk);
}

#[test]
fn poses_that_turn_by_nothing_change_no_bit() {
    // (0.1 + 0.7) / 2 is no f64, so a turn about it would round.
    let text = "[[cylinder]]\np0 = [0.1, 0.2, 0.3]\np1 = [0.7, 0.9, 1e10]\nradius = 0.1\n";
    let stated = root(text).solids.cylinders.get(0).cylinder();
    let turned = root(&format!(
        "{text}rotate_x = 0\nrotate_z = 360\ntranslate = [0, 0, 0]\n"
    ));
    assert_eq!(turned.solids.cylinders.get(0).cylinder(), stated);
    assert_eq!(stated.p1(), at(0.7, 0.9, 1e10));
}

#[test]
fn instances_turn_about_axes_before_their_list() {
    let scene = scene(
        "[[prototype]]\nname = \"a\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[instance]]\nof = \"a\"\nscale = [2, 3, 4]\nrotate_x = 90\nrotate_y = 90\nrotate_z = 90\n\
         rotate = [{ axis = [0, 0, 1], degrees = 90 }]\n",
    );
    let placed = scene.prototypes[0].placements[0].parent_from_child.matrix3;
    let turn = DMat3::from_cols(DVec3::NEG_Z * 2.0, DVec3::NEG_X * 3.0, DVec3::Y * 4.0);
    assert_eq!(placed, turn);
}

#[test]
fn set_operations_nest_and_turn_about_the_first_solid() {
    let drilled = "{ difference = { of = [{ cuboid = { center = [5, 0, 0], half_widths = [1, 1, 1] } }, \
         { cylinder = { p0 = [5, 0, -2], p1 = [5, 0, 2], radius = 0.5, rotate_y = 90 } }], translate = [0, 0, 1] } }";
    let ball = "{ sphere = { center = [8, 0, 1], radius = 0.25 } }";
    let text = format!("[[union]]\nof = [{drilled}, {ball}]\nrotate_z = 90\n");
    let union = root(&text).solids.compositions[0].solid.clone();
    let turn = Orientation::IDENTITY.rotated_z(90.0);
    // The hole lies along x at first, through (5, 0, 1) after the inner translation,
    // about which all is turned: the ball from 3 along x to 3 along y.
    let expected = Composition::Union(vec![
        Composition::Difference(vec![
            leaf(cuboid(at(5.0, 0.0, 1.0), DVec3::ONE, turn)),
            leaf(cylinder(at(5.0, -2.0, 1.0), at(5.0, 2.0, 1.0), 0.5)),
        ]),
        leaf(sphere(at(5.0, 3.0, 1.0), 0.25)),
    ]);
    assert_eq!(union, expected);
    let kinds: Vec<_> = expected
        .solids()
        .iter()
        .map(|one| one.kind().name())
        .collect();
    assert_eq!(kinds, ["cuboid", "cylinder", "sphere"]);

    // The same with a table for each operand.
    let spread = "[[union]]\nrotate_z = 90\n[[union.of]]\n[union.of.difference]\ntranslate = [0, 0, 1]\n\
         [[union.of.difference.of]]\n[union.of.difference.of.cuboid]\ncenter = [5, 0, 0]\nhalf_widths = [1, 1, 1]\n\
         [[union.of.difference.of]]\n[union.of.difference.of.cylinder]\np0 = [5, 0, -2]\np1 = [5, 0, 2]\nradius = 0.5\nrotate_y = 90\n\
         [[union.of]]\nsphere = { center = [8, 0, 1], radius = 0.25 }\n";
    assert_eq!(root(spread).solids.compositions[0].solid, expected);
}

#[test]
fn set_operations_hold_every_closed_kind() {
    let text = "[[intersection]]\nof = [\n\
         { cone = { p0 = [0, 0, 0], p1 = [0, 0, 1], radius0 = 1, radius1 = 0 } },\n\
         { rounded_cone = { p0 = [0, 0, 0], p1 = [0, 0, 1], radius0 = 1, radius1 = 0 } },\n\
         { union = { of = [{ sphere = { center = [0, 0, 0], radius = 1 } }] } },\n\
         { intersection = { of = [{ cylinder = { p0 = [0, 0, 0], p1 = [0, 0, 1], radius = 1, caps = \"both\" } }] } },\n]\n";
    let solids = root(text).solids.compositions[0].solid.solids();
    let kinds: Vec<_> = solids.iter().map(|one| one.kind().name()).collect();
    assert_eq!(kinds, ["cone", "rounded_cone", "sphere", "cylinder"]);
}

#[test]
fn neurons_have_cylinders_or_cones_or_rounded_cones() {
    let of = |keys: &str| {
        root(&format!(
            "[[swc]]\nfile = \"neuron.swc\"\nsoma = \"none\"\n{keys}"
        ))
    };
    let steps = of("degenerate = \"skip\"\ncaps = \"p0\"\n");
    let numbers: Vec<_> = steps
        .solids
        .cylinders
        .iter()
        .map(|one| one.primitive())
        .collect();
    assert_eq!(numbers, [0]);
    assert_eq!(steps.solids.len(), steps.solids.cylinders.len());

    let flat = of("degenerate = \"skip\"\njoints = \"flat\"\ncaps = \"p0\"\n");
    let found: Vec<_> = flat
        .solids
        .cones
        .iter()
        .map(|one| (one.primitive, one.solid))
        .collect();
    let top = at(0.0, 0.0, 5.0);
    let cone =
        |p0, p1, radius0, radius1| Cone::new(p0, p1, radius0, radius1, Caps::P0).expect("a cone");
    // The segment without length keeps its number; a tip of no radius is an apex.
    let expected = [
        (0, cone(DVec3::ZERO, top, 2.0, 0.5)),
        (2, cone(top, at(0.0, 4.0, 5.0), 0.5, 0.0)),
    ];
    assert_eq!(found, expected);
    assert!(flat.solids.cylinders.is_empty());

    let round = of("joints = \"round\"\n");
    let found: Vec<_> = round
        .solids
        .rounded_cones
        .iter()
        .map(|one| (one.primitive, one.solid))
        .collect();
    let cone =
        |p0, p1, radius0, radius1| RoundedCone::new(p0, p1, radius0, radius1).expect("a cone");
    let expected = [
        (0, cone(DVec3::ZERO, top, 2.0, 0.5)),
        (1, cone(top, top, 0.5, 0.25)),
        (2, cone(top, at(0.0, 4.0, 5.0), 0.5, 0.0)),
    ];
    assert_eq!(found, expected);
}

#[test]
fn census_counts_other_solids_and_their_box_holds_them() {
    let text = "[[prototype]]\nname = \"a\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[prototype.difference]]\nof = [{ cuboid = { center = [5, 0, 0], half_widths = [1, 2, 1] } }, { sphere = { center = [9, 0, 0], radius = 4 } }]\n\
         [[instance]]\nof = \"a\"\n[[instance]]\nof = \"a\"\ntranslate = [100, 0, 0]\n";
    let scene_stats = scene(text).scene_stats();
    assert_eq!(
        (scene_stats.unique.total(), scene_stats.instanced.total()),
        (2, 4)
    );
    assert_eq!(scene_stats.unique[SolidKind::Cylinder], 0);
    let (lower, upper) = (scene_stats.bounds.lower, scene_stats.bounds.upper);
    // Boxes are rounded outward, by next to nothing.
    assert!(
        lower.abs_diff_eq(at(-1.0, -2.0, -1.0), 1e-12) && lower.cmple(at(-1.0, -2.0, -1.0)).all()
    );
    assert!(
        upper.abs_diff_eq(at(106.0, 2.0, 1.0), 1e-12) && upper.cmpge(at(106.0, 2.0, 1.0)).all()
    );
}

#[test]
fn boxes_of_set_operations_follow_their_meaning() {
    let ball = |x: f64| leaf(sphere(at(x, 0.0, 0.0), 1.0));
    let (near, far) = (|| vec![ball(0.0), ball(1.0)], || vec![ball(0.0), ball(5.0)]);
    let across = |composition: Composition| {
        let bounds = composition.bounds();
        (bounds.lower.x.round(), bounds.upper.x.round())
    };
    assert_eq!(across(Composition::Union(near())), (-1.0, 2.0));
    assert_eq!(across(Composition::Intersection(near())), (0.0, 1.0));
    assert_eq!(across(Composition::Difference(near())), (-1.0, 1.0));
    assert!(Composition::Intersection(far()).bounds().is_empty());
    assert!(Composition::Union(Vec::new()).bounds().is_empty());
}
