//! The command line's own surface: help texts, usage errors, exit codes.

use assert_cmd::Command;

fn cyltrace(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("cyltrace")
        .expect("the program is built")
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 output");
    let code = output.status.code().expect("no signal");
    (code, text(output.stdout), text(output.stderr))
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
            ][..],
        ),
        ("trace", &["--rays", "--output", "-o", "--all"][..]),
        ("info", &[][..]),
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
