//! `--max-memory`: scenes that take more are refused before anything is made.

use crate::program;

use program::{cyltrace, folder_of};
use serde_json::Value;

/// Four thousand million placements: 447 GB of records.
const MANY: &str = "[[prototype]]\nname = \"tree\"\n\
    [[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 0.1\n\
    [[scatter]]\nof = \"tree\"\npattern = \"grid\"\ncount = COUNT\nspacing = 2\n";

#[test]
fn scatter_beyond_the_limit_is_refused_with_what_takes_the_memory() {
    let folder = folder_of(&[
        ("scene.toml", MANY.replace("COUNT", "4294967295").as_str()),
        ("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n"),
    ]);
    for command in [
        &["render", "scene.toml", "-o", "out.png"][..],
        &["trace", "scene.toml", "--rays", "rays.csv", "-o", "out.csv"],
        &["info", "scene.toml"],
    ] {
        let arguments = [command, &["--max-memory", "100 GB"]].concat();
        let (code, printed, error) = cyltrace(folder.path(), &arguments);
        assert_eq!((code, printed.as_str()), (2, ""), "{arguments:?}: {error}");
        for part in [
            "scene.toml: the scene ",
            " up to ",
            "--max-memory allows 100 GB",
            "447 GB  4294967295 placements of \"tree\" in the scene itself",
        ] {
            assert!(
                error.contains(part),
                "{arguments:?}: no {part:?} in\n{error}"
            );
        }
        assert_eq!(error.contains("Embree"), command[0] != "info", "{error}");
        for file in ["out.png", "out.csv"] {
            assert!(!folder.path().join(file).exists(), "{arguments:?}: {file}");
        }
    }
}

#[test]
fn tables_beyond_the_limit_are_refused_by_their_lines() {
    let scene = "[[cylinder_table]]\nfile = \"tree.csv\"\n\
         columns = { p0 = [\"a\", \"b\", \"c\"], p1 = [\"d\", \"e\", \"f\"], radius = \"r\" }\n";
    let rows = "0,0,0,0,0,1,1\n".repeat(999);
    let table = format!("a,b,c,d,e,f,r\n{rows}0,0,0,0,0,1,1");
    let folder = folder_of(&[("scene.toml", scene), ("tree.csv", &table)]);
    let (code, _, error) = cyltrace(
        folder.path(),
        &["info", "scene.toml", "--max-memory", "63999"],
    );
    assert_eq!(code, 2, "{error}");
    assert!(
        error.contains("1000 cylinders in the scene itself"),
        "{error}"
    );
    let (code, _, error) = cyltrace(
        folder.path(),
        &["info", "scene.toml", "--max-memory", "64000"],
    );
    assert_eq!(code, 0, "{error}");
}

#[test]
fn info_says_what_the_limit_is_held_against() {
    let folder = folder_of(&[("scene.toml", MANY.replace("COUNT", "50000"))]);
    let arguments = ["info", "scene.toml", "--json", "-"];
    let (code, printed, error) = cyltrace(folder.path(), &arguments);
    assert_eq!(code, 0, "{error}");
    let figures: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(figures["records"]["numbers"], "f64");
    let estimate = &figures["memory_estimate"];
    assert_eq!(estimate["records_bytes"], 50_000 * 104 + 64);
    let peak = estimate["peak_bytes"].as_u64().expect("a number");

    // What is estimated may be taken, with 12 bytes for each of 64 pixels; a byte less may not.
    let peak = peak + 64 * 12;
    let render = |limit: u64| {
        let limit = limit.to_string();
        let arguments = [
            "render",
            "scene.toml",
            "-o",
            "out.png",
            "--size",
            "8x8",
            "--max-memory",
            &limit,
        ];
        cyltrace(folder.path(), &arguments)
    };
    let (code, _, error) = render(peak - 1);
    assert_eq!(code, 2, "{error}");
    assert!(error.contains("50000 placements of \"tree\""), "{error}");
    let (code, _, error) = render(peak);
    assert_eq!(code, 0, "{error}");
}

#[test]
fn samples_of_a_picture_with_a_time_count() {
    let folder = folder_of(&[("scene.toml", "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n")]);
    let run = |line: &str| cyltrace(folder.path(), &program::words(line));
    // 144 bytes and more for each of 10^6 pixels.
    let line = "render scene.toml -o out.png --size 1000x1000 --max-memory 100MB";
    let (code, _, error) = run(&format!("{line} --time 0.01"));
    assert_eq!(code, 2, "{error}");
    assert!(
        error.contains("the samples of all tiles at once, for --time"),
        "{error}"
    );
    let (code, _, error) = run(&format!("{line} --spp 1"));
    assert_eq!(code, 0, "{error}");
    let (code, _, error) =
        run(&format!("{line} --time 0.01 --max-memory 300MB").replace("--max-memory 100MB", ""));
    assert_eq!(code, 0, "{error}");
}
