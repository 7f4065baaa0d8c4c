//! How queries decide about hits.

use super::frame::LocalRay;
use crate::solid::{Chord, ConvexSolid, Intersection};

/// How hits, misses and parts of solids are decided. Set operations decide by
/// rounded numbers always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Decisions {
    /// From differences of points as f64 rounds them.
    #[default]
    Rounded,
    /// From the numbers as stated; see [`ConvexSolid::exact_chord`].
    Exact,
}

impl Decisions {
    /// What [`Options::exact`](super::Options::exact) says.
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

/// The first intersection of a ray with a convex solid in a range of the whole ray's `t`, decided
/// exactly. A call, so that what decides otherwise is compiled as if this were not there.
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
