//! An order of boxes whose runs of a given length are compact.
//!
//! A block is one primitive to Embree, and a ray that intersects the block's box is tested
//! against all of its solids: the surface of the boxes determines the cost. The boxes are split
//! in two recursively, each time where the surface area heuristic is least,
//!
//! ```text
//! cost = area(left) · blocks(left) + area(right) · blocks(right)
//! ```
//!
//! among the borders of [`BINS`] bins of the centers along each axis (Wald, "On fast
//! construction of SAH-based bounding volume hierarchies", 2007). The split is then moved to
//! the next multiple of the block's size, so that blocks are full, since they are to save
//! memory. Only the last block may contain fewer.

use crate::embree::Box32;

/// Bins along an axis. More bins find better splits and take longer; beyond 16 the gain is not
/// measurable.
const BINS: usize = 16;

/// Fewer boxes than this are split on one thread: starting another takes about as long as
/// sorting them.
const LEAST_FOR_THREADS: usize = 1 << 14;

/// A box and its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub bounds: Box32,
    pub number: u32,
}

impl Item {
    /// Twice the center along an axis.
    #[inline]
    fn middle(&self, axis: usize) -> f32 {
        self.bounds.lower[axis] + self.bounds.upper[axis]
    }
}

/// Reorders the items so that `items.chunks(size)` are the blocks, on up to
/// `threads` threads. The order depends on the items alone.
pub(super) fn cluster(items: &mut [Item], size: usize, threads: usize) {
    if items.len() <= size {
        return;
    }
    let split = split(items, size);
    items.select_nth_unstable_by(split.left, |one, other| {
        let places = one.middle(split.axis).total_cmp(&other.middle(split.axis));
        places.then(one.number.cmp(&other.number))
    });
    let (left, right) = items.split_at_mut(split.left);
    if threads > 1 && left.len() + right.len() >= LEAST_FOR_THREADS {
        // Not on a rayon pool: a worker that builds a prototype during a query would take up
        // other work there, which may wait for this same build.
        std::thread::scope(|scope| {
            scope.spawn(|| cluster(left, size, threads / 2));
            cluster(right, size, threads - threads / 2);
        });
    } else {
        cluster(left, size, 1);
        cluster(right, size, 1);
    }
}

/// A split: the axis, and the number of items on the left.
#[derive(Clone, Copy, Debug)]
struct Split {
    axis: usize,
    left: usize,
}

/// The boxes whose centers are in a bin.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box32,
    count: usize,
}

const EMPTY: Bin = Bin {
    bounds: Box32::EMPTY,
    count: 0,
};

impl Bin {
    fn with(&self, other: &Self) -> Self {
        Self {
            bounds: self.bounds.union(&other.bounds),
            count: self.count + other.count,
        }
    }

    fn cost(&self, size: usize) -> f32 {
        half_area(&self.bounds) * self.count.div_ceil(size) as f32
    }
}

/// The best split of more items than one block contains; in the middle if all splits are equal.
fn split(items: &[Item], size: usize) -> Split {
    let mut best = (f32::INFINITY, 0, items.len() / 2);
    for axis in 0..3 {
        let middles = items.iter().map(|item| item.middle(axis));
        let (least, greatest) = middles
            .fold((f32::INFINITY, f32::NEG_INFINITY), |range, middle| {
                (range.0.min(middle), range.1.max(middle))
            });
        let rate = BINS as f32 / (greatest - least);
        if !rate.is_finite() {
            continue;
        }
        let mut bins = [EMPTY; BINS];
        for item in items {
            let place = ((item.middle(axis) - least) * rate) as usize;
            let bin = &mut bins[place.min(BINS - 1)];
            bin.bounds = bin.bounds.union(&item.bounds);
            bin.count += 1;
        }
        // The union to the right of each border, from the right; then the costs from the left.
        let mut right = [EMPTY; BINS];
        for border in (1..BINS).rev() {
            let further = right.get(border + 1).copied().unwrap_or(EMPTY);
            right[border] = bins[border].with(&further);
        }
        let mut left = EMPTY;
        for border in 1..BINS {
            left = left.with(&bins[border - 1]);
            if left.count == 0 || right[border].count == 0 {
                continue;
            }
            let cost = left.cost(size) + right[border].cost(size);
            if cost < best.0 {
                best = (cost, axis, left.count);
            }
        }
    }
    let (_, axis, wanted) = best;
    let blocks = items.len().div_ceil(size);
    let left = (wanted + size / 2) / size;
    Split {
        axis,
        left: left.clamp(1, blocks - 1) * size,
    }
}

fn half_area(bounds: &Box32) -> f32 {
    let [x, y, z] = std::array::from_fn(|axis| bounds.upper[axis] - bounds.lower[axis]);
    x * y + y * z + z * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    const SEED: u64 = 51;

    fn items(count: u32) -> Vec<Item> {
        let mut random = Random::new(SEED, u64::from(count));
        (0..count)
            .map(|number| {
                let lower: [f32; 3] = std::array::from_fn(|_| random.unit() as f32);
                Item {
                    bounds: Box32 {
                        lower,
                        upper: lower.map(|x| x + 0.001),
                    },
                    number,
                }
            })
            .collect()
    }

    fn area_of_blocks(items: &[Item], size: usize) -> f32 {
        items
            .chunks(size)
            .map(|block| {
                let boxes = block.iter().map(|item| item.bounds);
                half_area(&boxes.fold(Box32::EMPTY, |sum, one| sum.union(&one)))
            })
            .sum()
    }

    #[test]
    fn every_item_stays_and_blocks_are_near_together() {
        for count in [1, 7, 8, 9, 63, 1_000, 20_001] {
            let given = items(count);
            let mut ordered = given.clone();
            cluster(&mut ordered, 8, 2);
            let mut numbers: Vec<u32> = ordered.iter().map(|item| item.number).collect();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..count), "{count} items");
            if count >= 1_000 {
                let (before, after) = (area_of_blocks(&given, 8), area_of_blocks(&ordered, 8));
                // Random boxes in the cube, compared with cells of 8/count of its volume.
                let side = libm::cbrtf(8.0 / count as f32);
                let cell = 3.0 * side * side;
                let ideal = cell * (count as f32 / 8.0);
                assert!(
                    after < 2.0 * ideal && after < 0.2 * before,
                    "{count} items: {before} to {after}, cells have {ideal}"
                );
            }
        }
    }

    #[test]
    fn order_does_not_depend_on_threads() {
        let given = items(40_000);
        let numbers = |threads| {
            let mut items = given.clone();
            cluster(&mut items, 8, threads);
            items
                .into_iter()
                .map(|item| item.number)
                .collect::<Vec<_>>()
        };
        assert_eq!(numbers(1), numbers(2));
        assert_eq!(numbers(1), numbers(5));
    }

    #[test]
    fn coinciding_boxes_are_split_all_the_same() {
        let mut items = vec![items(1)[0]; 100];
        cluster(&mut items, 8, 1);
        assert_eq!(items.len(), 100);
    }
}
