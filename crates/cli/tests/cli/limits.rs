//! The limits of inputs and of the system: a refusal with exit code 2 and a message
//! that names the file and the limit, and no output that was not finished.

#![cfg(unix)]

use crate::program;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

use program::{cyltrace, folder_of, words};

const CYLINDER: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";

const RAYS: &str = "ox,oy,oz,dx,dy,dz\n-5,0,0.5,1,0,0\n";

/// Runs the program in a shell that has set a limit of the system.
fn limited(folder: &Path, limit: &str, line: &str) -> Output {
    let script = format!("{limit} && exec {} {line}", env!("CARGO_BIN_EXE_cyltrace"));
    let mut shell = Command::new("bash");
    shell.current_dir(folder).args(["-c", &script]);
    shell.output().expect("bash runs")
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("readable");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name())
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn what_is_no_regular_file_is_refused_as_a_scene() {
    let folder = folder_of::<&str>(&[]);
    let made = Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    assert!(made.expect("mkfifo runs").success());
    for path in ["/dev/zero", "/dev/urandom", "/dev/null", "pipe"] {
        let (code, _, error) = cyltrace(folder.path(), &["info", path]);
        assert_eq!(code, 2, "{error}");
        let expected = format!(
            "error: cannot read {path}: it is a device, a pipe or a socket: a regular file is needed\n"
        );
        assert_eq!(error, expected);
    }
    let (code, _, error) = cyltrace(folder.path(), &["info", "."]);
    assert_eq!(code, 2);
    assert!(error.contains("it is a directory"), "{error}");
}

#[test]
fn a_scene_file_beyond_the_greatest_size_is_refused_unread() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    let file = fs::OpenOptions::new()
        .write(true)
        .open(folder.path().join("scene.toml"))
        .expect("opened");
    // A hole, which takes no space on the disk.
    file.set_len(cyltrace::scene::GREATEST_SCENE_BYTES + 1)
        .expect("extended");
    let (code, _, error) = cyltrace(folder.path(), &["info", "scene.toml"]);
    assert_eq!(code, 2, "{error}");
    assert!(error.contains("more than 67108864 bytes"), "{error}");
}

#[test]
fn parsing_a_scene_stays_within_max_memory() {
    let scene = CYLINDER.repeat(150_000);
    let folder = folder_of(&[("scene.toml", scene.as_str()), ("rays.csv", RAYS)]);
    for line in [
        "info scene.toml --max-memory 20MB",
        "trace scene.toml --rays rays.csv -o hits.csv --max-memory 20MB",
        "render scene.toml -o picture.png --max-memory 20MB",
    ] {
        let (code, printed, error) = cyltrace(folder.path(), &words(line));
        assert_eq!((code, printed.as_str()), (2, ""), "{line}: {error}");
        assert_eq!(
            error,
            "error: scene.toml: reading the scene takes more memory than the limit: --max-memory allows 20.0 MB\n"
        );
        assert_eq!(names_in(folder.path()), ["rays.csv", "scene.toml"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_small_address_space_is_an_error_and_no_abort() {
    let scene = "[[prototype]]\nname = \"tree\"\n\
        [[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 0.1\n\
        [[scatter]]\nof = \"tree\"\npattern = \"grid\"\ncount = 1000000\nspacing = 2\n";
    let folder = folder_of(&[("scene.toml", scene), ("rays.csv", RAYS)]);
    let line = "trace scene.toml --rays rays.csv -o hits.csv --threads 2 --quiet";
    for megabytes in (150..=500).step_by(50) {
        let limit = format!("ulimit -v {}", megabytes * 1000);
        let output = limited(folder.path(), &limit, line);
        let error = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code();
        assert!(matches!(code, Some(0 | 2)), "{megabytes} MB: {output:?}");
        if code == Some(2) {
            assert!(error.starts_with("error: "), "{megabytes} MB: {error}");
            assert_eq!(names_in(folder.path()), ["rays.csv", "scene.toml"]);
        }
        let _ = fs::remove_file(folder.path().join("hits.csv"));
    }
}

#[test]
fn a_file_beyond_the_size_limit_is_an_error_that_names_the_output() {
    let rays = format!("ox,oy,oz,dx,dy,dz\n{}", "-5,0,0.5,1,0,0\n".repeat(20_000));
    let folder = folder_of(&[("scene.toml", CYLINDER), ("rays.csv", &rays)]);
    let before = names_in(folder.path());
    for (line, output) in [
        ("trace scene.toml --rays rays.csv -o hits.csv", "hits.csv"),
        (
            "tessellate scene.toml --segments 4096 -o mesh.obj",
            "mesh.obj",
        ),
        (
            "render scene.toml --integrator normal -o picture.exr",
            "picture.exr",
        ),
    ] {
        // Blocks of 1024 bytes.
        let ended = limited(folder.path(), "ulimit -f 50", line);
        let error = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(2), "{line}: {ended:?}");
        assert!(error.contains(output), "{line}: {error}");
        assert!(error.contains("File too large"), "{line}: {error}");
        assert!(!error.contains(".cyltrace-"), "{line}: {error}");
        assert_eq!(names_in(folder.path()), before, "{line}");
    }
}

#[test]
fn an_output_through_a_dangling_link_is_what_the_link_names() {
    let folder = folder_of(&[("scene.toml", CYLINDER), ("rays.csv", RAYS)]);
    symlink("target.csv", folder.path().join("link.csv")).expect("linked");
    let line = "trace scene.toml --rays rays.csv -o link.csv --quiet";
    let (code, _, error) = cyltrace(folder.path(), &words(line));
    assert_eq!(code, 0, "{error}");
    assert!(folder.path().join("link.csv").is_symlink());
    assert!(folder.path().join("target.csv").is_file());

    // Both outputs would be the same file.
    symlink("new.csv", folder.path().join("other.csv")).expect("linked");
    let line = "trace scene.toml --rays rays.csv -o other.csv --json new.csv";
    let (code, _, error) = cyltrace(folder.path(), &words(line));
    assert_eq!(code, 2);
    assert!(error.contains("are the same file"), "{error}");
}

#[test]
fn counts_beyond_all_numbers_are_named_so() {
    let mut scene = "[[instance]]\nof = \"p1\"\n".to_owned();
    for level in 1..64 {
        let next = format!("[[prototype.instance]]\nof = \"p{}\"\n", level + 1);
        scene += &format!("[[prototype]]\nname = \"p{level}\"\n{}", next.repeat(8));
    }
    let solid = CYLINDER.replace("cylinder", "prototype.cylinder");
    scene += &format!("[[prototype]]\nname = \"p64\"\n{solid}");
    let folder = folder_of(&[("scene.toml", scene.as_str())]);
    let line = "info scene.toml --json figures.json";
    let (code, printed, error) = cyltrace(folder.path(), &words(line));
    assert_eq!(code, 0, "{error}");
    for part in [
        "505 stored, more than can be counted in total",
        "cylinders: 1 unique, more than can be counted instanced",
    ] {
        assert!(printed.contains(part), "{printed}");
    }
    let figures = fs::read(folder.path().join("figures.json")).expect("read");
    let figures: serde_json::Value = serde_json::from_slice(&figures).expect("JSON");
    assert!(figures["instances"].is_null());
    assert!(figures["cylinders"]["instanced"].is_null());
}

#[test]
fn rays_of_sizes_that_are_not_supported_are_refused_by_line_and_value() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    for (ray, parts) in [
        ("1e61,0,0,1,0,0", ["1e61", "at most 1.6e60"]),
        ("0,0,0,1e-152,0,5e-324", ["1e-152", "between 3.1e-151"]),
        ("0,0,0,0,-1e151,0", ["-1e151", "and 3.3e150"]),
    ] {
        let rays = format!("{RAYS}{ray}\n");
        fs::write(folder.path().join("rays.csv"), rays).expect("written");
        let line = "trace scene.toml --rays rays.csv -o hits.csv";
        let (code, _, error) = cyltrace(folder.path(), &words(line));
        assert_eq!(code, 2, "{ray}: {error}");
        for part in ["rays.csv:3", parts[0], parts[1]] {
            assert!(error.contains(part), "{ray}: no {part:?} in {error}");
        }
    }
}

#[test]
fn numbers_beyond_their_limits_are_refused_with_them() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    for (line, limit) in [
        ("render scene.toml -o a.png --threads 1025", "1 to 1024"),
        ("render scene.toml -o a.png --threads 0", "1 to 1024"),
        ("render scene.toml -o a.png --spp 1048577", "1 to 1048576"),
        (
            "render scene.toml -o a.png --size 16385x16385",
            "268435456 pixels",
        ),
        (
            "render scene.toml -o a.png --size 4294967295x4294967295",
            "268435456 pixels",
        ),
        ("render scene.toml -o a.png --max-memory 0", "above 0"),
        (
            "tessellate scene.toml -o a.obj --segments 4097",
            "3 to 4096",
        ),
        ("check scene.toml --rays 1000000001", "10^9"),
        ("check scene.toml --segments 4294967296", "3 to 4096"),
        ("stress --cases 10000001", "10000000"),
        ("bench accuracy --cases 10000001", "1 to 10000000"),
        (
            "bench traversal --rays 18446744073709551615",
            "1 to 10000000",
        ),
        ("bench scale --rounds 100001", "1 to 100000"),
    ] {
        let (code, printed, error) = cyltrace(folder.path(), &words(line));
        assert_eq!((code, printed.as_str()), (2, ""), "{line}: {error}");
        assert!(error.contains(limit), "{line}: {error}");
    }
}

/// A Radiance HDR picture of one gray.
fn environment(width: usize, height: usize) -> Vec<u8> {
    let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    let pixels = [128, 128, 128, 128].repeat(width * height);
    [header.into_bytes(), pixels].concat()
}

#[test]
fn environment_counts_for_pictures_that_show_it() {
    let scene = "[environment]\nfile = \"sky.hdr\"\n\
        [[prototype]]\nname = \"tree\"\n\
        [[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 0.1\n\
        [[scatter]]\nof = \"tree\"\npattern = \"grid\"\ncount = 300000\nspacing = 2\n";
    let folder = folder_of(&[("scene.toml", scene)]);
    let sky = folder.path().join("sky.hdr");
    let needed = |(width, height), more: &str| {
        fs::write(&sky, environment(width, height)).expect("written");
        let line = format!("render scene.toml -o picture.png --max-memory 1MB {more}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert_eq!(code, 2, "{error}");
        let after = error.split(" up to ").nth(1).expect("the memory");
        let megabytes = after.split(" MB").next().expect("megabytes");
        let is_stated = error.contains("  the environment\n") || error.ends_with("the environment");
        (megabytes.parse::<f64>().expect("a number"), is_stated)
    };
    let (small, _) = needed((2, 1), "");
    let (large, is_stated) = needed((1024, 512), "");
    // 20 bytes for each pixel.
    assert!((large - small - 10.5).abs() < 0.2, "{small} and {large} MB");
    assert!(is_stated);
    let (without, is_stated) = needed((1024, 512), "--integrator ao");
    assert!((without - small).abs() < 0.2 && !is_stated, "{without} MB");
}

#[test]
fn environment_is_read_only_for_pictures_that_show_it() {
    let scene = format!("[environment]\nfile = \"missing.hdr\"\n{CYLINDER}");
    let folder = folder_of(&[("scene.toml", scene.as_str()), ("rays.csv", RAYS)]);
    for line in [
        "trace scene.toml --rays rays.csv -o hits.csv",
        "check scene.toml --rays 10",
        "tessellate scene.toml -o mesh.obj",
        "render scene.toml -o picture.png --size 4x4 --spp 1 --integrator normal",
        "render scene.toml -o open.png --size 4x4 --spp 1 --integrator ao",
    ] {
        let (code, _, error) = cyltrace(folder.path(), &words(line));
        assert_eq!(code, 0, "{line}: {error}");
    }
    // Its keys are validated in any case.
    for keys in ["strength = -1", "[sky]"] {
        let scene = format!("[environment]\nfile = \"missing.hdr\"\n{keys}\n{CYLINDER}");
        fs::write(folder.path().join("wrong.toml"), scene).expect("written");
        let line = "trace wrong.toml --rays rays.csv -o wrong.csv";
        let (code, _, error) = cyltrace(folder.path(), &words(line));
        assert_eq!(code, 2, "{keys}");
        assert!(error.contains("wrong.toml:"), "{error}");
    }
    for integrator in ["sun", "path"] {
        let line = format!("render scene.toml -o light.png --integrator {integrator}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert_eq!(code, 2, "{integrator}");
        assert!(error.contains("missing.hdr"), "{error}");
        assert!(!folder.path().join("light.png").exists());
    }
}

#[test]
fn pixels_count_for_the_memory_of_a_picture() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    for (more, megabytes) in [
        ("", "300 MB"),
        ("--channels depth", "400 MB"),
        ("--part 2/5", "60.1 MB"),
    ] {
        let output = if more.starts_with("--part") {
            "part"
        } else {
            "picture.exr"
        };
        let line =
            format!("render scene.toml -o {output} --size 5000x5000 --max-memory 1MB {more}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert_eq!(code, 2, "{error}");
        let expected = format!("{megabytes}  the pixels of the picture");
        assert!(error.contains(&expected), "{error}");
        assert_eq!(names_in(folder.path()), ["scene.toml"]);
    }
    // A picture and its reference.
    let line = "bench image scene.toml --size 5000x5000 --max-memory 1MB";
    let (code, _, error) = cyltrace(folder.path(), &words(line));
    assert_eq!(code, 2, "{error}");
    assert!(
        error.contains("600 MB  the pixels of the picture"),
        "{error}"
    );
}
