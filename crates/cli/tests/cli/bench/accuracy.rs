//! `cyltrace bench accuracy`.

use std::fs;

use super::{bench, figures, keys, report};

const SMALL: [&str; 13] = [
    "accuracy",
    "--cases",
    "60",
    "--rounds",
    "3",
    "--seed",
    "5",
    "--formulation",
    "center-dot",
    "--formulation",
    "cone-curve",
    "--formulation",
    "mesh-16",
];

#[test]
fn accuracy_json_has_the_promised_keys_and_sensible_figures() {
    let folder = tempfile::tempdir().expect("a directory");
    let figures = figures(folder.path(), &SMALL);
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
            ("center-dot", "f32"),
            ("center-dot", "f64"),
            ("triple-product", "f64"),
            ("cone-curve", "f32"),
            ("mesh-16", "f32"),
        ]
    );
    for row in rows {
        assert_eq!(
            keys(row),
            [
                "name",
                "precision",
                "times",
                "ns_median",
                "ns_spread",
                "ratio_median",
                "ratio_spread",
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
    let (out, names) = report(folder.path(), &SMALL);
    assert!(
        out.contains("mesh-16 f32") && out.contains("index.html"),
        "{out}"
    );
    assert_eq!(names, ["accuracy.csv", "accuracy.svg", "index.html"]);
    let read =
        |name: &str| fs::read_to_string(folder.path().join("new/report").join(name)).unwrap();
    assert_eq!(read("accuracy.csv").lines().count(), 6);
    let (figure, page) = (read("accuracy.svg"), read("index.html"));
    assert!(page.contains(&figure) && figure.contains(">center-dot<"));
}

#[test]
fn accuracy_unknown_name_is_refused_with_the_known_ones() {
    let folder = tempfile::tempdir().expect("a directory");
    let (code, out, err) = bench(folder.path(), &["accuracy", "--formulation", "triple"]);
    assert_eq!((code, out.as_str()), (2, ""));
    for part in ["'triple'", "triple-product", "cone-curve", "mesh-1024"] {
        assert!(err.contains(part), "no {part} in {err}");
    }
}
