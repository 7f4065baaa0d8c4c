//! `check --mesh` on meshes that `tessellate` made: right ones hold whatever their segments, and
//! faults are found at the solid that has them, beside solids of a far greater deviation.

use crate::program;

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::meshes::{MeshFile, read_mesh};
use cyltrace::scene::{Scene, load};
use cyltrace::solid::Cylinder;
use cyltrace::solid::tessellation::{Fit, Mesh};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{Deviation, Outcome, TracedMesh, compare_mesh};
use glam::{DAffine3, DVec3};
use program::{cyltrace, folder_of};
use serde_json::Value;

fn sample(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(format!("scenes/{name}.toml"))
}

/// Writes the mesh of a scene.
fn tessellate(folder: &Path, scene: &Path, mesh: &str, segments: u32, fit: Fit) {
    let scene = scene.to_str().expect("UTF-8");
    let segments = segments.to_string();
    let fit = format!("--{}", fit.name());
    let arguments = [
        "tessellate",
        scene,
        "-o",
        mesh,
        "--segments",
        &segments,
        &fit,
        "-q",
    ];
    let (code, out, err) = cyltrace(folder, &arguments);
    assert_eq!(code, 0, "{out}{err}");
}

/// The code of a check, its row, and what it prints to standard error.
fn checked(folder: &Path, scene: &Path, mesh: &str, more: &[&str]) -> (i32, Value, String) {
    let scene = scene.to_str().expect("UTF-8");
    let arguments = ["check", scene, "--mesh", mesh, "--json", "-", "--rays"];
    let (code, out, err) = cyltrace(folder, &[&arguments, more].concat());
    let figures: Value = serde_json::from_str(&out).expect("nothing but JSON");
    (code, figures["classes"][0].clone(), err)
}

#[test]
fn every_mesh_of_the_sample_scenes_holds() {
    let folder = folder_of::<&str>(&[]);
    for (name, mesh) in [
        ("minimal", "m.obj"),
        ("pathological", "m.obj"),
        ("lattice", "m.ply"),
    ] {
        for segments in [3, 4, 8, 12, 32] {
            for fit in [Fit::Inscribed, Fit::Circumscribed] {
                tessellate(folder.path(), &sample(name), mesh, segments, fit);
                let (code, row, err) = checked(folder.path(), &sample(name), mesh, &["2000"]);
                let what = format!("{name} {segments} {fit:?}: {row} {err}");
                assert_eq!(code, 0, "{what}");
                assert_eq!(row["tessellated"]["segments"], segments, "{what}");
                assert_eq!(row["tessellated"]["fit"], fit.name(), "{what}");
            }
        }
    }
}

/// A strut of the lattice where it is placed, and rays at its middle that meet nothing else.
struct Strut {
    ends: [DVec3; 2],
    radius: f64,
    rays: Vec<Ray>,
}

impl Strut {
    fn new(scene: &Scene, number: usize) -> Self {
        // The first prototype with struts along the first placements.
        let mut prototype = &scene.prototypes[0];
        let mut map = DAffine3::IDENTITY;
        while prototype.solids.cylinders.iter().count() < 1000 {
            let placement = &prototype.placements[0];
            map *= placement.parent_from_child;
            prototype = &scene.prototypes[placement.of.0 as usize];
        }
        let strut: Cylinder = prototype
            .solids
            .cylinders
            .iter()
            .nth(number)
            .expect("a strut")
            .cylinder();
        let ends = [strut.p0(), strut.p1()].map(|end| map.transform_point3(end));
        let axis = (ends[1] - ends[0]).normalize();
        let (one, other) = axis.any_orthonormal_pair();
        let rays = (0..16).map(|number| {
            let angle = std::f64::consts::TAU * (f64::from(number) + 0.3) / 16.0;
            let outward = one * angle.cos() + other * angle.sin();
            let middle = ends[0].midpoint(ends[1]) + 0.1 * strut.radius() * axis;
            let origin = middle + 3.0 * strut.radius() * outward;
            let mut ray = Ray::new(origin, -outward);
            ray.t_max = 6.0 * strut.radius();
            ray
        });
        Self {
            ends,
            radius: strut.radius(),
            rays: rays.collect(),
        }
    }

    /// The way from the axis to a point, where the point is no farther than the rim.
    fn away_from_axis(&self, point: DVec3) -> Option<DVec3> {
        let axis = self.ends[1] - self.ends[0];
        let share = ((point - self.ends[0]).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let away = point - (self.ends[0] + share * axis);
        (away.length() <= 1.2 * self.radius).then_some(away)
    }

    /// Whether a triangle is of its mesh.
    fn contains(&self, mesh: &Mesh, corners: &[u32; 3]) -> bool {
        let mut points = corners.iter().map(|&corner| mesh.vertices[corner as usize]);
        points.all(|point| self.away_from_axis(point).is_some())
    }

    /// The mesh with all vertices of the strut moved.
    fn moved(&self, mesh: &Mesh, by: impl Fn(DVec3) -> DVec3) -> Mesh {
        let mut moved = mesh.clone();
        for point in &mut moved.vertices {
            if let Some(away) = self.away_from_axis(*point) {
                *point += by(away);
            }
        }
        moved
    }
}

fn verdict(tracer: &Tracer, file: &MeshFile, rays: &[Ray]) -> Outcome {
    let deviation = Deviation::stated(file, tracer.scene()).expect("the file states it");
    assert!(
        matches!(deviation, Deviation::Tessellated { .. }),
        "{deviation:?}"
    );
    let go_on = |_: u64, _: u64| ControlFlow::Continue(());
    let mesh = TracedMesh::new(&file.mesh);
    compare_mesh(tracer, &mesh, ("given", rays), (deviation, 0.0), 3, &go_on).expect("an end")
}

/// The floor under the struts has a deviation of 10 at 12 segments, and their radii are 0.036 and more:
/// whatever is wrong with one of them is found at every ray.
#[test]
fn faults_of_thin_solids_beside_a_large_one_are_found() {
    let folder = folder_of::<&str>(&[]);
    let scene = Arc::new(load(&sample("lattice")).expect("a scene"));
    let tracer = Tracer::new(scene.clone(), &Options::default()).expect("a tracer");
    for (fit, number) in [(Fit::Inscribed, 17), (Fit::Circumscribed, 1003)] {
        tessellate(folder.path(), &sample("lattice"), "m.ply", 12, fit);
        let right = read_mesh(&folder.path().join("m.ply")).expect("a mesh");
        let strut = Strut::new(&scene, number);
        let count = strut.rays.len() as u64;
        let found = verdict(&tracer, &right, &strut.rays);
        let row = &found.rows[0];
        assert_eq!((row.hits, row.witnessed, row.violations), (count, count, 0));
        let tolerance = row.tolerance.expect("a tolerance");
        assert!(found.holds() && tolerance.greatest < 0.04 * strut.radius);
        let mut missing = right.mesh.clone();
        missing
            .triangles
            .retain(|corners| !strut.contains(&right.mesh, corners));
        for (what, mesh) in [
            ("missing", missing),
            ("thicker", strut.moved(&right.mesh, |away| 0.1 * away)),
            ("thinner", strut.moved(&right.mesh, |away| -0.1 * away)),
        ] {
            let file = MeshFile {
                mesh,
                ..right.clone()
            };
            let found = verdict(&tracer, &file, &strut.rays);
            let wrong = found.violation_count();
            assert_eq!(wrong, count, "{what} {number} {fit:?}: {found:?}");
        }
    }
}

const PLATE_AND_TWIG: &str = "[[cylinder]]\np0 = [0, 0, -1]\np1 = [0, 0, 0]\nradius = 300\ncaps = \"both\"\n\
[[cylinder]]\np0 = [0, 0, 1]\np1 = [0, 0, 3]\nradius = 0.04\ncaps = \"both\"\n";

/// A plate's deviation is at its rim: neither is a wrong height of it excused, nor its absence.
#[test]
fn faults_of_a_wide_plate_are_found_along_its_axis() {
    let folder = folder_of(&[("scene.toml", PLATE_AND_TWIG)]);
    let path = folder.path().join("scene.toml");
    let scene = Arc::new(load(&path).expect("a scene"));
    let tracer = Tracer::new(scene, &Options::default()).expect("a tracer");
    let down = |x: f64| Ray::new(DVec3::new(x, 0.5, 9.0), DVec3::NEG_Z);
    let rays = [down(0.0), down(50.0), down(-100.0)];
    for fit in [Fit::Inscribed, Fit::Circumscribed] {
        tessellate(folder.path(), &path, "m.ply", 8, fit);
        let right = read_mesh(&folder.path().join("m.ply")).expect("a mesh");
        assert_eq!(verdict(&tracer, &right, &rays).rows[0].witnessed, 3);
        assert!(verdict(&tracer, &right, &rays).holds());
        let mut low = right.clone();
        low.mesh
            .vertices
            .iter_mut()
            .for_each(|point| point.z -= 1e-3);
        let mut high = right.clone();
        high.mesh
            .vertices
            .iter_mut()
            .for_each(|point| point.z += 1e-3);
        let mut missing = right.clone();
        let is_twig = |corner: &u32| right.mesh.vertices[*corner as usize].z > 0.5;
        missing
            .mesh
            .triangles
            .retain(|corners| corners.iter().all(is_twig));
        for (what, file) in [("low", low), ("high", high), ("missing", missing)] {
            let found = verdict(&tracer, &file, &rays);
            assert_eq!(found.violation_count(), 3, "{what} {fit:?}: {found:?}");
        }
    }
}

/// Comments that anybody can write: none gives more than the one stated deviation, which then must
/// be less than the least radius.
#[test]
fn forged_comments_do_not_widen_the_tolerance() {
    let folder = folder_of(&[("scene.toml", PLATE_AND_TWIG)]);
    let scene = folder.path().join("scene.toml");
    let with = |made: u32, forge: &dyn Fn(&str) -> String| {
        tessellate(folder.path(), &scene, "m.obj", made, Fit::Inscribed);
        let text = fs::read_to_string(folder.path().join("m.obj")).expect("a mesh");
        let forged = forge(&text);
        assert_ne!(forged, text);
        fs::write(folder.path().join("m.obj"), forged).expect("a file");
        checked(folder.path(), &scene, "m.obj", &["500"])
    };
    let deviation = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("# deviation"));
        String::from(line.expect("tessellate states it"))
    };
    // Fewer segments than the mesh has, with what they would deviate.
    let fewer = |text: &str| {
        let text = text.replace("# segments 32\n", "# segments 3\n");
        text.replace(&deviation(&text), "# deviation 151")
    };
    let words = |what: &'static str| {
        move |text: &str| text.replace("# segments 32\n", &format!("# segments {what}\n"))
    };
    for (what, forge) in [
        ("fewer", &fewer as &dyn Fn(&str) -> String),
        ("negative", &words("-3")),
        ("none", &words("0")),
        ("two", &words("2")),
        ("huge", &words("4000000000")),
        ("beyond", &words("99999999999999999999")),
        ("not a number", &words("NaN")),
    ] {
        let (code, row, err) = with(32, forge);
        assert_eq!(code, 1, "{what}: {row}");
        assert_eq!(row["tessellated"], Value::Null, "{what}: {row}");
        let tolerance = row["tolerance"].as_f64().expect("a number");
        assert!(
            tolerance >= row["least_radius"].as_f64().expect("a number"),
            "{row} {err}"
        );
    }
    // More segments than the mesh has: a narrower tolerance, which its walls exceed.
    let more = |text: &str| text.replace("# segments 8\n", "# segments 64\n");
    let (code, row, err) = with(8, &more);
    assert_eq!(code, 1, "{row} {err}");
    assert_eq!(row["tessellated"]["segments"], 64);
    assert_ne!(row["violations"], 0, "{row}");
    // A smaller deviation than the segments make applies as it is.
    let smaller = |text: &str| text.replace(&deviation(text), "# deviation 0.001");
    let (code, row, err) = with(8, &smaller);
    assert_eq!(code, 1, "{row} {err}");
    assert_eq!(row["tessellated"], Value::Null);
    assert!(
        err.contains("the mesh is not what `cyltrace tessellate` makes"),
        "{err}"
    );
}
