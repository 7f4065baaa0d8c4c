//! `cyltrace bench traversal`, on scenes that take seconds.

use std::fs;

use super::{bench, figures, keys, report};

const ROW_KEYS: [&str; 11] = [
    "scene",
    "rays",
    "representation",
    "threads",
    "ns_per_ray",
    "spread",
    "mrays_per_s",
    "wrong_percent",
    "p99_error_r",
    "bytes_per_cylinder",
    "build_s",
];

const REPRESENTATIONS: [&str; 16] = [
    "analytic_single",
    "analytic_packet",
    "analytic_block",
    "embree_cone",
    "embree_cone_packet",
    "embree_round",
    "embree_round_packet",
    "embree_sphere",
    "embree_sphere_packet",
    "embree_disc",
    "embree_disc_packet",
    "mesh_8",
    "mesh_16",
    "mesh_32",
    "mesh_64",
    "mesh_faces",
];

/// Too little memory for meshes of more than 16 sides.
const STICKS: [&str; 13] = [
    "traversal",
    "--scene",
    "sticks_1e4",
    "--rays",
    "64",
    "--rounds",
    "1",
    "--seed",
    "5",
    "--threads",
    "2",
    "--max-memory",
    "90MB",
];

#[test]
fn traversal_json_has_every_row_and_ratio_or_its_reason() {
    let folder = tempfile::tempdir().expect("a directory");
    let found = figures(folder.path(), &STICKS);
    let rows = found["rows"].as_array().expect("an array");
    assert_eq!(rows.len(), 3 * REPRESENTATIONS.len());
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(keys(row)[..ROW_KEYS.len()], ROW_KEYS);
        assert_eq!(row["scene"], "sticks_1e4");
        assert_eq!(
            row["rays"],
            ["coherent", "shadow", "incoherent"][number / REPRESENTATIONS.len()]
        );
        let name = REPRESENTATIONS[number % REPRESENTATIONS.len()];
        assert_eq!(row["representation"], name);
        assert_eq!(row["threads"], 2);
        if row["ns_per_ray"].is_null() {
            assert!(row["reason"].is_string(), "{row}");
            assert!(row["build_s"].is_null(), "{row}");
            continue;
        }
        assert!(row["ns_per_ray"].as_f64().unwrap() > 0.0, "{row}");
        assert!(row["reason"].is_null(), "{row}");
        let is_ours = name.starts_with("analytic");
        if is_ours {
            assert_eq!(row["wrong_percent"], 0.0, "{row}");
        }
        assert_eq!(row["ratio"].is_null(), is_ours, "{row}");
        assert_eq!(row["p99_error_r"].is_null(), row["rays"] == "shadow");
    }
    let at = |name: &str| &rows[REPRESENTATIONS.iter().position(|&one| one == name).unwrap()];
    let error = |name| at(name)["p99_error_r"].as_f64().unwrap();
    assert!(error("analytic_single") < 1e-9, "{rows:?}");
    assert!(error("embree_cone") > 1e3 * error("analytic_single"));
    assert!(at("mesh_16")["build_s"].is_f64(), "{}", at("mesh_16"));
    for name in ["mesh_32", "mesh_64"] {
        let reason = at(name)["reason"].as_str().unwrap();
        assert!(reason.contains("more than the 90.0 MB"), "{reason}");
    }

    assert_eq!(keys(&found["ratios"]), ["sticks_1e4"]);
    for rays in ["coherent", "shadow", "incoherent"] {
        let ratios = &found["ratios"]["sticks_1e4"][rays];
        assert_eq!(
            keys(ratios),
            [
                "vs_embree_cone",
                "vs_embree_round",
                "vs_embree_sphere",
                "vs_embree_disc",
                "vs_mesh_32",
                "vs_mesh_64",
                "vs_mesh_faces",
            ]
        );
        let reasons = &found["reasons"]["sticks_1e4"][rays];
        assert!(ratios["vs_embree_cone"].as_f64().unwrap() > 0.0);
        assert!(reasons["vs_embree_cone"].is_null());
        assert!(ratios["vs_mesh_64"].is_null());
        assert!(reasons["vs_mesh_64"].as_str().unwrap().contains("90.0 MB"));
    }
}

/// Two placements, one within the other, of a prototype with one pole.
const PLACED: &str = r#"
[[cylinder]]
p0 = [0, 0, -0.2]
p1 = [0, 0, 0]
radius = 20

[[prototype]]
name = "pole"

[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 3]
radius = 0.5

[[prototype]]
name = "pair"

[[prototype.instance]]
of = "pole"

[[prototype.instance]]
of = "pole"
translate = [2, 0, 0]

[[instance]]
of = "pair"

[[instance]]
of = "pair"
translate = [0, 3, 0]
scale = 1.5
"#;

#[test]
fn traversal_nested_placements_are_instanced_and_absent_scenes_say_so() {
    let folder = tempfile::tempdir().expect("a directory");
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/lattice.toml"), PLACED).unwrap();
    let found = figures(
        folder.path(),
        &[
            "traversal",
            "--scene",
            "lattice",
            "--scene",
            "forest",
            "--scenes",
            "mine",
            "--rays",
            "512",
            "--rounds",
            "1",
            "--threads",
            "1",
        ],
    );
    let rows = found["rows"].as_array().expect("an array");
    assert_eq!(rows.len(), 2 * 3 * REPRESENTATIONS.len());
    for row in rows {
        let name = row["representation"].as_str().unwrap();
        let missing = row["reason"].as_str();
        if row["scene"] == "forest" {
            let missing = missing.expect("the forest does not exist");
            assert!(missing.contains("forest.toml does not exist"), "{missing}");
            continue;
        }
        match name {
            _ if is_of_other_kinds(name) => {
                assert!(missing.unwrap().contains("of the kind cylinder"), "{row}");
            }
            _ => assert_eq!(missing, None, "{row}"),
        }
        if name.starts_with("analytic") {
            assert_eq!(row["wrong_percent"], 0.0, "{row}");
        }
        // Poles of one scale: what f32 gets wrong is at edges. Packets through instances of
        // curves find what single rays find.
        if name == "mesh_64" {
            assert!(row["wrong_percent"].as_f64().unwrap() < 3.0, "{row}");
        }
    }
    let ratios = &found["ratios"]["forest"]["coherent"];
    assert!(ratios["vs_embree_cone"].is_null());
}

fn is_of_other_kinds(representation: &str) -> bool {
    let own = ["embree_round", "embree_sphere", "embree_disc", "mesh_faces"];
    own.iter().any(|one| representation.starts_with(one))
}

#[test]
fn traversal_other_solids_have_rows_and_rivals_of_their_own() {
    let folder = tempfile::tempdir().expect("a directory");
    let scenes = [
        ("cuboids_1e5", &["mesh_faces"][..]),
        (
            "disks_1e5",
            &["embree_disc", "embree_disc_packet", "mesh_8"],
        ),
    ];
    for (scene, rivals) in scenes {
        let mut arguments = STICKS;
        arguments[2] = scene;
        // Room for 12 triangles a solid, not for 16.
        arguments[12] = "160MB";
        let found = figures(folder.path(), &arguments);
        let rows = found["rows"].as_array().expect("an array");
        assert_eq!(rows.len(), 3 * REPRESENTATIONS.len());
        for row in rows {
            let name = row["representation"].as_str().unwrap();
            let measured = ["analytic_single", "analytic_packet", "analytic_block"];
            if measured.contains(&name) || rivals.contains(&name) {
                assert!(row["reason"].is_null(), "{row}");
                // A polygon of 8 sides is a tenth smaller than its disk.
                let most = match name {
                    "mesh_8" => 25.0,
                    _ if rivals.contains(&name) => 3.0,
                    _ => 0.0,
                };
                assert!(row["wrong_percent"].as_f64().unwrap() <= most, "{row}");
                continue;
            }
            assert!(row["ns_per_ray"].is_null(), "{row}");
            let reason = row["reason"].as_str().unwrap();
            let expected = match name {
                _ if name.starts_with("mesh_") && scene == "disks_1e5" && name != "mesh_faces" => {
                    "more than the 160 MB"
                }
                _ => "of the kind",
            };
            assert!(reason.contains(expected), "{name}: {reason}");
        }
    }
}

/// Cylinders and spheres of one prototype, which is placed on a ground.
const MIXED: &str = r#"
[[cylinder]]
p0 = [0, 0, -0.2]
p1 = [0, 0, 0]
radius = 20

[[prototype]]
name = "dumbbell"

[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 3]
radius = 0.5

[[prototype.sphere]]
center = [0, 0, 3]
radius = 1

[[instance]]
of = "dumbbell"

[[instance]]
of = "dumbbell"
translate = [3, 0, 0]
"#;

const COMPOSED: &str = r#"
[[union]]
of = [
    { sphere = { center = [0, 0, 0], radius = 1 } },
    { sphere = { center = [1, 0, 0], radius = 1 } },
]
"#;

#[test]
fn traversal_mixed_solids_have_meshes_and_composed_ones_a_reason() {
    let folder = tempfile::tempdir().expect("a directory");
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/lattice.toml"), MIXED).unwrap();
    fs::write(folder.path().join("mine/forest.toml"), COMPOSED).unwrap();
    let mut arguments = vec!["traversal", "--scene", "lattice", "--scene", "forest"];
    arguments.extend(["--scenes", "mine", "--rays", "512"]);
    arguments.extend(["--rounds", "1", "--threads", "1"]);
    let found = figures(folder.path(), &arguments);
    for row in found["rows"].as_array().expect("an array") {
        let name = row["representation"].as_str().unwrap();
        let missing = row["reason"].as_str();
        if row["scene"] == "forest" {
            assert!(missing.unwrap().contains("set operations"), "{row}");
        } else if name.starts_with("analytic") {
            assert_eq!(row["wrong_percent"], 0.0, "{row}");
        } else if name == "mesh_64" {
            assert!(row["wrong_percent"].as_f64().unwrap() < 5.0, "{row}");
        } else if name == "embree_cone" {
            assert!(missing.unwrap().contains("of the kind sphere"), "{row}");
        } else if name == "embree_sphere" {
            assert!(missing.unwrap().contains("of the kind cylinder"), "{row}");
        }
    }
}

#[test]
fn traversal_own_rivals_alone_are_summed_up_with_their_orders() {
    let folder = tempfile::tempdir().expect("a directory");
    let mut arguments = STICKS.to_vec();
    // Shadow rays of one tile are in one order only.
    arguments[4] = "256";
    arguments.extend(["--rival", "own", "--max-isa", "avx2"]);
    let found = figures(folder.path(), &arguments);
    let rows = found["rows"].as_array().expect("an array");
    let expected: Vec<&str> = REPRESENTATIONS
        .into_iter()
        .filter(|name| !name.starts_with("mesh_") || *name == "mesh_faces")
        .collect();
    assert_eq!(rows.len(), 3 * expected.len());
    for (row, name) in rows.iter().zip(expected.iter().cycle()) {
        assert_eq!(row["representation"], *name);
        let order = row["order"].as_str();
        assert_eq!(order.is_some(), row["reason"].is_null(), "{row}");
        if name.starts_with("analytic") {
            assert_eq!(order, Some("given"), "{row}");
        }
    }
    for key in ["processor", "embree"] {
        assert!(!found[key].as_str().unwrap().is_empty());
    }
    assert_eq!(found["clock"], "wall");
    let isa = found["isa"].as_str().unwrap();
    assert_ne!(isa, "avx512");
    let best = found["best"].as_array().expect("an array");
    assert_eq!(best.len(), 3);
    for (best, rays) in best.iter().zip(["coherent", "shadow", "incoherent"]) {
        assert_eq!(
            (&best["scene"], &best["rays"]),
            (&rows[0]["scene"], &rays.into())
        );
        assert!(best["ours"].as_str().unwrap().starts_with("analytic_"));
        assert!(best["rival"].as_str().unwrap().starts_with("embree_cone"));
        assert_eq!(best["wrong_percent"], 0.0);
        let ratios = &found["ratios"]["sticks_1e4"][rays];
        assert_eq!(best["ratio"], ratios["vs_embree_cone"]);
        assert!(best["bytes_per_cylinder"].as_f64() > best["rival_bytes_per_cylinder"].as_f64());
    }
}

#[test]
fn traversal_report_is_written_whole_and_needs_nothing_else() {
    let folder = tempfile::tempdir().expect("a directory");
    let (out, names) = report(folder.path(), &STICKS);
    for part in [
        "embree_cone_packet",
        "times as fast: sticks_1e4",
        "Embree's own",
        "0 wrong in all 9 rows",
        "index.html",
    ] {
        assert!(out.contains(part), "no {part} in {out}");
    }
    assert_eq!(
        names,
        [
            "index.html",
            "sticks_1e4-bytes.svg",
            "sticks_1e4-coherent.svg",
            "sticks_1e4-incoherent.svg",
            "sticks_1e4-shadow.svg",
            "traversal.csv",
        ]
    );
    let read = |name: &str| fs::read_to_string(folder.path().join("new/report").join(name));
    let rows = 3 * REPRESENTATIONS.len();
    let table = read("traversal.csv").unwrap();
    assert_eq!(table.lines().count(), 1 + rows);
    let headings = table.lines().next().unwrap();
    assert!(headings.ends_with("ratio_spread,reason,order,processor,embree,isa,ratio_to"));
    let page = read("index.html").unwrap();
    assert!(page.contains(&read("sticks_1e4-coherent.svg").unwrap()));
}

#[test]
fn traversal_unknown_scene_is_refused_with_the_known_ones() {
    let folder = tempfile::tempdir().expect("a directory");
    let (code, out, err) = bench(folder.path(), &["traversal", "--scene", "sticks"]);
    assert_eq!((code, out.as_str()), (2, ""));
    for part in ["sticks_1e4", "lattice", "forest", "rounded_cones_1e5"] {
        assert!(err.contains(part), "no {part} in {err}");
    }
}

#[test]
fn traversal_unknown_rival_is_refused_with_the_known_ones() {
    let folder = tempfile::tempdir().expect("a directory");
    for name in ["cone", "analytic_single"] {
        let (code, out, err) = bench(folder.path(), &["traversal", "--rival", name]);
        assert_eq!((code, out.as_str()), (2, ""));
        for part in [
            "[possible values: own, embree_cone",
            "embree_disc_packet",
            "mesh_faces",
        ] {
            assert!(err.contains(part), "no {part} in {err}");
        }
        assert!(!err.contains("analytic_block"), "{err}");
    }
}
