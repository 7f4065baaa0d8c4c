//! `cyltrace trace`: tables of rays in, tables of hits out.

use crate::program;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use program::{cyltrace, folder_of};
use serde_json::Value;
use tempfile::TempDir;

/// Numbers without rounding: radius 0.5 about the z axis, and the same, twice
/// as large, placed at x = 8 through two levels.
const SCENE: &str = r#"
[[cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 2]
radius = 0.5

[[instance]]
of = "pair"
translate = [8, 0, 0]

[[prototype]]
name = "pair"
[[prototype.instance]]
of = "post, open"
translate = [0, 64, 0]
[[prototype.instance]]
of = "post, open"
scale = 2

[[prototype]]
name = "post, open"
[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 2]
radius = 0.5
caps = "none"
"#;

const RAYS: &str = "\
# from the left, from above, beside, from inside a tube, behind, too short

 ox , oy, oz, dx,dy,dz,t_min,t_max
-4,0,1,1,0,0,0,inf
0,0.25,4,0,0,-2,0,inf
   \n\
0,4,1,1,0,0,-inf,inf
8,0,1,4,0,0,0,inf
# a comment between
4,0,1,1,0,0,-10,0
-4,0,1,1,0,0,0,3.25
";

/// What the rays above meet; `error`, the last column, is checked by value.
const HITS: [&str; 6] = [
    "0,1,3.5,-0.5,0,1,-1,0,0,,cylinder,0,side,enter,,0.5,0.5",
    "1,1,1,0,0.25,2,0,0,1,,cylinder,0,cap1,enter,,0.25,1",
    "2,0,,,,,,,,,,,,,,,",
    "3,1,0.25,9,0,1,1,0,0,\"post, open\",cylinder,0,side,leave,0/1,0,0.25",
    "4,1,-4.5,-0.5,0,1,-1,0,0,,cylinder,0,side,enter,,0.5,0.5",
    "5,0,,,,,,,,,,,,,,,",
];

fn workplace(rays: &[u8]) -> TempDir {
    folder_of(&[("scene.toml", SCENE.as_bytes()), ("rays.csv", rays)])
}

fn trace(directory: &Path, flags: &[&str]) -> (i32, String, String) {
    let arguments = ["trace", "scene.toml", "--rays", "rays.csv"];
    cyltrace(directory, &[&arguments, flags].concat())
}

#[test]
fn hits_of_exact_rays_match_the_golden_rows() {
    let directory = workplace(RAYS.as_bytes());
    let (code, out, err) = trace(directory.path(), &["-o", "-"]);
    assert_eq!(code, 0, "{err}");
    let mut lines = out.lines();
    assert_eq!(
        lines.next(),
        Some("ray,hit,t,x,y,z,nx,ny,nz,prototype,solid,primitive,part,crossing,instance,u,v,error")
    );
    for expected in HITS {
        let line = lines.next().expect("a row a ray");
        let (row, error) = line.rsplit_once(',').expect("columns");
        assert_eq!(row, expected);
        if expected.contains("cylinder") {
            let error: f64 = error.parse().expect("a number");
            assert!(error > 0.0 && error < 9e-12, "{line}");
        } else {
            assert_eq!(error, "", "{line}");
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn columns_in_another_order_and_quoted_same_hits() {
    let plain = workplace(b"ox,oy,oz,dx,dy,dz\n-4,0.125,1,1,0,0\n");
    let other =
        workplace(b"\xef\xbb\xbf\"dz\", \"dy\",dx,oz,oy,ox,t_max\r\n0,\"0\",1,1,0.125,-4,inf\r\n");
    let (code, expected, _) = trace(plain.path(), &["-o", "-"]);
    assert_eq!(code, 0);
    assert_eq!(trace(other.path(), &["-o", "-"]).1, expected);
}

#[test]
fn many_rays_any_thread_count_same_rows_in_order() {
    let mut rays = String::from("ox,oy,oz,dx,dy,dz\n");
    let count = 30_000;
    for ray in 0..count {
        let sideways = f64::from(ray) / f64::from(count) - 0.5;
        rays += &format!("-4,{},{sideways:?},1,{sideways:?},0.01\n", ray % 7);
        if ray % 1000 == 0 {
            rays += "# a comment that takes a line but no number\n";
        }
    }
    let directory = workplace(rays.as_bytes());
    let with = |threads| {
        let flags = ["-o", "hits.csv", "--threads", threads, "--quiet"];
        let (code, out, err) = trace(directory.path(), &flags);
        assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""));
        fs::read_to_string(directory.path().join("hits.csv")).expect("written")
    };
    let one = with("1");
    assert!(one == with("2"), "2 threads differ");
    assert!(one == with("7"), "7 threads differ");
    assert_eq!(one.lines().count(), count as usize + 1);
    for (ray, row) in one.lines().skip(1).enumerate() {
        assert!(row.starts_with(&format!("{ray},")), "row {ray}: {row}");
    }
}

#[test]
fn json_of_trace_counts_rays_and_hits() {
    let directory = workplace(RAYS.as_bytes());
    let (code, out, err) = trace(directory.path(), &["-o", "hits.csv", "--json", "-"]);
    assert_eq!(code, 0, "{err}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(figures["rays"], 6);
    assert_eq!(figures["hits"], 4);
    assert_eq!(figures["cylinders"]["instanced"], 3);
    for key in ["load_s", "build_s", "trace_s", "rays_per_s", "threads"] {
        assert!(
            figures[key].as_f64().is_some_and(|n| n > 0.0),
            "{key}: {figures}"
        );
    }
    for key in ["embree", "isa"] {
        assert!(figures[key].is_string(), "{key}: {figures}");
    }
}

#[test]
fn bad_ray_rows_refused_by_place_and_value_and_nothing_written() {
    let header = "ox,oy,oz,dx,dy,dz";
    let ranged = "ox,oy,oz,dx,dy,dz,t_min,t_max";
    for (rays, expected) in [
        (String::new(), &["rays.csv", "needs a header", header][..]),
        ("# only a comment\n".into(), &["rays.csv", "needs a header"]),
        (
            "ox,oy,oz,dx,dy\n".into(),
            &["rays.csv:1", "no column \"dz\""],
        ),
        (
            format!("\n{header},ox\n"),
            &["rays.csv:2", "more than one column \"ox\""],
        ),
        (
            format!("{header}\n1,2,3,4,5,6\n1,2,3,4,x,6\n"),
            &["rays.csv:3", "\"dy\"", "\"x\""],
        ),
        (
            format!("{header}\n# a\n\n1,2,,4,5,6\n"),
            &["rays.csv:4", "\"oz\"", "the cell is empty"],
        ),
        (
            format!("{header}\n1,nan,3,4,5,6\n"),
            &["rays.csv:2", "\"oy\"", "\"nan\"", "finite"],
        ),
        (
            format!("{header}\n1,2,3,inf,5,6\n"),
            &["rays.csv:2", "\"dx\"", "\"inf\"", "finite"],
        ),
        (
            format!("{header}\n1,2,3,1e999,5,6\n"),
            &["rays.csv:2", "\"dx\"", "\"1e999\""],
        ),
        (
            format!("{header}\n1,2,3,0,-0,0\n"),
            &["rays.csv:2", "direction is zero"],
        ),
        (
            format!("{header}\n1,2,3,4,5\n"),
            &["rays.csv:2", "5 cells", "6"],
        ),
        (
            format!("{header}\n1,2,3,4,5,6,7\n"),
            &["rays.csv:2", "7 cells", "6"],
        ),
        (
            format!("{ranged}\n1,2,3,4,5,6,nan,1\n"),
            &["rays.csv:2", "\"t_min\"", "\"nan\""],
        ),
        (
            format!("{ranged}\n1,2,3,4,5,6,2,1\n"),
            &["rays.csv:2", "t_min", "2.0", "1.0"],
        ),
        (
            format!("{header}\n{},2,3,4,5,6\n", "9".repeat(1_000_000)),
            &["rays.csv:2", "\"ox\"", "...", "1000000 bytes"],
        ),
    ] {
        let start: String = rays.chars().take(80).collect();
        let directory = workplace(rays.as_bytes());
        let (code, out, err) = trace(directory.path(), &["-o", "hits.csv"]);
        assert_eq!(code, 2, "{start:?}: {err}");
        assert!(out.is_empty(), "{start:?}: {out}");
        assert!(
            err.starts_with("error: ") && err.len() < 300,
            "{start:?}: {err}"
        );
        for fragment in expected {
            assert!(
                err.contains(fragment),
                "{start:?} without {fragment:?}: {err}"
            );
        }
        let left = fs::read_dir(directory.path()).expect("readable").count();
        assert_eq!(left, 2, "{start:?} left a file");
    }
}

#[test]
fn rays_from_standard_input_same_hits_and_errors_by_line() {
    let directory = workplace(RAYS.as_bytes());
    let from_input = |rays: &str| {
        Command::cargo_bin("cyltrace")
            .expect("the program is built")
            .current_dir(directory.path())
            .args(["trace", "scene.toml", "--rays", "-", "-o", "-"])
            .write_stdin(rays)
            .output()
            .expect("the program runs")
    };
    let (_, expected, _) = trace(directory.path(), &["-o", "-"]);
    // A file of that name is another thing.
    fs::write(directory.path().join("-"), "no rays").expect("written");
    let output = from_input(RAYS);
    assert!(output.status.success(), "{output:?}");
    assert!(expected.lines().count() == HITS.len() + 1);
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
    let output = from_input("ox,oy,oz,dx,dy,dz\n1,2,3,4,5,six\n");
    assert_eq!(output.status.code(), Some(2));
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(
        err.contains("standard input:2: ") && err.contains("\"six\""),
        "{err}"
    );
}

#[test]
fn bad_row_after_good_ones_nothing_on_standard_output() {
    let mut rays = String::from("ox,oy,oz,dx,dy,dz\n");
    rays += &"-4,0,1,1,0,0\n".repeat(50_000);
    rays += "-4,0,1,1,0,zero\n-4,0,1,1,0,nought\n";
    let directory = workplace(rays.as_bytes());
    let (code, out, err) = trace(directory.path(), &["-o", "-"]);
    assert_eq!(code, 2);
    assert!(
        err.contains("rays.csv:50002") && err.contains("\"zero\""),
        "{err}"
    );
    assert!(out.is_empty());
}

#[test]
fn rays_that_are_not_a_text_file_refused() {
    let directory = workplace(b"ox,oy,oz,dx,dy,dz\n1,2,\xff,4,5,6\n");
    let (code, _, err) = trace(directory.path(), &["-o", "hits.csv"]);
    assert!(
        code == 2 && err.contains("rays.csv:2") && err.contains("UTF-8"),
        "{err}"
    );
    fs::remove_file(directory.path().join("rays.csv")).expect("removed");
    let (code, _, err) = trace(directory.path(), &["-o", "hits.csv"]);
    assert!(code == 2 && err.contains("rays.csv"), "{err}");
    fs::create_dir(directory.path().join("rays.csv")).expect("directory");
    let (code, _, err) = trace(directory.path(), &["-o", "hits.csv"]);
    assert!(code == 2 && err.contains("is a directory"), "{err}");
}

#[test]
fn rays_that_cannot_be_read_write_no_header_either() {
    let folder = workplace(RAYS.as_bytes());
    for rays in ["none.csv", "."] {
        let arguments = ["trace", "scene.toml", "--rays", rays, "-o", "-"];
        let (code, out, err) = cyltrace(folder.path(), &arguments);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
    }
}
