//! Meshes of random solids in random places, proven again without the filter.

use glam::{DAffine3, DMat3};

use super::*;
use crate::bounding_meshes::placed::{Budget, windows};
use crate::bounding_meshes::window::Window;
use crate::solids::tests::random_solid;
use cyltrace::math::Random;
use cyltrace::scene::{MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord};
use cyltrace_oracle::ExactVector;

const BOTH: [Fit; 2] = [Fit::Inscribed, Fit::Circumscribed];

fn random_disk(random: &mut Random) -> AnySolid {
    let center = random.direction() * random.log_uniform(1e-3, 10.0);
    let normal = random.direction() * random.log_uniform(0.1, 10.0);
    let radius = random.log_uniform(0.05, 1.0);
    Disk::new(center, normal, radius).unwrap().into()
}

/// A window about one solid in a placement that stretches, shears and may mirror.
pub(crate) fn random_window(solid: AnySolid, random: &mut Random) -> Window {
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    let mut stretch = || random.log_uniform(0.3, 3.0);
    let scale = DMat3::from_diagonal(DVec3::new(stretch(), stretch(), stretch()));
    let mut matrix = DMat3::from_cols(x, y, x.cross(y)) * scale;
    if random.below(2) == 0 {
        matrix.x_axis = -matrix.x_axis;
    }
    let away = random.direction() * random.log_uniform(1e-3, 1e5);
    let root = Prototype {
        placements: vec![Placement {
            of: PrototypeIndex(1),
            parent_from_child: DAffine3::from_mat3_translation(matrix, away),
        }],
        ..Prototype::default()
    };
    let mut own = Prototype::default();
    let material = MaterialIndex(0);
    let record = SolidRecord::new(solid, 0, material);
    own.solids.push(record).expect("f64 keeps it");
    let budget = Budget {
        triangles: 1 << 24,
        segments: 64,
    };
    windows(&Scene::new(vec![root, own]), budget, 0).remove(0)
}

fn volume(hull: &Hull) -> f64 {
    let middle = wide(hull.vertices[0]);
    let sixth = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| wide(hull.vertices[i as usize]) - middle);
        a.dot(b.cross(c)) / 6.0
    };
    hull.triangles.iter().map(sixth).sum()
}

fn with_hulls(
    placed: &PlacedSolid,
    window: &Window,
    segments: u32,
    check: impl FnOnce(&MeshFrame, &Proven, [Option<Hull>; 2]),
) {
    let frame = MeshFrame::new(window);
    let map = MeshMap::new(&frame, &placed.frame);
    let proven = Proven::new(placed);
    let hulls = BOTH.map(|side| hull(&frame, &map, placed, segments, side));
    check(&frame, &proven, hulls);
}

#[test]
fn random_solids_have_proven_meshes() {
    for (segments, cases) in [(3, 600), (8, 400), (64, 30)] {
        let mut random = Random::new(93, u64::from(segments));
        for case in 0..cases {
            let solid = random_solid(&mut random);
            let window = random_window(solid, &mut random);
            with_hulls(
                &window.solids[0],
                &window,
                segments,
                |frame, proven, hulls| {
                    let [Some(inner), Some(outer)] = hulls else {
                        panic!("case {case}: {solid:?} has no mesh with {segments} sides");
                    };
                    let world = |vertex| frame.exact_world_from_mesh(wide(vertex));
                    for &vertex in &inner.vertices {
                        assert!(proven.contains(&world(vertex)), "case {case}: {solid:?}");
                    }
                    // No facet's plane passes on the wrong side of the middle, and
                    // no corner is in the solid.
                    for corners in &outer.triangles {
                        let corners = corners.map(|i| world(outer.vertices[i as usize]));
                        assert_ne!(proven.is_around_middle(&corners), Some(false));
                    }
                    for &vertex in &outer.vertices {
                        assert!(!proven.contains(&world(vertex)), "case {case}: {solid:?}");
                    }
                    let [inner, outer] = [&inner, &outer].map(volume);
                    assert!(0.0 < inner && inner < outer, "case {case}: {inner} {outer}");
                },
            );
        }
    }
}

#[test]
fn disks_have_sheets_on_both_sides() {
    let mut random = Random::new(94, 0);
    for case in 0..300 {
        let solid = random_disk(&mut random);
        let window = random_window(solid, &mut random);
        with_hulls(&window.solids[0], &window, 16, |frame, proven, hulls| {
            let [Some(sheets), Some(outer)] = hulls else {
                panic!("case {case}: {solid:?} has no mesh");
            };
            let sides = sheets
                .vertices
                .iter()
                .map(|&vertex| proven.side_of_disk(&frame.exact_world_from_mesh(wide(vertex))));
            let sides: Vec<Option<f64>> = sides.collect();
            let (over, under) = sides.split_at(sides.len() / 2);
            assert!(over.iter().all(|side| *side == Some(1.0)), "case {case}");
            assert!(under.iter().all(|side| *side == Some(-1.0)), "case {case}");
            // And so are the triangles.
            let halves = sheets.triangles.split_at(sheets.triangles.len() / 2);
            let is_over = |corner: &u32| (*corner as usize) < over.len();
            assert!(halves.0.iter().flatten().all(is_over), "case {case}");
            assert!(!halves.1.iter().flatten().any(is_over), "case {case}");
            assert!(volume(&outer) > 0.0);
        });
    }
}

/// What the filters let through, next to the surface, is so.
#[test]
fn filters_are_never_wrong_near_the_surface() {
    let mut random = Random::new(95, 0);
    let mut counts = [[0; 2]; 2];
    for case in 0..20_000 {
        let solid = random_solid(&mut random);
        let window = random_window(solid, &mut random);
        let placed = &window.solids[0];
        let frame = MeshFrame::new(&window);
        let map = MeshMap::new(&frame, &placed.frame);
        let here = Rounded::new(&frame, &map, placed);
        let proven = Proven::new(placed);
        let (anchor, direction) = (solid.anchor(), random.direction());
        let from_anchor = solid.center() - anchor;
        let Some(chord) = solid.chord(from_anchor, direction) else {
            continue;
        };
        let on_surface = from_anchor + direction * chord.leave.t;
        let surface = solid.surface_point(chord.leave.part, on_surface);
        let off = random.log_uniform(1e-17, 1e-7) * if random.below(2) == 0 { 1.0 } else { -1.0 };
        let point = surface.point - anchor + surface.normal * off;
        let vertex = here.anchor().base + map.matrix * point;
        let world: ExactVector = frame.exact_world_from_mesh(vertex);
        for (count, (is_sure, is_so)) in counts.iter_mut().zip([
            (here.surely_contains(vertex), proven.contains(&world)),
            (
                here.is_surely_beyond(vertex, surface.normal),
                proven.is_beyond(&world, surface.normal),
            ),
        ]) {
            assert!(is_so || !is_sure, "case {case}: {solid:?} at {off:e}");
            count[0] += u32::from(is_so);
            count[1] += u32::from(is_sure);
        }
        assert!(!(proven.contains(&world) && proven.is_beyond(&world, surface.normal)));
    }
    for [so, sure] in counts {
        assert!(sure > so / 3 && sure < so, "{counts:?}");
    }
}

/// Without margins rounding leaves hardly any mesh on its side.
#[test]
fn meshes_without_margins_are_caught() {
    let mut random = Random::new(96, 0);
    let (mut tried, mut passed) = (0, [0; 2]);
    for _ in 0..200 {
        let solid = random_solid(&mut random);
        let window = random_window(solid, &mut random);
        let placed = &window.solids[0];
        let frame = MeshFrame::new(&window);
        let map = MeshMap::new(&frame, &placed.frame);
        let builder = Builder {
            frame: &frame,
            map: &map,
            placed,
            here: Rounded::new(&frame, &map, placed),
            own: at_origin(&solid).expect("a solid"),
        };
        tried += 1;
        passed[0] += u32::from(builder.inside(16, 0.0).is_some());
        passed[1] += u32::from(builder.around(16, 0.0).is_some());
    }
    assert!(
        passed.iter().all(|&passed| passed * 50 < tried),
        "{passed:?} of {tried}"
    );
}
