//! Placements by rule: many copies of a prototype on a plane.
//!
//! Item `k` of a scatter depends only on `k`, the keys and the seed: its random
//! numbers are stream `k` of the seed, first the yaw, then the scale. Both are drawn
//! even if unused.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use super::document::ScatterKeys;
use super::error::SceneError;
use super::source::Source;
use super::transform::{GREATEST_ENTRY, Reach};
use super::values::NumberOrList;
use crate::math::{Random, rotation};

/// 2^64 divided by the square of the golden ratio, rounded: the golden angle
/// as a fraction of a turn.
const GOLDEN_TURN: u64 = 0x61C8_8646_80B5_83EB;

/// An upper bound of the rounding errors of a rotation and its norms.
const ROUNDING_FACTOR: f64 = 1.0 + 64.0 * f64::EPSILON;

/// The arrangement of the items in the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pattern {
    /// A square grid about the origin, row by row from the least x and y.
    Grid,
    /// A sunflower: item k is at distance `spacing · √((k + 1/2)/π)`, a golden
    /// angle after the previous one. The area per item is `spacing²`.
    Disk,
}

/// A validated `[[scatter]]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scatter {
    pub pattern: Pattern,
    /// At least 1.
    pub count: u32,
    /// Positive.
    pub spacing: f64,
    pub random_yaw: bool,
    /// The limits of the scale, positive and in order.
    pub scale: [f64; 2],
    pub seed: u64,
}

impl Scatter {
    /// The scatter of an entry of the scene file.
    pub fn new(source: &Source, keys: &ScatterKeys) -> Result<Self, SceneError> {
        const PATTERNS: [(&str, Pattern); 3] = [
            ("grid", Pattern::Grid),
            ("disk", Pattern::Disk),
            ("disc", Pattern::Disk),
        ];
        const YAWS: [(&str, bool); 2] = [("none", false), ("random", true)];
        let wrong = |place, message: String| Err(source.error(place, message));

        let count = keys.count.get_ref().0;
        let Some(count) = u32::try_from(count).ok().filter(|&count| count > 0) else {
            return wrong(
                keys.count.span(),
                format!("count is {count}: it must be between 1 and {}", u32::MAX),
            );
        };
        let spacing = keys.spacing.get_ref().0;
        if spacing <= 0.0 {
            return wrong(
                keys.spacing.span(),
                format!("spacing is {spacing}: it must be a positive length"),
            );
        }
        let scale = keys
            .scale
            .as_ref()
            .map_or([1.0; 2], |scale| match scale.get_ref() {
                NumberOrList::One(scale) => [*scale; 2],
                NumberOrList::Many(range) => *range,
            });
        let accepted = 1.0 / GREATEST_ENTRY..=GREATEST_ENTRY;
        if let Some(key) = &keys.scale
            && !(accepted.contains(&scale[0])
                && accepted.contains(&scale[1])
                && scale[0] <= scale[1])
        {
            return wrong(
                key.span(),
                format!(
                    "scale is [{}, {}]: it must be a number, or the least and the greatest in that order, between 2^-100 and 2^100",
                    scale[0], scale[1]
                ),
            );
        }
        let scatter = Self {
            pattern: source.choose("pattern", &keys.pattern, &PATTERNS)?,
            count,
            spacing,
            random_yaw: match &keys.yaw {
                Some(word) => source.choose("yaw", word, &YAWS)?,
                None => false,
            },
            scale,
            seed: keys.seed.map_or(0, |seed| seed.0),
        };
        if scatter.reach().translation > GREATEST_ENTRY {
            return wrong(
                keys.spacing.span(),
                format!(
                    "spacing is {spacing}: with {count} items the scatter reaches beyond 2^100"
                ),
            );
        }
        Ok(scatter)
    }

    /// Bounds for all items.
    pub fn reach(&self) -> Reach {
        // A grid's last item is at most (√count + 1)/2 spacings away on each
        // axis, a disk's at most √(count/π).
        let farthest = self.spacing * (f64::from(self.count).sqrt() + 1.0);
        Reach {
            stretch: self.scale[1] * ROUNDING_FACTOR,
            squeeze: ROUNDING_FACTOR / self.scale[0],
            translation: farthest,
        }
    }

    /// The items' placements, in the order of their numbers, on the caller's rayon pool.
    pub fn items(&self) -> impl IndexedParallelIterator<Item = DAffine3> {
        let scatter = *self;
        let columns = columns(scatter.count);
        let items = (0..scatter.count).into_par_iter();
        items.map(move |item| scatter.item(item, columns))
    }

    fn item(&self, item: u32, columns: u32) -> DAffine3 {
        let mut random = Random::new(self.seed, u64::from(item));
        let yaw = random.unit();
        let [low, high] = self.scale;
        let scale = random.uniform(low, high).min(high);
        let matrix = if self.random_yaw {
            rotation(DVec3::Z, libm::sincos(yaw * TAU)) * scale
        } else {
            DMat3::from_diagonal(DVec3::splat(scale))
        };
        DAffine3::from_mat3_translation(matrix, self.position(item, columns))
    }

    fn position(&self, item: u32, columns: u32) -> DVec3 {
        match self.pattern {
            Pattern::Grid => {
                let rows = self.count.div_ceil(columns);
                let along = |place: u32, places: u32| {
                    (f64::from(place) - 0.5 * f64::from(places - 1)) * self.spacing
                };
                DVec3::new(
                    along(item % columns, columns),
                    along(item / columns, rows),
                    0.0,
                )
            }
            Pattern::Disk => {
                let turn = u64::from(item).wrapping_mul(GOLDEN_TURN);
                let turn = (turn >> 11) as f64 * (f64::EPSILON / 2.0);
                let (sin, cos) = libm::sincos(turn * TAU);
                let distance = self.spacing * ((f64::from(item) + 0.5) / PI).sqrt();
                DVec3::new(distance * cos, distance * sin, 0.0)
            }
        }
    }
}

/// The side of the smallest square grid for `count` items.
fn columns(count: u32) -> u32 {
    let side = count.isqrt();
    if side * side == count { side } else { side + 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCATTER: Scatter = Scatter {
        pattern: Pattern::Grid,
        count: 7,
        spacing: 2.0,
        random_yaw: false,
        scale: [1.0, 1.0],
        seed: 1,
    };

    #[test]
    fn grid_is_centered_and_counts_row_by_row() {
        let positions: Vec<DVec3> = SCATTER.items().map(|item| item.translation).collect();
        let expected = [
            [-2.0, -2.0, 0.0],
            [0.0, -2.0, 0.0],
            [2.0, -2.0, 0.0],
            [-2.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [-2.0, 2.0, 0.0],
        ]
        .map(DVec3::from);
        assert_eq!(positions, expected);
        assert!(SCATTER.items().all(|item| item.matrix3 == DMat3::IDENTITY));
    }

    #[test]
    fn columns_are_the_side_of_the_smallest_square() {
        for (count, side) in [(1, 1), (2, 2), (4, 2), (5, 3), (9, 3), (10, 4)] {
            assert_eq!(columns(count), side, "{count}");
        }
        assert_eq!(columns(u32::MAX), 65_536);
    }

    #[test]
    fn disk_spreads_items_evenly_and_apart() {
        let scatter = Scatter {
            pattern: Pattern::Disk,
            count: 2_000,
            ..SCATTER
        };
        let positions: Vec<DVec3> = scatter.items().map(|item| item.translation).collect();
        let radius = 2.0 * (2_000.0 / PI).sqrt();
        let mean: DVec3 = positions.iter().sum::<DVec3>() / 2_000.0;
        assert!(mean.length() < 0.02 * radius, "{mean:?}");
        // A disk of 1/√2 of the radius has half of the area.
        let inside = positions
            .iter()
            .filter(|position| position.length() < radius * 0.5_f64.sqrt());
        assert!(inside.count().abs_diff(1_000) <= 1);
        let mut nearest = f64::INFINITY;
        for (index, first) in positions.iter().enumerate() {
            for second in &positions[..index] {
                nearest = nearest.min(first.distance(*second));
            }
        }
        assert!(nearest > 0.75 * 2.0, "{nearest}");
    }

    #[test]
    fn random_items_keep_their_numbers_and_limits() {
        let scatter = Scatter {
            count: 500,
            random_yaw: true,
            scale: [0.5, 2.0],
            ..SCATTER
        };
        let longer = Scatter {
            count: 1_000,
            ..scatter
        };
        let reach = scatter.reach();
        let mut mean_heading = DVec3::ZERO;
        let pairs: Vec<_> = scatter.items().zip(longer.items()).collect();
        for (first, second) in pairs {
            assert_eq!(first.matrix3, second.matrix3);
            let scale = first.matrix3.z_axis.z;
            assert!((0.5..=2.0).contains(&scale), "{scale}");
            assert!((first.matrix3.x_axis.length() - scale).abs() < 1e-15 * 4.0);
            assert!(first.translation.abs().max_element() <= reach.translation);
            mean_heading += first.matrix3.x_axis / scale / 500.0;
        }
        assert!(mean_heading.length() < 0.15, "{mean_heading:?}");
        let other = Scatter { seed: 2, ..scatter };
        assert!(
            scatter
                .items()
                .zip(other.items())
                .all(|(first, second)| first != second)
        );
    }
}
