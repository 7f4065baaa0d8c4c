//! Checks your own intersector, here a textbook one in f32, against a scene:
//! `cargo run --release --example check_own_intersector [SCENE]`.
//!
//! It traces the scene's own cylinders without placements. Exits with 1, because the check
//! detects the errors of f32.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use cyltrace::math::Ray;
use cyltrace::scene;
use cyltrace::solid::Cylinder;
use cyltrace_check::{Intersector, ReportedHit, Settings, compare, summary, verdict};
use glam::Vec3;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map(PathBuf::from);
    let minimal = || concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/minimal.toml").into();

    // The check, in three lines.
    let scene = scene::load(&path.unwrap_or_else(minimal))?;
    let own = Own(scene.prototypes[0]
        .solids
        .cylinders
        .iter()
        .map(|record| record.cylinder())
        .collect());
    let outcome = compare(&scene, &own, &Settings::default())?;

    print!("{}", summary(&outcome));
    println!("{}", verdict(&outcome));
    Ok(ExitCode::from(u8::from(!outcome.holds())))
}

/// Cylinders that are intersected in f32.
struct Own(Vec<Cylinder>);

impl Intersector for Own {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        let hits = self.0.iter().flat_map(|cylinder| hits(cylinder, ray));
        let t = hits
            .map(f64::from)
            .filter(|t| (ray.t_min..=ray.t_max).contains(t))
            .min_by(f64::total_cmp)?;
        Some(ReportedHit {
            t,
            normal: None,
            place: None,
        })
    }
}

/// The parameters at which a line hits a cylinder's wall and disks.
fn hits(cylinder: &Cylinder, ray: &Ray) -> Vec<f32> {
    let (p0, a) = (cylinder.p0(), cylinder.p1() - cylinder.p0());
    let from_p0 = (ray.origin - p0).as_vec3();
    let (direction, axis) = (ray.direction.as_vec3(), a.normalize().as_vec3());
    let (length, radius) = (a.length() as f32, cylinder.radius() as f32);
    let (height, rate) = (from_p0.dot(axis), direction.dot(axis));
    let across = |vector: Vec3, along: f32| vector - axis * along;
    let (start, way) = (across(from_p0, height), across(direction, rate));

    let (qa, qb) = (way.dot(way), start.dot(way));
    let root = (qb * qb - qa * (start.dot(start) - radius * radius)).sqrt();
    let wall = [(-qb - root) / qa, (-qb + root) / qa];
    let wall = wall
        .into_iter()
        .filter(|t| (0.0..=length).contains(&(height + t * rate)));
    let caps = cylinder.caps();
    let disks = [
        (caps.at_p0(), -height / rate),
        (caps.at_p1(), (length - height) / rate),
    ];
    let disks = disks
        .into_iter()
        .filter(|&(is_there, t)| is_there && (start + way * t).length() <= radius)
        .map(|(_, t)| t);
    wall.chain(disks).collect()
}
