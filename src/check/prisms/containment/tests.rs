//! The filter against exact numbers, where they are hardest to tell apart.

use glam::{DAffine3, DMat3};

use super::*;
use crate::check::prisms::mesh_solid::MeshMap;
use crate::check::prisms::placed::{Window, windows};
use crate::math::Random;
use crate::scene::{CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene};
use crate::solid::{Caps, Cylinder};

/// Whether all vertices are in the solid, without the filter.
pub(in crate::check) fn holds_all_exactly(
    solid: &PlacedSolid,
    frame: &MeshFrame,
    vertices: &[[f32; 3]],
) -> bool {
    let solid = ExactSolid::new(solid);
    let mut vertices = vertices.iter();
    vertices.all(|&vertex| solid.is_inside(&frame.exact_world_from_mesh(wide(vertex))))
}

/// Whether the solid is behind all triangles, without the filter.
pub(in crate::check) fn is_enclosed_exactly(
    solid: &PlacedSolid,
    frame: &MeshFrame,
    mut triangles: impl Iterator<Item = [[f32; 3]; 3]>,
) -> bool {
    let solid = ExactSolid::new(solid);
    triangles.all(|corners| {
        let plane = Plane::new(frame, corners);
        solid.is_behind(&plane) || solid.is_below(&plane)
    })
}

/// A window about one cylinder in up to three placements that stretch, shear
/// and mirror, of any size, up to a million sizes away.
pub(in crate::check) fn random_window(random: &mut Random) -> Window {
    let size = random.log_uniform(1e-3, 1e3);
    let p0 = random.direction() * (size * random.log_uniform(1e-3, 10.0));
    let along = random.direction() * (size * random.log_uniform(0.05, 20.0));
    let radius = size * random.log_uniform(0.05, 1.0);
    let cylinder = Cylinder::new(p0, p0 + along, radius, Caps::Both).expect("a cylinder");
    let levels = 1 + random.below(3);
    let mut prototypes = Vec::new();
    for level in 0..levels {
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        let mut stretch = || random.log_uniform(0.3, 3.0);
        let scale = DMat3::from_diagonal(DVec3::new(stretch(), stretch(), stretch()));
        let mut matrix = DMat3::from_cols(x, y, x.cross(y)) * scale;
        if random.below(2) == 0 {
            matrix.x_axis = -matrix.x_axis;
        }
        let away = random.direction() * (size * random.log_uniform(1e-3, 1e6));
        prototypes.push(Prototype {
            placements: vec![Placement {
                of: PrototypeIndex(level as u32 + 1),
                parent_from_child: DAffine3::from_mat3_translation(matrix, away),
            }],
            ..Prototype::default()
        });
    }
    prototypes.push(Prototype {
        cylinders: vec![CylinderRecord::new(&cylinder, 0, MaterialIndex(0))].into(),
        ..Prototype::default()
    });
    windows(&Scene::new(prototypes), 100, 0).remove(0)
}

/// A share of a whole that may be next to nothing.
fn tiny(random: &mut Random) -> f64 {
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    sign * random.log_uniform(1e-17, 1e-8)
}

#[test]
fn points_near_the_surface_are_never_taken_for_inside_wrongly() {
    let mut random = Random::new(61, 0);
    let (mut inside, mut decided) = (0, 0);
    for case in 0..20_000 {
        let window = random_window(&mut random);
        let (frame, placed) = (MeshFrame::new(&window), &window.solids[0]);
        let map = MeshMap::new(&frame, &placed.frame);
        let solid = MeshSolid::new(&frame, &map, placed);
        let unit = solid.axis / solid.length;
        let across = unit.cross(random.direction()).normalize();
        let (mut height, mut radial) = (random.unit(), random.unit());
        match random.below(3) {
            0 => height = tiny(&mut random),
            1 => height = 1.0 + tiny(&mut random),
            _ => radial = 1.0 + tiny(&mut random),
        }
        let point = unit * (height * solid.length) + across * (radial * solid.radius);
        let point = solid.base + map.matrix * point;
        let truth = ExactSolid::new(placed).is_inside(&frame.exact_world_from_mesh(point));
        let filtered = is_surely_inside(&solid, point);
        assert!(
            truth || !filtered,
            "case {case}: {point:?} is outside of {placed:?}"
        );
        inside += u32::from(truth);
        decided += u32::from(filtered);
    }
    assert!(
        decided > inside / 2 && decided < inside,
        "{inside} inside, {decided} of them surely"
    );
}

#[test]
fn planes_near_the_surface_are_never_taken_for_outside_wrongly() {
    let mut random = Random::new(62, 0);
    let (mut outside, mut decided) = (0, 0);
    for case in 0..20_000 {
        let window = random_window(&mut random);
        let (frame, placed) = (MeshFrame::new(&window), &window.solids[0]);
        let map = MeshMap::new(&frame, &placed.frame);
        let solid = MeshSolid::new(&frame, &map, placed);
        let unit = solid.axis / solid.length;
        let across = unit.cross(random.direction()).normalize();
        let beside = unit.cross(across);
        // A plane through a rim, tilted from the wall to the cap.
        let (cos, sin) = match random.below(3) {
            0 => (1.0, 0.0),
            1 => (0.0, 1.0),
            _ => {
                let (sin, cos) = libm::sincos(random.uniform(0.0, 1.5));
                (cos, sin)
            }
        };
        let normal = across * cos + unit * sin;
        let tangent = unit * cos - across * sin;
        let rim = unit * solid.length + across * solid.radius;
        let rim = rim + normal * (tiny(&mut random) * solid.radius);
        let mut corner = || {
            let (u, v) = (random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            solid.base + map.matrix * (rim + (tangent * u + beside * v) * solid.radius)
        };
        let mut corners = [corner(), corner(), corner()];
        let out = map.inverse.transpose() * normal;
        if (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .dot(out)
            < 0.0
        {
            corners.swap(1, 2);
        }
        let plane = Plane::of(corners.map(|corner| frame.exact_world_from_mesh(corner)));
        let truth = ExactSolid::new(placed).is_behind(&plane);
        let filtered = is_surely_outside(&solid, corners);
        assert!(
            truth || !filtered,
            "case {case}: {corners:?} cuts {placed:?}"
        );
        outside += u32::from(truth);
        decided += u32::from(filtered);
    }
    assert!(
        decided > outside / 2 && decided < outside,
        "{outside} outside, {decided} of them surely"
    );
}

/// Triangles of caps, tilted a little and up to past the middle of the axis, with
/// corners next to the plane of the end.
#[test]
fn triangles_near_an_end_are_never_taken_for_beyond_it_wrongly() {
    let mut random = Random::new(63, 0);
    let (mut beyond, mut decided) = (0, 0);
    for case in 0..20_000 {
        let window = random_window(&mut random);
        let (frame, placed) = (MeshFrame::new(&window), &window.solids[0]);
        let map = MeshMap::new(&frame, &placed.frame);
        let solid = MeshSolid::new(&frame, &map, placed);
        let unit = solid.axis / solid.length;
        let across = unit.cross(random.direction()).normalize();
        let beside = unit.cross(across);
        let is_top = random.below(2) == 0;
        let mut corner = |u: f64, v: f64| {
            let lift = match random.below(4) {
                0 => solid.length * random.log_uniform(1e-3, 10.0),
                _ => solid.length * tiny(&mut random).abs(),
            };
            // One in 16 is on the wrong side, by little.
            let lift = if random.below(16) == 0 { -lift } else { lift };
            let height = if is_top { solid.length + lift } else { -lift };
            let off = (across * u + beside * v) * solid.radius;
            solid.base + map.matrix * (unit * height + off)
        };
        let mut corners = [corner(0.0, 0.0), corner(1.0, -0.1), corner(1.0, 0.1)];
        if is_top == map.is_mirrored {
            corners.swap(1, 2);
        }
        let plane = Plane::of(corners.map(|corner| frame.exact_world_from_mesh(corner)));
        let truth = ExactSolid::new(placed).is_below(&plane);
        let filtered = is_surely_beyond_end(&solid, corners);
        assert!(
            truth || !filtered,
            "case {case}: {corners:?} is not beyond an end of {placed:?}"
        );
        beyond += u32::from(truth);
        decided += u32::from(filtered);
    }
    assert!(
        decided > beyond / 4 && decided < beyond && beyond < 20_000,
        "{beyond} beyond, {decided} of them surely"
    );
}
