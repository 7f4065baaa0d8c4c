//! Random compositions, and exact membership in them.

use cyltrace::math::{Orientation, Random};
use cyltrace::solid::{AnySolid, Caps, Composition, Cone, Cuboid, Cylinder, RoundedCone, Sphere};
use cyltrace_oracle::truth;
use glam::DVec3;

/// A seeded number that is a multiple of 1/4 if `is_coarse`.
fn number(random: &mut Random, low: f64, high: f64, is_coarse: bool) -> f64 {
    let number = random.uniform(low, high);
    if is_coarse {
        (number * 4.0).round() / 4.0
    } else {
        number
    }
}

/// A solid near the origin, turned if there is a turn. Coarse ones often share faces,
/// walls and axes.
pub fn draw_solid(random: &mut Random, is_coarse: bool, turn: Orientation) -> AnySolid {
    let vector = |random: &mut Random| {
        let mut one = || number(random, -1.5, 1.5, is_coarse);
        DVec3::new(one(), one(), one())
    };
    let size = |random: &mut Random| number(random, 0.3, 1.5, is_coarse).max(0.25);
    let center = turn.to_world(vector(random));
    let axis = if is_coarse {
        DVec3::AXES[random.below(3) as usize] * size(random)
    } else {
        random.direction() * size(random)
    };
    let ends = (center - turn.to_world(axis), center + turn.to_world(axis));
    let (radius0, radius1) = (size(random), size(random));
    match random.below(5) {
        0 => Cylinder::new(ends.0, ends.1, radius0, Caps::Both)
            .expect("a cylinder")
            .into(),
        1 => Cone::new(ends.0, ends.1, radius0, radius1, Caps::Both)
            .expect("a cone")
            .into(),
        2 => RoundedCone::new(ends.0, ends.1, radius0, radius1)
            .expect("a hull")
            .into(),
        3 => Sphere::new(center, radius0).expect("a sphere").into(),
        _ => {
            let half_widths = DVec3::new(radius0, radius1, size(random));
            Cuboid::new(center, half_widths, turn)
                .expect("a cuboid")
                .into()
        }
    }
}

/// A tree of operations, at most so deep.
pub fn draw_tree(
    random: &mut Random,
    depth: u32,
    draw: &mut impl FnMut(&mut Random) -> AnySolid,
) -> Composition {
    if depth == 0 || random.below(4) == 0 {
        return Composition::Solid(draw(random));
    }
    let count = 1 + random.below(3);
    let parts = (0..count)
        .map(|_| draw_tree(random, depth - 1, draw))
        .collect();
    match random.below(3) {
        0 => Composition::Union(parts),
        1 => Composition::Intersection(parts),
        _ => Composition::Difference(parts),
    }
}

/// Exact membership of a point that is on no leaf's boundary.
pub fn holds(composition: &Composition, point: DVec3) -> bool {
    match composition {
        Composition::Solid(solid) => truth(solid).truly_contains(point),
        Composition::Union(parts) => parts.iter().any(|part| holds(part, point)),
        Composition::Intersection(parts) => parts.iter().all(|part| holds(part, point)),
        Composition::Difference(parts) => {
            holds(&parts[0], point) && !parts[1..].iter().any(|part| holds(part, point))
        }
    }
}
