//! An order in which rays visit what their neighbours have just left in the caches.
//!
//! Rays that start near each other with similar directions visit the same nodes and solids. If
//! all rays of a group have similar directions, as to a sun, rays with nearby lines belong
//! together: they are sorted along a Morton curve in the plane across the direction. Others are
//! sorted along a Morton curve of their origins, and in each cell by the octant of their
//! direction. The number of cells is about that of rays, and rays of a cell keep their order.

use glam::DVec3;

use super::are_alike;
use crate::math::{Ray, morton_code_2, morton_code_3};

/// Fewer rays than this keep their order: they share the caches in any order.
const LEAST_RAYS: usize = 64;

/// The most rays that are sorted together. More gain less and less, and are farther apart in
/// the caller's memory.
const GREATEST_GROUP: usize = 1 << 15;

/// The most rays with similar directions that are sorted together: enough for packets full of
/// neighbours, and few enough for the nearest caches.
const GREATEST_ALIKE: usize = 1 << 10;

/// The bits of a coordinate across a direction. It trades a pass of sorting for cells that
/// distinguish the rays of neighbouring pixels in a whole picture.
const BITS_ACROSS: u32 = 12;

/// Rays that are sorted together.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    pub rays: &'a [Ray],
    /// Whether the rays are coherent: all directions are similar to the first.
    pub is_alike: bool,
}

/// Splits off the first rays, those that are best sorted together.
pub(super) fn split(rays: &[Ray]) -> (Group<'_>, &[Ray]) {
    let (alike, after) = rays.split_at(rays.len().min(GREATEST_ALIKE));
    if are_alike(alike) {
        let group = Group {
            rays: alike,
            is_alike: true,
        };
        return (group, after);
    }
    let (rays, after) = rays.split_at(rays.len().min(GREATEST_GROUP));
    let group = Group {
        rays,
        is_alike: false,
    };
    (group, after)
}

/// The numbers of the rays in the order in which they are traced; `None` to keep the given
/// order. If the scene fits the caches, only coherent rays are sorted, for packets.
pub(super) fn order(group: Group, fits_caches: bool) -> Option<Vec<u32>> {
    let rays = group.rays;
    if rays.len() < LEAST_RAYS {
        return None;
    }
    let (mut lower, mut upper) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for ray in rays {
        lower = lower.min(ray.origin);
        upper = upper.max(ray.origin);
    }
    let extent = (upper - lower).max_element();
    // Rays from one point are usually neighbours in a picture.
    if !(extent > 0.0 && extent.is_finite()) {
        return None;
    }
    let (keys, key_bits): (Vec<u32>, u32) = if group.is_alike {
        let plane = Plane::new(rays[0].direction, lower, extent);
        let key = |ray: &Ray| plane.key(ray.origin);
        (rays.iter().map(key).collect(), 2 * BITS_ACROSS)
    } else if fits_caches {
        return None;
    } else {
        let bits = rays.len().ilog2().div_ceil(3);
        let per_cell = f64::from(1_u32 << bits) / extent;
        let key = |ray: &Ray| {
            let cell = (ray.origin - lower) * per_cell;
            let code = morton_code_3(cell.to_array().map(|x| cell_number(x, bits)));
            (code << 3) as u32 | ray.direction.is_negative_bitmask()
        };
        (rays.iter().map(key).collect(), 3 * bits + 3)
    };
    Some(sorted_by(&keys, key_bits))
}

/// The plane across a direction.
struct Plane {
    across: [DVec3; 2],
    lower: DVec3,
    extent: f64,
}

impl Plane {
    fn new(direction: DVec3, lower: DVec3, extent: f64) -> Self {
        let (one, other) = direction.normalize().any_orthonormal_pair();
        Self {
            across: [one, other],
            lower,
            extent,
        }
    }

    /// The number of a point's cell along the curve. Seen along the direction, a point of a
    /// cube with sides of `extent` is within `√3 extent` of its corner.
    fn key(&self, point: DVec3) -> u32 {
        const REACH: f64 = 1.75;
        let per_cell = f64::from(1_u32 << BITS_ACROSS) / (2.0 * REACH * self.extent);
        let from_lower = point - self.lower;
        let cell = self.across.map(|across| {
            let place = from_lower.dot(across) + REACH * self.extent;
            cell_number(place * per_cell, BITS_ACROSS)
        });
        morton_code_2(cell) as u32
    }
}

/// The number of one of `2^bits` cells; NaN is in the first.
fn cell_number(x: f64, bits: u32) -> u32 {
    (x as u32).min((1 << bits) - 1)
}

/// The positions of the keys, sorted stably by key: a radix sort by bytes, which takes a few
/// operations per key.
fn sorted_by(keys: &[u32], key_bits: u32) -> Vec<u32> {
    let mut sorted: Vec<u32> = (0..keys.len() as u32).collect();
    let mut before = sorted.clone();
    for shift in (0..key_bits).step_by(8) {
        std::mem::swap(&mut sorted, &mut before);
        let digit = |position: u32| (keys[position as usize] >> shift & 0xFF) as usize;
        let mut next = [0; 257];
        for &position in &before {
            next[digit(position) + 1] += 1;
        }
        for value in 1..256 {
            next[value] += next[value - 1];
        }
        for &position in &before {
            let place: &mut usize = &mut next[digit(position)];
            sorted[*place] = position;
            *place += 1;
        }
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    fn rays(count: u64, direction: impl Fn(&mut Random) -> DVec3) -> Vec<Ray> {
        let ray = |number| {
            let mut random = Random::new(3, number);
            let origin = DVec3::new(random.unit(), random.unit(), random.unit());
            Ray::new(origin, direction(&mut random))
        };
        (0..count).map(ray).collect()
    }

    /// The order of the rays as one group.
    fn order_of(rays: &[Ray], fits_caches: bool) -> Option<Vec<u32>> {
        let is_alike = are_alike(rays);
        order(Group { rays, is_alike }, fits_caches)
    }

    /// The mean distance of neighbours, seen along `direction`.
    fn mean_distance(rays: impl Iterator<Item = Ray> + Clone, direction: DVec3) -> f64 {
        let pairs = rays.clone().zip(rays.skip(1));
        let distances: Vec<f64> = pairs
            .map(|(one, other)| {
                let between = one.origin - other.origin;
                (between - direction * between.dot(direction)).length()
            })
            .collect();
        distances.iter().sum::<f64>() / distances.len() as f64
    }

    #[test]
    fn every_ray_is_there_once_and_neighbours_are_near() {
        let down = DVec3::NEG_Z;
        for (count, along, gain) in [(64, down, 2.0), (1000, down, 8.0), (32768, down, 40.0)] {
            let rays = rays(count, |_| along);
            let order = order_of(&rays, false).unwrap();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..count as u32));
            let before = mean_distance(rays.iter().copied(), along);
            let after = mean_distance(order.iter().map(|&ray| rays[ray as usize]), along);
            assert!(after * gain < before, "{count}: {before} to {after}");
        }
        let rays = rays(32768, |random| random.direction());
        let order = order_of(&rays, false).unwrap();
        let before = mean_distance(rays.iter().copied(), DVec3::ZERO);
        let after = mean_distance(order.iter().map(|&ray| rays[ray as usize]), DVec3::ZERO);
        assert!(after * 8.0 < before, "{before} to {after}");
        assert_eq!(order_of(&rays, true), None);
    }

    #[test]
    fn rays_of_one_point_and_of_nowhere_stay_as_they_are() {
        let mut all = rays(100, |_| DVec3::X);
        all[7].origin.x = f64::INFINITY;
        assert_eq!(order_of(&all, false), None);
        all.iter_mut().for_each(|ray| ray.origin = DVec3::ONE);
        assert_eq!(order_of(&all, false), None);
        all[7].origin.x = f64::NAN;
        assert_eq!(order_of(&all, false), None);
    }
}
