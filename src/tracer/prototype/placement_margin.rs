//! The distance of rays that a prototype passes on to its children, and the resulting growth of
//! the boxes of placements.

use glam::DVec3;
use rayon::prelude::*;

use super::parts::Parts;
use crate::math::{Bounds, ChildFromParent, PlacementErrors, UNIT_ROUNDOFF};
use crate::scene::Placement;
use crate::tracer::frame::FAR;

/// The greatest distance of rays that a prototype passes on to its children.
///
/// The roundings of a child's ray, and of its solvers, displace its hits in proportion to the
/// distance of the ray's origin from the child's. The origin is at most `√3` [`FAR`] units of
/// the prototype's frame from the center, or the ray was moved nearer. A unit is at most the
/// radius of the prototype's reach, which in turn contains the displacements:
///
/// ```text
/// reach <= radius + √3 max (displacement · (√3 FAR reach + offset))
/// ```
///
/// with `offset` the distance of a child's origin from the center. Since
/// [`GREATEST_CONDITION`](crate::scene::GREATEST_CONDITION) keeps `displacement` below
/// `60 u 2^27`, the factor of `reach` on the right is below 1/5, and `reach` below 5/4 of the
/// rest.
#[derive(Clone, Copy)]
pub(super) struct PlacementMargin {
    center: DVec3,
    /// An upper bound of the radius of the reach.
    reach: f64,
}

impl PlacementMargin {
    pub fn new<'a>(
        bounds: &Bounds,
        placements: impl ParallelIterator<Item = &'a Placement>,
    ) -> Self {
        let center = bounds.center();
        let offset = placements
            .map(|placement| displacement(placement) * offset(center, placement))
            .reduce(|| 0.0, f64::max);
        let radius = 0.5 * bounds.extent().length();
        Self {
            center,
            reach: 1.25 * (radius + 2.0 * offset),
        }
    }

    /// The box that contains the hits in a placed child: the image of the child's reach, grown
    /// by the displacement.
    pub fn placement_reach(&self, placement: &Placement, child_reach: &Bounds) -> Bounds {
        let image = child_reach.transformed(&placement.parent_from_child);
        image.grown(self.slack(placement))
    }

    /// A tighter box with the same property, from the child's parts if a list of this length
    /// uses them.
    pub fn tight_reach(
        &self,
        placement: &Placement,
        child_reach: &Bounds,
        parts: &Parts,
        placements: usize,
    ) -> Bounds {
        if !parts.serve(placements) {
            return self.placement_reach(placement, child_reach);
        }
        let image = parts.image(&placement.parent_from_child);
        image.grown(self.slack(placement))
    }

    /// The displacement of a placed child's hits in the parent.
    pub fn slack(&self, placement: &Placement) -> f64 {
        let distance = 2.0 * FAR * self.reach + offset(self.center, placement);
        displacement(placement) * distance
    }
}

/// The distance of a child's origin from a point of its parent.
fn offset(center: DVec3, placement: &Placement) -> f64 {
    (center - placement.parent_from_child.translation).length()
}

/// The displacement of a child's hits in its parent, as a share of the distance of the ray's
/// origin from the child's: from the roundings of the child's origin and direction and,
/// multiplied by `condition`, of the solver.
fn displacement(placement: &Placement) -> f64 {
    let child_from_parent = ChildFromParent::new(&placement.parent_from_child);
    let errors = PlacementErrors::new(&placement.parent_from_child, &child_from_parent);
    2.0 * errors.inverse_error + 16.0 * UNIT_ROUNDOFF * errors.condition
}
