//! Prisms of random solids, of a whole scene, and what they take.

use std::collections::HashSet;
use std::path::Path;

use super::*;
use crate::check::prisms::containment::tests::{
    holds_all_exactly, is_enclosed_exactly, random_window,
};
use crate::check::prisms::placed::windows;
use crate::embree::{Device, DeviceOptions, SceneBuilder};
use crate::math::Random;

const BOTH: [Side; 2] = [Side::Inscribed, Side::Circumscribed];

fn corners(prisms: &Prisms) -> impl Iterator<Item = [[f32; 3]; 3]> {
    let triangles = prisms.triangles.iter();
    triangles.map(|triangle| triangle.map(|i| prisms.vertices[i as usize]))
}

fn volume(prisms: &Prisms) -> f64 {
    let middle = DVec3::from_array(prisms.vertices[0].map(f64::from));
    let sixth = |triangle: [[f32; 3]; 3]| {
        let [a, b, c] = triangle.map(|corner| DVec3::from_array(corner.map(f64::from)) - middle);
        a.dot(b.cross(c)) / 6.0
    };
    corners(prisms).map(sixth).sum()
}

#[test]
fn triangles_form_a_closed_surface() {
    for segments in [3, 4, 17] {
        let triangles = triangles(segments);
        assert_eq!(triangles.len(), 4 * segments as usize);
        let edges = triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let edges: Vec<(u32, u32)> = edges.collect();
        let distinct: HashSet<_> = edges.iter().copied().collect();
        assert_eq!(distinct.len(), edges.len());
        assert!(edges.iter().all(|&(a, b)| distinct.contains(&(b, a))));
        let vertices: HashSet<u32> = triangles.iter().flatten().copied().collect();
        assert_eq!(vertices.len() + triangles.len(), edges.len() / 2 + 2);
    }
}

/// Every prism is proven again without the filter, and the two are on both
/// sides of the solid by volume.
#[test]
fn random_solids_have_proven_prisms() {
    for (segments, cases) in [(3, 1_000), (8, 1_000), (64, 400), (1024, 25)] {
        let mut random = Random::new(71, u64::from(segments));
        let (mut empty, mut unbounded) = (0, 0);
        for case in 0..cases {
            let window = random_window(&mut random);
            let frame = MeshFrame::new(&window);
            let [inner, outer] = BOTH.map(|side| prisms(&window, &frame, segments, side));
            empty += inner.empty.len();
            unbounded += outer.unbounded.len();
            assert!(
                holds_all_exactly(&window.solids[0], &frame, &inner.vertices),
                "case {case}: the inner prism of {:?}",
                window.solids[0]
            );
            assert!(
                is_enclosed_exactly(&window.solids[0], &frame, corners(&outer)),
                "case {case}: the outer prism of {:?}",
                window.solids[0]
            );
            if inner.empty.is_empty() && outer.unbounded.is_empty() {
                let [inner, outer] = [volume(&inner), volume(&outer)];
                assert!(0.0 < inner && inner < outer, "case {case}: {inner} {outer}");
            }
        }
        assert_eq!(
            (empty, unbounded),
            (0, 0),
            "of {cases} with {segments} sides"
        );
    }
}

/// Without margins, about half of all vertices would be on the wrong side.
#[test]
fn prisms_without_margins_are_caught() {
    for (segments, cases) in [(8, 500), (64, 200)] {
        let mut random = Random::new(72, u64::from(segments));
        let mut caught = [0, 0];
        for _ in 0..cases {
            let window = random_window(&mut random);
            let frame = MeshFrame::new(&window);
            let map = MeshMap::new(&frame, &window.solids[0].frame);
            let solid = MeshSolid::new(&frame, &map, &window.solids[0]);
            for (side, caught) in BOTH.into_iter().zip(&mut caught) {
                let builder = Builder::new(segments, side);
                let vertices = builder.vertices(&solid, 0.0, 0.0).expect("a prism");
                let triangles = builder.triangles(map.is_mirrored).iter();
                let corners = triangles.map(|corners| corners.map(|i| vertices[i as usize]));
                let (filtered, truth) = match side {
                    Side::Inscribed => (
                        holds_all(&solid, &frame, &vertices),
                        holds_all_exactly(solid.placed, &frame, &vertices),
                    ),
                    Side::Circumscribed => (
                        is_enclosed(&solid, &frame, corners.clone()),
                        is_enclosed_exactly(solid.placed, &frame, corners),
                    ),
                };
                assert_eq!(filtered, truth);
                *caught += i32::from(!truth);
            }
        }
        assert!(
            caught.iter().all(|&caught| caught >= cases * 99 / 100),
            "{segments} sides: of {cases}, {caught:?} were caught"
        );
    }
}

/// Solids too small for f32 where they are have no prisms, and say so.
#[test]
fn solids_below_the_last_bit_are_unwitnessed() {
    let mut random = Random::new(73, 0);
    for _ in 0..100 {
        let mut window = random_window(&mut random);
        let bounds = window.extent();
        let size = bounds.extent().length();
        let far = bounds.centre() + random.direction() * (size * 1e9);
        window.bounds = Some(crate::math::Bounds::at(far).grown(size));
        let frame = MeshFrame::new(&window);
        assert_eq!(prisms(&window, &frame, 16, Side::Inscribed).empty, [0]);
        let outer = prisms(&window, &frame, 16, Side::Circumscribed);
        let count = outer.solid_of.len() + outer.unbounded.len();
        assert_eq!(count, 1);
        assert!(is_enclosed_exactly(
            &window.solids[0],
            &frame,
            corners(&outer)
        ));
    }
}

/// `scenes/lattice.toml` at 64 sides.
#[test]
fn lattice_has_all_prisms() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lattice.toml");
    let scene = crate::scene::load(&path).expect("the scene is there");
    let window = windows(&scene, 1 << 17, 0).remove(0);
    let frame = MeshFrame::new(&window);
    for side in BOTH {
        let prisms = prisms(&window, &frame, 64, side);
        assert_eq!(prisms.solid_of.len(), window.solids.len());
        assert_eq!(
            prisms.triangles.len(),
            window.solids.len() * prisms.triangles_per_prism
        );
    }
}

/// The estimate against what lists and Embree hold.
#[test]
fn memory_is_near_the_estimate() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lattice.toml");
    let scene = crate::scene::load(&path).expect("the scene is there");
    let window = &mut windows(&scene, 1 << 17, 0)[0];
    for (solids, segments) in [(10_000, 16), (3_000, 64), (300, 512)] {
        window.solids.truncate(solids);
        let frame = MeshFrame::new(window);
        let device = Device::new(&DeviceOptions::default()).expect("a device");
        let mut held = 0;
        let scenes = BOTH.map(|side| {
            let prisms = prisms(window, &frame, segments, side);
            held += size_of_val(&*prisms.vertices) + size_of_val(&*prisms.triangles);
            let mut builder = SceneBuilder::<()>::new(&device).expect("a scene");
            let attached = builder.attach_triangles(&prisms.vertices, &prisms.triangles);
            attached.expect("a legal mesh");
            builder.commit().expect("built")
        });
        let held = held + device.memory_bytes();
        drop(scenes);
        let estimate = bytes_needed(solids as u64, segments);
        let ratio = held as f64 / estimate as f64;
        assert!(
            (0.9..1.1).contains(&ratio),
            "{solids} solids of {segments} sides: {ratio} of the estimate"
        );
    }
}
