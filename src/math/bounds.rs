//! Axis-aligned boxes in f64 that are rounded outward.

use glam::{DAffine3, DVec3};

use super::UNIT_ROUNDOFF;

/// The closed box `lower <= x <= upper`, axis by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub lower: DVec3,
    /// Greatest coordinates.
    pub upper: DVec3,
}

impl Bounds {
    /// The box that contains nothing; the neutral element of [`Bounds::union`].
    pub const EMPTY: Self = Self {
        lower: DVec3::INFINITY,
        upper: DVec3::NEG_INFINITY,
    };

    /// Whether no point lies in the box.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.lower.cmple(self.upper).all()
    }

    /// Whether the boxes have a point in common.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.lower.cmple(other.upper).all() && other.lower.cmple(self.upper).all()
    }

    /// The smallest box that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            lower: self.lower.min(other.lower),
            upper: self.upper.max(other.upper),
        }
    }

    /// The middle of a box that is not empty, rounded.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.lower * 0.5 + self.upper * 0.5
    }

    /// The edge lengths of a box that is not empty, rounded.
    #[must_use]
    pub fn extent(&self) -> DVec3 {
        self.upper - self.lower
    }

    /// The box of one point.
    #[must_use]
    pub fn at(point: DVec3) -> Self {
        Self {
            lower: point,
            upper: point,
        }
    }

    /// The box with every face moved outward by `distance`.
    #[must_use]
    pub fn grown(&self, distance: f64) -> Self {
        Self {
            lower: self.lower - distance,
            upper: self.upper + distance,
        }
    }

    /// The next larger box: every coordinate moves outward by one ulp, which
    /// covers one rounding to nearest.
    #[must_use]
    pub fn rounded_outward(&self) -> Self {
        Self {
            lower: self.lower.map(f64::next_down),
            upper: self.upper.map(f64::next_up),
        }
    }

    /// A box that contains the image of every point of this one.
    ///
    /// The center and the half extent (through the matrix of absolute values)
    /// are mapped with at most 6 roundings a term. The box grows by 8 units of
    /// the terms' sizes.
    #[must_use]
    pub fn transformed(&self, to_from_here: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let center = self.center();
        let half = (self.upper - center).max(center - self.lower) * (1.0 + 2.0 * UNIT_ROUNDOFF);
        let matrix = to_from_here.matrix3;
        let absolute = matrix.abs();
        let size = absolute * center.abs() + to_from_here.translation.abs();
        let reach = absolute * half;
        let reach = reach + (size + reach) * (8.0 * UNIT_ROUNDOFF);
        let middle = matrix * center + to_from_here.translation;
        Self {
            lower: middle - reach,
            upper: middle + reach,
        }
        .rounded_outward()
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::math::Random;

    #[test]
    fn transformed_box_contains_the_images_of_its_corners() {
        let mut random = Random::new(3, 0);
        for case in 0..2_000 {
            let mut point = || {
                let size = random.log_uniform(1e-6, 1e6);
                random.direction() * size
            };
            let (a, b) = (point(), point());
            let bounds = Bounds {
                lower: a.min(b),
                upper: a.max(b),
            };
            let matrix = DMat3::from_cols(point(), point(), point());
            let affine = DAffine3::from_mat3_translation(matrix, point());
            let image = bounds.transformed(&affine);
            for corner in 0..8 {
                let pick = |bit: u32, low, high| if corner >> bit & 1 == 0 { low } else { high };
                let corner = DVec3::new(
                    pick(0, bounds.lower.x, bounds.upper.x),
                    pick(1, bounds.lower.y, bounds.upper.y),
                    pick(2, bounds.lower.z, bounds.upper.z),
                );
                let moved = affine.transform_point3(corner);
                assert!(
                    image.lower.cmple(moved).all() && moved.cmple(image.upper).all(),
                    "case {case}: {moved:?} is not in {image:?}"
                );
            }
        }
    }

    #[test]
    fn empty_box_stays_empty() {
        assert!(Bounds::EMPTY.is_empty());
        assert!(
            Bounds::EMPTY
                .transformed(&DAffine3::from_scale(DVec3::splat(2.0)))
                .is_empty()
        );
        let point = Bounds {
            lower: DVec3::ONE,
            upper: DVec3::ONE,
        };
        assert_eq!(Bounds::EMPTY.union(&point), point);
    }
}
