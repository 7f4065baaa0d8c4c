//! Parts that are missing, damaged, foreign, doubled or there already.

use std::fs;
use std::process::Child;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{SCENE, TWIGS, bytes, make_parts, refused, run, scene, unfinished};
use crate::program::{command, cyltrace, words};

#[test]
fn merge_refuses_what_is_no_whole_and_writes_nothing() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --spp 1";
    make_parts(folder, line, 4);
    run(folder, "render scene.toml --spp 2 --part 2/4 -o other -q");
    fs::write(folder.join("merged.png"), "old").expect("written");
    let merge = |parts: &str, expected: &[&str]| {
        let message = refused(folder, &format!("merge {parts} -o merged.png"));
        for word in expected {
            assert!(message.contains(word), "{parts}: {message}");
        }
        assert_eq!(bytes(folder, "merged.png"), b"old");
    };
    merge(
        "parts/1 parts/2 parts/4",
        &["missing", "tiles 10 to 14 of 20", "parts/2"],
    );
    merge(
        "parts/1 parts/2 parts/2 parts/3 parts/4",
        &["overlap", "parts/2"],
    );
    merge(
        "parts/1 other parts/3 parts/4",
        &["other", "its spp is 2, not 1"],
    );
    merge("parts/1 scene.toml", &["scene.toml", "not a part"]);
    merge("parts/1 absent", &["absent"]);

    // A file of the scene has changed between two parts.
    fs::write(folder.join("twigs.csv"), TWIGS.replace("0.2\n", "0.3\n")).expect("written");
    run(folder, "render scene.toml --spp 1 --part 2/4 -o changed -q");
    merge(
        "parts/1 changed parts/3 parts/4",
        &["changed", "another content"],
    );

    let mut damaged = bytes(folder, "parts/3");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 4;
    fs::write(folder.join("parts/3"), &damaged).expect("written");
    merge("parts", &["parts/3", "damaged", "checksum"]);
    fs::write(folder.join("parts/3"), &damaged[..middle]).expect("written");
    merge(
        "parts/1 parts/2 parts/3 parts/4",
        &["parts/3", "damaged", "cut off"],
    );

    for line in [
        "merge parts/1 parts/2 parts/4 -o parts/1",
        "merge parts/1 parts/2 parts/4 -o other.png --json parts/1",
        "merge parts/1 parts/2 parts/4 -o other.png --json other.png",
        "parts parts --json parts/1",
    ] {
        let message = refused(folder, line);
        assert!(message.contains("choose"), "{line}: {message}");
    }
    fs::create_dir(folder.join("empty")).expect("created");
    merge("empty", &["no parts in", "empty"]);
    // A picture is not replaced by a part.
    let message = refused(folder, "render scene.toml --part 1/2 -o merged.png");
    assert!(message.contains("not a part"), "{message}");
}

#[test]
fn parts_lists_what_is_there_missing_and_damaged() {
    let folder = scene();
    let folder = folder.path();
    make_parts(folder, "render scene.toml --spp 1", 5);
    let (code, output, _) = cyltrace(folder, &words("parts parts"));
    assert_eq!(code, 0, "{output}");
    assert!(
        output.contains("render") && output.contains("5 of 5"),
        "{output}"
    );

    fs::remove_file(folder.join("parts/2")).expect("removed");
    fs::write(folder.join("parts/4"), &bytes(folder, "parts/4")[..300]).expect("written");
    let (code, output, _) = cyltrace(folder, &words("parts parts --json -"));
    assert_eq!(code, 1, "{output}");
    let figures: Value = serde_json::from_str(&output).expect("JSON");
    assert_eq!(figures["results"][0]["missing"], serde_json::json!([2, 4]));
    assert_eq!(figures["damaged"][0]["file"], "parts/4");
    let (_, output, _) = cyltrace(folder, &words("parts parts"));
    assert!(output.contains("missing: 2, 4"), "{output}");

    // A part twice, which `merge` refuses.
    make_parts(folder, "render scene.toml --spp 1", 5);
    fs::copy(folder.join("parts/2"), folder.join("parts/twice")).expect("copied");
    let (code, output, _) = cyltrace(folder, &words("parts parts"));
    assert_eq!(code, 1, "{output}");
    assert!(output.contains("overlap"), "{output}");
}

#[test]
fn resume_keeps_valid_parts_only() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --spp 1 --part 1/2 -o part --resume";
    run(folder, line);
    let changed = || {
        folder
            .join("part")
            .metadata()
            .and_then(|file| file.modified())
    };
    let first = changed().expect("a file");
    let output = run(folder, line);
    assert!(output.contains("already there"), "{output}");
    assert_eq!(changed().expect("a file"), first);

    let whole = bytes(folder, "part");
    fs::write(folder.join("part"), &whole[..whole.len() - 10]).expect("written");
    let output = run(folder, line);
    assert!(!output.contains("already there"), "{output}");
    run(folder, "render scene.toml --spp 1 --part 2/2 -o other -q");
    run(folder, "merge part other -o merged.png");

    // The figures of a part that is kept.
    run(folder, &format!("{line} --json figures.json"));
    let figures: Value = serde_json::from_slice(&bytes(folder, "figures.json")).expect("JSON");
    assert_eq!(figures["part"], "1/2");

    // Only parts of a picture with an error have the rule of its samples.
    let rule = br#""error_rule":2"#;
    let has_rule = |part: &[u8]| part.windows(rule.len()).any(|bytes| bytes == rule);
    assert!(!has_rule(&bytes(folder, "part")));
    run(
        folder,
        "render scene.toml --error 1 --part 1/2 -o until.part",
    );
    assert!(has_rule(&bytes(folder, "until.part")));

    // Every setting that changes the picture, and another scene.
    for option in [
        "--size 33x17",
        "--seed 1",
        "--integrator normal",
        "--sampler random",
        "--exposure 1",
        "--tonemap agx",
        "--channels ids",
        "--exact",
    ] {
        for line in [format!("{line} {option}"), line.to_owned()] {
            let output = run(folder, &line);
            assert!(!output.contains("already there"), "{line}: {output}");
        }
    }
    let output = run(folder, &line.replace("--spp 1", "--spp 2"));
    assert!(!output.contains("already there"), "{output}");
    fs::write(folder.join("scene.toml"), SCENE.replace("0.7", "0.6")).expect("written");
    let output = run(folder, &line.replace("--spp 1", "--spp 2"));
    assert!(!output.contains("already there"), "{output}");
}

#[test]
fn rows_that_change_are_traced_again() {
    let folder = scene();
    let folder = folder.path();
    let row = |x: u32| format!("{x:06},0,5,0,0,-1\n");
    // Longer than the ends that every part reads.
    let rows: String = (0..20_000).map(|_| row(0)).collect();
    let table = |rows: &str| format!("ox,oy,oz,dx,dy,dz\n{rows}");
    fs::write(folder.join("rays.csv"), table(&rows)).expect("written");
    let line = "trace scene.toml --rays rays.csv --part 2/3 -o part --resume";
    run(folder, line);
    assert!(run(folder, line).contains("already there"));
    let (head, tail) = rows.split_at(row(0).len() * 10_000);
    let changed = format!("{head}{}{}", row(9), &tail[row(0).len()..]);
    fs::write(folder.join("rays.csv"), table(&changed)).expect("written");
    assert!(!run(folder, line).contains("already there"));
}

#[test]
fn part_of_what_can_be_read_only_once_is_refused() {
    let folder = scene();
    let folder = folder.path();
    let message = refused(folder, "trace scene.toml --rays - -o part --part 1/2");
    assert!(message.contains("standard input"), "{message}");
    let message = refused(folder, "trace scene.toml --rays twigs.csv -o - --part 1/2");
    assert!(message.contains("standard output"), "{message}");
    for wrong in ["0/2", "3/2", "1", "1/0"] {
        let message = refused(folder, &format!("render scene.toml -o part --part {wrong}"));
        assert!(message.contains("K/N"), "{message}");
    }
}

/// A full disk, as the process sees it: files may not be longer than some kilobytes.
#[cfg(unix)]
#[test]
fn disk_that_fills_up_leaves_no_part() {
    let folder = scene();
    let folder = folder.path();
    let program = env!("CARGO_BIN_EXE_cyltrace");
    let script =
        format!("ulimit -f 8; exec {program} render scene.toml --spp 1 --part 1/1 -o part");
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder)
        .output()
        .expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(message.contains("cannot write \"part\""), "{message}");
    let left = fs::read_dir(folder).expect("readable").count();
    assert_eq!(left, 2, "the scene and its table");
}

#[test]
fn one_part_rendered_twice_at_the_same_time_is_whole() {
    let folder = scene();
    let folder = folder.path();
    let line = words("render scene.toml --spp 512 --part 1/1 -o part -q");
    let both: Vec<Child> = (0..2)
        .map(|_| command(folder, &line).spawn().expect("it runs"))
        .collect();
    // Both have begun to write.
    let start = Instant::now();
    while unfinished(folder) < 2 {
        assert!(start.elapsed() < Duration::from_secs(60), "one writer");
    }
    for mut child in both {
        assert!(child.wait().expect("it ends").success());
    }
    run(folder, "render scene.toml --spp 512 -o whole.exr -q");
    run(folder, "merge part -o merged.exr -q");
    assert!(bytes(folder, "whole.exr") == bytes(folder, "merged.exr"));
}
