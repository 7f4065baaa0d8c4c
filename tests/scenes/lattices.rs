//! Beam lattices in 3MF become the solids that the specification says.

use test_support::three_mf;

use std::fs;

use cyltrace::scene::{Composition, Prototype, Scene, SceneError, beams_of_model, load};
use cyltrace::solid::{AnySolid, Caps, Cylinder, Sphere};
use glam::DVec3;
use three_mf::{model, three_mf};

/// The scene of a `[[beam_lattice]]` with these keys, of a model.
fn loaded(keys: &str, model: &str) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("lattice.3mf"), three_mf(model)).expect("writing the lattice");
    let path = folder.path().join("scene.toml");
    let scene = format!("[[beam_lattice]]\nfile = \"lattice.3mf\"\n{keys}");
    fs::write(&path, scene).expect("writing the scene");
    load(&path)
}

fn prototype(keys: &str, model: &str) -> Prototype {
    let mut scene = loaded(keys, model).unwrap_or_else(|error| panic!("{model}\n{error}"));
    scene.prototypes.remove(0)
}

/// An object with four vertices on the x axis, at 0, 4, 6 and 6.5, and one at (0, 8, 0).
fn object(id: u32, lattice: &str, beams: &str) -> String {
    let vertices = [0.0, 4.0, 6.0, 6.5].map(|x| format!("<vertex x=\"{x}\" y=\"0\" z=\"0\"/>"));
    format!(
        "<object id=\"{id}\"><mesh><vertices>{}<vertex x=\"0\" y=\"8\" z=\"0\"/></vertices><triangles/>\n\
         <b:beamlattice {lattice}><b:beams>\n{beams}\n</b:beams></b:beamlattice></mesh></object>",
        vertices.concat()
    )
}

/// A model that builds one lattice as it is.
fn single(lattice: &str, beams: &str) -> String {
    let object = object(1, lattice, beams);
    model(
        "requiredextensions=\"b\"",
        &format!("<resources>{object}</resources>\n<build><item objectid=\"1\"/></build>"),
    )
}

/// Number, ends and radius of the cylinders.
fn cylinders(prototype: &Prototype) -> Vec<(u32, DVec3, DVec3, f64)> {
    let records = prototype.solids.cylinders.iter();
    records
        .map(|record| {
            let one = record.cylinder();
            (record.primitive(), one.p0(), one.p1(), one.radius())
        })
        .collect()
}

/// Number, center and radius of the spheres.
fn spheres(prototype: &Prototype) -> Vec<(u32, DVec3, f64)> {
    let records = prototype.solids.spheres.iter();
    records
        .map(|record| {
            (
                record.primitive,
                record.solid.center(),
                record.solid.radius(),
            )
        })
        .collect()
}

const X4: DVec3 = DVec3::new(4.0, 0.0, 0.0);
const X6: DVec3 = DVec3::new(6.0, 0.0, 0.0);
const Y8: DVec3 = DVec3::new(0.0, 8.0, 0.0);

#[test]
fn radii_of_beams_are_their_own_or_the_lattice_s() {
    let lattice = single(
        "radius=\"0.5\" minlength=\"0.001\" cap=\"butt\"",
        "<b:beam v1=\"0\" v2=\"1\"/>\n<b:beam v1=\"1\" v2=\"2\" r1=\"0.25\"/>\n<b:beam v1=\"0\" v2=\"4\" r1=\"1\" r2=\"0.125\"/>",
    );
    let found = prototype("", &lattice);
    let expected = [(0, DVec3::ZERO, X4, 0.5), (1, X4, X6, 0.25)];
    assert_eq!(cylinders(&found), expected);
    let [cone] = found.solids.cones.as_slice() else {
        panic!("{:?}", found.solids);
    };
    assert_eq!(cone.primitive, 2);
    assert_eq!((cone.solid.p0(), cone.solid.p1()), (DVec3::ZERO, Y8));
    assert_eq!((cone.solid.radius0(), cone.solid.radius1()), (1.0, 0.125));
    assert_eq!(cone.solid.caps(), Caps::Both);
    assert_eq!(
        found.solids.counts().total(),
        found.solids.cylinders.len() as u128 + 1
    );
}

#[test]
fn round_caps_are_one_ball_at_each_vertex_as_great_as_the_greatest() {
    let beams = "<b:beam v1=\"0\" v2=\"1\" r1=\"0.5\"/><b:beam v1=\"1\" v2=\"2\" r1=\"0.75\" r2=\"0.25\" cap2=\"butt\"/>";
    let found = prototype("", &single("radius=\"1\" minlength=\"0\"", beams));
    // The default cap is a sphere; at x = 4 there are two.
    assert_eq!(spheres(&found), [(2, DVec3::ZERO, 0.5), (3, X4, 0.75)]);
    assert_eq!(found.solids.cones[0].primitive, 1);
    assert!(found.solids.compositions.is_empty());
}

#[test]
fn hemisphere_is_a_ball_where_the_beam_hides_the_other_half() {
    let beams = "<b:beam v1=\"0\" v2=\"1\" r1=\"0.5\" r2=\"1\"/>";
    let lattice = "radius=\"1\" minlength=\"0\" cap=\"hemisphere\"";
    let found = prototype("", &single(lattice, beams));
    assert_eq!(spheres(&found), [(1, DVec3::ZERO, 0.5)]);
    let [half] = found.solids.compositions.as_slice() else {
        panic!("{:?}", found.solids);
    };
    assert_eq!(half.primitive, 2);
    // The wider end is the half of its ball where x >= 4.
    let ball = Sphere::new(X4, 1.0).expect("a ball");
    let stand = Cylinder::new(X4, X4 * 2.0, 2.0, Caps::Both).expect("a cylinder");
    let parts = [AnySolid::Sphere(ball), AnySolid::Cylinder(stand)].map(Composition::Solid);
    assert_eq!(half.solid, Composition::Intersection(parts.into()));

    // A greater ball at the same vertex holds the half.
    let more = "<b:beam v1=\"1\" v2=\"2\" r1=\"1.5\" r2=\"1.5\" cap1=\"sphere\" cap2=\"butt\"/>";
    let found = prototype("", &single(lattice, &format!("{beams}{more}")));
    assert_eq!(spheres(&found), [(2, DVec3::ZERO, 0.5), (3, X4, 1.5)]);
    assert!(found.solids.compositions.is_empty());

    // A beam shorter than its radius does not hide the other half.
    let short = "<b:beam v1=\"2\" v2=\"3\" r1=\"1\" cap1=\"butt\"/>";
    let found = prototype("", &single(lattice, short));
    assert!(found.solids.spheres.is_empty());
    assert_eq!(found.solids.compositions.len(), 1);
}

#[test]
fn beams_below_the_least_length_keep_their_numbers_and_are_counted() {
    let beams = "<b:beam v1=\"2\" v2=\"3\"/><b:beam v1=\"0\" v2=\"1\" cap1=\"butt\"/>";
    let lattice = single("radius=\"1\" minlength=\"0.6\"", beams);
    let scene = loaded("", &lattice).expect("the scene");
    assert_eq!(scene.skipped_rows, 1);
    assert_eq!(cylinders(&scene.prototypes[0]), [(1, DVec3::ZERO, X4, 1.0)]);
    assert_eq!(spheres(&scene.prototypes[0]), [(2, X4, 1.0)]);
}

#[test]
fn beams_without_a_radius_are_left_out_where_that_is_asked_for() {
    let beams = "<b:beam v1=\"0\" v2=\"1\" r1=\"0\"/><b:beam v1=\"1\" v2=\"2\"/>";
    let lattice = single("radius=\"1\" minlength=\"0\" cap=\"butt\"", beams);
    let scene = loaded("degenerate = \"skip\"", &lattice).expect("the scene");
    assert_eq!(scene.skipped_rows, 1);
    assert_eq!(cylinders(&scene.prototypes[0]), [(1, X4, X6, 1.0)]);
    let error = loaded("", &lattice).expect_err("a beam of no radius");
    let text = error.to_string();
    assert!(
        text.contains("radius is 0.0") && text.contains("degenerate = \"skip\""),
        "{text}"
    );
}

#[test]
fn balls_are_at_stated_vertices_or_at_all() {
    let of_mode = |mode: &str| {
        let beams = "<b:beam v1=\"0\" v2=\"1\"/></b:beams>\n\
             <b2:balls><b2:ball vindex=\"1\" r=\"3\"/></b2:balls><b:beams>";
        let lattice = format!("radius=\"0.5\" minlength=\"0\" cap=\"butt\" {mode}");
        spheres(&prototype("", &single(&lattice, beams)))
    };
    assert_eq!(of_mode(""), []);
    assert_eq!(of_mode("ballmode=\"none\""), []);
    let mixed = [(1, X4, 3.0)];
    assert_eq!(of_mode("ballmode=\"mixed\" ballradius=\"2\""), mixed);
    assert_eq!(of_mode("b2:ballmode=\"mixed\" b2:ballradius=\"2\""), mixed);
    let all = [(1, DVec3::ZERO, 2.0), (2, X4, 3.0)];
    assert_eq!(of_mode("ballmode=\"all\" ballradius=\"2\""), all);
}

#[test]
fn lengths_are_the_file_s_unless_the_scene_states_its_unit() {
    let beams = "<b:beam v1=\"0\" v2=\"1\"/>";
    let in_unit = |unit: &str, keys: &str| {
        let single = single("radius=\"0.3\" minlength=\"0\" cap=\"butt\"", beams);
        let stated = single.replace("requiredextensions", &format!("{unit} requiredextensions"));
        let (_, _, end, radius) = cylinders(&prototype(keys, &stated))[0];
        (end.x, radius)
    };
    assert_eq!(in_unit("", ""), (4.0, 0.3));
    assert_eq!(in_unit("unit=\"foot\"", ""), (4.0, 0.3));
    assert_eq!(in_unit("", "unit = \"millimeter\""), (4.0, 0.3));
    // The nearest f64, as a single rounding gives it.
    assert_eq!(in_unit("", "unit = \"meter\""), (0.004, 0.3 / 1000.0));
    assert_eq!(
        in_unit("unit=\"meter\"", "unit = \"micron\""),
        (4e6, 0.3 * 1e6)
    );
    assert_eq!(
        in_unit("unit=\"foot\"", "unit = \"inch\""),
        (48.0, 0.3 * 12.0)
    );
    assert_eq!(
        in_unit("unit=\"inch\"", "unit = \"centimeter\"").0,
        4.0 * 127.0 / 50.0
    );
}

#[test]
fn objects_are_where_the_build_and_the_components_put_them() {
    let lattice = "radius=\"0.5\" minlength=\"0\" cap=\"butt\"";
    let beam = object(1, lattice, "<b:beam v1=\"0\" v2=\"1\"/>");
    let unused = object(2, lattice, "<b:beam v1=\"0\" v2=\"4\"/>");
    // A quarter turn about z, twice as large, and 10 up.
    let turned = "0 2 0 -2 0 0 0 0 2 0 0 10";
    let group = format!(
        "<object id=\"3\"><components><component objectid=\"1\"/>\
         <component objectid=\"1\" transform=\"{turned}\"/></components></object>"
    );
    let build = "<build><item objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"/><item objectid=\"1\"/></build>";
    let model = model(
        "",
        &format!("<resources>{beam}{unused}{group}</resources>{build}"),
    );
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let expected = [
        (0, DVec3::ZERO, X4, 0.5),
        (1, at(100.0, 0.0, 0.0), at(104.0, 0.0, 0.0), 0.5),
        (2, at(100.0, 0.0, 10.0), at(100.0, 8.0, 10.0), 1.0),
    ];
    assert_eq!(cylinders(&prototype("", &model)), expected);
}

#[test]
fn transforms_with_few_decimals_count_as_turns() {
    let beam = object(
        1,
        "radius=\"1\" minlength=\"0\" cap=\"butt\"",
        "<b:beam v1=\"0\" v2=\"1\"/>",
    );
    let placed = |transform: &str| {
        let build = format!("<build><item objectid=\"1\" transform=\"{transform}\"/></build>");
        loaded(
            "",
            &model("", &format!("<resources>{beam}</resources>{build}")),
        )
    };
    let scene =
        placed("0.7660 0.6428 0 -0.6428 0.7660 0 0 0 1 0 0 0").expect("a turn by 40 degrees");
    let (_, _, end, radius) = cylinders(&scene.prototypes[0])[0];
    assert_eq!(end, DVec3::new(4.0 * 0.7660, 4.0 * 0.6428, 0.0));
    assert!((radius - 1.0).abs() < 1e-4, "{radius}");
    for uneven in [
        "1 0 0 0 1 0 0 0 1.001 0 0 0",
        "1 0.001 0 0 1 0 0 0 1 0 0 0",
        "0 0 0 0 0 0 0 0 0 0 0 0",
    ] {
        let text = placed(uneven).expect_err(uneven).to_string();
        assert!(text.contains("beams would no longer be round"), "{text}");
    }
}

#[test]
fn lattices_of_prototypes_and_their_materials_are_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let lattice = single(
        "radius=\"1\" minlength=\"0\"",
        "<b:beam v1=\"0\" v2=\"1\" cap1=\"butt\"/>",
    );
    fs::write(folder.path().join("lattice.3mf"), three_mf(&lattice)).expect("writing the lattice");
    let path = folder.path().join("scene.toml");
    let text = "[[material]]\nname = \"steel\"\ncolor = [0.5, 0.5, 0.6]\n\
         [[prototype]]\nname = \"cell\"\n[[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n\
         [[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[prototype.beam_lattice]]\nfile = \"lattice.3mf\"\nmaterial = \"steel\"\n[[instance]]\nof = \"cell\"\n";
    fs::write(&path, text).expect("writing the scene");
    let scene = load(&path).expect("the scene");
    let cell = &scene.prototypes[1];
    let numbers: Vec<_> = cell
        .solids
        .cylinders
        .iter()
        .map(|one| (one.primitive(), one.material().0))
        .collect();
    assert_eq!(numbers, [(0, 0), (1, 1)]);
    let spheres: Vec<_> = cell
        .solids
        .spheres
        .iter()
        .map(|one| (one.primitive, one.material.0))
        .collect();
    assert_eq!(spheres, [(2, 1), (3, 0)]);
}

/// The notes on a model, without the paths before them.
fn notes(keys: &str, model: &str) -> Vec<String> {
    let scene = loaded(keys, model).unwrap_or_else(|error| panic!("{model}\n{error}"));
    let notes = scene.notes.iter();
    let notes = notes.map(|note| {
        note.rsplit_once("3dmodel.model:")
            .expect("a place")
            .1
            .to_owned()
    });
    notes.collect()
}

const SMALL: &str = "radius=\"1\" minlength=\"0\" cap=\"butt\"";
const BEAM: &str = "<b:beam v1=\"0\" v2=\"1\"/>";

#[test]
fn beams_of_a_model_are_counted_without_an_archive() {
    let two = single(SMALL, &BEAM.repeat(2));
    assert_eq!(beams_of_model(&two).expect("a model"), 2);
    assert!(beams_of_model("<model/>").is_err());
}

#[test]
fn good_lattices_have_no_notes() {
    assert_eq!(notes("", &single(SMALL, BEAM)), [""; 0]);
    let solid = single(SMALL, BEAM).replace("id=\"1\"", "id=\"1\" type=\"solidsupport\"");
    assert_eq!(notes("", &solid), [""; 0]);
}

#[test]
fn what_the_specification_forbids_is_read_with_a_note() {
    let of_support = single(SMALL, BEAM).replace("id=\"1\"", "id=\"1\" type=\"support\"");
    let [note] = &notes("", &of_support)[..] else {
        panic!("one note");
    };
    assert!(
        note.starts_with("2: object 1: its type is \"support\", but only"),
        "{note}"
    );
    assert_eq!(cylinders(&prototype("", &of_support)).len(), 1);

    let not_required = single(SMALL, BEAM).replace("requiredextensions=\"b\"", "");
    let [note] = &notes("", &not_required)[..] else {
        panic!("one note");
    };
    assert!(note.starts_with("1: the model does not require"), "{note}");

    let of_balls =
        format!("{BEAM}</b:beams><b2:balls><b2:ball vindex=\"0\" r=\"3\"/></b2:balls><b:beams>");
    let of_balls = single(SMALL, &of_balls);
    let [note] = &notes("", &of_balls)[..] else {
        panic!("one note");
    };
    assert!(
        note.contains("its balls are ignored because it has no ballmode"),
        "{note}"
    );
    assert!(spheres(&prototype("", &of_balls)).is_empty());
}

#[test]
fn objects_are_named_whose_triangles_are_left_out() {
    let triangles = "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"4\"/></triangles>";
    let solid =
        |id: u32, lattice: &str| object(id, lattice, BEAM).replace("<triangles/>", triangles);
    let whole = solid(1, SMALL) + &solid(2, SMALL) + &object(3, SMALL, BEAM)
        + &solid(4, &format!("{SMALL} clippingmode=\"inside\" clippingmesh=\"3\""))
        // It is not built.
        + &solid(5, SMALL);
    let items = (1..=4)
        .map(|id| format!("<item objectid=\"{id}\"/>"))
        .collect::<String>();
    let model = model(
        "requiredextensions=\"b\"",
        &format!("<resources>{whole}</resources>\n<build>{items}</build>"),
    );
    let found = notes("meshes = \"skip\"", &model);
    let [left_out, clipped] = &found[..] else {
        panic!("two notes: {found:?}");
    };
    assert!(
        left_out.contains(": objects 1, 2, 4: its triangles are ignored"),
        "{left_out}"
    );
    assert!(
        clipped.contains(": object 4: its lattice is clipped by a mesh"),
        "{clipped}"
    );
}

/// All balls of a lattice are united.
#[test]
fn the_greatest_of_several_balls_at_a_vertex_stays() {
    let balls = "<b2:ball vindex=\"0\" r=\"3\"/><b2:ball vindex=\"0\" r=\"2\"/><b2:ball vindex=\"1\" r=\"0.5\"/>";
    let beams = format!("{BEAM}</b:beams><b2:balls>{balls}</b2:balls><b:beams>");
    for (mode, expected) in [("mixed", 0.5), ("all", 0.5)] {
        let keys = format!("{SMALL} ballmode=\"{mode}\" ballradius=\"1\"");
        let found = spheres(&prototype("", &single(&keys, &beams)));
        assert_eq!(found, [(1, DVec3::ZERO, 3.0), (2, X4, expected)], "{mode}");
    }
}
