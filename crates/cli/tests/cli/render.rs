//! `cyltrace render` and `cyltrace info`, from scene files to pictures.

use crate::program;

use std::fs;
use std::path::Path;

use program::{command, cyltrace, folder_of};
use serde_json::Value;
use tempfile::TempDir;

/// Ten cylinders of all cap kinds in a prototype, placed three times, two of
/// them through another prototype.
const SCENE: &str = r#"
[[cylinder]]
p0 = [0, 0, -1]
p1 = [0, 0, -0.9]
radius = 6

[[instance]]
of = "group"
translate = [-2, 0, 0]

[[instance]]
of = "pair"
translate = [2, 0, 0]

[[prototype]]
name = "pair"
[[prototype.instance]]
of = "group"
scale = 0.5
[[prototype.instance]]
of = "group"
scale = 0.7
translate = [0, 3, 0]

[[prototype]]
name = "group"
[[prototype.cylinder]]
p0 = [0, 0, -0.8]
p1 = [0.3, 0, 1]
radius = 0.4
caps = "none"
[[prototype.cylinder]]
p0 = [1, 0, 0]
p1 = [1, 1, 0]
radius = 0.2
caps = "p0"
[[prototype.cylinder]]
p0 = [0, 1, 0]
p1 = [0, 1, 2]
radius = 0.1
caps = "p1"
[[prototype.cylinder]]
p0 = [-1, 0, 0]
p1 = [-1, 1, 1]
radius = 0.3
"#;

/// A directory that holds `scene.toml`.
fn workplace() -> TempDir {
    folder_of(&[("scene.toml", SCENE)])
}

fn files_in(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).expect("readable");
    let mut names: Vec<_> = entries
        .map(|entry| {
            entry
                .expect("entry")
                .file_name()
                .into_string()
                .expect("UTF-8")
        })
        .collect();
    names.sort();
    names
}

/// The bytes of a small picture made with some flags.
fn picture(directory: &Path, name: &str, flags: &[&str]) -> Vec<u8> {
    let arguments = [
        "render",
        "scene.toml",
        "-o",
        name,
        "--size",
        "97x61",
        "--quiet",
    ];
    let (code, out, err) = cyltrace(directory, &[&arguments, flags].concat());
    assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""), "{flags:?}");
    fs::read(directory.join(name)).expect("a picture")
}

#[test]
fn picture_any_thread_count_same_bytes() {
    let directory = workplace();
    for integrator in ["sun", "ao", "normal"] {
        for name in ["a.png", "a.exr"] {
            let with = |threads| {
                let flags = ["--threads", threads, "--integrator", integrator];
                picture(directory.path(), name, &flags)
            };
            let one = with("1");
            assert!(one == with("2"), "{integrator} {name}: 2 threads differ");
            assert!(one == with("7"), "{integrator} {name}: 7 threads differ");
        }
    }
}

#[test]
fn picture_any_instruction_set_same_bytes() {
    let directory = workplace();
    let best = picture(directory.path(), "a.exr", &[]);
    for isa in cyltrace::embree::MaxIsa::available() {
        let held = picture(directory.path(), "a.exr", &["--max-isa", isa.name()]);
        assert!(best == held, "{isa} differs");
    }
}

#[test]
fn picture_seed_changes_samples_only_with_the_seed() {
    let directory = workplace();
    let first = picture(directory.path(), "a.exr", &["--seed", "1"]);
    assert!(first == picture(directory.path(), "a.exr", &["--seed", "1"]));
    assert!(first != picture(directory.path(), "a.exr", &["--seed", "2"]));
}

#[test]
fn json_of_render_has_the_promised_keys_and_counts() {
    let directory = workplace();
    let arguments = [
        "render",
        "scene.toml",
        "-o",
        "a.png",
        "--size",
        "64x48",
        "--spp",
        "2",
        "--threads",
        "2",
        "--json",
        "-",
    ];
    let (code, out, err) = cyltrace(directory.path(), &arguments);
    assert_eq!(code, 0, "{err}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(figures["scene"], "scene.toml");
    assert_eq!(figures["size"], serde_json::json!([64, 48]));
    assert_eq!(figures["spp"], 2);
    assert_eq!(figures["integrator"], "sun");
    assert_eq!(figures["rays"]["camera"], 64 * 48 * 2);
    for time in ["load_s", "build_s", "render_s", "rays_per_s"] {
        assert!(
            figures[time].as_f64().is_some_and(|s| s > 0.0),
            "{time}: {figures}"
        );
    }
    for kind in ["shadow", "ao"] {
        assert!(
            figures["rays"][kind].as_u64().is_some_and(|n| n > 0),
            "{kind}: {figures}"
        );
    }
    assert_eq!(figures["cylinders"]["unique"], 5);
    assert_eq!(figures["cylinders"]["instanced"], 1 + 3 * 4);
    assert_eq!(figures["instances"], 4);
    for part in ["embree_bytes", "records_bytes"] {
        assert!(
            figures["memory"][part].as_u64().is_some_and(|n| n > 0),
            "{part}: {figures}"
        );
    }
    assert_eq!(
        figures["memory"]["peak_rss_bytes"].as_u64().is_some(),
        Path::new("/proc/self/status").exists()
    );
    assert!(figures["skipped"].is_array());
    assert!(
        figures["embree"]
            .as_str()
            .is_some_and(|version| version.contains('.'))
    );
    assert!(figures["isa"].is_string());
    assert_eq!(figures["threads"], 2);
}

#[test]
fn rows_left_out_are_told_by_render() {
    let directory = workplace();
    let write = |name, text| fs::write(directory.path().join(name), text).expect("written");
    write("a.csv", "x,y,z,X,Y,Z,r\n0,0,0,1,0,0,0.1\n0,0,0,0,0,0,0.1\n");
    write(
        "rows.toml",
        "[[cylinder_table]]\nfile = \"a.csv\"\ndegenerate = \"skip\"\n\
         columns = { p0 = [\"x\", \"y\", \"z\"], p1 = [\"X\", \"Y\", \"Z\"], radius = \"r\" }\n",
    );
    let arguments = ["render", "rows.toml", "-o", "a.png", "--size", "8x8"];
    let (code, out, err) = cyltrace(directory.path(), &arguments);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("skipped: degenerate rows of tables: 1"),
        "{out}"
    );
}

/// `/dev/full` refuses every byte, as a full disk does.
#[cfg(target_os = "linux")]
#[test]
fn full_standard_output_is_an_error_and_no_panic() {
    let directory = workplace();
    let render = ["render", "scene.toml", "-o", "a.png", "--size", "8x8"];
    let rendered = [&render[..], &["--json", "a.json"]].concat();
    for arguments in [&["info", "scene.toml"][..], &rendered] {
        let full = fs::File::options().write(true).open("/dev/full");
        let output = command(directory.path(), arguments)
            .stdout(full.expect("there"))
            .output()
            .expect("the program runs");
        let message = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(
            message.contains("cannot write to standard output"),
            "{message}"
        );
    }
    assert_eq!(
        files_in(directory.path()),
        ["a.json", "a.png", "scene.toml"]
    );
}

#[test]
fn integrator_without_lights_traces_no_light_rays_and_says_so() {
    let directory = workplace();
    for (integrator, kinds) in [("normal", [0, 0]), ("ao", [0, 1])] {
        let arguments = [
            "render",
            "scene.toml",
            "-o",
            "a.png",
            "--size",
            "32x32",
            "--json",
            "-",
            "--integrator",
            integrator,
        ];
        let (_, out, err) = cyltrace(directory.path(), &arguments);
        let figures: Value = serde_json::from_str(&out).expect(&err);
        for (kind, traced) in ["shadow", "ao"].into_iter().zip(kinds) {
            let rays = figures["rays"][kind].as_u64().expect("a count");
            assert_eq!(rays.min(1), traced, "{integrator}: {rays} {kind} rays");
        }
        let skipped = figures["skipped"].to_string();
        assert!(skipped.contains("no shadow rays"), "{skipped}");
    }
}

#[test]
fn failed_render_leaves_no_file_and_exits_2() {
    let directory = workplace();
    fs::write(directory.path().join("broken.toml"), "[[cylinder]\n").expect("written");
    fs::write(directory.path().join("old.png"), "old").expect("written");
    let before = files_in(directory.path());
    for (scene, output, expected) in [
        ("scene.toml", "a.jpg", ".png or .exr"),
        ("scene.toml", "nowhere/a.png", "nowhere"),
        ("missing.toml", "a.png", "missing.toml"),
        ("broken.toml", "old.png", "broken.toml"),
    ] {
        let (code, out, err) = cyltrace(directory.path(), &["render", scene, "-o", output]);
        assert_eq!(code, 2, "{scene} {output}: {err}");
        assert!(
            err.starts_with("error: ") && err.contains(expected),
            "{err}"
        );
        assert!(out.is_empty(), "{out}");
        assert_eq!(files_in(directory.path()), before, "{scene} {output}");
    }
    let old = fs::read(directory.path().join("old.png")).expect("still there");
    assert_eq!(old, b"old");
}

#[test]
fn json_to_missing_directory_refused_before_rendering() {
    let directory = workplace();
    let arguments = [
        "render",
        "scene.toml",
        "-o",
        "a.png",
        "--json",
        "nowhere/a.json",
    ];
    let (code, _, err) = cyltrace(directory.path(), &arguments);
    assert_eq!(code, 2, "{err}");
    assert_eq!(files_in(directory.path()), ["scene.toml"]);
}

#[cfg(unix)]
#[test]
fn interrupted_render_keeps_the_old_picture_and_exits_130() {
    let directory = workplace();
    let old = directory.path().join("a.png");
    fs::write(&old, "old").expect("written");
    let arguments = [
        "render",
        "scene.toml",
        "-o",
        "a.png",
        "--spp",
        "20000",
        "--threads",
        "2",
    ];
    let mut child = command(directory.path(), &arguments)
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("the program runs");
    // The temporary file shows that the rendering is under way.
    while files_in(directory.path()).len() < 3 {
        assert_eq!(child.try_wait().expect("a status"), None, "it ended early");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let sent = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill runs");
    assert!(sent.success());
    assert_eq!(child.wait().expect("a status").code(), Some(130));
    assert_eq!(files_in(directory.path()), ["a.png", "scene.toml"]);
    assert_eq!(fs::read(&old).expect("still there"), b"old");
}

#[test]
fn info_counts_what_the_scene_holds() {
    let directory = workplace();
    let (code, out, err) = cyltrace(directory.path(), &["info", "scene.toml", "--json", "-"]);
    assert_eq!(code, 0, "{err}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(figures["prototypes"]["all"], 2);
    assert_eq!(figures["prototypes"]["placed"], 2);
    assert_eq!(figures["placements"], 4);
    assert_eq!(figures["instances"], 4);
    assert_eq!(figures["depth"], 2);
    assert_eq!(figures["cylinders"]["unique"], 5);
    assert_eq!(figures["cylinders"]["instanced"], 13);
    for (axis, expected) in [(0, -6.0), (2, -1.0)] {
        let lower = figures["bounds"]["lower"][axis].as_f64().expect("a number");
        assert!((lower - expected).abs() < 1e-9, "{figures}");
    }
    assert!(
        figures["memory_estimate"]["records_bytes"]
            .as_u64()
            .is_some_and(|n| n > 0)
    );

    let (_, text, _) = cyltrace(directory.path(), &["info", "scene.toml"]);
    for words in ["5 unique", "13 instanced", "nesting depth 2"] {
        assert!(text.contains(words), "{words:?} not in\n{text}");
    }
    let (_, text, _) = cyltrace(directory.path(), &["info", "scene.toml", "--quiet"]);
    assert_eq!(text, "");
}
