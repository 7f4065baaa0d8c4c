//! The orders in which rivals get their rays: as they are, and as this library's batches
//! trace them.
//!
//! A rival may gain from the second order as much as this library does, so each is timed
//! with both and the faster one counts. Sorting is not part of a rival's time; it is part
//! of this library's.

use super::interleave::PIECE;
use super::rays::Rays;
use cyltrace::tracer::Tracer;

/// An order of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Order {
    /// As the rays were drawn.
    Given,
    /// As this library's batches trace them.
    Sorted,
}

impl Order {
    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The rays in the order in which batches of `tracer` trace them, one batch a
/// [`PIECE`]. `None` where they are in this order already.
pub fn sorted(rays: &Rays, tracer: &Tracer) -> Option<Rays> {
    let mut wide = Vec::with_capacity(rays.wide.len());
    for batch in rays.wide.chunks(PIECE) {
        let order = tracer.batch_order(batch);
        wide.extend(order.into_iter().map(|position| batch[position as usize]));
    }
    (wide != rays.wide).then(|| Rays::new(rays.kind, wide))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::flat::Flat;
    use super::super::random_scene::sticks;
    use super::super::rays::Kind;
    use super::*;
    use cyltrace::tracer::Options;

    /// The rays' numbers as bits, in an order that depends on nothing else.
    fn bits(rays: &[cyltrace::math::Ray]) -> Vec<[u64; 6]> {
        let numbers = |ray: &cyltrace::math::Ray| {
            let [o, d] = [ray.origin, ray.direction].map(|vector| vector.to_array());
            [o[0], o[1], o[2], d[0], d[1], d[2]].map(f64::to_bits)
        };
        let mut all: Vec<[u64; 6]> = rays.iter().map(numbers).collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn sorted_rays_are_the_same_rays_within_each_piece_and_nearer_their_neighbours() {
        const COUNT: usize = PIECE + 3000;
        // More than fit the caches, so that incoherent rays are sorted too.
        let scene = Arc::new(sticks(100_000, 9));
        let tracer = Tracer::new(Arc::clone(&scene), &Options::default()).unwrap();
        for rays in Rays::of_scene(&Flat::new(scene), &tracer, COUNT, 9) {
            let Some(found) = sorted(&rays, &tracer) else {
                // The camera's rays start at one point.
                assert_eq!(rays.kind, Kind::Coherent);
                continue;
            };
            assert_eq!(found.kind, rays.kind);
            for (found, given) in found.wide.chunks(PIECE).zip(rays.wide.chunks(PIECE)) {
                assert_eq!(bits(found), bits(given), "{}", rays.kind.name());
            }
            let steps = |rays: &Rays| -> f64 {
                let pairs = rays.wide.windows(2);
                pairs
                    .map(|pair| (pair[1].origin - pair[0].origin).length())
                    .sum()
            };
            let (near, far) = (steps(&found), steps(&rays));
            let expected = match rays.kind {
                Kind::Incoherent => 0.2 * far,
                _ => far,
            };
            assert!(near < expected, "{}: {near} of {far}", rays.kind.name());
        }
    }
}
