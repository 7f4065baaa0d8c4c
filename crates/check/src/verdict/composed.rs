//! Bounds of the first hit of a composition from the crossings of the meshes of its leaves.
//!
//! From `t_min` on, the line is *surely* in a leaf while it is in the mesh inside it, and
//! *perhaps* while it is in the mesh around it. With sets of parameters for both, the
//! operations give those of the composition: a union's and an intersection's are the union
//! and the intersection of either kind, and a subtracted leaf is replaced by its
//! complement, which the line is surely in where it is not even perhaps in the leaf:
//!
//! ```text
//! perhaps (A \ B) = perhaps A ∩ not surely B      surely (A \ B) = surely A ∩ not perhaps B
//! ```
//!
//! A leaf is convex, and contains all that is between two points of the mesh inside it: the
//! line is surely in it from its first entry of that mesh to its last exit, and perhaps from
//! the first entry of the mesh around it to the last exit.
//!
//! The line hits the surface where it goes from outside to inside or back. So with the
//! first parameter `i` at which it is surely inside, and the first `o` at which it is
//! surely outside, both not before `t_min`:
//!
//! - *starting surely outside*, the first hit is not before it is perhaps inside, nor
//!   after `i`;
//! - *starting surely inside*, not before it is perhaps outside, nor after `o`;
//! - otherwise the lower bound is `t_min`, and the hit is not after the later of `i` and `o`.
//!
//! Exact crossings are rounded so that the sets of each leaf that are surely inside are
//! smaller by less than an ulp at each end, and those that are perhaps inside larger
//! (`exact_recheck`). All three operations keep that order, so the bounds are right, if wider by
//! as much.
//!
//! After a partial traversal (`sandwich`) the sets are unknown beyond its end, and leaves around
//! the start of the ray are not found, so it does not settle answers about compositions.

use smallvec::{SmallVec, smallvec};

use super::sandwich::{Interval, SolidBounds};
use crate::bounding_meshes::crossings::{Crossings, LeafCrossings};
use cyltrace::solid::Composition;

/// Closed intervals of parameters, in order and apart.
type Spans = SmallVec<[(f64, f64); 4]>;

/// The parameters at which the line is inside.
struct Within {
    surely: Spans,
    perhaps: Spans,
}

impl Within {
    /// In a leaf, from `t_min` on.
    fn leaf(crossings: &LeafCrossings, t_min: f64) -> Self {
        let span = |one: &Crossings, starts_inside: bool| -> Spans {
            if one.is_none() {
                return smallvec![];
            }
            let start = if starts_inside { t_min } else { one.enter };
            smallvec![(start, one.last_leave)]
        };
        let LeafCrossings { outer, inner } = crossings;
        let mut surely = span(inner, inner.starts_inside());
        surely.retain(|span| span.0 <= span.1);
        // `is_odd` reports a line that enters and does not leave.
        let mut perhaps = span(outer, outer.may_start_inside());
        perhaps
            .iter_mut()
            .for_each(|span| span.1 = span.1.max(span.0));
        Self { surely, perhaps }
    }

    /// In a composition, whose leaves come in the order of their crossings.
    fn composition<'a>(
        composition: &Composition,
        leaves: &mut impl Iterator<Item = &'a LeafCrossings>,
        t_min: f64,
    ) -> Self {
        let mut each = |parts: &[Composition]| -> Vec<Self> {
            let parts = parts.iter();
            parts
                .map(|part| Self::composition(part, leaves, t_min))
                .collect()
        };
        let nothing = || Self {
            surely: smallvec![],
            perhaps: smallvec![],
        };
        match composition {
            Composition::Solid(_) => leaves
                .next()
                .map_or_else(nothing, |crossings| Self::leaf(crossings, t_min)),
            Composition::Union(parts) => {
                let parts = each(parts).into_iter();
                parts.reduce(Self::with).unwrap_or_else(nothing)
            }
            Composition::Intersection(parts) => {
                let parts = each(parts).into_iter();
                parts.reduce(Self::in_common).unwrap_or_else(nothing)
            }
            Composition::Difference(parts) => {
                let parts = each(parts).into_iter();
                parts
                    .reduce(|first, other| first.in_common(other.outside(t_min)))
                    .unwrap_or_else(nothing)
            }
        }
    }

    fn with(self, other: Self) -> Self {
        Self {
            surely: union(self.surely, other.surely),
            perhaps: union(self.perhaps, other.perhaps),
        }
    }

    fn in_common(self, other: Self) -> Self {
        Self {
            surely: intersection(&self.surely, &other.surely),
            perhaps: intersection(&self.perhaps, &other.perhaps),
        }
    }

    fn outside(self, t_min: f64) -> Self {
        Self {
            surely: complement(&self.perhaps, t_min),
            perhaps: complement(&self.surely, t_min),
        }
    }
}

fn union(one: Spans, other: Spans) -> Spans {
    let mut all = one;
    all.extend(other);
    all.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let mut merged: Spans = smallvec![];
    for (start, end) in all {
        match merged.last_mut() {
            Some(last) if start <= last.1 => last.1 = last.1.max(end),
            _ => merged.push((start, end)),
        }
    }
    merged
}

fn intersection(one: &Spans, other: &Spans) -> Spans {
    let mut common: Spans = smallvec![];
    for &(start, end) in one {
        for &(other_start, other_end) in other {
            let (start, end) = (start.max(other_start), end.min(other_end));
            if start <= end {
                common.push((start, end));
            }
        }
    }
    common
}

/// All of the line from `t_min` on that is not in one of the spans, with its ends.
fn complement(spans: &Spans, t_min: f64) -> Spans {
    let mut free: Spans = smallvec![];
    let mut start = t_min;
    for &(span_start, span_end) in spans {
        if span_start > start {
            free.push((start, span_start));
        }
        start = start.max(span_end);
    }
    if start < f64::INFINITY {
        free.push((start, f64::INFINITY));
    }
    free
}

/// The first parameter not before `t_min` of any of the spans.
fn first(spans: &Spans) -> f64 {
    spans.first().map_or(f64::INFINITY, |span| span.0)
}

/// Where a span that starts at `t_min` ends.
fn end_at_start(spans: &Spans, t_min: f64) -> Option<f64> {
    spans
        .first()
        .filter(|span| span.0 <= t_min)
        .map(|span| span.1)
}

/// The bounds for a composition. `leaves` are in the order of its operands.
pub(crate) fn composed_bounds(
    composition: &Composition,
    leaves: &[LeafCrossings],
    t_min: f64,
) -> SolidBounds {
    let within = Within::composition(composition, &mut leaves.iter(), t_min);
    let surely_outside = complement(&within.perhaps, t_min);
    let (inside, outside) = (first(&within.surely), first(&surely_outside));
    let interval = if let Some(end) = end_at_start(&within.surely, t_min) {
        Interval {
            low: end,
            high: outside,
        }
    } else if end_at_start(&within.perhaps, t_min).is_some() {
        Interval {
            low: t_min,
            high: inside.max(outside),
        }
    } else {
        Interval {
            low: first(&within.perhaps),
            high: inside,
        }
    };
    let perhaps_last = within.perhaps.last();
    SolidBounds {
        interval,
        inner: None,
        last: perhaps_last.map_or(f64::NEG_INFINITY, |span| span.1),
        is_odd: leaves.iter().any(is_odd),
    }
}

/// Whether the crossings of a leaf contradict that its meshes are nested.
fn is_odd(leaf: &LeafCrossings) -> bool {
    let LeafCrossings { outer, inner } = leaf;
    let is_endless = |one: &Crossings| !one.is_none() && one.last_leave < one.enter.min(one.leave);
    is_endless(outer)
        || is_endless(inner)
        || (outer.is_none() && !inner.is_none())
        || inner.last_leave > outer.last_leave
        || (!outer.may_start_inside() && (inner.starts_inside() || inner.enter < outer.enter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::solid::Sphere;
    use glam::DVec3;

    const NOTHING: f64 = f64::INFINITY;

    /// A leaf that the line is surely in from start to end, and perhaps a tenth around that.
    fn leaf(start: f64, end: f64) -> LeafCrossings {
        let crossings = |start: f64, end: f64| {
            let mut crossings = Crossings::NONE;
            if start >= 0.0 {
                crossings.add(start, true);
            }
            if end >= 0.0 {
                crossings.add(end, false);
            }
            crossings
        };
        LeafCrossings {
            outer: crossings(start - 0.1, end + 0.1),
            inner: crossings(start, end),
        }
    }

    fn solid() -> Composition {
        Composition::Solid(Sphere::new(DVec3::ZERO, 1.0).unwrap().into())
    }

    fn bounds(composition: &Composition, leaves: &[LeafCrossings]) -> (f64, f64) {
        let bounds = composed_bounds(composition, leaves, 0.0);
        assert!(!bounds.is_odd);
        let close = |x: f64| {
            if x.is_finite() {
                (x * 1e6).round() / 1e6
            } else {
                x
            }
        };
        (close(bounds.interval.low), close(bounds.interval.high))
    }

    #[test]
    fn operations_have_the_bounds_of_their_sets() {
        let union = Composition::Union(vec![solid(), solid()]);
        let common = Composition::Intersection(vec![solid(), solid()]);
        let less = Composition::Difference(vec![solid(), solid()]);
        let [early, late] = [leaf(1.0, 4.0), leaf(3.0, 6.0)];
        assert_eq!(bounds(&union, &[early, late]), (0.9, 1.0));
        assert_eq!(bounds(&common, &[early, late]), (2.9, 3.0));
        assert_eq!(bounds(&less, &[early, late]), (0.9, 1.0));
        assert_eq!(bounds(&less, &[late, early]), (4.0, 4.1));
        // A solid without itself is empty or a skin.
        assert_eq!(bounds(&less, &[early, early]), (0.9, NOTHING));
        assert_eq!(
            bounds(&common, &[early, leaf(5.0, 6.0)]),
            (NOTHING, NOTHING)
        );
        // From inside of both, of one, and from within a skin.
        let around = leaf(-1.0, 2.0);
        assert_eq!(bounds(&union, &[around, leaf(1.0, 4.0)]), (4.0, 4.1));
        assert_eq!(bounds(&common, &[around, leaf(-1.0, 4.0)]), (2.0, 2.1));
        assert_eq!(bounds(&less, &[around, leaf(1.0, 4.0)]), (0.9, 1.0));
        let skin = leaf(0.05, 2.0);
        assert_eq!(bounds(&union, &[skin, LeafCrossings::NONE]), (0.0, 2.1));
    }

    #[test]
    fn nested_operations_take_leaves_in_order() {
        // A block without (a bore in common with a plug).
        let bore = Composition::Intersection(vec![solid(), solid()]);
        let block = Composition::Difference(vec![solid(), bore]);
        let leaves = [leaf(1.0, 9.0), leaf(-1.0, 3.0), leaf(-1.0, 2.0)];
        assert_eq!(bounds(&block, &leaves), (2.0, 2.1));
    }

    #[test]
    fn contradictions_are_odd() {
        let mut leaf = leaf(1.0, 2.0);
        leaf.inner.enter = 0.5;
        assert!(composed_bounds(&solid(), &[leaf], 0.0).is_odd);
        leaf = LeafCrossings {
            outer: Crossings::NONE,
            ..leaf
        };
        assert!(composed_bounds(&solid(), &[leaf], 0.0).is_odd);
    }
}
