//! The command line's own surface: help texts, usage errors, exit codes.

use crate::program;

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
                "path",
            ],
            "normal",
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

#[test]
fn document_has_every_column_and_json_key() {
    let document = include_str!("../../../../docs/command-line.md");
    let mut missing = Vec::new();
    let mut need = |word: &str| {
        if !document.contains(&format!("`{word}")) {
            missing.push(word.to_owned());
        }
    };
    let directory = tempfile::tempdir().expect("directory");
    let at = |name: &str| {
        directory
            .path()
            .join(name)
            .to_str()
            .expect("UTF-8")
            .to_owned()
    };
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/minimal.toml");
    let (rays, hits, picture) = (at("rays.csv"), at("hits.csv"), at("a.png"));
    let mesh = at("a.ply");
    std::fs::write(&rays, "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n").expect("written");
    for arguments in [
        &["info", scene, "--json", "-"][..],
        &[
            "render", scene, "-o", &picture, "--size", "8x8", "--json", "-",
        ],
        &["trace", scene, "--rays", &rays, "-o", &hits, "--json", "-"],
        &["check", scene, "--rays", "100", "--json", "-"],
        &["tessellate", scene, "-o", &mesh, "--json", "-"],
    ] {
        let (_, out, err) = cyltrace(arguments);
        let figures: serde_json::Value = serde_json::from_str(&out).expect(&err);
        figures
            .as_object()
            .expect("keys")
            .keys()
            .for_each(|key| need(&format!("{key}`")));
    }
    let hits = std::fs::read_to_string(hits).expect("written");
    let header = hits.lines().next().expect("a header");
    header.split(',').for_each(|name| need(&format!("{name}`")));
    assert!(missing.is_empty(), "{missing:?}");
}
