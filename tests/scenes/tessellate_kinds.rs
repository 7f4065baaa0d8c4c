//! Meshes of solids of all kinds, placed, written to files and read back, held against
//! the solids.

use std::collections::HashSet;
use std::ops::ControlFlow;

use cyltrace::math::{Random, UNIT_ROUNDOFF};
use cyltrace::meshes::{Format, Plan, read_mesh};
use cyltrace::scene::{Placement, PrototypeIndex, Scene};
use cyltrace::solid::tessellation::{Fit, Mesh, deviation_of, mesh_size_of};
use cyltrace::solid::{AnySolid, Caps, Location, Part};
use glam::{DAffine3, DMat3, DVec3};
use test_support::random_rotation;
use test_support::solids::{crowd, prototype_of};

/// How much the placed solids of a scene are stretched at most.
const STRETCH: f64 = 3.0;

/// A crowd, and another one placed twice: stretched unevenly, the second mirrored.
fn scene(seed: u64) -> Scene {
    let mut random = Random::new(seed, 1);
    let mut root = prototype_of(&crowd(seed, 24));
    root.placements = [1.0, -1.0]
        .map(|mirror| {
            let scale = DVec3::new(mirror * 0.5, 1.0, STRETCH);
            let turned = random_rotation(&mut random);
            let matrix = turned * DMat3::from_diagonal(scale) * random_rotation(&mut random);
            Placement {
                of: PrototypeIndex(1),
                parent_from_child: DAffine3::from_mat3_translation(
                    matrix,
                    random.direction() * 9.0,
                ),
            }
        })
        .to_vec();
    let mut leaf = prototype_of(&crowd(seed + 1, 48));
    leaf.name = "leaf".into();
    Scene::new(vec![root, leaf])
}

/// The solids in the order of the file, and where they are.
fn placed(scene: &Scene) -> Vec<(AnySolid, DAffine3)> {
    let [root, leaf] = &scene.prototypes[..] else {
        panic!("two prototypes");
    };
    let own = root.singles().map(|(_, solid)| (solid, DAffine3::IDENTITY));
    let others = root.placements.iter().flat_map(|placement| {
        let singles = leaf.singles();
        singles.map(|(_, solid)| (solid, placement.parent_from_child))
    });
    own.chain(others).collect()
}

/// The parts of a solid's surface.
fn parts(solid: &AnySolid) -> Vec<Part> {
    let tapered = |caps: Caps| {
        let caps = [(caps.at_p0(), Part::Cap0), (caps.at_p1(), Part::Cap1)];
        let caps = caps.into_iter().filter(|(is_there, _)| *is_there);
        caps.map(|(_, part)| part).chain([Part::Side]).collect()
    };
    match solid {
        AnySolid::Cylinder(cylinder) => tapered(cylinder.caps()),
        AnySolid::Cone(cone) => tapered(cone.caps()),
        AnySolid::RoundedCone(cone) => {
            let delta = (cone.radius1() - cone.radius0()).abs();
            let is_hull = (cone.p1() - cone.p0()).length() > delta * (1.0 + 1e-9);
            let caps = vec![Part::Cap0, Part::Cap1];
            if is_hull { tapered(Caps::Both) } else { caps }
        }
        AnySolid::Sphere(_) | AnySolid::Disk(_) => vec![Part::Side],
        AnySolid::Cuboid(_) => vec![
            Part::XMin,
            Part::XMax,
            Part::YMin,
            Part::YMax,
            Part::ZMin,
            Part::ZMax,
        ],
    }
}

/// The distance in the world of a point from a point of the solid's surface that is near.
fn distance(solid: &AnySolid, map: &DAffine3, point: DVec3) -> f64 {
    let local = map.inverse().transform_point3(point);
    let candidates = parts(solid).into_iter().filter_map(|part| {
        let surface = solid.surface_point(part, local - solid.anchor());
        // Within a rounded cone a sphere is no part of the surface.
        let beyond = surface.point + surface.normal * (1e-7 * solid.size());
        let is_outside = solid.locate(beyond) == Location::Outside;
        is_outside.then(|| (map.transform_point3(surface.point) - point).length())
    });
    candidates.fold(f64::INFINITY, f64::min)
}

/// Holds the mesh of one solid against it.
fn judge((solid, map): &(AnySolid, DAffine3), mesh: &Mesh, plan: &Plan, what: &str) {
    let is_placed = *map != DAffine3::IDENTITY;
    let stretch = if is_placed { STRETCH } else { 1.0 };
    let deviation = stretch * deviation_of(solid, plan.segments(), plan.fit());
    // The way there and back here has some 20 roundings of numbers up to 30.
    let most = deviation * (1.0 + 1e-12) + plan.rounding() + 640.0 * UNIT_ROUNDOFF * 30.0;
    assert!(deviation <= plan.deviation(), "{what}");

    let corners = |triangle: &[u32; 3]| triangle.map(|i| mesh.vertices[i as usize]);
    let triangles = mesh.triangles.iter().map(corners);
    for [a, b, c] in triangles.clone() {
        for point in [a, b, c, (a + b) / 2.0, (a + c) / 2.0, (a + b + c) / 3.0] {
            let seen = distance(solid, map, point);
            assert!(seen <= most, "{what}: {seen} from the surface, not {most}");
        }
    }
    if matches!(solid, AnySolid::Disk(_)) {
        return;
    }
    let (center, inverse) = (solid.center(), map.inverse());
    for vertex in &mesh.vertices {
        let from_center = inverse.transform_point3(*vertex) - center;
        let scaled = |factor: f64| solid.locate(center + from_center * factor);
        match plan.fit() {
            Fit::Inscribed => assert!(scaled(1.0 - 1e-9).is_held(), "{what}: {vertex}"),
            Fit::Circumscribed => {
                assert_ne!(scaled(1.0 + 1e-9), Location::Inside, "{what}: {vertex}");
            }
        }
    }
    let inside = map.transform_point3(center);
    for [a, b, c] in triangles {
        let outward = (b - a).cross(c - a).dot(a - inside);
        assert!(outward > 0.0, "{what}: a triangle faces inward");
    }
    if solid.is_closed() {
        let triangles = mesh.triangles.iter();
        let edges: HashSet<[u32; 2]> = triangles
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        assert_eq!(edges.len(), 3 * mesh.triangles.len(), "{what}");
        let is_met = |&[a, b]: &[u32; 2]| edges.contains(&[b, a]);
        assert!(edges.iter().all(is_met), "{what}: not closed");
        let euler = mesh.vertices.len() + mesh.triangles.len();
        assert_eq!(euler, edges.len() / 2 + 2, "{what}");
    }
}

#[test]
fn meshes_of_all_kinds_read_back_and_stay_within_their_deviation() {
    let folder = tempfile::tempdir().unwrap();
    for (seed, segments, fit) in [
        (11, 3, Fit::Inscribed),
        (12, 3, Fit::Circumscribed),
        (13, 18, Fit::Inscribed),
        (14, 18, Fit::Circumscribed),
    ] {
        let scene = scene(seed);
        let plan = Plan::new(&scene, segments, fit).unwrap();
        assert!(!plan.are_prisms());
        let solids = placed(&scene);
        assert_eq!(solids.len() as u128, plan.solids());
        for (format, name) in [(Format::Obj, "mesh.obj"), (Format::Ply, "mesh.ply")] {
            let mut bytes = Vec::new();
            let mut items = 0;
            let mut count = |more| {
                items += more;
                ControlFlow::Continue(())
            };
            format
                .write(&scene, &plan, name, &mut bytes, &mut count)
                .unwrap();
            assert_eq!(u128::from(items), plan.vertices() + plan.triangles());
            assert!(bytes.len() as u128 <= format.file_bytes(&plan, name));
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let file = read_mesh(&path).unwrap();
            assert_eq!(file.deviation, Some(plan.deviation()));
            assert_eq!(file.mesh.vertices.len() as u128, plan.vertices());
            assert_eq!(file.mesh.triangles.len() as u128, plan.triangles());

            let (mut first, mut first_triangle) = (0, 0);
            for (number, solid) in solids.iter().enumerate() {
                let (vertices, triangles) = mesh_size_of(&solid.0, segments);
                let end = first_triangle + triangles as usize;
                let own = file.mesh.triangles[first_triangle..end].iter();
                let mesh = Mesh {
                    vertices: file.mesh.vertices[first..first + vertices as usize].to_vec(),
                    triangles: own
                        .map(|corners| corners.map(|corner| corner - first as u32))
                        .collect(),
                };
                let what = format!("{name}, seed {seed}, {number}: {solid:?}, {segments} {fit:?}");
                judge(solid, &mesh, &plan, &what);
                (first, first_triangle) = (first + vertices as usize, end);
            }
        }
    }
}
