//! When the solids of a prototype get more than one frame.
//!
//! Boxes grow by g = 2^-19 R, R the radius of their frame ([`BOX_GROWTH`]). One solid
//! that is very far from the others, or very large, makes R and so g large for all of
//! them. Where g is no longer small against solids that lie close together, a
//! ray through them meets most of their boxes.
//!
//! **What it costs.** A line through a convex region of half surface area A meets a
//! convex box in it, of half area a, with the probability a/A (Crofton). So the
//! callbacks of a ray through a cube of side 2h, with n boxes in it, are
//!
//! ```text
//! callbacks(g) = sum over the boxes of min(1, a(g) / 12 h²)
//! ```
//!
//! where a(g) is the half area of a box grown by g. With a frame of their own
//! the n solids have `g' = 2^-19 √3 h`. A ray is as likely to go to the cube as its
//! target is one of the n among all N, hence
//!
//! ```text
//! gain = n/N (callbacks(g) - callbacks(g'))
//! ```
//!
//! Another frame costs each ray that comes to the prototype about what a callback
//! costs: entering it, and mostly finding that its sphere is missed. So the solids in
//! the cube become a group of their own where the gain is at least
//! [`LEAST_GAIN`] and their frame is at least [`LEAST_RATIO`] times smaller.
//!
//! **How it is found.** The areas come from a sample of [`SAMPLE`] boxes at equal
//! strides, cubes around the middles of some of them are tried, and the best one is
//! doubled until the next octave is empty. Then nothing is left out that belongs to
//! it: everything else is more than twice as far away as the rest. What remains
//! is treated likewise. Where g adds less than a quarter to the boxes of the sample,
//! as in nearly all prototypes, that ends the search.
//!
//! The result depends on the boxes alone, not on threads. Answers do not
//! depend on it.

use glam::DVec3;
use rayon::prelude::*;

use crate::math::{Bounds, power_of_two};
use crate::tracer::frame::BOX_GROWTH;

/// The least number of callbacks that another frame spares a ray.
const LEAST_GAIN: f64 = 1.0;

/// By how much a frame has to be smaller. Below, a growth of 2^-19 R is 2^-15 of
/// the group: only hundreds of millions of solids are so close together.
const LEAST_RATIO: f64 = 16.0;

/// The most boxes that decide. More find groups that are a smaller share of all, and
/// take longer: the square of them, in prototypes that need groups.
const SAMPLE: usize = 256;

/// The most cubes that are tried.
const CENTERS: usize = 32;

/// The least part of a sample that is trusted: a few boxes that are close by chance
/// would represent thousands.
const LEAST_SHARE: f64 = 1.0 / 32.0;

/// The octaves around a cube that are looked at in one pass over the boxes.
const OCTAVES: u32 = 64;

/// Growth matters to a box whose area it multiplies by more than this.
const NOTABLE: f64 = 1.25;

/// The most groups of a prototype. Each takes a leaf in the tree of every
/// prototype that places it.
pub(super) const MOST_GROUPS: usize = 8;

/// Things with boxes; the box of what contains nothing is empty.
pub(super) trait Boxed: Sync {
    /// How many there are.
    fn len(&self) -> usize;

    /// The box of one.
    fn bounds(&self, number: usize) -> Bounds;
}

/// A cube that contains a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cube {
    center: DVec3,
    half_side: f64,
}

impl Cube {
    /// Half the side of the cube doubled some times.
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

/// The cubes of all groups but the last, which has the rest; `whole` contains
/// everything. What is in several cubes belongs to the first of them.
///
/// `first` contains all but the further groups of what is placed. Where nothing is gained
/// by a frame of its own, it gets one all the same if that is [`LEAST_RATIO`] times
/// smaller: what was apart in a child stays apart, and hits are the bits of the scene
/// without the child's outliers.
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

/// What no group has been found for.
struct Rest<'a, B> {
    all: &'a B,
    /// The numbers of it; `None` for all.
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

    /// The numbers of those whose box has a property.
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

    /// The greatest half side of a cube. Whatever its center, something is outside.
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

    /// The cube doubled until the next octave is empty, or it is the greatest.
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

    /// Which of the octaves around a cube have a box: bit k is set if one reaches beyond the
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
    /// What a box of the sample counts for.
    each: f64,
    growth: f64,
    /// The greatest half side of a cube.
    greatest: f64,
}

impl Search<'_> {
    /// The best cube around a point with what it gains, among those that contain the
    /// nearest boxes and are half as large and smaller each time.
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

    /// The callbacks that a frame of their own spares a ray.
    fn gain(&self, half_side: f64, inside: &[(f64, &Bounds)]) -> f64 {
        let own = 3_f64.sqrt() * half_side * BOX_GROWTH;
        let region = 12.0 * half_side * half_side;
        let met = |bounds: &Bounds, growth| (half_area(&bounds.grown(growth)) / region).min(1.0);
        let spared = inside
            .iter()
            .map(|(_, bounds)| met(bounds, self.growth) - met(bounds, own));
        let share = inside.len() as f64 / self.sample.len() as f64;
        share * self.each * spared.sum::<f64>()
    }
}
