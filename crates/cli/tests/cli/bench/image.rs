//! `cyltrace bench image`, of pictures of 12 tiles.

use std::fs;

use serde_json::Value;

use super::{figures, program, report};

const SCENE: &str = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
    [[cylinder]]\np0 = [-2, 0, -1]\np1 = [2, 0, -1]\nradius = 0.4\n";

const IMAGE: [&str; 10] = [
    "image",
    "scene.toml",
    "--size",
    "64x48",
    "--spp",
    "16",
    "--error",
    "0.1",
    "--rounds",
    "1",
];

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().expect(key)
}

#[test]
fn image_json_has_every_picture_and_its_error() {
    let folder = tempfile::tempdir().expect("a directory");
    fs::write(folder.path().join("scene.toml"), SCENE).expect("written");
    let found = figures(folder.path(), &IMAGE);
    let rows = found["pictures"].as_array().expect("an array");
    // Three integrators, two samplers, 4, 8 and 16 samples and an error.
    assert_eq!(rows.len(), 3 * 2 * 4);
    for of_sampler in rows.chunks_exact(4) {
        let [first, second, third, until] = of_sampler else {
            panic!("four rows")
        };
        let name = (&first["integrator"], &first["sampler"]);
        let errors = [first, second, third].map(|row| number(row, "rmse"));
        assert!(
            errors[0] > errors[1] && errors[1] > errors[2],
            "{name:?}: {errors:?}"
        );
        if first["sampler"] == "random" {
            // The root of the number: a quarter of the variance, within the noise of 9216 values.
            let ratio = errors[0] / errors[2];
            assert!((1.7..2.35).contains(&ratio), "{name:?}: {ratio}");
        }
        assert!(until["tiles_kept"].as_u64() >= Some(10), "{until}");
        assert_eq!(
            (&until["tiles"], &until["tiles_above"]),
            (&12.into(), &0.into())
        );
        let greatest = number(until, "greatest_of_tiles");
        assert!(greatest >= number(until, "p95_of_tiles"), "{until}");
    }
    // Rays are those of the same picture.
    let line = "render scene.toml -o out.exr --size 64x48 --spp 8 --integrator ao --json - \
                --sampler random";
    let (code, out, error) = program::cyltrace(folder.path(), &program::words(line));
    assert_eq!(code, 0, "{error}");
    let one: Value = serde_json::from_str(&out).expect("JSON");
    let rays = one["rays"].as_object().expect("an object").values();
    let rays: u64 = rays.filter_map(Value::as_u64).sum();
    assert_eq!(rows[21]["samples_per_pixel"], 8.0);
    assert_eq!(rows[21]["rays"], rays);
}

#[test]
fn image_report_has_figures_slopes_and_a_page() {
    let folder = tempfile::tempdir().expect("a directory");
    fs::write(folder.path().join("scene.toml"), SCENE).expect("written");
    let arguments = [&IMAGE[..], &["--integrator", "ao"]].concat();
    let (out, names) = report(folder.path(), &arguments);
    assert_eq!(names, ["image.csv", "index.html", "scene-ao.svg"]);
    assert!(out.contains("slope of rmse"), "{out}");
    let csv = fs::read_to_string(folder.path().join("new/report/image.csv")).expect("read");
    assert_eq!(csv.lines().count(), 1 + 2 * 4, "{csv}");
}
