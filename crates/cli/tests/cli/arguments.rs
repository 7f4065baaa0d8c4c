//! The command line's own surface: help texts, usage errors, exit codes.

use crate::program;

use std::collections::BTreeSet;
use std::path::Path;

fn cyltrace(arguments: &[&str]) -> (i32, String, String) {
    program::cyltrace(Path::new("."), arguments)
}

#[test]
fn help_of_every_command_mentions_every_flag() {
    let common = ["--json", "--quiet", "--threads", "--max-isa", "<SCENE>"];
    for (command, own) in [
        (
            "render",
            &[
                "--output",
                "-o",
                "--size",
                "--spp",
                "--integrator",
                "--seed",
                "--max-memory",
            ][..],
        ),
        (
            "trace",
            &[
                "--rays",
                "--points",
                "--output",
                "-o",
                "--all",
                "--max-memory",
            ][..],
        ),
        ("info", &["--max-memory"][..]),
        (
            "check",
            &[
                "--segments",
                "--rays",
                "--hits",
                "--tolerance",
                "--mesh",
                "--deviation",
                "--class",
                "--seed",
                "--max-memory",
                "--report",
                "--replay",
            ],
        ),
        (
            "tessellate",
            &[
                "--output",
                "-o",
                "--segments",
                "--inscribed",
                "--circumscribed",
                "--max-memory",
            ][..],
        ),
    ] {
        let (code, help, _) = cyltrace(&[command, "--help"]);
        assert_eq!(code, 0);
        for flag in common.iter().chain(own) {
            assert!(
                help.contains(flag),
                "{command} --help lacks {flag}:\n{help}"
            );
        }
        let (_, overview, _) = cyltrace(&["--help"]);
        assert!(
            overview.contains(command),
            "--help lacks {command}:\n{overview}"
        );
    }
}

#[test]
fn bad_arguments_exit_2_and_name_the_remedy() {
    for (arguments, expected) in [
        (&[][..], "Usage"),
        (&["paint"], "paint"),
        (&["render", "scene.toml"], "--output"),
        (
            &["render", "scene.toml", "-o", "a.png", "--size", "640"],
            "1280x720",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--size", "0x720"],
            "1280x720",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--spp", "0"],
            "--spp",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--threads", "0"],
            "--threads",
        ),
        (
            &[
                "render",
                "scene.toml",
                "-o",
                "a.png",
                "--integrator",
                "paths",
            ],
            "normal, path",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--max-isa", "mmx"],
            "sse2, sse4.2, avx, avx2, avx512",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--colour", "red"],
            "--colour",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--spp", "0"],
            "'0' for '--spp <N>': it must be a whole number from 1",
        ),
        (
            &["render", "scene.toml", "-o", "a.png", "--seed", "-1"],
            "'-1' for '--seed <N>': it must be a whole number from 0",
        ),
        (
            &["info", "scene.toml", "--threads", "100000"],
            "'100000' for '--threads <N>': it must be a whole number from 1 to 1024",
        ),
        (&["trace", "scene.toml", "-o", "hits.csv"], "--rays"),
        (&["info"], "<SCENE>"),
    ] {
        let (code, out, err) = cyltrace(arguments);
        assert_eq!(code, 2, "{arguments:?}: {err}");
        assert!(
            err.contains(expected),
            "{arguments:?} without {expected:?}: {err}"
        );
        assert!(out.is_empty(), "{arguments:?}: {out}");
    }
}

/// The reference of the command line.
const DOCUMENT: &str = include_str!("../../../../docs/command-line.md");

/// Commands that write JSON, as the table of keys names them, with arguments for a folder
/// that has `rays.csv` and `points.csv`.
const WITH_JSON: [(&str, &str); 10] = [
    ("info", "info SCENE"),
    ("render", "render SCENE -o a.png --size 8x8"),
    ("trace --rays", "trace SCENE --rays rays.csv -o hits.csv"),
    (
        "trace --points",
        "trace SCENE --points points.csv -o in.csv",
    ),
    ("check", "check SCENE --rays 100"),
    ("tessellate", "tessellate SCENE -o a.ply"),
    ("stress", "stress --family rim --cases 1"),
    (
        "bench accuracy",
        "bench accuracy --cases 1 --rounds 1 --formulation exact",
    ),
    (
        "bench traversal",
        "bench traversal --scene spheres_1e5 --rival embree_sphere --rays 16 --rounds 1 --threads 1",
    ),
    (
        "bench scale",
        "bench scale --most 1000 --rays 16 --rounds 1",
    ),
];

#[test]
fn document_has_the_json_keys_of_each_command() {
    let folder = program::folder_of(&[
        ("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n"),
        ("points.csv", "x,y,z\n0,0,0\n"),
    ]);
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/minimal.toml");
    for (command, line) in WITH_JSON {
        let line = format!("{} --json -", line.replace("SCENE", scene));
        let (_, out, err) = program::cyltrace(folder.path(), &program::words(&line));
        let figures: serde_json::Value = serde_json::from_str(&out).expect(&err);
        let found: BTreeSet<&str> = figures
            .as_object()
            .expect("an object")
            .keys()
            .map(String::as_str)
            .collect();
        assert_eq!(found, documented_keys(command), "{command}");
    }
}

/// The keys that the table has for a command. A row for `trace` is one for both of its
/// kinds of tables.
fn documented_keys(command: &str) -> BTreeSet<&'static str> {
    let (_, table) = DOCUMENT
        .split_once("| key | of |")
        .expect("a table of keys");
    let of_command = |of: &str| of == command || command.starts_with("trace ") && of == "trace";
    let mut keys = BTreeSet::new();
    for row in table.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').collect();
        if cells[2].split(',').map(str::trim).any(of_command) {
            let names = cells[1]
                .split(',')
                .map(|name| name.trim().trim_matches('`'));
            keys.extend(names);
        }
    }
    keys
}

#[test]
fn document_has_every_column_of_hits() {
    let folder = program::folder_of(&[("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n")]);
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/minimal.toml");
    let line = format!("trace {scene} --rays rays.csv -o - --quiet");
    let (_, hits, err) = program::cyltrace(folder.path(), &program::words(&line));
    let header = hits.lines().next().expect(&err);
    for name in header.split(',') {
        assert!(DOCUMENT.contains(&format!("`{name}`")), "{name}");
    }
}
