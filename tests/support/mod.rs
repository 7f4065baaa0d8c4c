//! What several tests share: random scenes, and hits by way of the command
//! line.
#![allow(dead_code, reason = "each test uses some of it")]

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use assert_cmd::Command;
use cyltrace::math::{Random, Ray};
use cyltrace::scene::{CylinderRecord, MaterialIndex, Prototype, Scene};
use cyltrace::solid::{Caps, Cylinder};
use glam::{DMat3, DVec3};

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
pub fn trace(folder: &Path, scene: &str, rays: &[Ray]) -> Vec<Option<Row>> {
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

/// The bits of a ray, for messages that can be replayed.
pub fn bits(ray: &Ray) -> String {
    let numbers = ray
        .origin
        .to_array()
        .into_iter()
        .chain(ray.direction.to_array());
    numbers
        .chain([ray.t_min, ray.t_max])
        .map(|number| format!("{:#018x}", number.to_bits()))
        .collect::<Vec<_>>()
        .join(" ")
}

/// A scene of prototypes, the first of which is the root, and nothing else.
pub fn scene_of(prototypes: Vec<Prototype>) -> Arc<Scene> {
    Arc::new(Scene::new(prototypes))
}

/// `count` cylinders in the unit cube: long and short, thick and thin, of all
/// cap kinds, along an axis or not, some of them twice.
pub fn cylinders_in_a_box(seed: u64, count: u32) -> Vec<CylinderRecord> {
    let mut random = Random::new(seed, 1);
    let mut records: Vec<CylinderRecord> = Vec::new();
    for primitive in 0..count {
        let p0 = DVec3::new(random.unit(), random.unit(), random.unit());
        let heading = match random.below(3) {
            0 => DVec3::AXES[random.below(3) as usize],
            _ => random.direction(),
        };
        let p1 = p0 + heading * random.log_uniform(1e-3, 0.5);
        let radius = random.log_uniform(1e-5, 5e-2);
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let mut cylinder = Cylinder::new(p0, p1, radius, caps).unwrap();
        if random.below(20) == 0 && primitive > 0 {
            let twin = random.below(u64::from(primitive)) as usize;
            cylinder = records[twin].cylinder();
        }
        records.push(CylinderRecord::new(&cylinder, primitive, MaterialIndex(0)));
    }
    records
}

/// A rotation, any as likely as any other axis and angle.
pub fn random_rotation(random: &mut Random) -> DMat3 {
    let axis = random.direction();
    let across = axis.any_orthonormal_vector();
    let (sin, cos) = libm::sincos(random.uniform(0.0, std::f64::consts::TAU));
    let turned = across * cos + axis.cross(across) * sin;
    DMat3::from_cols(axis, turned, axis.cross(turned))
}
