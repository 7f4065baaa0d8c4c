//! From how far the rays come that a prototype hands on to what it places, and
//! so by how much the boxes of placements have to grow.

use glam::DVec3;
use rayon::prelude::*;

use super::parts::Parts;
use crate::math::{Bounds, ChildFromParent, PlacementErrors, UNIT_ROUNDOFF};
use crate::scene::Placement;
use crate::tracer::frame::FAR;

/// From how far the rays come that a prototype hands on to what it places.
///
/// The roundings of a child's ray, and of the solvers that get it, displace its
/// hits in proportion to the distance of the ray's origin from the child's. The
/// origin is at most `√3` [`FAR`] units of the prototype's frame from the center, or
/// the ray was moved nearer; a unit is at most the radius of the prototype's
/// reach, which in turn contains the displacements:
///
/// ```text
/// reach <= radius + √3 max (displacement · (√3 FAR reach + offset))
/// ```
///
/// with `offset` the distance of a child's origin from the center. As
/// [`GREATEST_CONDITION`](crate::scene::GREATEST_CONDITION) keeps `displacement`
/// below `60 u 2^27`, the factor of `reach` on the right is below 1/5, and
/// `reach` below 5/4 of the rest.
#[derive(Clone, Copy)]
pub(super) struct PlacementMargin {
    center: DVec3,
    /// The bound of the radius of the reach.
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

    /// Where hits in a placed child may be: the image of the child's reach,
    /// grown by the displacement.
    pub fn placement_reach(&self, placement: &Placement, child_reach: &Bounds) -> Bounds {
        let image = child_reach.transformed(&placement.parent_from_child);
        image.grown(self.slack(placement))
    }

    /// The same in a tighter box, of the child's parts where these serve a list of this
    /// many placements.
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

    /// How far a placed child's hits are displaced in the parent.
    pub fn slack(&self, placement: &Placement) -> f64 {
        let distance = 2.0 * FAR * self.reach + offset(self.center, placement);
        displacement(placement) * distance
    }
}

/// The distance of a child's origin from a point of its parent.
fn offset(center: DVec3, placement: &Placement) -> f64 {
    (center - placement.parent_from_child.translation).length()
}

/// By how much a child's hits are displaced in its parent, as a share of the
/// distance of the ray's origin from the child's: by the roundings of the
/// child's origin and direction and, behind `condition`, of the solver.
fn displacement(placement: &Placement) -> f64 {
    let way = ChildFromParent::new(&placement.parent_from_child);
    let errors = PlacementErrors::new(&placement.parent_from_child, &way);
    2.0 * errors.inverse_error + 16.0 * UNIT_ROUNDOFF * errors.condition
}
