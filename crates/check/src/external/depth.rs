//! The depth of a point in a composition.
//!
//! It is the greatest or the least of the depths in its leaves (`solids`), with the
//! other sign for subtracted ones. That changes no faster than the point moves,
//! and its sign is right: so its size is no more than the distance from the surface.

use glam::DVec3;

use crate::solids::shape;
use cyltrace::solid::Composition;

/// No more than the depth of a point in a composition, and no more in size, with its
/// sign.
pub(super) fn depth_in_composed(solid: &Composition, point: DVec3) -> f64 {
    let depths = |parts: &[Composition]| -> Vec<f64> {
        let parts = parts.iter();
        parts.map(|part| depth_in_composed(part, point)).collect()
    };
    let nowhere = f64::NEG_INFINITY;
    match solid {
        Composition::Solid(solid) => shape(solid).get().depth(point),
        Composition::Union(parts) => depths(parts).into_iter().fold(nowhere, f64::max),
        Composition::Intersection(parts) => depths(parts)
            .into_iter()
            .reduce(f64::min)
            .unwrap_or(nowhere),
        Composition::Difference(parts) => {
            let operands = depths(parts).into_iter().enumerate();
            let operands = operands.map(|(number, depth)| if number == 0 { depth } else { -depth });
            operands.reduce(f64::min).unwrap_or(nowhere)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Random;
    use cyltrace::solid::{Location, Sphere};

    /// Within the depth of a point all points are on the same side.
    #[test]
    fn depth_in_composed_solids_is_room_on_one_side() {
        const SEED: u64 = 45;
        let mut sides = [0, 0];
        for case in 0..2_000 {
            let mut random = Random::new(SEED, case);
            let mut ball = || {
                let center = random.direction() * random.unit();
                let sphere = Sphere::new(center, random.uniform(0.3, 1.0)).unwrap();
                Composition::Solid(sphere.into())
            };
            let both = vec![ball(), ball()];
            let both = match case % 3 {
                0 => Composition::Union(both),
                1 => Composition::Intersection(both),
                _ => Composition::Difference(both),
            };
            let solid = match case % 5 {
                0 => Composition::Difference(vec![ball(), both]),
                1 => Composition::Intersection(vec![both, ball()]),
                _ => Composition::Union(vec![both, ball()]),
            };
            let point = random.direction() * random.uniform(0.0, 2.0);
            let found = depth_in_composed(&solid, point);
            let side = if found > 0.0 {
                Location::Inside
            } else {
                Location::Outside
            };
            sides[usize::from(found > 0.0)] += 1;
            for _ in 0..20 {
                let other = point + random.direction() * (found.abs() * random.uniform(0.0, 0.999));
                let what = format!("seed {SEED}, case {case}: {solid:?} {point:?} {other:?}");
                assert_eq!(solid.locate(other), side, "{what}");
            }
        }
        assert!(sides.into_iter().all(|side| side > 400), "{sides:?}");
    }
}
