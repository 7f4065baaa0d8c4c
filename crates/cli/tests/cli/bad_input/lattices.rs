//! Beam lattices whose archive, XML or numbers are wrong.

use super::Case;
use super::three_mf::{archive, model, three_mf};

const SCENE: &str = "[[beam_lattice]]\nfile = \"lattice.3mf\"\n";
const BUILD: &str = "<build><item objectid=\"1\"/></build>";

/// A scene that names a model.
fn of_model(name: &'static str, model: &str, message: &'static [&'static str]) -> Case {
    Case::new(name, SCENE, message).with_bytes("lattice.3mf", three_mf(model))
}

/// A scene that names a model with these objects, from its line 2, and this build.
fn built(name: &'static str, objects: &str, build: &str, message: &'static [&'static str]) -> Case {
    let body = format!("<resources>{objects}</resources>\n{build}");
    of_model(name, &model("requiredextensions=\"b\"", &body), message)
}

/// An object of two vertices and, on line 3 of the model, the lattice.
fn object(lattice: &str) -> String {
    format!(
        "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices>\n{lattice}</mesh></object>"
    )
}

/// A lattice of these keys with, on line 4 of the model, these elements.
fn lattice(
    name: &'static str,
    keys: &str,
    elements: &str,
    message: &'static [&'static str],
) -> Case {
    let lattice = format!("<b:beamlattice {keys}>\n{elements}</b:beamlattice>");
    built(name, &object(&lattice), BUILD, message)
}

/// A good lattice but for a beam on line 4 of the model.
fn beam(name: &'static str, attributes: &str, message: &'static [&'static str]) -> Case {
    let beams = format!("<b:beams><b:beam {attributes}/></b:beams>");
    lattice(name, "radius=\"1\" minlength=\"0\"", &beams, message)
}

/// A good beam, and balls.
fn balls(name: &'static str, keys: &str, ball: &str, message: &'static [&'static str]) -> Case {
    let elements =
        format!("<b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams><b2:balls>{ball}</b2:balls>");
    let keys = format!("radius=\"1\" minlength=\"0\" {keys}");
    lattice(name, &keys, &elements, message)
}

const BEAMS: &str = "<b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams>";

fn good_object() -> String {
    object(&format!(
        "<b:beamlattice radius=\"1\" minlength=\"0\">{BEAMS}</b:beamlattice>"
    ))
}

fn archives() -> Vec<Case> {
    vec![
        Case::new(
            "lattice_that_is_missing",
            SCENE,
            &["scene.toml:2:8", "lattice.3mf: the file does not exist"],
        ),
        Case::new(
            "lattice_that_is_no_archive",
            SCENE,
            &["scene.toml:2:8", "cannot read", "lattice.3mf", "zip archive"],
        )
        .with("lattice.3mf", "<model/>"),
        Case::new(
            "lattice_that_is_cut_off",
            SCENE,
            &["scene.toml:2:8", "cannot read", "lattice.3mf"],
        )
        .with_bytes("lattice.3mf", {
            let whole = three_mf(&model("", BUILD));
            whole[..whole.len() / 2].to_vec()
        }),
        Case::new(
            "lattice_with_a_wrong_byte",
            SCENE,
            &["scene.toml:2:8", "lattice.3mf: cannot read"],
        )
        .with_bytes("lattice.3mf", {
            let mut bytes = three_mf(&model("", BUILD));
            // The first byte of the first part's compressed data.
            let name = b"_rels/.rels";
            let at = bytes.windows(name.len()).position(|window| window == name);
            bytes[at.expect("the name of a part") + name.len()] ^= 0x55;
            bytes
        }),
        Case::new(
            "lattice_that_states_two_gigabytes",
            SCENE,
            &["scene.toml:2:8", "\"3D/3dmodel.model\" is larger than the limit of 1073741824 bytes"],
        )
        .with_bytes("lattice.3mf", {
            let mut bytes = three_mf(&model("", BUILD));
            // The last part's entry in the directory at the end has its length at byte 24.
            let entry = bytes.windows(4).rposition(|window| window == b"PK\x01\x02");
            let length = entry.expect("a directory") + 24;
            bytes[length..length + 4].copy_from_slice(&(1_u32 << 31).to_le_bytes());
            bytes
        }),
        Case::new(
            "lattice_without_relationships",
            SCENE,
            &["scene.toml:2:8", "the archive contains no \"_rels/.rels\""],
        )
        .with_bytes("lattice.3mf", archive(&[("a.txt", b"nothing")])),
        Case::new(
            "lattice_whose_relationships_name_no_model",
            SCENE,
            &["scene.toml:2:8", "_rels/.rels names no 3D model"],
        )
        .with_bytes("lattice.3mf", archive(&[("_rels/.rels", b"<a/>")])),
        Case::new(
            "lattice_whose_model_is_not_there",
            SCENE,
            &["scene.toml:2:8", "the archive contains no \"3D/m.model\""],
        )
        .with_bytes(
            "lattice.3mf",
            archive(&[("_rels/.rels", br#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/m.model" Id="a" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#)]),
        ),
        of_model(
            "model_that_is_no_xml",
            "<model>\n<resources>\n</model>",
            &["lattice.3mf/3D/3dmodel.model:3", "this is not valid XML"],
        ),
        of_model(
            "model_of_another_kind",
            "<svg/>",
            &["3dmodel.model:1", "this is not a 3MF model"],
        ),
        of_model(
            "model_with_entities",
            "<!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\">]>\n<model>&a;</model>",
            &["3dmodel.model:1", "this is not valid XML"],
        ),
        of_model(
            "model_of_elements_within_each_other_without_end",
            &model("", &format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000))),
            &["3dmodel.model:1", "the <build> of the file contains no object with beams"],
        ),
        Case::new(
            "model_in_utf_16",
            SCENE,
            &["3dmodel.model:1", "looks like UTF-16"],
        )
        .with_bytes("lattice.3mf", {
            let relationships = r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="a" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
            archive(&[
                ("_rels/.rels", relationships.as_bytes()),
                ("3D/3dmodel.model", b"\xff\xfe<\0a\0/\0>\0"),
            ])
        }),
    ]
}

fn models() -> Vec<Case> {
    let good = good_object();
    let resources = format!("<resources>{good}</resources>\n{BUILD}");
    let elsewhere = good.replace("<mesh>", "<mesh ><!-- -->").replace(
        "<b:beamlattice",
        "<triangles>\n<triangle v1=\"0\" v2=\"1\" v3=\"0\"/></triangles><b:beamlattice",
    );
    vec![
        of_model(
            "model_that_requires_what_is_not_known",
            &model("xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" requiredextensions=\"b s\"", &resources),
            &["3dmodel.model:1", "slice/2015/07", "does not support", "beam lattices"],
        ),
        of_model(
            "model_that_requires_an_undeclared_prefix",
            &model("requiredextensions=\"q\"", &resources),
            &["3dmodel.model:1", "requires the extension \"q\""],
        ),
        of_model(
            "model_of_an_unknown_unit",
            &model("unit=\"furlong\"", &resources),
            &["3dmodel.model:1", "\"furlong\" is not a value of unit", "\"millimeter\""],
        ),
        built(
            "model_that_builds_nothing",
            &good,
            "<build/>",
            &["3dmodel.model:1", "the <build> of the file contains no object with beams"],
        ),
        built(
            "item_of_no_object",
            &good,
            "<build>\n<item objectid=\"7\"/></build>",
            &["3dmodel.model:5", "objectid is \"7\""],
        ),
        built(
            "item_of_another_part",
            &good,
            "<build><item objectid=\"1\" p:path=\"/3D/other.model\"/></build>",
            &["3dmodel.model:4", "in another part of the archive"],
        ),
        built(
            "item_with_eleven_numbers",
            &good,
            "<build><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0\"/></build>",
            &["3dmodel.model:4", "transform has 11 numbers: it needs 12"],
        ),
        built(
            "item_with_a_word_in_its_transform",
            &good,
            "<build><item objectid=\"1\" transform=\"1 0 0 0 one 0 0 0 1 0 0 0\"/></build>",
            &["3dmodel.model:4", "transform of <item> is \"one\""],
        ),
        built(
            "item_that_is_stretched",
            &good,
            "<build><item objectid=\"1\" transform=\"2 0 0 0 1 0 0 0 1 0 0 0\"/></build>",
            &["3dmodel.model:4", "no longer be round", "[[instance]]"],
        ),
        built(
            "components_of_an_object_in_itself",
            &format!("{good}<object id=\"2\"><components>\n<component objectid=\"2\"/></components></object>"),
            "<build><item objectid=\"2\"/></build>",
            &["3dmodel.model:4", "objectid is \"2\": it must be the id of an object before this"],
        ),
        built(
            "components_that_double_without_end",
            &(2..40).fold(good.clone(), |objects, id| {
                let inner = id - 1;
                objects + &format!("<object id=\"{id}\"><components><component objectid=\"{inner}\"/><component objectid=\"{inner}\"/></components></object>")
            }),
            "<build><item objectid=\"39\"/></build>",
            &["3dmodel.model:3", "places objects more than 1048576 times"],
        ),
        built(
            "objects_of_the_same_id",
            &format!("{good}\n{good}"),
            BUILD,
            &["3dmodel.model:4", "the id \"1\" occurs twice"],
        ),
        built(
            "objects_of_the_same_number",
            &format!("{good}\n{}", good.replace("id=\"1\"", "id=\"01\"")),
            BUILD,
            &["3dmodel.model:4", "the id \"01\" occurs twice"],
        ),
        built(
            "object_of_an_id_in_words",
            &good.replace("id=\"1\"", "id=\"one\""),
            BUILD,
            &["3dmodel.model:2", "id of <object> is \"one\"", "whole number from 1"],
        ),
        built(
            "object_of_an_unknown_type",
            &good.replace("id=\"1\"", "id=\"1\" type=\"lattice\""),
            BUILD,
            &["3dmodel.model:2", "\"lattice\" is not a value of type", "\"solidsupport\""],
        ),
        built(
            "item_of_an_object_of_type_other",
            &good.replace("id=\"1\"", "id=\"1\" type=\"other\""),
            BUILD,
            &["3dmodel.model:4", "type \"other\"", "give the object type=\"model\""],
        ),
        built(
            "lattice_of_no_namespace_of_lattices",
            &good.replace("b:beamlattice", "beamlattice"),
            BUILD,
            &["3dmodel.model:3", "<beamlattice> is in the namespace", "beamlattice/2017/02"],
        ),
        built(
            "beams_of_no_namespace_of_lattices",
            &good.replace("b:beam ", "beam "),
            BUILD,
            &["3dmodel.model:3", "<beam> is in the namespace"],
        ),
        built(
            "two_lattices_in_a_mesh",
            &object(&format!(
                "<b:beamlattice radius=\"1\" minlength=\"0\">{BEAMS}</b:beamlattice>\n<b:beamlattice radius=\"1\" minlength=\"0\"/>"
            )),
            BUILD,
            &["3dmodel.model:4", "only one <beamlattice>"],
        ),
        // Quadratic before: 42 seconds.
        of_model(
            "model_of_80_000_attributes",
            &model(
                &(0..80_000).map(|number| format!("a{number}=\"\" ")).collect::<String>(),
                &resources,
            ),
            &["3dmodel.model:1", "more than 256 attributes"],
        ),
        of_model(
            "model_of_80_000_namespaces",
            &model("", &{
                let open = (0..80_000).map(|n| format!("<a xmlns:p{n}=\"u{n}\">")).collect::<String>();
                open + &"</a>".repeat(80_000)
            }),
            &["3dmodel.model:2", "more than 256 namespace prefixes"],
        ),
        built(
            "lattice_beside_triangles",
            &elsewhere,
            BUILD,
            &["3dmodel.model:3", "this object has triangles", "meshes = \"skip\""],
        ),
    ]
}

fn lattices() -> Vec<Case> {
    const GOOD: &str = "radius=\"1\" minlength=\"0\"";
    vec![
        lattice(
            "lattice_without_a_radius",
            "minlength=\"0\"",
            BEAMS,
            &["3dmodel.model:3", "<beamlattice> has no radius"],
        ),
        lattice(
            "lattice_without_a_least_length",
            "radius=\"1\"",
            BEAMS,
            &["3dmodel.model:3", "<beamlattice> has no minlength"],
        ),
        lattice(
            "lattice_of_a_negative_radius",
            "radius=\"-1\" minlength=\"0\"",
            BEAMS,
            &["3dmodel.model:3", "radius of <beamlattice> is -1"],
        ),
        lattice(
            "lattice_of_unknown_caps",
            "radius=\"1\" minlength=\"0\" cap=\"round\"",
            BEAMS,
            &[
                "3dmodel.model:3",
                "\"round\" is not a value of cap",
                "\"hemisphere\"",
            ],
        ),
        lattice(
            "lattice_that_is_clipped",
            "radius=\"1\" minlength=\"0\" clippingmode=\"inside\" clippingmesh=\"1\"",
            BEAMS,
            &["3dmodel.model:3", "clipped by a mesh", "meshes = \"skip\""],
        ),
        lattice(
            "lattice_that_is_clipped_in_an_unknown_way",
            "radius=\"1\" minlength=\"0\" clippingmode=\"Inside\"",
            BEAMS,
            &[
                "3dmodel.model:3",
                "\"Inside\" is not a value of clippingmode",
            ],
        ),
        lattice(
            "lattice_without_beams",
            GOOD,
            "<b:beams/>",
            &[
                "3dmodel.model:1",
                "the <build> of the file contains no object with beams",
            ],
        ),
        beam(
            "beam_without_a_vertex",
            "v1=\"0\"",
            &["3dmodel.model:4", "<beam> has no v2"],
        ),
        beam(
            "beam_to_a_vertex_that_is_not_there",
            "v1=\"0\" v2=\"2\"",
            &["3dmodel.model:4", "v2 of <beam> is \"2\"", "below 2"],
        ),
        beam(
            "beam_to_its_own_start",
            "v1=\"1\" v2=\"1\"",
            &["3dmodel.model:4", "both 1", "two vertices"],
        ),
        beam(
            "beam_of_a_radius_in_words",
            "v1=\"0\" v2=\"1\" r1=\"thin\"",
            &["3dmodel.model:4", "r1 of <beam> is \"thin\""],
        ),
        beam(
            "beam_of_a_radius_that_is_nan",
            "v1=\"0\" v2=\"1\" r1=\"nan\"",
            &["3dmodel.model:4", "r1 of <beam> is \"nan\"", "finite"],
        ),
        beam(
            "beam_of_a_second_radius_alone",
            "v1=\"0\" v2=\"1\" r2=\"1\"",
            &[
                "3dmodel.model:4",
                "an r2 but no r1",
                "write r1=\"1\" r2=\"1\"",
            ],
        ),
        beam(
            "beam_of_no_radius",
            "v1=\"0\" v2=\"1\" r1=\"0\"",
            &["3dmodel.model:4", "radius is 0.0", "degenerate = \"skip\""],
        ),
        beam(
            "beam_of_unknown_caps",
            "v1=\"0\" v2=\"1\" cap1=\"flat\"",
            &["3dmodel.model:4", "\"flat\" is not a value of cap1"],
        ),
        beam(
            "beam_beyond_all_numbers",
            "v1=\"0\" v2=\"1\" r1=\"1e60\" r2=\"1\"",
            &["3dmodel.model:4", "radius0 is 1e60"],
        ),
        balls(
            "balls_of_no_radius",
            "ballmode=\"all\"",
            "<b2:ball vindex=\"0\"/>",
            &["3dmodel.model:3", "a ballmode but no ballradius"],
        ),
        balls(
            "balls_of_an_unknown_mode",
            "ballmode=\"some\" ballradius=\"1\"",
            "<b2:ball vindex=\"0\"/>",
            &["3dmodel.model:3", "\"some\" is not a value of ballmode"],
        ),
        balls(
            "ball_at_a_vertex_that_is_not_there",
            "ballmode=\"mixed\" ballradius=\"1\"",
            "<b2:ball vindex=\"9\"/>",
            &["3dmodel.model:4", "vindex of <ball> is \"9\""],
        ),
        balls(
            "ball_of_radius_zero",
            "ballmode=\"mixed\" ballradius=\"1\"",
            "<b2:ball vindex=\"0\" r=\"0\"/>",
            &["3dmodel.model:4", "the radius 0"],
        ),
        built(
            "ball_where_no_beam_ends",
            &object(
                "<b:beamlattice radius=\"1\" minlength=\"0\" ballmode=\"mixed\" ballradius=\"1\"><b:beams/>\n<b2:balls><b2:ball vindex=\"1\"/></b2:balls></b:beamlattice>",
            ),
            BUILD,
            &["3dmodel.model:4", "must be at an end of a beam"],
        ),
        built(
            "vertex_without_a_coordinate",
            &object("<b:beamlattice radius=\"1\" minlength=\"0\"/>").replace(" z=\"1\"", ""),
            BUILD,
            &["3dmodel.model:2", "<vertex> has no z"],
        ),
    ]
}

fn keys() -> Vec<Case> {
    let with = |name, key: &str, message| {
        Case::new(name, format!("{SCENE}{key}\n"), message)
            .with_bytes("lattice.3mf", three_mf(&model("", "")))
    };
    vec![
        with(
            "lattice_of_an_unknown_scene_unit",
            "unit = \"mm\"",
            &[
                "scene.toml:3:8",
                "\"mm\" is not a value of unit",
                "\"millimeter\"",
            ],
        ),
        with(
            "lattice_of_an_unknown_word_for_meshes",
            "meshes = \"keep\"",
            &[
                "scene.toml:3:10",
                "\"keep\" is not a value of meshes",
                "\"skip\"",
            ],
        ),
        with(
            "lattice_with_caps_in_the_scene",
            "caps = \"both\"",
            &["scene.toml:3:1", "unknown key \"caps\"", "\"unit\""],
        ),
    ]
}

pub fn cases() -> Vec<Case> {
    [archives(), models(), lattices(), keys()]
        .into_iter()
        .flatten()
        .collect()
}
