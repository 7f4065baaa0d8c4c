//! `cyltrace trace --points`: tables of points in, tables of the solids that hold them
//! out.

use crate::program;

use std::fs;

use program::{cyltrace, folder_of};
use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = r#"
[[sphere]]
center = [0, 0, 0]
radius = 1

[[cuboid]]
center = [1, 0, 0]
half_widths = [1, 1, 1]

[[instance]]
of = "balls, two"
translate = [10, 0, 0]

[[prototype]]
name = "balls, two"
[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 2]
radius = 0.5
caps = "none"
[[prototype.sphere]]
center = [0, 0, 0]
radius = 1
"#;

const POINTS: &str = "\
# in both, on the corner, in the placed ones, outside
z, x, y

0,0.5,0
1,2,1
0.25,10,0
-1.5,0,0
";

const ROWS: &str = "\
point,inside,prototype,solid,primitive,instance
0,1,,sphere,0,
0,1,,cuboid,1,
1,1,,cuboid,1,
2,1,\"balls, two\",cylinder,0,0
2,1,\"balls, two\",sphere,1,0
3,0,,,,
";

fn workplace(points: &str) -> TempDir {
    folder_of(&[("scene.toml", SCENE), ("points.csv", points)])
}

#[test]
fn points_have_a_row_for_each_solid_that_holds_them() {
    let directory = workplace(POINTS);
    let in_scene = ["trace", "scene.toml", "--points", "points.csv"];
    let (code, out, err) = cyltrace(directory.path(), &[&in_scene[..], &["-o", "-"]].concat());
    assert_eq!((code, out.as_str()), (0, ROWS), "{err}");

    let to_files = ["-o", "inside.csv", "--json", "figures.json", "--quiet"];
    let (code, out, err) = cyltrace(directory.path(), &[&in_scene[..], &to_files].concat());
    assert_eq!((code, out.as_str()), (0, ""), "{err}");
    let written = fs::read_to_string(directory.path().join("inside.csv")).expect("written");
    assert_eq!(written, ROWS);
    let figures = fs::read_to_string(directory.path().join("figures.json")).expect("written");
    let figures: Value = serde_json::from_str(&figures).expect("JSON");
    for (key, value) in [
        ("points", 4),
        ("inside_points", 3),
        ("containing_solids", 5),
    ] {
        assert_eq!(figures[key], value, "{key}");
    }
    assert_eq!(figures["other_solids"]["unique"], 3);
}

#[test]
fn bad_tables_of_points_are_refused_at_their_place() {
    for (points, expected) in [
        ("x,y\n1,2\n", "points.csv:1: the table has no column \"z\""),
        (
            "1,2,3\n",
            "points.csv:1: the table has no column \"x\"; its first line contains numbers",
        ),
        (
            "x,y,z\n1,2,3\n1,2\n",
            "points.csv:3: the row has 2 cells, but the header has 3",
        ),
        (
            "x,y,z\n1,inf,3\n",
            "points.csv:2: column \"y\": \"inf\" is not a finite number",
        ),
        (
            "# nothing\n",
            "points.csv:2: the table is empty: it needs a header or rows with x,y,z",
        ),
    ] {
        let directory = workplace(points);
        let arguments = [
            "trace",
            "scene.toml",
            "--points",
            "points.csv",
            "-o",
            "out.csv",
        ];
        let (code, _, err) = cyltrace(directory.path(), &arguments);
        assert_eq!(code, 2, "{err}");
        assert!(err.contains(expected), "{err}");
        assert!(!directory.path().join("out.csv").exists());
    }
}

#[test]
fn rays_and_points_and_all_do_not_go_together() {
    let directory = workplace(POINTS);
    let points = ["trace", "scene.toml", "-o", "-", "--points", "points.csv"];
    for more in [&["--rays", "points.csv"][..], &["--all"]] {
        let (code, _, err) = cyltrace(directory.path(), &[&points[..], more].concat());
        assert_eq!(code, 2);
        assert!(err.contains("cannot be used with"), "{err}");
    }
    let (code, _, err) = cyltrace(directory.path(), &points[..4]);
    assert_eq!(code, 2);
    assert!(err.contains("--rays <FILE>|--points <FILE>"), "{err}");
}
