//! `cyltrace tessellate`: files, figures, and what it refuses.

use crate::program;

use std::fs;
use std::path::Path;
use std::process::Command;

use program::{command, cyltrace, folder_of, words};
use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = r#"
[[cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 1]
radius = 1

[[instance]]
of = "tube"
translate = [4, 0, 0]

[[prototype]]
name = "tube"
[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 1]
radius = 0.5
caps = "none"
"#;

fn workplace() -> TempDir {
    folder_of(&[("scene.toml", SCENE)])
}

/// Runs `cyltrace tessellate` with words that need no quoting.
fn tessellate(directory: &Path, line: &str) -> (i32, String, String) {
    cyltrace(directory, &[&["tessellate"], &words(line)[..]].concat())
}

#[test]
fn mesh_is_stated_written_and_told_in_json() {
    let directory = workplace();
    let read = |name: &str| fs::read(directory.path().join(name)).expect("written");
    let line = "scene.toml -o a.obj --segments 8";
    let (code, out, err) = tessellate(directory.path(), line);
    assert_eq!((code, err.as_str()), (0, ""));
    for words in [
        "2 inscribed prisms of 8 sides, 34 vertices, 48 triangles",
        "deviation: at most 0.07612046748",
    ] {
        assert!(out.contains(words), "{words:?} not in {out}");
    }
    let text = String::from_utf8(read("a.obj")).expect("text");
    let count = |key: &str| text.lines().filter(|line| line.starts_with(key)).count();
    assert_eq!((count("v "), count("f "), count("g ")), (34, 48, 2));
    assert!(text.contains("# deviation 0.07612046748"), "{text}");
    assert!(text.contains("# scene scene.toml\n") && text.contains("g tube/0\n"));

    let line = "scene.toml -o b.PLY --segments 8 --circumscribed --json -";
    let (code, out, err) = tessellate(directory.path(), line);
    assert_eq!(code, 0, "{err}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(figures["fit"], "circumscribed");
    assert_eq!(figures["vertices"], 34);
    assert_eq!(figures["triangles"], 48);
    assert_eq!(figures["solids"], 2);
    let deviation = figures["deviation"].as_f64().expect("a number");
    assert!((deviation - 0.0823922002923).abs() < 1e-11, "{deviation}");
    assert!(read("b.PLY").starts_with(b"ply\nformat binary_little_endian 1.0\n"));

    // The same bits again, and 64 sides where nothing is asked for.
    let (code, out, _) = tessellate(directory.path(), "scene.toml -o c.obj --quiet --inscribed");
    assert_eq!((code, out.as_str()), (0, ""));
    tessellate(directory.path(), "scene.toml -o d.obj --segments 64");
    assert!(read("c.obj") == read("d.obj"));
}

#[test]
fn solids_of_all_kinds_are_written_and_composed_ones_refused() {
    const KINDS: &str = r#"
[[sphere]]
center = [0, 0, 0]
radius = 1

[[cuboid]]
half_widths = [1, 2, 0.5]

[[cone]]
p0 = [0, 0, 0]
p1 = [0, 0, 1]
radius0 = 1
radius1 = 0

[[rounded_cone]]
p0 = [0, 0, 0]
p1 = [3, 0, 0]
radius0 = 0.5
radius1 = 0.5

[[disk]]
center = [0, 0, 0]
normal = [1, 1, 1]
radius = 1
"#;
    let directory = workplace();
    fs::write(directory.path().join("kinds.toml"), KINDS).expect("written");
    let line = "kinds.toml -o kinds.obj --segments 8";
    let (code, out, err) = tessellate(directory.path(), line);
    assert_eq!((code, err.as_str()), (0, ""));
    // Ball and capsule have four rings and two poles; 8, 1 + 9 and 9 corners more.
    // The ball deviates most: 1 - cos 18 degrees along the meridian, and around the
    // rings at 72 degrees sin 72 (1 - cos 22.5) degrees.
    for words in [
        "5 inscribed meshes of 8 sides, 95 vertices, 164 triangles",
        "deviation: at most 0.12133835",
    ] {
        assert!(out.contains(words), "{words:?} not in {out}");
    }
    let text = fs::read_to_string(directory.path().join("kinds.obj")).expect("written");
    let count = |key: &str| text.lines().filter(|line| line.starts_with(key)).count();
    assert_eq!((count("v "), count("f "), count("g ")), (95, 164, 1));

    let composed = format!(
        "{KINDS}\n[[union]]\nof = [\n{{ sphere = {{ center = [0, 0, 0], radius = 1 }} }},\n\
         {{ sphere = {{ center = [1, 0, 0], radius = 1 }} }},\n]\n"
    );
    fs::write(directory.path().join("composed.toml"), composed).expect("written");
    let (code, _, err) = tessellate(directory.path(), "composed.toml -o composed.obj");
    assert_eq!(code, 2, "{err}");
    for words in [
        "solids composed by union, intersection or difference cannot be tessellated, and the scene contains 1",
        "remove them, or list their parts as separate solids",
    ] {
        assert!(err.contains(words), "{words:?} not in {err}");
    }
    assert!(!directory.path().join("composed.obj").exists());
}

#[test]
fn refusals_name_the_remedy_and_write_nothing() {
    let directory = workplace();
    fs::write(directory.path().join("broken.toml"), "[[cylinder]\n").expect("written");
    fs::write(directory.path().join("old.obj"), "old").expect("written");
    for (line, expected) in [
        ("scene.toml", "--output"),
        ("-o a.obj", "<SCENE>"),
        ("scene.toml -o a.stl", "must end in .obj or .ply"),
        ("scene.toml -o -", "must end in .obj or .ply"),
        ("scene.toml -o nowhere/a.obj", "nowhere"),
        ("missing.toml -o a.obj", "missing.toml"),
        ("broken.toml -o old.obj", "broken.toml"),
        (
            "scene.toml -o a.obj --inscribed --circumscribed",
            "'--inscribed' cannot be used with '--circumscribed'",
        ),
        (
            "scene.toml -o a.obj --segments 2",
            "'2' for '--segments <N>': it must be a whole number from 3 to 4096",
        ),
        (
            "scene.toml -o a.obj --segments -8",
            "it must be a whole number from 3 to 4096",
        ),
        (
            "scene.toml -o a.obj --max-memory 4XB",
            "'4XB' for '--max-memory <SIZE>': it must be a number of bytes",
        ),
        (
            "scene.toml -o old.obj --max-memory 2kB",
            "error: the mesh needs up to ",
        ),
        ("scene.toml -o scene.toml", "would overwrite"),
        ("scene.toml -o a.obj --json a.obj", "are the same file"),
    ] {
        let (code, _, err) = tessellate(directory.path(), line);
        assert_eq!(code, 2, "{line}: {err}");
        assert!(err.contains(expected), "{line}: {expected:?} not in {err}");
        let mut names: Vec<_> = fs::read_dir(directory.path())
            .expect("readable")
            .map(|entry| entry.expect("entry").file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["broken.toml", "old.obj", "scene.toml"], "{line}");
    }
    let old = fs::read(directory.path().join("old.obj")).expect("still there");
    assert_eq!(old, b"old");
}

#[cfg(unix)]
#[test]
fn interrupted_mesh_keeps_the_old_file_and_exits_130() {
    let directory = workplace();
    let old = directory.path().join("a.obj");
    fs::write(&old, "old").expect("written");
    let many = format!(
        "{SCENE}\n[[scatter]]\nof = \"tube\"\npattern = \"grid\"\ncount = 100000\nspacing = 2\n"
    );
    fs::write(directory.path().join("many.toml"), many).expect("written");
    let line = "tessellate many.toml -o a.obj --segments 512 --max-memory 1TB";
    let mut child = command(directory.path(), &words(line))
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("it runs");
    let count = || fs::read_dir(directory.path()).expect("readable").count();
    // The temporary file shows that the writing is under way.
    while count() < 4 {
        assert_eq!(child.try_wait().expect("a status"), None, "it ended early");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill runs");
    assert!(sent.success());
    assert_eq!(child.wait().expect("a status").code(), Some(130));
    assert_eq!(count(), 3);
    assert_eq!(fs::read(&old).expect("still there"), b"old");
}
