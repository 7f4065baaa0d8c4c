//! The hits of `cyltrace trace`, read back.

use std::fmt::Write as _;
use std::path::Path;

use assert_cmd::Command;
use cyltrace::math::Ray;
use glam::DVec3;

/// A row of the output of `cyltrace trace`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub t: f64,
    pub point: DVec3,
    pub normal: DVec3,
    pub part: String,
    pub crossing: String,
    pub primitive: u32,
    pub instance: String,
    pub error: f64,
}

/// Runs `cyltrace trace` in `folder` and answers with one row a ray.
pub fn trace(folder: &Path, scene: &str, rays: &[Ray], options: &[&str]) -> Vec<Option<Row>> {
    let mut table = String::from("ox,oy,oz,dx,dy,dz,t_min,t_max\n");
    for ray in rays {
        let (o, d) = (ray.origin, ray.direction);
        let numbers = [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max];
        let cells: Vec<String> = numbers.iter().map(|number| format!("{number:e}")).collect();
        writeln!(table, "{}", cells.join(",")).unwrap();
    }
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    std::fs::write(folder.join("rays.csv"), table).unwrap();
    Command::cargo_bin("cyltrace")
        .unwrap()
        .current_dir(folder)
        .args([
            "trace",
            "scene.toml",
            "--rays",
            "rays.csv",
            "-o",
            "hits.csv",
            "--quiet",
        ])
        .args(options)
        .assert()
        .success();

    let mut reader = csv::Reader::from_path(folder.join("hits.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|cell| cell == name).unwrap();
    let rows: Vec<Option<Row>> = reader
        .records()
        .enumerate()
        .map(|(number, record)| {
            let record = record.unwrap();
            let cell = |name: &str| record[column(name)].to_owned();
            let value = |name: &str| -> f64 { cell(name).parse().unwrap() };
            let vector = |names: [&str; 3]| DVec3::from_array(names.map(value));
            assert_eq!(cell("ray"), number.to_string());
            (cell("hit") == "1").then(|| Row {
                t: value("t"),
                point: vector(["x", "y", "z"]),
                normal: vector(["nx", "ny", "nz"]),
                part: cell("part"),
                crossing: cell("crossing"),
                primitive: cell("primitive").parse().unwrap(),
                instance: cell("instance"),
                error: value("error"),
            })
        })
        .collect();
    assert_eq!(rows.len(), rays.len());
    rows
}
