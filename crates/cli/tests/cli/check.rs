//! `cyltrace check`, as users run it.

use crate::program;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use cyltrace::math::Random;
use cyltrace::solid::tessellation::inscribed_prism;
use cyltrace::solid::{Caps, Cylinder};
use glam::DVec3;
use program::{cyltrace, folder_of};
use serde_json::Value;

/// Two capped cylinders that do not touch.
const SCENE: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 2]\nradius = 0.5\ncaps = \"both\"\n\
[[cylinder]]\np0 = [2, 0, 0]\np1 = [2, 1, 1]\nradius = 0.25\ncaps = \"both\"\n";

/// The same, for tests that make meshes of them.
fn cylinders() -> [Cylinder; 2] {
    let new = |p0: [f64; 3], p1: [f64; 3], radius| {
        Cylinder::new(DVec3::from(p0), DVec3::from(p1), radius, Caps::Both).expect("a cylinder")
    };
    [
        new([0.0; 3], [0.0, 0.0, 2.0], 0.5),
        new([2.0, 0.0, 0.0], [2.0, 1.0, 1.0], 0.25),
    ]
}

/// A folder with the scene, `count` rays to points around it, and the hits of
/// `cyltrace trace`.
fn folder(count: u64) -> tempfile::TempDir {
    let mut rays = String::from("ox,oy,oz,dx,dy,dz\n");
    for index in 0..count {
        let mut random = Random::new(3, index);
        let center = DVec3::new(1.0, 0.3, 1.0);
        let o = center + random.direction() * 6.0;
        let d = center + random.direction() * random.uniform(0.0, 1.5) - o;
        let cells = [o.x, o.y, o.z, d.x, d.y, d.z].map(|x| format!("{x:?}"));
        writeln!(rays, "{}", cells.join(",")).unwrap();
    }
    let folder = folder_of(&[("scene.toml", SCENE), ("rays.csv", &rays)]);
    let arguments = [
        "trace",
        "scene.toml",
        "--rays",
        "rays.csv",
        "-o",
        "hits.csv",
        "--quiet",
    ];
    assert_eq!(cyltrace(folder.path(), &arguments).0, 0);
    folder
}

/// The hits of the folder, each changed by `change`, as a table of two columns.
fn told(folder: &Path, change: impl Fn(usize, Option<f64>) -> Option<f64>) -> String {
    let mut reader = csv::Reader::from_path(folder.join("hits.csv")).unwrap();
    let mut text = String::from("# another program\nt,hit\n");
    for (number, record) in reader.records().enumerate() {
        let record = record.unwrap();
        let t = (&record[1] == "1").then(|| record[2].parse().unwrap());
        match change(number, t) {
            Some(t) => writeln!(text, "{t:?},1").unwrap(),
            None => writeln!(text, ",0").unwrap(),
        }
    }
    text
}

const AGAINST: [&str; 6] = [
    "check",
    "scene.toml",
    "--rays",
    "rays.csv",
    "--hits",
    "told.csv",
];

#[test]
fn check_json_has_the_promised_keys_and_the_scene_holds() {
    let folder = folder(1);
    let arguments = [
        "check",
        "scene.toml",
        "--rays",
        "600",
        "--segments",
        "64,8",
        "--json",
        "-",
    ];
    let (code, out, err) = cyltrace(folder.path(), &arguments);
    assert_eq!(code, 0, "{err}{out}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(figures["violations"], 0);
    assert_eq!(figures["holds"], true);
    let rows = figures["classes"].as_array().expect("an array");
    let prisms: Vec<(&str, u64)> = rows
        .iter()
        .filter(|row| row["witness"] == "prisms")
        .map(|row| {
            (
                row["name"].as_str().unwrap(),
                row["segments"].as_u64().unwrap(),
            )
        })
        .collect();
    let classes = ["camera", "sphere", "inside", "grazing", "axial"];
    let expected: Vec<(&str, u64)> = [8, 64]
        .iter()
        .flat_map(|&sides| classes.map(|class| (class, sides)))
        .collect();
    assert_eq!(prisms, expected);
    for row in rows {
        let keys: Vec<&str> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        assert_eq!(
            keys[..7],
            [
                "name",
                "witness",
                "segments",
                "rays",
                "violations",
                "band_percent",
                "max_dt_over_chord"
            ]
        );
    }
    let convergence = figures["convergence"].as_array().expect("an array");
    let band = |row: usize| convergence[row]["band_percent"].as_f64().unwrap();
    assert!(band(0) > 4.0 * band(1), "{convergence:?}");
}

/// Embree's f32 depends on the instruction set; what a verdict is made of does not.
#[test]
fn check_json_differs_by_instruction_set_in_named_fields_only() {
    let folder = folder(1);
    let figures = |isa: &str| -> Value {
        let arguments = ["check", "scene.toml", "--rays", "2000", "--json", "-"];
        let arguments = [&arguments[..], &["--max-isa", isa]].concat();
        let (code, out, err) = cyltrace(folder.path(), &arguments);
        assert_eq!(code, 0, "{err}{out}");
        let mut figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
        let named = figures["isa_dependent"].as_array().expect("names").clone();
        for name in ["isa", "check_s"] {
            figures.as_object_mut().expect("an object").remove(name);
        }
        for rows in ["classes", "convergence"] {
            for row in figures[rows].as_array_mut().expect("rows") {
                for name in &named {
                    let name = name.as_str().expect("a name");
                    row.as_object_mut().expect("an object").remove(name);
                }
            }
        }
        figures
    };
    let least = figures("sse2");
    assert!(least["classes"][0]["hits"].is_u64());
    for isa in ["avx2", "avx512"] {
        assert_eq!(least, figures(isa), "{isa}");
    }
}

#[test]
fn check_report_is_written_whole_and_needs_nothing_else() {
    let folder = folder(1);
    let arguments = [
        "check",
        "scene.toml",
        "--rays",
        "300",
        "--segments",
        "8,16,32",
        "--class",
        "sphere",
        "--report",
        "new/report",
    ];
    let (code, out, err) = cyltrace(folder.path(), &arguments);
    assert_eq!(code, 0, "{err}{out}");
    assert!(
        out.contains("passes: no answer is wrong") && out.contains("index.html"),
        "{out}"
    );
    let names: Vec<_> = fs::read_dir(folder.path().join("new/report"))
        .expect("the directory is made")
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(names, ["index.html"]);
    let page = fs::read_to_string(folder.path().join("new/report/index.html")).unwrap();
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 4);
    for part in [
        "<svg",
        "Convergence",
        "No answer is wrong.",
        "the mesh alone in 0",
    ] {
        assert!(page.contains(part), "no {part}");
    }
    for foreign in ["src=\"h", "href=", "@import", "url(", "<script"] {
        assert!(!page.contains(foreign), "the page has {foreign}");
    }
}

#[test]
fn hits_rounded_to_f32_hold() {
    let folder = folder(3000);
    let rounded = told(folder.path(), |_, t| t.map(|t| f64::from(t as f32)));
    fs::write(folder.path().join("told.csv"), rounded).unwrap();
    let (code, out, err) = cyltrace(folder.path(), &AGAINST);
    assert_eq!(code, 0, "{err}{out}");
}

#[test]
fn wrong_hits_fail_both_ways_with_ray_line_and_both_answers() {
    let folder = folder(2000);
    let path = folder.path().join("told.csv");
    let first = |is_hit: bool| {
        let mut reader = csv::Reader::from_path(folder.path().join("hits.csv")).unwrap();
        let rows = reader.records().map(|record| &record.unwrap()[1] == "1");
        rows.enumerate().find(|&(_, hit)| hit == is_hit).unwrap().0
    };
    type Change = fn(Option<f64>) -> Option<f64>;
    let changes: [(bool, Change, &str); 3] = [
        (true, |_| None, "answered a miss, exactly t "),
        (false, |_| Some(1.0), "answered t 1.0, exactly a miss"),
        (true, |t| t.map(|t| t * 1.001), "answered t "),
    ];
    for (of_hits, change, expected) in changes {
        let wrong = first(of_hits);
        let text = told(
            folder.path(),
            |number, t| {
                if number == wrong { change(t) } else { t }
            },
        );
        fs::write(&path, text).unwrap();
        let (code, out, err) = cyltrace(folder.path(), &AGAINST);
        assert_eq!(code, 1, "{expected}: {err}{out}");
        // The comment and the header come before the first row.
        let place = format!("ray {wrong} (told.csv:{}): {expected}", wrong + 3);
        assert!(out.contains(&place), "no {place:?} in {out}");
        assert!(
            !out.contains("--replay"),
            "a replay is of another thing: {out}"
        );
        assert!(out.contains("\n  o ("), "no ray in {out}");
    }
    // What is wrong is right with enough tolerance.
    let arguments = [&AGAINST[..], &["--tolerance", "0.01"]].concat();
    assert_eq!(cyltrace(folder.path(), &arguments).0, 0);
}

#[test]
fn bad_tables_of_hits_are_refused_with_file_and_line() {
    let folder = folder(2);
    for (text, expected) in [
        ("hit,t\n0,\n", "told.csv: the table has 1 rows for 2 rays"),
        ("hit\n0\n0\n", "told.csv:1: the table has no column \"t\""),
        (
            "hit,t\n0,\n2,1\n",
            "told.csv:3: column \"hit\": \"2\" must be 0 or 1",
        ),
        (
            "hit,t\n1,far\n0,\n",
            "told.csv:2: column \"t\": \"far\" is not a number",
        ),
        (
            "ray,hit,t\n0,0,\n0,0,\n",
            "told.csv:3: column \"ray\": \"0\" must be 1: the table must have one row per ray",
        ),
        (
            "hit,t\n0,\n0\n",
            "told.csv:3: the row has 1 cells, but the header has 2",
        ),
    ] {
        fs::write(folder.path().join("told.csv"), text).unwrap();
        let (code, out, err) = cyltrace(folder.path(), &AGAINST);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(err.contains(expected), "no {expected:?} in {err}");
    }
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let folder = folder(1);
    for (arguments, expected) in [
        (&["--hits", "hits.csv"][..], "--rays FILE"),
        (&["--rays", "rays.csv"], "needs --hits or --mesh"),
        (&["--segments", "2"], "a whole number from 3 to 4096"),
        (&["--segments", "16,"], "a whole number from 3 to 4096"),
        (
            &["--rays", "1e4"],
            "a whole number from 1 to 10^9 or the name of an existing file",
        ),
        (&["--report", "scene.toml"], "is a file"),
        (&["--max-memory", "1kB"], "bytes"),
        (
            &["--class", "upward"],
            "camera, sphere, inside, grazing, axial",
        ),
        (&["--replay", "1:2:3"], "CLASS:INDEX"),
        (&["--replay", "foo"], "CLASS:INDEX"),
        (&["--mesh", "scene.toml"], ".obj, .ply or .stl"),
        (
            &[
                "--rays", "rays.csv", "--hits", "hits.csv", "--json", "hits.csv",
            ],
            "overwrite",
        ),
    ] {
        let (code, out, err) = cyltrace(
            folder.path(),
            &[&["check", "scene.toml"], arguments].concat(),
        );
        assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}: {err}");
        assert!(err.contains(expected), "no {expected:?} in {err}");
    }
}

/// A mesh of the scene as OBJ with `comment`, all vertices moved by `shift`.
fn obj(segments: u32, comment: &str, shift: DVec3) -> String {
    let mut text = format!("# {comment}\n");
    let mut first = 1;
    for cylinder in cylinders() {
        let mesh = inscribed_prism(&cylinder, segments);
        for v in mesh.vertices.iter().map(|&vertex| vertex + shift) {
            writeln!(text, "v {:?} {:?} {:?}", v.x, v.y, v.z).unwrap();
        }
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| first + corner);
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
        first += mesh.vertices.len() as u32;
    }
    text
}

#[test]
fn mesh_within_its_deviation_holds_and_beyond_fails() {
    let folder = folder(4000);
    // The sagitta of 32 sides is 0.0048 radii.
    let good = obj(32, "deviation 0.0025 scene units", DVec3::ZERO);
    let shifted = obj(32, "deviation 0.0025", DVec3::X * 0.02);
    let silent = obj(32, "no word of it", DVec3::ZERO);
    for (name, text) in [("good", good), ("shifted", shifted), ("silent", silent)] {
        fs::write(folder.path().join(format!("{name}.obj")), text).unwrap();
    }
    let with = |more: &[&str]| cyltrace(folder.path(), &[&["check", "scene.toml"], more].concat());
    for more in [
        &["--mesh", "good.obj", "--rays", "4000"][..],
        &["--mesh", "good.obj", "--rays", "rays.csv"],
        &[
            "--mesh",
            "silent.obj",
            "--rays",
            "rays.csv",
            "--deviation",
            "0.0025",
        ],
    ] {
        let (code, out, err) = with(more);
        assert_eq!(code, 0, "{more:?}: {err}{out}");
    }
    let (code, out, _) = with(&["--mesh", "shifted.obj", "--rays", "rays.csv", "--json", "-"]);
    assert_eq!(code, 1);
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert!(figures["violations"].as_u64() > Some(100), "{out}");
    assert_eq!(figures["holds"], false);
    assert_eq!(figures["classes"][0]["witness"], "user-mesh");
    assert!(figures["classes"][0]["triangle_errors"].is_null());
    let (code, _, err) = with(&["--mesh", "silent.obj"]);
    assert_eq!(code, 2);
    assert!(err.contains("--deviation X"), "{err}");
}
