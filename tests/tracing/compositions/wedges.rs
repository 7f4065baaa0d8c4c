//! Wedges between faces that are nearly parallel, at stated points.
//!
//! All solids have the origin on their surface, and what is next to it of each is the half space
//! that its name states, within third order of the distance. The angles are powers of two from
//! 2^-20 to 2^-200, far below what f64 resolves in a unit vector.

use cyltrace::math::{Orientation, Random, power_of_two};
use cyltrace::solid::{AnySolid, Caps, Composition, Cone, Location, RoundedCone};
use cyltrace_oracle::ComposedTruth;
use glam::DVec3;

use super::random::cases;
use super::{at, cuboid, cylinder, sphere, turned_cuboid};
use Composition::{Difference, Intersection, Union};
use Location::{Boundary, Inside, Outside};
use test_support::trees::draw_tree;

fn cone(p0: DVec3, p1: DVec3, [r0, r1]: [f64; 2]) -> Composition {
    let cone = Cone::new(p0, p1, r0, r1, Caps::Both).expect("a cone");
    Composition::Solid(cone.into())
}

fn rounded_cone(p0: DVec3, p1: DVec3, [r0, r1]: [f64; 2]) -> Composition {
    let cone = RoundedCone::new(p0, p1, r0, r1).expect("a rounded cone");
    Composition::Solid(cone.into())
}

/// Flat solids that are `v·n > 0` next to the origin, for any `n`.
fn flat(n: DVec3) -> [Composition; 4] {
    let aside = at(0.0, 0.0, 0.0);
    [
        cylinder(aside, n, 1.0),
        cylinder(n * 4.0, aside, 2.0),
        cone(aside, n * 0.5, [1.0, 3.0]),
        cone(n, aside, [0.0, 2.0]),
    ]
}

/// Solids that are `x > 0` next to the origin, or less by a bend.
fn x_above() -> Vec<Composition> {
    let mut solids = flat(DVec3::X).to_vec();
    solids.extend([
        cuboid(at(3.0, 0.0, 0.0), at(3.0, 1.0, 2.0)),
        sphere(at(2.0, 0.0, 0.0), 2.0),
        cylinder(at(1.0, 0.0, -1.0), at(1.0, 0.0, 2.0), 1.0),
        // The radius is 5 where the wall passes the origin, and the axis tilts as the wall.
        cylinder(at(5.0, -1.0, -1.0), at(5.0, 2.0, 2.0), 5.0),
        rounded_cone(at(3.0, 0.0, -1.0), at(3.0, 0.0, 1.0), [3.0, 3.0]),
        rounded_cone(at(3.0, 0.0, 0.0), at(3.0, 0.0, 4.0), [3.0, 3.0]),
    ]);
    solids
}

/// Flat solids that are `x + e y > 0` next to the origin, with the angle `e` about.
fn tilted(e: f64) -> Vec<Composition> {
    let mut solids = flat(at(1.0, e, 0.0)).to_vec();
    let turn = Orientation::IDENTITY.rotated_z(e.to_degrees());
    let normal = turn.world_from_object().x_axis;
    assert!(normal.y > 0.0 && normal.z == 0.0);
    let half_widths = at(normal.x, 1.0, 1.0);
    solids.push(turned_cuboid(at(1.0, 0.0, 0.0), half_widths, turn));
    solids
}

/// Flat solids that are `y > 0`, or `y < 0`.
fn y_beyond(sign: f64) -> Vec<Composition> {
    let mut solids = flat(at(0.0, sign, 0.0)).to_vec();
    solids.push(cuboid(at(0.0, 2.0 * sign, 0.0), at(3.0, 2.0, 1.0)));
    solids
}

fn assert_at_origin(set: &Composition, expected: Location) {
    assert_eq!(set.locate(DVec3::ZERO), expected, "{set:?}");
    let truth = ComposedTruth::new(set).locate(DVec3::ZERO);
    assert_eq!(truth, expected, "the oracle: {set:?}");
}

/// An input of the fuzzer: next to the origin this is `a·x > 0`, `b·x <= 0`, a wedge.
#[test]
fn axes_that_differ_by_less_than_f64_resolves_leave_a_wedge() {
    let origin = DVec3::ZERO;
    let tilted = at(2.592726849313141, 9.107298248878237e-18, 0.0);
    let [a, b] = [tilted, DVec3::X].map(|axis| cylinder(origin, axis, 1.0));
    let rest = Difference(vec![Union(vec![a, b.clone()]), b.clone()]);
    assert_at_origin(&rest, Boundary);
    assert_at_origin(&Difference(vec![rest, b]), Boundary);
}

/// What is above one plane and not above another is the wedge `x > 0`, `x + e y <= 0`, which
/// is all in `y < 0`; what a solid with a bend has of it too.
#[test]
fn wedge_is_there_until_it_is_cut_away() {
    for exponent in (20..=200).step_by(15) {
        let e = power_of_two(-exponent);
        for above in x_above() {
            for tilted in tilted(e) {
                let wedge = Difference(vec![above.clone(), tilted.clone()]);
                let other = Difference(vec![tilted, above.clone()]);
                assert_eq!(wedge.locate(DVec3::ZERO), Boundary, "{wedge:?}");
                assert_eq!(other.locate(DVec3::ZERO), Boundary, "{other:?}");
                for (sign, is_cut) in [(1.0, false), (-1.0, true)] {
                    let expected = if is_cut { Outside } else { Boundary };
                    for cut in y_beyond(sign) {
                        let rest = Difference(vec![wedge.clone(), cut.clone()]);
                        assert_eq!(rest.locate(DVec3::ZERO), expected, "{rest:?}");
                    }
                    let expected = if is_cut { Boundary } else { Outside };
                    for common in y_beyond(sign) {
                        let rest = Intersection(vec![common, wedge.clone()]);
                        assert_eq!(rest.locate(DVec3::ZERO), expected, "{rest:?}");
                    }
                }
            }
        }
    }
}

/// `x < 0` and `x + e y > 0` leave a wedge in `y < 0`, which another solid fills or not.
#[test]
fn gap_is_there_until_it_is_filled() {
    for exponent in (20..=200).step_by(15) {
        for below in flat(DVec3::NEG_X) {
            for tilted in tilted(power_of_two(-exponent)) {
                let both = Union(vec![below.clone(), tilted]);
                assert_eq!(both.locate(DVec3::ZERO), Boundary, "{both:?}");
                for (sign, expected) in [(1.0, Boundary), (-1.0, Inside)] {
                    for third in y_beyond(sign) {
                        let all = Union(vec![both.clone(), third]);
                        assert_eq!(all.locate(DVec3::ZERO), expected, "{all:?}");
                    }
                }
            }
        }
    }
}

/// A vector of 0, 1 and -1 that is not zero.
fn draw_signs(random: &mut Random) -> DVec3 {
    loop {
        let mut one = || random.below(3) as f64 - 1.0;
        let signs = at(one(), one(), one());
        if signs != DVec3::ZERO {
            return signs;
        }
    }
}

/// A solid with the origin on its surface. Normals are of whole numbers, and those of its
/// disks are tilted by multiples of `e`.
fn draw_through_origin(random: &mut Random, e: f64) -> AnySolid {
    let shift = random.below(3);
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let placed = |x: f64, y: f64, z: f64| {
        let [x, y, z] = [x, y, z].map(|number| number * sign);
        match shift {
            0 => at(x, y, z),
            1 => at(y, z, x),
            _ => at(z, x, y),
        }
    };
    let tilt = e * (random.below(3) as f64 - 1.0);
    let drawn = match random.below(8) {
        0 | 1 => {
            let axis = draw_signs(random) + draw_signs(random) * e;
            flat(axis)[random.below(4) as usize].clone()
        }
        2 => cuboid(draw_signs(random), DVec3::ONE),
        // The rim of a disk.
        3 => cylinder(placed(0.0, 0.0, 1.0), placed(1.0, tilt, 1.0), 1.0),
        4 => sphere(placed(2.0, 0.0, 0.0), 2.0),
        5 => cylinder(placed(1.0, 0.0, -1.0), placed(1.0, 0.0, 2.0), 1.0),
        6 => cone(placed(2.0, 0.0, -1.0), placed(2.0, 0.0, 1.0), [1.0, 3.0]),
        _ => rounded_cone(placed(3.0, 0.0, 0.0), placed(3.0, 0.0, 4.0), [3.0, 3.0]),
    };
    drawn.solids()[0]
}

/// Every cell that the oracle reports exists; it misses some cusps along common tangents that
/// are thinner than f64 resolves. So where it found both sides, the answer is known.
#[test]
fn what_the_oracle_finds_in_random_wedges_is_found() {
    let mut judged = 0;
    for index in 0..cases() / 50 {
        let mut random = Random::new(83, index);
        let e = power_of_two(-20 - 5 * random.below(37) as i32);
        let set = draw_tree(&mut random, 3, &mut |random| draw_through_origin(random, e));
        if ComposedTruth::new(&set).locate(DVec3::ZERO) == Boundary {
            judged += 1;
            assert_eq!(set.locate(DVec3::ZERO), Boundary, "{index}: {set:?}");
        }
    }
    println!("{judged} of {} on the boundary", cases() / 50);
    assert!(judged > cases() / 100);
}

/// `c0 + c1 e + c2 e² + c3 e³` for an `e` of at most 2^-20, far above which the whole
/// coefficients stay.
type Polynomial = [i64; 4];

fn product(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut product = [0; 4];
    for i in 0..4 {
        for j in 0..4 {
            match a[i] * b[j] {
                0 => {}
                term => product[i + j] += term,
            }
        }
    }
    product
}

fn difference(a: &Polynomial, b: &Polynomial) -> Polynomial {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The sign: that of the first coefficient that is not zero.
fn sign(a: &Polynomial) -> i64 {
    assert!(a.iter().all(|c| c.abs() < 1 << 18), "{a:?}");
    a.iter().find(|c| **c != 0).map_or(0, |c| c.signum())
}

type Vector = [Polynomial; 3];

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)]
        .map(|(i, j)| difference(&product(&a[i], &b[j]), &product(&a[j], &b[i])))
}

fn dot(a: &Vector, b: &Vector) -> Polynomial {
    let terms = [0, 1, 2].map(|i| product(&a[i], &b[i]));
    std::array::from_fn(|i| terms.iter().map(|term| term[i]).sum())
}

/// A flat solid with the origin on its surface, and the normals of the half spaces `v·n > 0`
/// that it is there.
fn draw_flat(random: &mut Random, e: f64) -> (AnySolid, Vec<Vector>) {
    let signs = draw_signs(random);
    let whole = |x: f64, tilt: f64| [x as i64, tilt as i64, 0, 0];
    if random.below(4) == 0 {
        let solid = cuboid(signs, DVec3::ONE).solids()[0];
        let normals = (0..3).filter(|&i| signs[i] != 0.0).map(|i| {
            let axis = DVec3::AXES[i] * signs[i];
            axis.to_array().map(|x| whole(x, 0.0))
        });
        return (solid, normals.collect());
    }
    // Tilted where it is zero, so that nothing is rounded.
    let mut tilt = draw_signs(random);
    for i in 0..3 {
        if signs[i] != 0.0 {
            tilt[i] = 0.0;
        }
    }
    let normal = std::array::from_fn(|i| whole(signs[i], tilt[i]));
    let solid = &flat(signs + tilt * e)[random.below(4) as usize];
    (solid.solids()[0], vec![normal])
}

/// The formula at a direction, for which `leaves` states whether each leaf contains it.
fn formula(set: &Composition, leaves: &mut impl Iterator<Item = bool>) -> bool {
    let mut of = |parts: &[Composition]| -> Vec<bool> {
        parts
            .iter()
            .map(|part| formula(part, &mut *leaves))
            .collect()
    };
    match set {
        Union(parts) => of(parts).contains(&true),
        Intersection(parts) => !of(parts).contains(&false),
        Difference(parts) => {
            let values = of(parts);
            values[0] && !values[1..].contains(&true)
        }
        Composition::Solid(_) => leaves.next().expect("a leaf"),
    }
}

/// Planes through the origin, those of the coordinates among them, divide space into cones with
/// corners. Three rays of a cone's edges have their sum within it, and all such rays are
/// cross products of two normals. So the sums of all triples of those find each cell.
fn locate_flat(set: &Composition, leaves: &[Vec<Vector>]) -> Location {
    let mut planes: Vec<Vector> = (0..3)
        .map(|i| std::array::from_fn(|j| [i64::from(i == j), 0, 0, 0]))
        .collect();
    for plane in leaves.iter().flatten() {
        if !planes.contains(plane) {
            planes.push(*plane);
        }
    }
    let mut rays: Vec<Vector> = Vec::new();
    for (index, one) in planes.iter().enumerate() {
        for other in &planes[..index] {
            rays.extend([cross(one, other), cross(other, one)]);
        }
    }
    // Of each ray, its product with every plane.
    let heights: Vec<Vec<Polynomial>> = (rays.iter())
        .map(|ray| planes.iter().map(|plane| dot(ray, plane)).collect())
        .collect();
    let position = |plane: &Vector| planes.iter().position(|one| one == plane).unwrap();
    let leaves: Vec<Vec<usize>> = (leaves.iter())
        .map(|leaf| leaf.iter().map(position).collect())
        .collect();
    let mut found = [false; 2];
    for i in 0..rays.len() {
        for j in 0..i {
            for k in 0..j {
                let at = |plane: usize| -> i64 {
                    let sum =
                        |c| heights[i][plane][c] + heights[j][plane][c] + heights[k][plane][c];
                    sign(&std::array::from_fn(sum))
                };
                if (0..planes.len()).any(|plane| at(plane) == 0) {
                    continue;
                }
                let mut within = leaves
                    .iter()
                    .map(|leaf| leaf.iter().all(|&one| at(one) > 0));
                found[usize::from(formula(set, &mut within))] = true;
            }
        }
    }
    match found {
        [true, true] => Boundary,
        [false, _] => Inside,
        [true, false] => Outside,
    }
}

#[test]
fn random_arrangements_of_planes_are_decided_exactly() {
    let mut found = std::collections::HashMap::new();
    for index in 0..cases() / 20 {
        let mut random = Random::new(89, index);
        let e = power_of_two(-20 - 5 * random.below(37) as i32);
        let mut leaves = Vec::new();
        let set = loop {
            leaves.clear();
            let set = draw_tree(&mut random, 3, &mut |random| {
                let (solid, normals) = draw_flat(random, e);
                leaves.push(normals);
                solid
            });
            if (2..=7).contains(&leaves.len()) {
                break set;
            }
        };
        let expected = locate_flat(&set, &leaves);
        assert_eq!(set.locate(DVec3::ZERO), expected, "{index}: {set:?}");
        *found.entry(format!("{expected:?}")).or_insert(0) += 1;
    }
    println!("{found:?}");
    assert!(found.len() == 3, "{found:?}");
}
