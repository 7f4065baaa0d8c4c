//! Decides when the solids of a prototype get more than one frame.
//!
//! Boxes grow by g = 2^-19 R, R the radius of their frame ([`BOX_GROWTH`]). One solid that is
//! very far from the others, or very large, makes R and so g large for all of them. If g is no
//! longer small compared with solids that are close together, a ray through them intersects
//! most of their boxes.
//!
//! **Cost.** A line through a convex region of half surface area A intersects a convex box in
//! it, of half area a, with the probability a/A (Crofton). So the number of callbacks of a ray
//! through a cube of side 2h with n boxes in it is
//!
//! ```text
//! callbacks(g) = sum over the boxes of min(1, a(g) / 12 h²)
//! ```
//!
//! where a(g) is the half area of a box grown by g. With a frame of their own the n solids have
//! `g' = 2^-19 √3 h`. The probability that a ray passes through the cube is that of its target
//! being one of the n among all N, hence
//!
//! ```text
//! gain = n/N (callbacks(g) - callbacks(g'))
//! ```
//!
//! Another frame costs each ray that enters the prototype about as much as a callback: the ray
//! is tested against the sphere of the frame, and mostly misses. So the solids in the cube
//! become a group of their own if the gain is at least [`LEAST_GAIN`] and their frame is at
//! least [`LEAST_RATIO`] times smaller.
//!
//! **Search.** The areas come from a sample of [`SAMPLE`] boxes at equal strides. Cubes around
//! the centers of some of them are tried, and the best one is doubled until the next octave is
//! empty. Then nothing is left out that belongs to it: everything else is more than twice as
//! far away as the rest. The remainder is treated in the same way. If g adds less than a
//! quarter to the boxes of the sample, as in nearly all prototypes, that ends the search.
//!
//! The groups depend on the boxes alone, not on threads. Results of queries do not depend on
//! the groups.

use glam::DVec3;
use rayon::prelude::*;

use crate::math::{Bounds, power_of_two};
use crate::tracer::frame::BOX_GROWTH;

/// The least number of callbacks that another frame saves a ray.
const LEAST_GAIN: f64 = 1.0;

/// The least ratio of the frames' sizes. Below it, a growth of 2^-19 R is 2^-15 of the group:
/// only hundreds of millions of solids are so close together.
const LEAST_RATIO: f64 = 16.0;

/// The size of the sample. More boxes find groups that are a smaller share of all, and take
/// longer: the square of their number, in prototypes that need groups.
const SAMPLE: usize = 256;

/// The greatest number of cubes that are tried.
const CENTERS: usize = 32;

/// The least share of a sample that makes a group: a few boxes that are close by chance would
/// represent thousands.
const LEAST_SHARE: f64 = 1.0 / 32.0;

/// The octaves around a cube that one pass over the boxes examines.
const OCTAVES: u32 = 64;

/// Growth matters for a box whose area it multiplies by more than this.
const NOTABLE: f64 = 1.25;

/// The greatest number of groups of a prototype. Each takes a leaf in the tree of every
/// prototype that places it.
pub(super) const MOST_GROUPS: usize = 8;

/// A collection of boxes; the box of an empty solid is empty.
pub(super) trait Boxed: Sync {
    /// The number of boxes.
    fn len(&self) -> usize;

    /// A box.
    fn bounds(&self, number: usize) -> Bounds;
}

/// A cube that contains a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cube {
    center: DVec3,
    half_side: f64,
}

impl Cube {
    /// Half the side of the cube, doubled some times.
    fn side_after(&self, octaves: u32) -> f64 {
        self.half_side * power_of_two(octaves as i32)
    }

    /// Whether a box is inside.
    pub fn contains(&self, bounds: &Bounds) -> bool {
        reach(self.center, bounds) <= self.half_side
    }
}

/// Half the side of the least cube around a point that contains a box.
fn reach(center: DVec3, bounds: &Bounds) -> f64 {
    (bounds.upper - center)
        .max(center - bounds.lower)
        .max_element()
}

/// Half the surface of a box.
fn half_area(bounds: &Bounds) -> f64 {
    let extent = bounds.extent();
    extent.x * extent.y + extent.y * extent.z + extent.z * extent.x
}

/// The cubes of all groups except the last, which has the rest; `whole` contains everything.
/// What is in several cubes belongs to the first of them.
///
/// `first` contains everything except the further groups of placed prototypes. If a frame of
/// its own gains nothing, it gets one anyway if the frame is [`LEAST_RATIO`] times smaller:
/// outliers of a child stay separate, and hits have the bits of the scene without the child's
/// outliers.
pub(super) fn cubes(all: &impl Boxed, whole: &Bounds, first: &Bounds) -> Vec<Cube> {
    let mut cubes = Vec::new();
    let mut rest = Rest {
        all,
        numbers: None,
        bounds: *whole,
    };
    while cubes.len() + 1 < MOST_GROUPS {
        let Some(cube) = rest.cube() else { break };
        rest = rest.without(&cube);
        cubes.push(cube);
    }
    if cubes.is_empty() && first != whole && !first.is_empty() {
        let center = first.center();
        let half_side = reach(center, first);
        let cube = Cube { center, half_side };
        if half_side <= rest.greatest() {
            cubes.push(rest.widened(cube));
        }
    }
    cubes
}

/// The boxes without a group.
struct Rest<'a, B> {
    all: &'a B,
    /// Their numbers; `None` for all.
    numbers: Option<Vec<usize>>,
    bounds: Bounds,
}

impl<'a, B: Boxed> Rest<'a, B> {
    fn len(&self) -> usize {
        self.numbers.as_ref().map_or(self.all.len(), Vec::len)
    }

    fn number(&self, position: usize) -> usize {
        self.numbers.as_ref().map_or(position, |all| all[position])
    }

    /// The numbers of the boxes with a property.
    fn with(&self, property: impl Fn(&Bounds) -> bool + Sync) -> Vec<usize> {
        let positions = (0..self.len()).into_par_iter().with_min_len(1 << 10);
        let numbers = positions.map(|position| self.number(position));
        numbers
            .filter(|&number| property(&self.all.bounds(number)))
            .collect()
    }

    fn without(&self, cube: &Cube) -> Self {
        let numbers = self.with(|bounds| !cube.contains(bounds));
        let bounds = numbers.par_iter().with_min_len(1 << 10);
        let bounds = bounds
            .map(|&number| self.all.bounds(number))
            .reduce(|| Bounds::EMPTY, |one, other| one.union(&other));
        Self {
            all: self.all,
            numbers: Some(numbers),
            bounds,
        }
    }

    /// The greatest half side of a cube. Something is outside such a cube for any center.
    fn greatest(&self) -> f64 {
        0.5 * self.bounds.extent().max_element() / LEAST_RATIO
    }

    /// The cube of a group, if one pays.
    fn cube(&self) -> Option<Cube> {
        let stride = self.len().div_ceil(SAMPLE).max(1);
        let positions = (0..self.len()).step_by(stride);
        let sample: Vec<Bounds> = positions
            .map(|position| self.all.bounds(self.number(position)))
            .filter(|bounds| !bounds.is_empty())
            .collect();
        let growth = 0.5 * self.bounds.extent().length() * BOX_GROWTH;
        let is_notable =
            |bounds: &&Bounds| half_area(&bounds.grown(growth)) > NOTABLE * half_area(bounds);
        let small: Vec<&Bounds> = sample.iter().filter(is_notable).collect();
        let least = match stride {
            1 => 2,
            _ => ((LEAST_SHARE * sample.len() as f64) as usize).max(1),
        };
        if small.len() < least {
            return None;
        }
        let search = Search {
            sample: &sample,
            least,
            each: self.len() as f64 / sample.len() as f64,
            growth,
            greatest: self.greatest(),
        };
        let middles = small.iter().step_by(small.len().div_ceil(CENTERS));
        let cubes = middles.filter_map(|bounds| search.around(bounds.center()));
        let (gain, cube) = cubes.reduce(|best, one| if one.0 > best.0 { one } else { best })?;
        (gain >= LEAST_GAIN).then(|| self.widened(cube))
    }

    /// The cube, doubled until the next octave is empty or the greatest size is reached.
    fn widened(&self, cube: Cube) -> Cube {
        let most = (1..=OCTAVES).take_while(|&octaves| cube.side_after(octaves) <= self.greatest());
        let occupied = self.octaves_around(&cube).trailing_ones();
        let octaves = occupied.min(most.count() as u32);
        let widened = Cube {
            half_side: cube.side_after(octaves),
            ..cube
        };
        match octaves {
            OCTAVES => self.widened(widened),
            _ => widened,
        }
    }

    /// The octaves around a cube that contain a box: bit k is set if a box extends beyond the
    /// cube doubled k times, but not beyond it doubled once more.
    fn octaves_around(&self, cube: &Cube) -> u64 {
        let positions = (0..self.len()).into_par_iter().with_min_len(1 << 10);
        let bits = positions.map(|position| {
            let reach = reach(cube.center, &self.all.bounds(self.number(position)));
            let octave = (0..=OCTAVES).find(|&octaves| reach <= cube.side_after(octaves));
            match octave {
                None | Some(0) => 0,
                Some(octave) => 1 << (octave - 1),
            }
        });
        bits.reduce(|| 0, |one, other| one | other)
    }
}

/// A search for the best cube in a sample.
struct Search<'a> {
    sample: &'a [Bounds],
    /// The least number of boxes in a cube.
    least: usize,
    /// The number of boxes that a box of the sample represents.
    each: f64,
    growth: f64,
    /// The greatest half side of a cube.
    greatest: f64,
}

impl Search<'_> {
    /// The best cube around a point, with its gain, among those that contain the nearest boxes
    /// and are half as large and smaller each time.
    fn around(&self, center: DVec3) -> Option<(f64, Cube)> {
        let mut near: Vec<(f64, &Bounds)> = self
            .sample
            .iter()
            .map(|bounds| (reach(center, bounds), bounds))
            .collect();
        near.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let mut best: Option<(f64, Cube)> = None;
        let mut limit = self.greatest;
        loop {
            let inside = near.partition_point(|(reach, _)| *reach <= limit);
            if inside < self.least {
                return best;
            }
            let half_side = near[inside - 1].0;
            let gain = self.gain(half_side, &near[..inside]);
            if best.is_none_or(|(known, _)| gain > known) {
                best = Some((gain, Cube { center, half_side }));
            }
            limit = 0.5 * half_side;
        }
    }

    /// The callbacks that a frame of their own saves a ray.
    fn gain(&self, half_side: f64, inside: &[(f64, &Bounds)]) -> f64 {
        let own = 3_f64.sqrt() * half_side * BOX_GROWTH;
        let region = 12.0 * half_side * half_side;
        let probability =
            |bounds: &Bounds, growth| (half_area(&bounds.grown(growth)) / region).min(1.0);
        let spared = inside
            .iter()
            .map(|(_, bounds)| probability(bounds, self.growth) - probability(bounds, own));
        let share = inside.len() as f64 / self.sample.len() as f64;
        share * self.each * spared.sum::<f64>()
    }
}
