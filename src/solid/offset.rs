//! Offsets between points, with the remainders of their roundings.
//!
//! A solver computes with differences: the offset `x` from a point of its solid to the origin
//! of the ray, and the axis `a` from one end to the other. f64 rounds them. If a rounded number
//! leaves a decision open, it is computed again from exact numbers, which can be two things:
//! the rounded difference itself, or the difference of the two points as stated. A solver has
//! the same code for both, with the offset as a type.
//!
//! The rounded sum `s` of `a` and `b` and its remainder `(a + b) - s` are two f64 numbers
//! (Knuth, *The Art of Computer Programming*, volume 2, section 4.2.2), which
//! `DoubleDouble::sum` computes without a branch. A sum of three numbers is three such numbers.

use std::fmt::Debug;

use glam::DVec3;

use super::exact::{Number, difference, vector};
use crate::math::DoubleDouble;

/// An offset from one point to another.
pub(super) trait Offset: Copy + Debug {
    /// The offset, each component within `u + 3 u²` of itself, u = 2^-53.
    fn rounded(&self) -> DVec3;

    /// The offset as numbers `N`.
    fn exactly<N: Number>(&self) -> [N; 3];

    /// Whether the rounded offset is exact.
    fn is_rounded(&self) -> bool;
}

/// An offset that f64 represents.
impl Offset for DVec3 {
    #[inline(always)]
    fn rounded(&self) -> DVec3 {
        *self
    }

    fn exactly<N: Number>(&self) -> [N; 3] {
        vector(*self)
    }

    #[inline(always)]
    fn is_rounded(&self) -> bool {
        true
    }
}

/// The offset from one point to another, rounded only on request.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    pub from: DVec3,
    pub to: DVec3,
}

impl Offset for Between {
    #[inline(always)]
    fn rounded(&self) -> DVec3 {
        self.to - self.from
    }

    fn exactly<N: Number>(&self) -> [N; 3] {
        difference(self.to, self.from)
    }

    fn is_rounded(&self) -> bool {
        self.exact().is_rounded()
    }
}

impl Between {
    /// The rounded offset with its remainder.
    pub fn exact(&self) -> ExactOffset {
        RayOrigin::at(self.to).offset_from(self.from)
    }
}

/// A rounded offset and its exact remainder.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactOffset {
    rounded: DVec3,
    rest: [DVec3; 2],
}

impl Offset for ExactOffset {
    #[inline(always)]
    fn rounded(&self) -> DVec3 {
        self.rounded
    }

    fn exactly<N: Number>(&self) -> [N; 3] {
        let of = |axis: usize| {
            let [more, less] = self.rest.map(|rest| N::of(rest[axis]));
            N::of(self.rounded[axis]).plus(&more).plus(&less)
        };
        std::array::from_fn(of)
    }

    fn is_rounded(&self) -> bool {
        self.rest == [DVec3::ZERO; 2]
    }
}

/// The exact origin of a ray in a prototype: the point `base + offset`, a sum that f64 may not
/// represent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOrigin {
    /// Zero, or the point near which a far ray was moved.
    pub base: DVec3,
    /// The offset from there.
    pub offset: DVec3,
}

impl RayOrigin {
    /// A point that f64 represents.
    #[must_use]
    pub fn at(point: DVec3) -> Self {
        Self {
            base: DVec3::ZERO,
            offset: point,
        }
    }

    /// The offset from a point.
    ///
    /// If the offset nearly cancels the difference to the base, their sum is exact, and the
    /// middle one of the three numbers is the remainder of the other rounding. So the rounded
    /// offset is always within `u + 3 u²` of itself.
    pub(super) fn offset_from(&self, point: DVec3) -> ExactOffset {
        let [mut rounded, mut more, mut less] = [DVec3::ZERO; 3];
        for axis in 0..3 {
            let to_base = DoubleDouble::sum(self.base[axis], -point[axis]);
            let sum = DoubleDouble::sum(to_base.high, self.offset[axis]);
            let rests = DoubleDouble::sum(to_base.low, sum.low);
            let sum = DoubleDouble::sum(sum.high, rests.high);
            (rounded[axis], more[axis], less[axis]) = (sum.high, sum.low, rests.low);
        }
        ExactOffset {
            rounded,
            rest: [more, less],
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use super::super::exact::{Expression, sign};
    use super::*;

    /// A component of an offset minus a number.
    struct Component(ExactOffset, usize, f64);

    impl Expression for Component {
        fn value<N: Number>(&self) -> N {
            self.0.exactly::<N>()[self.1].minus(&N::of(self.2))
        }
    }

    #[test]
    fn exact_offset_keeps_what_rounding_loses() {
        let moved = RayOrigin {
            base: DVec3::splat(1e20),
            offset: DVec3::new(0.1, 1e-30, -1e20),
        };
        let point = DVec3::new(1e20, 1e20, 1e-40);
        let offset = moved.offset_from(point);
        assert_eq!(offset.rounded(), DVec3::new(0.1, 1e-30, -1e-40));
        assert!(offset.is_rounded());
        let off = moved.offset_from(DVec3::new(1e-3, 1.0, -0.1));
        assert!(!off.is_rounded());
        let signs = [0, 1, 2].map(|axis| sign(&Component(off, axis, off.rounded()[axis])));
        assert_eq!(signs, [Ordering::Greater, Ordering::Less, Ordering::Equal]);
    }
}
