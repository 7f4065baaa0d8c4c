//! Meshes against the solids they are of.
//!
//! The distance of two convex bodies, one of which holds the other, is the greatest
//! difference of their support functions `h(n) = max n·x`, and one holds the other if
//! its own is never less. That of a solid is written here from its definition; that of
//! a mesh is the greatest over its corners, if it is convex.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::DVec3;

use cyltrace::math::{Random, UNIT_ROUNDOFF};
use cyltrace::solid::tessellation::*;
use cyltrace::solid::{AnySolid, Caps, Cone, Cylinder, Disk, RoundedCone, Sphere};
use test_support::solids::{random_solid, support};

/// By the divergence theorem, about a point.
fn volume(mesh: &Mesh, about: DVec3) -> f64 {
    let six_times = mesh.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|i| mesh.vertices[i as usize] - about);
        a.dot(b.cross(c))
    });
    six_times.sum::<f64>() / 6.0
}

/// The edges that are not met once in either direction.
fn open_edges(mesh: &Mesh) -> usize {
    let mut met: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            met.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
        }
    }
    met.values()
        .filter(|directions| **directions != [1, 1])
        .count()
}

#[test]
fn meshes_hold_or_are_held_within_their_deviation() {
    const SEED: u64 = 41;
    for case in 0..1_000 {
        let mut random = Random::new(SEED, case);
        let solid = random_solid(&mut random);
        let segments = [3, 4, 17, 64][random.below(4) as usize];
        let error = corner_error_of(&solid, segments);
        // The support functions of the test round, too.
        let most = error + 16.0 * UNIT_ROUNDOFF * solid.size();
        for fit in [Fit::Inscribed, Fit::Circumscribed] {
            let what = format!("seed {SEED}, case {case}: {solid:?}, {segments} {fit:?}");
            let mesh = mesh_of(&solid, segments, fit);
            let size = (mesh.vertices.len() as u64, mesh.triangles.len() as u64);
            assert_eq!(size, mesh_size_of(&solid, segments), "{what}");
            assert_eq!(mesh.triangles, triangles_of(&solid, segments), "{what}");
            let deviation = deviation_of(&solid, segments, fit);
            let check = |normal: DVec3, slack: f64| {
                let corners = mesh.vertices.iter().map(|corner| corner.dot(normal));
                let beyond = corners.fold(f64::NEG_INFINITY, f64::max) - support(&solid, normal);
                let (low, high) = match fit {
                    Fit::Inscribed => (-deviation, 0.0),
                    Fit::Circumscribed => (0.0, deviation),
                };
                assert!(
                    (low - slack..=high + slack).contains(&beyond),
                    "{what}: {beyond:e} beyond along {normal:?}, {deviation:e} {slack:e}"
                );
            };
            let reach = reach_of(&solid, segments) + error;
            assert!(
                mesh.vertices.iter().all(|corner| corner.length() <= reach),
                "{what}"
            );
            (0..40).for_each(|_| check(random.direction(), most));
            if matches!(solid, AnySolid::Disk(_)) {
                continue;
            }
            assert_eq!(open_edges(&mesh), 0, "{what}");
            let edges = 3 * mesh.triangles.len() / 2;
            assert_eq!(
                mesh.vertices.len() + mesh.triangles.len(),
                edges + 2,
                "{what}"
            );
            // The planes of faces, where the solid is touched or farthest in; all
            // corners are on the inner side, so that the mesh is convex.
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize]);
                let across = (b - a).cross(c - a);
                let longest = (b - a).length().max((c - a).length()).max((c - b).length());
                // Roundings turn the plane by as much over the triangle's height, and
                // the farthest corner comes out by that turn.
                let turn = 4.0 * most * longest / across.length();
                let slack = most + turn * solid.size();
                if slack < 1e-6 * solid.size() {
                    let normal = across.normalize();
                    check(normal, slack);
                    let plane = a.dot(normal);
                    let farthest = mesh.vertices.iter().map(|corner| corner.dot(normal));
                    let beyond = farthest.fold(f64::NEG_INFINITY, f64::max) - plane;
                    assert!(beyond <= slack, "{what}: {corners:?} is {beyond:e} deep");
                    if fit == Fit::Circumscribed {
                        let over = plane - support(&solid, normal);
                        assert!(over.abs() <= slack, "{what}: {corners:?} {over:e} away");
                    }
                }
            }
        }
    }
}

/// The volume of the solid of a kind that has a formula.
fn exact_volume(solid: &AnySolid) -> Option<f64> {
    let frustum = |length: f64, r0: f64, r1: f64| PI * length * (r0 * r0 + r0 * r1 + r1 * r1) / 3.0;
    let ball = |radius: f64| 4.0 / 3.0 * PI * radius * radius * radius;
    match solid {
        AnySolid::Cylinder(c) => Some(frustum((c.p1() - c.p0()).length(), c.radius(), c.radius())),
        AnySolid::Cone(c) => Some(frustum(
            (c.p1() - c.p0()).length(),
            c.radius0(),
            c.radius1(),
        )),
        AnySolid::Sphere(s) => Some(ball(s.radius())),
        AnySolid::RoundedCone(c) if c.radius0() == c.radius1() => {
            let (length, radius) = ((c.p1() - c.p0()).length(), c.radius0());
            Some(frustum(length, radius, radius) + ball(radius))
        }
        _ => None,
    }
}

#[test]
fn volumes_of_meshes_enclose_the_solids_and_close_in_on_it() {
    let (p0, p1) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 4.0, 3.5));
    let solids: [AnySolid; 5] = [
        Cylinder::new(p0, p1, 0.7, Caps::Both).unwrap().into(),
        Cone::new(p0, p1, 0.7, 0.2, Caps::Both).unwrap().into(),
        Cone::new(p0, p1, 0.0, 1.2, Caps::Both).unwrap().into(),
        Sphere::new(p0, 1.5).unwrap().into(),
        RoundedCone::new(p0, p1, 0.7, 0.7).unwrap().into(),
    ];
    for solid in solids {
        let exact = exact_volume(&solid).expect("a formula");
        let mut gap = f64::INFINITY;
        for segments in [3, 4, 7, 64, 256] {
            let [inner, outer] = [Fit::Inscribed, Fit::Circumscribed]
                .map(|fit| volume(&mesh_of(&solid, segments, fit), p0));
            assert!(inner < exact && exact < outer, "{solid:?} {segments}");
            assert!(outer - inner < gap, "{solid:?} {segments}");
            gap = outer - inner;
            if let AnySolid::Cylinder(_) | AnySolid::Cone(_) = solid {
                // The areas of regular polygons in and around the unit circle, over π.
                let n = f64::from(segments);
                let (sin, cos) = libm::sincos(PI / n);
                for (seen, area) in [(inner, sin * cos), (outer, sin / cos)] {
                    let expected = area * n / PI * exact;
                    assert!((seen / expected - 1.0).abs() < 1e-13, "{seen} {expected}");
                }
            }
        }
        assert!(gap < 1e-3 * exact, "{solid:?}: {gap}");
    }
}

/// What is there of a wall, and in which order, is that of a cylinder whatever the
/// taper.
#[test]
fn open_ends_stay_open_and_an_apex_closes_one() {
    let cone = |r0, r1, caps| -> AnySolid {
        Cone::new(DVec3::ZERO, DVec3::Z, r0, r1, caps)
            .unwrap()
            .into()
    };
    for (solid, open) in [
        (cone(1.0, 2.0, Caps::Both), 0),
        (cone(1.0, 2.0, Caps::P0), 8),
        (cone(1.0, 2.0, Caps::P1), 8),
        (cone(1.0, 2.0, Caps::None), 16),
        (cone(0.0, 2.0, Caps::None), 8),
        (cone(0.0, 2.0, Caps::P1), 0),
        (cone(2.0, 0.0, Caps::P0), 0),
        (cone(2.0, 0.0, Caps::P1), 8),
    ] {
        let mesh = mesh_of(&solid, 8, Fit::Inscribed);
        assert_eq!(open_edges(&mesh), open, "{solid:?}");
    }
    for caps in [Caps::None, Caps::P0, Caps::P1, Caps::Both] {
        assert_eq!(prism_size(caps, 8), mesh_size_of(&cone(1.0, 2.0, caps), 8));
    }
}

/// Without its disks a wall has no inside; then what is asked is by heights.
#[test]
fn corners_and_walls_keep_their_distance_from_the_axis() {
    let mut random = Random::new(3, 0);
    for case in 0..2_000 {
        let p0 = random.direction() * random.log_uniform(1e-3, 1e3);
        let length = random.log_uniform(1e-3, 1e3);
        let p1 = p0 + random.direction() * length;
        let (r0, r1) = (random.log_uniform(1e-3, 1e3), random.log_uniform(1e-3, 1e3));
        let solid = AnySolid::from(Cone::new(p0, p1, r0, r1, Caps::None).unwrap());
        let axis = (p1 - p0).normalize();
        let segments = 3 + random.below(60) as u32;
        let factor = inner_factor(segments);
        for fit in [Fit::Inscribed, Fit::Circumscribed] {
            let scale = if fit == Fit::Inscribed {
                1.0
            } else {
                1.0 / factor
            };
            let mesh = mesh_of(&solid, segments, fit);
            let most = 2.0 * corner_error_of(&solid, segments);
            for (number, corner) in mesh.vertices.iter().enumerate() {
                let (end, radius) = if number % 2 == 0 { (p0, r0) } else { (p1, r1) };
                let from = *corner - end;
                let along = from.dot(axis);
                let across = (from - axis * along).length() - radius * scale;
                assert!(along.abs() <= most, "case {case}: {along:e} {most:e}");
                assert!(across.abs() <= most, "case {case}: {across:e} {most:e}");
            }
            // The deviation is met, in the middle of a side or at a corner.
            let share = deviation_of(&solid, segments, fit) / r0.max(r1);
            let expected = (scale - if fit == Fit::Inscribed { factor } else { 1.0 }).abs();
            assert!((share / expected - 1.0).abs() < 1e-9, "{share} {expected}");
        }
    }
}

/// A rounded cone that is a ball has the mesh of the ball, and the mesh of a disk is
/// seen from where its normal points.
#[test]
fn balls_are_balls_and_disks_face_their_normal() {
    let p0 = DVec3::new(1.0, 2.0, 3.0);
    let held = RoundedCone::new(p0, p0 + DVec3::X, 0.5, 2.0).unwrap();
    let ball = Sphere::new(p0 + DVec3::X, 2.0).unwrap();
    let [held, ball] =
        [held.into(), ball.into()].map(|solid: AnySolid| mesh_of(&solid, 9, Fit::Circumscribed));
    assert_eq!(
        (held.vertices, held.triangles),
        (ball.vertices, ball.triangles)
    );
    // Far centers that all but coincide still give the axis a direction.
    let nearly = RoundedCone::new(DVec3::ZERO, DVec3::new(0.0, 1e-300, 0.0), 1.0, 1.0).unwrap();
    let mesh = mesh_of(&nearly.into(), 16, Fit::Inscribed);
    assert!(
        mesh.vertices
            .iter()
            .all(|corner| (corner.length() - 1.0).abs() < 1e-14)
    );

    let disk = Disk::new(p0, DVec3::new(0.0, -3.0, 4.0), 0.7).unwrap();
    let mesh = mesh_of(&disk.into(), 5, Fit::Inscribed);
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| mesh.vertices[i as usize]);
        assert!((b - a).cross(c - a).dot(disk.normal()) > 0.0);
    }
}
