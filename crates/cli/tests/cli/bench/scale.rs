//! `cyltrace bench scale`, on scenes that take seconds.

use super::{figures, keys, report};

const SCALE: [&str; 11] = [
    "scale",
    "--most",
    "10000",
    "--rays",
    "64",
    "--rounds",
    "1",
    "--threads",
    "1",
    "--seed",
    "3",
];

#[test]
fn scale_json_has_decades_fits_and_reasons() {
    let folder = tempfile::tempdir().expect("a directory");
    let arguments = [&SCALE[..], &["--max-memory", "1MB"]].concat();
    let found = figures(folder.path(), &arguments);
    let numbers = |series: &str| -> Vec<u64> {
        let rows = found[series].as_array().expect("an array");
        rows.iter().map(|row| row["n"].as_u64().unwrap()).collect()
    };
    assert_eq!(numbers("cylinders"), [1000, 10_000]);
    assert_eq!(numbers("placements"), [100, 1000, 10_000]);
    let first = &found["cylinders"][0];
    assert_eq!(
        keys(first)[..7],
        [
            "series",
            "n",
            "build_s",
            "bytes",
            "bytes_per",
            "resident_bytes",
            "rays_per_s"
        ]
    );
    let bytes = first["bytes"].as_f64().unwrap();
    assert_eq!(first["bytes_per"].as_f64().unwrap(), bytes / 1000.0);
    assert!(first["rays_per_s"].as_f64().unwrap() > 0.0);
    assert!(found["cylinders"][1]["bytes"].is_null());
    let reason = found["cylinders"][1]["reason"].as_str().unwrap();
    assert!(reason.contains("more than the 1.0 MB"), "{reason}");

    assert!(found["fits"]["cylinders"]["bytes"].is_null());
    let growth = found["fits"]["placements"]["bytes"].as_f64().unwrap();
    assert!((0.0..1.0).contains(&growth), "{growth}");
}

#[test]
fn scale_report_is_written_whole() {
    let folder = tempfile::tempdir().expect("a directory");
    let (out, names) = report(folder.path(), &SCALE);
    assert!(
        out.contains("memory as n^") && out.contains("index.html"),
        "{out}"
    );
    let expected = [
        "build.svg",
        "bytes.svg",
        "index.html",
        "rays.svg",
        "scale.csv",
    ];
    assert_eq!(names, expected);
}
