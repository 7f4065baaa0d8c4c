//! The oracle of set operations on examples whose answers are worked out by hand.
//!
//! The expected values are those of regularised set operations: the closure of the
//! interior. Each line states the solid, and the hits as parameters and directions.

mod random;

use cyltrace::math::{Orientation, Ray, power_of_two};
use cyltrace::solid::{
    AnySolid, Caps, Composition, Cone, Crossing, Cuboid, Cylinder, Location, Part, RoundedCone,
    Sphere,
};
use cyltrace_oracle::{ComposedTruth, to_f64};
use glam::DVec3;

use Composition::{Difference, Intersection, Union};
use Crossing::{Enter, Leave};
use Location::{Boundary, Inside, Outside};

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn leaf(solid: impl Into<AnySolid>) -> Composition {
    Composition::Solid(solid.into())
}

/// The box between two corners.
fn block(lower: DVec3, upper: DVec3) -> Composition {
    let (center, half_widths) = ((lower + upper) / 2.0, (upper - lower) / 2.0);
    leaf(Cuboid::new(center, half_widths, Orientation::IDENTITY).expect("a cuboid"))
}

fn cylinder(p0: DVec3, p1: DVec3, radius: f64) -> Composition {
    leaf(Cylinder::new(p0, p1, radius, Caps::Both).expect("a cylinder"))
}

fn cone(p0: DVec3, p1: DVec3, radii: [f64; 2]) -> Composition {
    leaf(Cone::new(p0, p1, radii[0], radii[1], Caps::Both).expect("a cone"))
}

fn sphere(center: DVec3, radius: f64) -> Composition {
    leaf(Sphere::new(center, radius).expect("a sphere"))
}

/// The hits of a ray from a point; each must have a face to name.
fn hits(composition: &Composition, origin: DVec3, direction: DVec3) -> Vec<(f64, Crossing)> {
    let found = ComposedTruth::new(composition).hits(&Ray::new(origin, direction));
    let hits = found.iter().map(|hit| {
        assert!(!hit.faces.is_empty(), "no face: {composition:?} {hit:?}");
        (to_f64(&hit.t), hit.crossing)
    });
    hits.collect()
}

/// The faces of the first hit.
fn faces(composition: &Composition, origin: DVec3, direction: DVec3) -> Vec<(u32, Part)> {
    let found = ComposedTruth::new(composition).hits(&Ray::new(origin, direction));
    let mut faces: Vec<_> = found[0]
        .faces
        .iter()
        .map(|face| (face.leaf, face.part))
        .collect();
    faces.sort_by_key(|(leaf, part)| (*leaf, part.name()));
    faces
}

fn locate(composition: &Composition, point: DVec3) -> Location {
    ComposedTruth::new(composition).locate(point)
}

/// A block of 4 whose half with `x > 0` is taken away by one of the same width.
fn half() -> Composition {
    Difference(vec![
        block(at(-2.0, -2.0, -2.0), at(2.0, 2.0, 2.0)),
        block(at(0.0, -2.0, -2.0), at(4.0, 2.0, 2.0)),
    ])
}

#[test]
fn cut_that_ends_in_a_face_leaves_no_film() {
    let half = half();
    assert_eq!(
        hits(&half, at(5.0, 2.0, 0.0), -DVec3::X),
        [(5.0, Enter), (7.0, Leave)]
    );
    assert_eq!(
        hits(&half, at(5.0, 0.0, 2.0), -DVec3::X),
        [(5.0, Enter), (7.0, Leave)]
    );
    assert_eq!(
        hits(&half, at(5.0, 2.0, 0.0), at(-1.0, 0.0, 0.1)),
        [(5.0, Enter), (7.0, Leave)]
    );
    assert_eq!(hits(&half, at(1.0, 2.0, 5.0), -DVec3::Z), []);
    let above = 2.0_f64.next_up();
    assert_eq!(hits(&half, at(5.0, above, 0.0), -DVec3::X), []);
    for (point, location) in [
        (at(2.0, 2.0, 0.0), Outside),
        (at(1.0, 2.0, 0.0), Outside),
        (at(0.0, 2.0, 0.0), Boundary),
        (at(-1.0, 2.0, 0.0), Boundary),
        (at(-1.0, 0.0, 0.0), Inside),
        (at(0.0, 0.0, 0.0), Boundary),
    ] {
        assert_eq!(locate(&half, point), location, "{point}");
    }
    // The edge at (0, 2, 0) is one of the cut and of the block's face.
    let found = faces(&half, at(5.0, 2.0, 0.0), -DVec3::X);
    assert_eq!(found, [(0, Part::YMax), (1, Part::XMin)]);
}

#[test]
fn bore_as_long_as_its_block_is_open_in_the_plane_of_its_mouth() {
    let pipe = Difference(vec![
        cylinder(DVec3::ZERO, DVec3::Z * 2.0, 1.0),
        cylinder(DVec3::ZERO, DVec3::Z * 2.0, 0.5),
    ]);
    let all = [(4.0, Enter), (4.5, Leave), (5.5, Enter), (6.0, Leave)];
    assert_eq!(hits(&pipe, at(-5.0, 0.0, 2.0), DVec3::X), all);
    assert_eq!(hits(&pipe, at(-5.0, 0.0, 1.0), DVec3::X), all);
    // The rim of the bore: its wall and the block's cap, and no cap of the bore.
    let found = ComposedTruth::new(&pipe).hits(&Ray::new(at(-5.0, 0.0, 2.0), DVec3::X));
    let mut parts: Vec<_> = found[1]
        .faces
        .iter()
        .map(|one| (one.leaf, one.part))
        .collect();
    parts.sort_by_key(|one| one.0);
    assert_eq!(parts, [(0, Part::Cap1), (1, Part::Side)]);
    let normal = found[1].faces.iter().find(|face| face.leaf == 1);
    assert_eq!(normal.and_then(|face| face.normal), Some(DVec3::X));
}

#[test]
fn joint_of_two_bores_has_no_wall() {
    let joint = Difference(vec![
        cylinder(-DVec3::Z, DVec3::Z * 3.0, 1.0),
        cylinder(-DVec3::Z, DVec3::Z, 0.5),
        cylinder(DVec3::Z, DVec3::Z * 3.0, 0.5),
    ]);
    let all = [(4.0, Enter), (4.5, Leave), (5.5, Enter), (6.0, Leave)];
    assert_eq!(hits(&joint, at(-5.0, 0.0, 1.0), DVec3::X), all);
    assert_eq!(
        hits(&joint, DVec3::Z, DVec3::X),
        [(0.5, Enter), (1.0, Leave)]
    );
    assert_eq!(hits(&joint, DVec3::Z, DVec3::Z), []);
    // At the joint the wall is that of either bore.
    let found = faces(&joint, DVec3::Z, DVec3::X);
    assert_eq!(found, [(1, Part::Side), (2, Part::Side)]);
}

#[test]
fn stacked_boxes_have_no_inner_face() {
    let stack = Union(vec![
        block(at(-1.0, -1.0, -1.0), at(1.0, 1.0, 1.0)),
        block(at(-1.0, -1.0, 1.0), at(1.0, 1.0, 3.0)),
    ]);
    assert_eq!(hits(&stack, at(0.25, 0.0, 1.0), DVec3::X), [(0.75, Leave)]);
    assert_eq!(
        hits(&stack, at(0.25, 0.0, 1.0), at(1.0, 0.0, 0.5)),
        [(0.75, Leave)]
    );
    assert_eq!(hits(&stack, at(0.25, 0.0, 1.0), DVec3::Z), [(2.0, Leave)]);
    assert_eq!(
        hits(&stack, at(-5.0, 0.0, 1.0), DVec3::X),
        [(4.0, Enter), (6.0, Leave)]
    );
    assert_eq!(locate(&stack, at(0.25, 0.0, 1.0)), Inside);
    assert_eq!(locate(&stack, at(1.0, 0.0, 1.0)), Boundary);
    let drums = Union(vec![
        cylinder(DVec3::ZERO, DVec3::Z, 1.0),
        cylinder(DVec3::Z, DVec3::Z * 2.0, 1.0),
    ]);
    assert_eq!(
        hits(&drums, at(-5.0, 0.0, 1.0), DVec3::X),
        [(4.0, Enter), (6.0, Leave)]
    );
    assert_eq!(locate(&drums, at(0.5, 0.5, 1.0)), Inside);
}

#[test]
fn solid_without_itself_is_empty() {
    let solids = [
        block(at(-1.0, -1.0, -1.0), at(1.0, 1.0, 1.0)),
        cylinder(-DVec3::Z, DVec3::Z, 1.0),
        cone(-DVec3::Z, DVec3::Z, [1.0, 0.0]),
        sphere(DVec3::ZERO, 1.0),
        leaf(RoundedCone::new(-DVec3::Z, DVec3::Z, 1.0, 0.5).expect("a hull")),
    ];
    for solid in solids {
        let nothing = Difference(vec![solid.clone(), solid]);
        for origin in [at(-5.0, 0.0, 0.0), at(-5.0, 0.0, 1.0), at(-5.0, 1.0, 0.0)] {
            assert_eq!(hits(&nothing, origin, DVec3::X), []);
        }
        assert_eq!(hits(&nothing, at(0.0, 0.0, -5.0), DVec3::Z), []);
        for point in [
            DVec3::ZERO,
            DVec3::X,
            DVec3::Z,
            -DVec3::Z,
            at(1.0, 0.0, 1.0),
        ] {
            assert_eq!(locate(&nothing, point), Outside, "{point}");
        }
    }
}

#[test]
fn solids_that_touch_have_an_empty_intersection() {
    let boxes = Intersection(vec![
        block(at(-1.0, -1.0, -1.0), at(0.0, 1.0, 1.0)),
        block(at(0.0, -1.0, -1.0), at(1.0, 1.0, 1.0)),
    ]);
    assert_eq!(hits(&boxes, at(0.0, 0.0, -5.0), DVec3::Z), []);
    assert_eq!(hits(&boxes, at(-5.0, 0.0, 0.0), DVec3::X), []);
    assert_eq!(locate(&boxes, DVec3::ZERO), Outside);
    let balls = |operation: fn(Vec<Composition>) -> Composition| {
        operation(vec![sphere(DVec3::ZERO, 1.0), sphere(DVec3::X * 2.0, 1.0)])
    };
    assert_eq!(hits(&balls(Intersection), at(-5.0, 0.0, 0.0), DVec3::X), []);
    assert_eq!(locate(&balls(Intersection), DVec3::X), Outside);
    // Through the point of contact: it is a point of the surface, inside before and behind.
    let along = hits(&balls(Union), at(-5.0, 0.0, 0.0), DVec3::X);
    assert_eq!(
        along,
        [(4.0, Enter), (6.0, Leave), (6.0, Enter), (8.0, Leave)]
    );
    assert_eq!(locate(&balls(Union), DVec3::X), Boundary);
    // Across it the line touches both from outside.
    let across = hits(&balls(Union), at(1.0, -5.0, 0.0), DVec3::Y);
    assert_eq!(across, [(5.0, Enter), (5.0, Leave)]);
}

#[test]
fn ball_that_touches_another_from_inside() {
    let (outer, inner) = (sphere(DVec3::ZERO, 2.0), sphere(DVec3::X, 1.0));
    let shell = Difference(vec![outer.clone(), inner.clone()]);
    // At (2, 0, 0) the wall of the shell has no thickness: to the right of the
    // hole, the line leaves at x = 0 and comes back at no other point.
    assert_eq!(
        hits(&shell, at(-5.0, 0.0, 0.0), DVec3::X),
        [(3.0, Enter), (5.0, Leave), (7.0, Enter), (7.0, Leave)]
    );
    assert_eq!(locate(&shell, at(2.0, 0.0, 0.0)), Boundary);
    assert_eq!(
        locate(
            &Difference(vec![inner.clone(), outer.clone()]),
            at(2.0, 0.0, 0.0)
        ),
        Outside
    );
    let both = Intersection(vec![outer, inner]);
    assert_eq!(
        hits(&both, at(-5.0, 0.0, 0.0), DVec3::X),
        [(5.0, Enter), (7.0, Leave)]
    );
    assert_eq!(
        faces(&both, at(-5.0, 0.0, 0.0), DVec3::X),
        [(1, Part::Side)]
    );
    assert_eq!(
        faces(&both, at(5.0, 0.0, 0.0), -DVec3::X),
        [(1, Part::Side)]
    );
}

#[test]
fn tangent_cylinders_inside_and_outside() {
    let big = cylinder(DVec3::ZERO, DVec3::Z * 4.0, 2.0);
    let inner = cylinder(at(1.0, 0.0, 0.0), at(1.0, 0.0, 4.0), 1.0);
    let outer = cylinder(at(3.0, 0.0, 0.0), at(3.0, 0.0, 4.0), 1.0);
    // The common ruling x = 2, y = 0.
    let ruling = |composition: &Composition| hits(composition, at(2.0, 0.0, -1.0), DVec3::Z);
    let whole = [(1.0, Enter), (5.0, Leave)];
    assert_eq!(ruling(&Intersection(vec![big.clone(), outer.clone()])), []);
    assert_eq!(
        ruling(&Intersection(vec![big.clone(), inner.clone()])),
        whole
    );
    assert_eq!(ruling(&Difference(vec![inner.clone(), big.clone()])), []);
    assert_eq!(ruling(&Difference(vec![big.clone(), inner.clone()])), whole);
    assert_eq!(ruling(&Union(vec![big.clone(), outer.clone()])), whole);
    let through = hits(&Union(vec![big, outer]), at(-5.0, 0.0, 2.0), DVec3::X);
    assert_eq!(
        through,
        [(3.0, Enter), (7.0, Leave), (7.0, Enter), (9.0, Leave)]
    );
}

#[test]
fn line_that_touches_an_edge_touches() {
    let block = block(at(-1.0, -1.0, -1.0), at(1.0, 1.0, 1.0));
    let wedge = Difference(vec![
        block.clone(),
        cylinder(at(0.0, -2.0, 3.0), at(0.0, 2.0, 3.0), 1.0),
    ]);
    let touched = hits(&wedge, at(0.0, 0.0, 2.0), at(1.0, 0.0, -1.0));
    assert_eq!(touched, [(1.0, Enter), (1.0, Leave)]);
    let corner = hits(&wedge, at(1.0, 0.0, 2.0), at(0.0, 1.0, -1.0));
    assert_eq!(corner, [(1.0, Enter), (1.0, Leave)]);
    // A rim that touches an edge: the face has a cusp there, between both.
    let drum = Union(vec![
        block.clone(),
        cylinder(at(-1.0, 0.0, 0.0), at(-2.0, 0.0, 0.0), 1.0),
    ]);
    let found = faces(&drum, at(-1.0, -3.0, 0.0), DVec3::Y);
    assert_eq!(found, [(0, Part::XMin), (0, Part::YMin), (1, Part::Side)]);
    // A hole is touched from inside.
    let bored = Difference(vec![
        block,
        cylinder(at(0.0, 0.0, -1.0), at(0.0, 0.0, 1.0), 0.5),
    ]);
    let all = [(4.0, Enter), (5.0, Leave), (5.0, Enter), (6.0, Leave)];
    assert_eq!(hits(&bored, at(-5.0, 0.5, 0.0), DVec3::X), all);
}

#[test]
fn checkerboard_touches_itself_along_an_edge() {
    let two = Union(vec![
        block(at(-1.0, -1.0, -1.0), at(0.0, 0.0, 1.0)),
        block(at(0.0, 0.0, -1.0), at(1.0, 1.0, 1.0)),
    ]);
    // Along the common edge the line is in the boundary.
    assert_eq!(
        hits(&two, at(0.0, 0.0, -2.0), DVec3::Z),
        [(1.0, Enter), (3.0, Leave)]
    );
    assert_eq!(
        hits(&two, at(0.0, 0.0, 0.0), DVec3::Z),
        [(0.0, Enter), (1.0, Leave)]
    );
    // From one to the other through it.
    let through = hits(&two, at(-2.0, -2.0, 0.0), at(1.0, 1.0, 0.0));
    assert_eq!(
        through,
        [(1.0, Enter), (2.0, Leave), (2.0, Enter), (3.0, Leave)]
    );
    // Between both.
    let between = hits(&two, at(-2.0, 2.0, 0.0), at(1.0, -1.0, 0.0));
    assert_eq!(between, [(2.0, Enter), (2.0, Leave)]);
    assert_eq!(faces(&two, at(-2.0, 2.0, 0.0), at(1.0, -1.0, 0.0)).len(), 4);
}

#[test]
fn cones_at_their_apex() {
    let up = cone(DVec3::ZERO, DVec3::Z * 4.0, [0.0, 3.0]);
    let down = cone(DVec3::ZERO, DVec3::Z * -4.0, [0.0, 3.0]);
    let glass = Union(vec![up.clone(), down.clone()]);
    assert_eq!(locate(&glass, DVec3::ZERO), Boundary);
    assert_eq!(
        locate(&Intersection(vec![up.clone(), down]), DVec3::ZERO),
        Outside
    );
    let along = hits(&glass, at(0.0, 0.0, -5.0), DVec3::Z);
    assert_eq!(
        along,
        [(1.0, Enter), (5.0, Leave), (5.0, Enter), (9.0, Leave)]
    );
    let across = hits(&glass, at(-5.0, 0.0, 0.0), DVec3::X);
    assert_eq!(across, [(5.0, Enter), (5.0, Leave)]);
    assert_eq!(
        hits(&glass, DVec3::ZERO, at(3.0, 0.0, 4.0)),
        [(0.0, Enter), (1.0, Leave)]
    );
    // Two cones of 45 degrees touch along the ruling (1, -1, 0), and elsewhere both have a wall.
    let wide = [DVec3::X, -DVec3::Y].map(|axis| cone(DVec3::ZERO, axis, [0.0, 1.0]));
    let found = faces(
        &Union(wide.to_vec()),
        at(-5.0, 5.0, 0.0),
        at(1.0, -1.0, 0.0),
    );
    let apexes = [0, 1].map(|leaf| [(leaf, Part::Cap0), (leaf, Part::Side)]);
    assert_eq!(found, apexes.concat());
    // A narrower cone with the same apex taken away leaves a shell.
    let narrow = cone(DVec3::ZERO, DVec3::Z * 4.0, [0.0, 1.0]);
    let shell = Difference(vec![up.clone(), narrow]);
    assert_eq!(locate(&shell, DVec3::ZERO), Boundary);
    assert_eq!(
        hits(&shell, at(0.0, 0.0, -1.0), DVec3::Z),
        [(1.0, Enter), (1.0, Leave)]
    );
    let found = faces(&shell, at(-5.0, 0.0, 0.0), DVec3::X);
    let apex = [
        (0, Part::Cap0),
        (0, Part::Side),
        (1, Part::Cap0),
        (1, Part::Side),
    ];
    assert_eq!(found, apex);
    // A needle that is narrower than a direction in f64 is rounded.
    let (tip, thin) = (at(1e-7, -0.3, 2.5), power_of_two(-61));
    let needle = RoundedCone::new(DVec3::ZERO, tip, thin, 0.0).expect("a needle");
    assert_eq!(locate(&leaf(needle), tip), Boundary);
    let half_as_thin = cone(DVec3::ZERO, tip, [thin * 0.5, 0.0]);
    let shell = Difference(vec![cone(DVec3::ZERO, tip, [thin, 0.0]), half_as_thin]);
    assert_eq!(locate(&shell, tip), Boundary);
    // A box that has half of the cone, and whose face has its apex.
    let cut = Intersection(vec![up, block(at(0.0, -5.0, -5.0), at(5.0, 5.0, 5.0))]);
    assert_eq!(
        hits(&cut, at(0.0, 0.0, -1.0), DVec3::Z),
        [(1.0, Enter), (5.0, Leave)]
    );
    assert_eq!(locate(&cut, DVec3::ZERO), Boundary);
    let found = faces(&cut, at(0.0, 0.0, -1.0), DVec3::Z);
    let all = [(0, Part::Cap0), (0, Part::Side), (1, Part::XMin)];
    assert_eq!(found, all);
}

#[test]
fn wall_that_two_solids_share_is_inner_where_one_fills_the_other() {
    // A cone in two pieces: radii 3, 2, 1 at heights 0, 1, 2.
    let pieces = [
        cone(DVec3::ZERO, DVec3::Z, [3.0, 2.0]),
        cone(DVec3::Z, DVec3::Z * 2.0, [2.0, 1.0]),
    ];
    let both = Union(pieces.to_vec());
    assert_eq!(
        hits(&both, at(-5.0, 0.0, 1.0), DVec3::X),
        [(3.0, Enter), (7.0, Leave)]
    );
    // The ruling through (3, 0, 0) and (1, 0, 2).
    let ruling = hits(&both, at(4.0, 0.0, -1.0), at(-1.0, 0.0, 1.0));
    assert_eq!(ruling, [(1.0, Enter), (3.0, Leave)]);
    // What fills a bore leaves no wall.
    let plug = cylinder(DVec3::ZERO, DVec3::Z * 2.0, 0.5);
    let filled = Union(vec![
        Difference(vec![
            cylinder(DVec3::ZERO, DVec3::Z * 2.0, 1.0),
            plug.clone(),
        ]),
        plug,
    ]);
    assert_eq!(
        hits(&filled, at(-5.0, 0.0, 1.0), DVec3::X),
        [(4.0, Enter), (6.0, Leave)]
    );
    assert_eq!(hits(&filled, at(-5.0, 0.5, 2.0), DVec3::X).len(), 2);
    assert_eq!(locate(&filled, at(0.5, 0.0, 1.0)), Inside);
}

/// What the operations say of closed sets, with the boundary between outside and
/// inside: the answer before operations were regularised.
fn closed(composition: &Composition, point: DVec3) -> Location {
    let opposite = |location| match location {
        Outside => Inside,
        Boundary => Boundary,
        Inside => Outside,
    };
    let parts = |all: &[Composition]| -> Vec<Location> {
        all.iter().map(|one| closed(one, point)).collect()
    };
    let located = match composition {
        Composition::Solid(_) => return locate(composition, point),
        Union(all) => parts(all).into_iter().max(),
        Intersection(all) => parts(all).into_iter().min(),
        Difference(all) => {
            let located = parts(all).into_iter().enumerate();
            let located = located.map(|(i, one)| if i == 0 { one } else { opposite(one) });
            located.min()
        }
    };
    located.unwrap_or(Outside)
}

/// Closed sets keep films, which the oracle does not.
#[test]
fn closed_sets_differ_from_regularised_ones() {
    let half = half();
    for (point, is_wrong) in [
        (at(1.0, 2.0, 0.0), true),
        (at(2.0, 2.0, 0.0), true),
        (at(-1.0, 2.0, 0.0), false),
        (at(-1.0, 0.0, 0.0), false),
        (at(5.0, 2.0, 0.0), false),
    ] {
        let differs = closed(&half, point) != locate(&half, point);
        assert_eq!(differs, is_wrong, "{point}");
    }
}
