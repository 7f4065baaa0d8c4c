//! Ways between points, with what their rounding leaves.
//!
//! A solver computes with differences: the way `x` from a point of its solid to the origin of
//! the ray, and the axis `a` from one end to the other. f64 rounds them. Where a rounded
//! number leaves a decision open, it is made from exact numbers, and there are two
//! answers to what these are: the rounded difference itself, or the difference of the two
//! points as stated. A solver is the same code for both, with the way as a type.
//!
//! A number `s = a + b`, rounded, and its rest `(a + b) - s` are two f64 numbers (Knuth, *The
//! Art of Computer Programming*, volume 2, section 4.2.2), which `DoubleDouble::sum` finds without
//! a branch. A sum of three numbers is three such numbers.

use std::fmt::Debug;

use glam::DVec3;

use super::exact::{Number, difference, vector};
use crate::math::DoubleDouble;

/// A way between two points.
pub(super) trait Way: Copy + Debug {
    /// The way, each component within `u + 3 u²` of itself, u = 2^-53.
    fn rounded(&self) -> DVec3;

    /// The way as numbers `N`.
    fn exactly<N: Number>(&self) -> [N; 3];

    /// Whether the rounded way is the exact one.
    fn is_rounded(&self) -> bool;
}

/// A way that f64 represents.
impl Way for DVec3 {
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

/// The way from one point to another, rounded only where that is needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    pub from: DVec3,
    pub to: DVec3,
}

impl Way for Between {
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
    /// The same with its rest.
    pub fn exact(&self) -> ExactWay {
        RayOrigin::at(self.to).way_from(self.from)
    }
}

/// A way and what its rounding left, exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactWay {
    rounded: DVec3,
    rest: [DVec3; 2],
}

impl Way for ExactWay {
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

/// The origin of a ray as exactly as a prototype has it: the point `base + offset`, a sum
/// that f64 need not hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayOrigin {
    /// Zero, or the point that a far ray was moved next to.
    pub base: DVec3,
    /// The way from there.
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

    /// The way from a point.
    ///
    /// Where the offset nearly cancels the way to the base, their sum is exact, and the
    /// middle one of the three numbers is what is left of the other rounding. So the
    /// rounded way is within `u + 3 u²` of itself always.
    pub(super) fn way_from(&self, point: DVec3) -> ExactWay {
        let [mut rounded, mut more, mut less] = [DVec3::ZERO; 3];
        for axis in 0..3 {
            let to_base = DoubleDouble::sum(self.base[axis], -point[axis]);
            let sum = DoubleDouble::sum(to_base.high, self.offset[axis]);
            let rests = DoubleDouble::sum(to_base.low, sum.low);
            let way = DoubleDouble::sum(sum.high, rests.high);
            (rounded[axis], more[axis], less[axis]) = (way.high, way.low, rests.low);
        }
        ExactWay {
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

    /// A component of a way less a number.
    struct Component(ExactWay, usize, f64);

    impl Expression for Component {
        fn value<N: Number>(&self) -> N {
            self.0.exactly::<N>()[self.1].minus(&N::of(self.2))
        }
    }

    #[test]
    fn exact_way_keeps_what_rounding_loses() {
        let moved = RayOrigin {
            base: DVec3::splat(1e20),
            offset: DVec3::new(0.1, 1e-30, -1e20),
        };
        let point = DVec3::new(1e20, 1e20, 1e-40);
        let way = moved.way_from(point);
        assert_eq!(way.rounded(), DVec3::new(0.1, 1e-30, -1e-40));
        assert!(way.is_rounded());
        let off = moved.way_from(DVec3::new(1e-3, 1.0, -0.1));
        assert!(!off.is_rounded());
        let signs = [0, 1, 2].map(|axis| sign(&Component(off, axis, off.rounded()[axis])));
        assert_eq!(signs, [Ordering::Greater, Ordering::Less, Ordering::Equal]);
    }
}
