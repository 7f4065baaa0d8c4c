//! `cyltrace bench`, as users run it. Nothing here depends on how long
//! anything takes.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn bench(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("cyltrace")
        .expect("the program is built")
        .current_dir(folder)
        .args(["bench", "accuracy"])
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 output");
    let code = output.status.code().expect("no signal");
    (code, text(output.stdout), text(output.stderr))
}

const SMALL: [&str; 12] = [
    "--cases",
    "60",
    "--rounds",
    "3",
    "--seed",
    "5",
    "--formulation",
    "centre-dot",
    "--formulation",
    "cone-curve",
    "--formulation",
    "mesh-16",
];

#[test]
fn accuracy_json_has_the_promised_keys_and_sensible_figures() {
    let folder = tempfile::tempdir().expect("a directory");
    let arguments = [&SMALL[..], &["--json", "-"]].concat();
    let (code, out, err) = bench(folder.path(), &arguments);
    assert_eq!(code, 0, "{err}");
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    let rows = figures["formulations"].as_array().expect("an array");
    let names: Vec<(&str, &str)> = rows
        .iter()
        .map(|row| {
            (
                row["name"].as_str().unwrap(),
                row["precision"].as_str().unwrap(),
            )
        })
        .collect();
    assert_eq!(
        names,
        [
            ("centre-dot", "f32"),
            ("centre-dot", "f64"),
            ("triple-product", "f64"),
            ("cone-curve", "f32"),
            ("mesh-16", "f32"),
        ]
    );
    for row in rows {
        let keys: Vec<&str> = row
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        assert_eq!(
            keys,
            [
                "name",
                "precision",
                "ns_median",
                "ns_spread",
                "p99_error_r",
                "worst_family",
                "worst_p99_error_r",
                "wrong_percent_mean",
                "bytes",
            ]
        );
        assert!(row["ns_median"].as_f64().unwrap() > 0.0, "{row}");
    }
    let error = |row: usize| rows[row]["p99_error_r"].as_f64().unwrap();
    assert!(error(2) < 1e-9 && error(0) > 1e3 * error(2), "{rows:?}");
    assert!(error(4) > 1e-3 && error(4) < 2.0, "{rows:?}");
    assert_eq!(rows[2]["wrong_percent_mean"], 0.0);
    for key in ["machine", "isa", "target_features", "commit"] {
        assert!(figures.get(key).is_some(), "no {key}");
    }
    let told = ["cases", "seed", "rounds"].map(|key| figures[key].as_u64());
    assert_eq!(told, [Some(60), Some(5), Some(3)]);
}

#[test]
fn accuracy_report_is_written_whole_and_needs_nothing_else() {
    let folder = tempfile::tempdir().expect("a directory");
    let arguments = [&SMALL[..], &["--report", "new/report"]].concat();
    let (code, out, err) = bench(folder.path(), &arguments);
    assert_eq!(code, 0, "{err}");
    assert!(
        out.contains("mesh-16 f32") && out.contains("index.html"),
        "{out}"
    );
    let report = folder.path().join("new/report");
    let mut names: Vec<String> = fs::read_dir(&report)
        .expect("the directory is made")
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["accuracy.csv", "accuracy.svg", "index.html"]);
    let read = |name: &str| fs::read_to_string(report.join(name)).unwrap();
    assert_eq!(read("accuracy.csv").lines().count(), 6);
    let (figure, page) = (read("accuracy.svg"), read("index.html"));
    assert!(page.contains(&figure) && figure.contains(">centre-dot<"));
    for foreign in ["src=", "href=", "@import", "url(", "<script"] {
        assert!(!page.contains(foreign), "the page has {foreign}");
    }
}

#[test]
fn accuracy_unknown_name_is_refused_with_the_known_ones() {
    let folder = tempfile::tempdir().expect("a directory");
    let (code, out, err) = bench(folder.path(), &["--formulation", "triple"]);
    assert_eq!((code, out.as_str()), (2, ""));
    for part in ["\"triple\"", "triple-product", "cone-curve", "mesh-1024"] {
        assert!(err.contains(part), "no {part} in {err}");
    }
}
