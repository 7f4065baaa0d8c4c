//! `cyltrace check --mesh` and `--hits` with inputs that a careless check would accept.

use crate::program;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use cyltrace::solid::tessellation::{Mesh, inscribed_prism};
use cyltrace::solid::{Caps, Cylinder};
use glam::DVec3;
use program::{cyltrace, folder_of};
use serde_json::Value;

const SCENE: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 2]\nradius = 0.5\ncaps = \"both\"\n\
[[cylinder]]\np0 = [2, 0, 0]\np1 = [2, 1, 1]\nradius = 0.25\ncaps = \"both\"\n";

/// More than the sagitta of 32 sides, 0.0048 radii.
const DEVIATION: &str = "0.0025";

fn mesh() -> Mesh {
    let new = |p0: [f64; 3], p1: [f64; 3], radius| {
        Cylinder::new(DVec3::from(p0), DVec3::from(p1), radius, Caps::Both).expect("a cylinder")
    };
    let mut mesh = inscribed_prism(&new([0.0; 3], [0.0, 0.0, 2.0], 0.5), 32);
    mesh.append(&inscribed_prism(
        &new([2.0, 0.0, 0.0], [2.0, 1.0, 1.0], 0.25),
        32,
    ));
    mesh
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {:?} {:?} {:?}", v.x, v.y, v.z).expect("text");
    }
    for [a, b, c] in mesh
        .triangles
        .iter()
        .map(|one| one.map(|corner| corner + 1))
    {
        writeln!(text, "f {a} {b} {c}").expect("text");
    }
    text
}

/// Binary, with a first word as a text has.
fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = b"solid of cyltrace".to_vec();
    bytes.resize(80, 0);
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for corners in &mesh.triangles {
        bytes.extend([0; 12]);
        for corner in corners {
            let point = mesh.vertices[*corner as usize].as_vec3().to_array();
            bytes.extend(point.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// The code and the output of a check of a mesh, with more arguments.
fn checked(folder: &Path, name: &str, content: &[u8], more: &[&str]) -> (i32, String) {
    fs::write(folder.join(name), content).expect("writing the mesh");
    let arguments = ["check", "scene.toml", "--rays", "3000", "--mesh", name];
    let (code, out, err) = cyltrace(folder, &[&arguments, more].concat());
    (code, out + &err)
}

/// As [`checked`], with the deviation of 32 sides.
fn judged(mesh: &Mesh) -> (i32, String) {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    checked(
        folder.path(),
        "m.obj",
        obj(mesh).as_bytes(),
        &["--deviation", DEVIATION],
    )
}

#[test]
fn right_meshes_hold_in_each_format_and_say_their_tolerance() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    for (name, content) in [
        ("m.obj", obj(&mesh()).into_bytes()),
        ("m.STL", stl(&mesh())),
    ] {
        let more = ["--deviation", DEVIATION];
        let (code, text) = checked(folder.path(), name, &content, &more);
        assert_eq!(code, 0, "{name}: {text}");
        assert!(
            text.contains("tolerance: at most 0.0025, the least radius is 0.25"),
            "{text}"
        );
        let (code, text) = checked(
            folder.path(),
            name,
            &content,
            &[&more[..], &["--json", "-"]].concat(),
        );
        assert_eq!(code, 0, "{name}: {text}");
        let figures: Value = serde_json::from_str(&text).expect("nothing but JSON");
        let row = &figures["classes"][0];
        let tolerance = row["tolerance"].as_f64().expect("a number");
        assert!((0.0025..0.002501).contains(&tolerance), "{row}");
        assert_eq!(row["least_radius"], 0.25);
        let percent = row["witnessed_percent"].as_f64().expect("a number");
        assert_eq!(row["judged"].as_f64(), Some((30.0 * percent).round()));
        assert_eq!(figures["isa_dependent"], Value::Array(Vec::new()));
    }
}

/// Finding 1: with a vertex at 1e7 the tolerance was 9 units.
#[test]
fn far_vertex_makes_no_tolerance() {
    let far = |mesh: &mut Mesh, distance: f64| {
        let first = mesh.vertices.len() as u32;
        let end = DVec3::new(distance, 0.0, 0.0);
        mesh.vertices.extend([end, end + DVec3::Y, end + DVec3::Z]);
        mesh.triangles.push([first, first + 1, first + 2]);
    };
    for distance in [1e7, 1e20, 1e45] {
        // Far from the scene, no ray to it meets the triangle.
        let mut whole = mesh();
        far(&mut whole, distance);
        let (code, text) = judged(&whole);
        assert_eq!(code, 0, "{distance}: {text}");
        assert!(text.contains("at most 0.0025,"), "{text}");
        let mut half = mesh();
        let mut number = 0;
        half.triangles.retain(|_| {
            number += 1;
            number % 2 == 0
        });
        far(&mut half, distance);
        let (code, text) = judged(&half);
        assert_eq!(code, 1, "{distance}: {text}");
        assert!(text.contains("answers are wrong"), "{text}");
    }
}

#[test]
fn meshes_of_other_things_fail() {
    let moved = |by: DVec3| {
        let mut mesh = mesh();
        mesh.vertices.iter_mut().for_each(|vertex| *vertex += by);
        mesh
    };
    let one = |corners: [DVec3; 3]| Mesh {
        vertices: corners.to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    let mut spiked = mesh();
    spiked.vertices[0] = DVec3::new(1e12, 0.0, 1.0);
    let mut wall = mesh();
    wall.append(&one([
        DVec3::new(-1e6, -1e6, 5.0),
        DVec3::new(1e6, -1e6, 5.0),
        DVec3::new(0.0, 1e6, 5.0),
    ]));
    let mut first = mesh();
    first.triangles.truncate(first.triangles.len() / 2);
    for (what, mesh) in [
        ("far away", moved(DVec3::X * 1e9)),
        ("moved a little", moved(DVec3::X * 0.02)),
        ("without one cylinder", first),
        ("a triangle without area", one([DVec3::ZERO; 3])),
        (
            "a huge triangle in the middle",
            one([
                DVec3::new(-1e30, 0.0, -1e30),
                DVec3::new(1e30, 0.0, -1e30),
                DVec3::new(0.0, 0.0, 1e30),
            ]),
        ),
        ("a spike", spiked),
        ("a wall in front", wall),
    ] {
        let (code, text) = judged(&mesh);
        assert_eq!(code, 1, "{what}: {text}");
    }
}

#[test]
fn deviation_beyond_the_least_radius_fails_and_says_so() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let with = |text: &str, more: &[&str]| checked(folder.path(), "m.obj", text.as_bytes(), more);
    let good = obj(&mesh());
    for deviation in ["0.25", "0.26", "1e9", "1e300"] {
        for (text, more) in [
            (good.clone(), &["--deviation", deviation][..]),
            (format!("# deviation {deviation}\n{good}"), &[]),
        ] {
            let (code, out) = with(&text, more);
            assert_eq!(code, 1, "{deviation}: {out}");
            assert!(
                out.contains("fails: the tolerance reaches the radius"),
                "{out}"
            );
        }
    }
    let (code, out) = with(&good, &["--deviation", "0.24"]);
    assert_eq!(code, 0, "{out}");
}

#[test]
fn empty_scenes_and_meshes_do_not_hold() {
    let folder = folder_of(&[("scene.toml", "[[prototype]]\nname = \"a\"\n")]);
    let (code, text) = checked(
        folder.path(),
        "m.obj",
        obj(&mesh()).as_bytes(),
        &["--deviation", "0"],
    );
    assert_ne!(code, 0, "{text}");
    let folder = folder_of(&[("scene.toml", SCENE)]);
    for (name, content) in [
        ("m.obj", &b"v 0 0 0\n"[..]),
        ("m.stl", b"solid\nendsolid\n"),
        ("m.ply", b""),
    ] {
        let (code, text) = checked(folder.path(), name, content, &["--deviation", "0.1"]);
        assert_eq!(code, 2, "{name}: {text}");
    }
}

/// Findings 5 and 6, and one of each format: file and line, exit code 2.
#[test]
fn bad_meshes_are_refused_with_file_and_line() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let bomb = "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement foo 1000000000\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";
    for (name, content, message) in [
        (
            "m.obj",
            "v 0 0 1e160\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "m.obj:1: the vertex is (0.0, 0.0, 1e160)",
        ),
        (
            "m.obj",
            "v 0 0 0\nf 1 1 x # no\n",
            "m.obj:2: the corner \"x\"",
        ),
        (
            "m.ply",
            bomb,
            "m.ply:7: the element \"foo\" has 1000000000 records but no properties",
        ),
        (
            "m.stl",
            "solid\nfacet\nloop\n",
            "m.stl:3: expected outer loop, found \"loop\"",
        ),
    ] {
        let (code, text) = checked(
            folder.path(),
            name,
            content.as_bytes(),
            &["--deviation", "0"],
        );
        assert_eq!(code, 2, "{text}");
        assert!(text.contains(message), "no {message:?} in {text}");
    }
}

/// Checks rays against the hits of another program.
fn hits(rays: &str, hits: &str, more: &[&str]) -> (i32, String) {
    hits_in(SCENE, rays, hits, more)
}

/// The same in another scene.
fn hits_in(scene: &str, rays: &str, hits: &str, more: &[&str]) -> (i32, String) {
    let rays = format!("ox,oy,oz,dx,dy,dz\n{rays}");
    let hits = format!("hit,t\n{hits}");
    let folder = folder_of(&[
        ("scene.toml", scene),
        ("rays.csv", &rays),
        ("hits.csv", &hits),
    ]);
    let arguments = [
        "check",
        "scene.toml",
        "--rays",
        "rays.csv",
        "--hits",
        "hits.csv",
    ];
    let (code, out, err) = cyltrace(folder.path(), &[&arguments, more].concat());
    (code, out + &err)
}

#[test]
fn tolerance_of_hits_is_about_the_ray_and_its_solid() {
    const RAYS: &str = "-5,0,1,1,0,0\n0,0,9,0,0,-1\n0,9,1,1,0,0\n";
    let (code, text) = hits(RAYS, "1,4.5\n1,7\n0,\n", &[]);
    assert_eq!(code, 0, "{text}");
    for wrong in [
        "0,\n1,7\n0,\n",
        "1,4.5\n1,8\n0,\n",
        "1,4.5\n1,7\n1,1e30\n",
        "1,4.5\n1,7\n1,1e308\n",
        "0,\n0,\n0,\n",
    ] {
        let (code, text) = hits(RAYS, wrong, &[]);
        assert_eq!(code, 1, "{wrong}: {text}");
    }
    // A tolerance of a tenth of some ten units is more than either radius.
    let (code, text) = hits(RAYS, "1,4.5\n1,7\n0,\n", &["--tolerance", "0.1"]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("fails: the tolerance reaches"), "{text}");
}

/// The length of such a direction is 0 in f64, and with it every `t` agreed.
#[test]
fn tiny_directions_are_no_excuse() {
    let (code, text) = hits("-5,0,1,1e-200,0,0\n", "1,1\n", &[]);
    assert_ne!(code, 0, "{text}");
    let (code, text) = hits("0,9,1,1e-200,0,0\n", "1,1\n", &[]);
    assert_ne!(code, 0, "{text}");
}

/// A far solid made the tolerance of all rays as large as f32 is coarse there.
#[test]
fn far_solid_does_not_loosen_the_tolerance_of_others() {
    let scene = format!("{SCENE}[[sphere]]\ncenter = [1e8, 0, 0]\nradius = 100\n");
    let (code, text) = hits_in(&scene, "0,0,9,0,0,-1\n", "1,7.4\n", &[]);
    assert_eq!(code, 1, "{text}");
    assert!(text.contains("answered t 7.4, exactly t 7.0"), "{text}");
}

/// Rays to points of the scene's box hardly ever meet small solids far apart.
#[test]
fn small_solids_missing_beside_a_floor_and_far_apart_are_found() {
    let small = |x: u32, y: u32| {
        format!("[[cylinder]]\np0 = [{x}, {y}, 0]\np1 = [{x}, {y}, 0.2]\nradius = 0.01\n")
    };
    let floor = "[[cuboid]]\nhalf_widths = [1000, 1000, 1]\ncenter = [0, 0, -1]\n";
    let beside_a_floor = format!("{}{}{floor}", small(0, 0), small(100, 0));
    let apart = [(0, 0), (30, 0), (0, 50), (100, 0)].map(|(x, y)| small(x, y));
    for (scene, of_one) in [(beside_a_floor, 2), (apart.concat(), 4)] {
        let folder = folder_of(&[("scene.toml", scene.as_str())]);
        let made = [
            "tessellate",
            "scene.toml",
            "-o",
            "m.obj",
            "--segments",
            "16",
        ];
        assert_eq!(cyltrace(folder.path(), &made).0, 0);
        let text = fs::read_to_string(folder.path().join("m.obj")).expect("reading the mesh");
        let (code, output) = checked(folder.path(), "whole.obj", text.as_bytes(), &[]);
        assert_eq!(code, 0, "{output}");
        // The faces of the last cylinder, whose vertices come last but for the floor's eight.
        let faces = text.lines().filter(|line| line.starts_with("f ")).count();
        let solid = (faces - 12 * usize::from(of_one == 2)) / of_one;
        let first = (of_one - 1) * solid;
        let mut number = 0;
        let kept: String = text
            .lines()
            .filter(|line| {
                number += usize::from(line.starts_with("f "));
                !(line.starts_with("f ") && first < number && number <= first + solid)
            })
            .map(|line| format!("{line}\n"))
            .collect();
        let (code, output) = checked(folder.path(), "lacks.obj", kept.as_bytes(), &[]);
        assert_eq!(code, 1, "{output}");
    }
}

#[test]
fn mesh_that_no_ray_could_meet_is_not_said_to_hold() {
    let folder = folder_of(&[
        ("scene.toml", SCENE),
        ("away.csv", "ox,oy,oz,dx,dy,dz\n9,9,9,1,0,0\n"),
    ]);
    let away = ["--deviation", DEVIATION, "--rays", "away.csv"];
    fs::write(folder.path().join("m.obj"), obj(&mesh())).expect("writing the mesh");
    let arguments = ["check", "scene.toml", "--mesh", "m.obj"];
    let (code, out, err) = cyltrace(folder.path(), &[&arguments[..], &away].concat());
    assert_eq!(code, 1, "{out}{err}");
    assert!((out + &err).contains("no ray hits a solid"));
}
