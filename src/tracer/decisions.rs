//! How queries decide about hits.

use super::frame::LocalRay;
use crate::solid::{Chord, ConvexSolid, Intersection};

/// How hits, misses and parts of solids are decided. Set operations always decide from rounded
/// numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Decisions {
    /// From rounded differences of points.
    #[default]
    Rounded,
    /// From the stated numbers; see [`ConvexSolid::exact_chord`].
    Exact,
}

impl Decisions {
    /// From [`Options::exact`](super::Options::exact).
    pub fn new(is_exact: bool) -> Self {
        if is_exact { Self::Exact } else { Self::Rounded }
    }

    /// The interval in which a ray is inside a convex solid.
    #[inline(always)]
    pub fn chord<S: ConvexSolid>(self, solid: &S, ray: &LocalRay) -> Option<Chord> {
        match self {
            Self::Rounded => solid.chord(ray.origin_from(solid.anchor()), ray.direction),
            Self::Exact => exact_chord(solid, ray),
        }
    }
}

/// The first intersection of a ray with a convex solid in a range of the whole ray's `t`,
/// decided exactly. Not inlined, so that it does not affect the compilation of its callers.
#[cold]
#[inline(never)]
pub(crate) fn exact_first<S: ConvexSolid>(
    solid: &S,
    ray: &LocalRay,
    t_min: f64,
    t_max: f64,
) -> Option<Intersection> {
    solid.exact_first(&ray.start(), ray.direction, ray.shift, [t_min, t_max])
}

#[cold]
#[inline(never)]
fn exact_chord<S: ConvexSolid>(solid: &S, ray: &LocalRay) -> Option<Chord> {
    solid.exact_chord(&ray.start(), ray.direction)
}
