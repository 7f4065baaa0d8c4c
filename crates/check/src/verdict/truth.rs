//! Answers against the exact oracle, on a sample.
//!
//! An intersector computes in f64 and cannot be right to the last digit. An answer is
//! right if it is right for the scene with every solid displaced by
//! at most `δ` in its own space: [`LEEWAY`] times the rounding of the ray on its way to that
//! space (`surface`), at the farthest point of the solid. The solid
//! grown by `δ` contains everything within `δ` of it, and every solid that is displaced by `δ`
//! contains the one shrunk by `δ` (`solids::displaced`). So they replace the outer and the
//! inner mesh, with exact crossings in place of triangles, and the same bounds follow
//! (`sandwich`, `composed`). The sheets of a disk are the disks `δ` above and below it,
//! smaller by `δ`.
//!
//! A crossing of a tube is certain if its height is more than `2 δ` from the
//! missing disks. A ray that enters through one and leaves through another
//! has no upper bound: the sandwich cannot prove that it misses.

use std::ops::Range;

use glam::{DAffine3, DVec3};

use cyltrace::math::Ray;
use cyltrace::solid::{AnySolid, Crossing, Disk, Part};
use cyltrace_oracle::{ExactAffine, placed_hits_of_any};

use super::composed::composed_bounds;
use super::sandwich::{Interval, sheet_bounds, solid_bounds};
use super::surface::LocalRay;
use crate::bounding_meshes::crossings::{Crossings, LeafCrossings};
use crate::bounding_meshes::meshes::may_meet;
use crate::bounding_meshes::window::{PlacedSolid, Window};
use crate::solids::{at_origin, displaced, shape};

/// The allowed roundings of an intersector for each rounding of the ray: a
/// solver has some 30 operations from the ray to `t`.
const LEEWAY: f64 = 32.0;

/// The bounds of the scene's first hit; `None` if a solid is smaller than its displacement.
pub(crate) fn bounds(window: &Window, ray: &Ray) -> Option<Interval> {
    let mut first = Interval::NOTHING;
    for leaves in candidates(window, ray) {
        first = first.first(displaced_bounds(window, leaves, ray)?);
    }
    Some(first)
}

/// The exact first hit of a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrueHit {
    pub t: f64,
    /// The first leaf of the solid that is hit.
    pub solid: u32,
    /// The part of a solid that is not composed.
    pub part: Option<Part>,
}

/// The exact first hit of the scene.
pub(crate) fn first_hit(window: &Window, ray: &Ray) -> Option<TrueHit> {
    let hits = candidates(window, ray).filter_map(|leaves| {
        let solid = leaves.start;
        let Some(found) = window.composition_of(solid) else {
            let placed = &window.solids[solid as usize];
            let hits = placed_hits_of_any(&placed.solid, &placed.frame.exact, ray);
            let hit = hits.into_iter().next()?;
            let (t, part) = (hit.t_f64(), Some(hit.part));
            return Some(TrueHit { t, solid, part });
        };
        let endless = endless(ray);
        let leaves = &window.solids[leaves.start as usize..leaves.end as usize];
        let both = leaves.iter().map(|leaf| {
            let crossings = crossings(&leaf.solid, &leaf.frame.exact, &endless);
            LeafCrossings {
                outer: crossings,
                inner: crossings,
            }
        });
        let both: Vec<LeafCrossings> = both.collect();
        // The upper bound: where two faces coincide, nothing of any length is hit.
        let t = composed_bounds(&found.composition, &both, ray.t_min)
            .interval
            .high;
        let is_hit = t <= ray.t_max && t < f64::INFINITY;
        is_hit.then_some(TrueHit {
            t,
            solid,
            part: None,
        })
    });
    hits.min_by(|one, other| one.t.total_cmp(&other.t))
}

/// The leaves of each solid that the ray may hit.
fn candidates<'a>(window: &'a Window, ray: &'a Ray) -> impl Iterator<Item = Range<u32>> + 'a {
    // A ray this near to a box may hit the displaced solid in it.
    const NEAR: f64 = 1e-12;
    let farthest = ray.origin.abs().max_element();
    let may_meet = move |solid: &PlacedSolid| {
        let bounds = solid.bounds();
        let size = bounds.lower.abs().max(bounds.upper.abs()).max_element() + farthest;
        may_meet(&bounds.grown(NEAR * size), ray)
    };
    window.leaves().filter(move |leaves| {
        let mut leaves = window.solids[leaves.start as usize..leaves.end as usize].iter();
        leaves.any(may_meet)
    })
}

fn endless(ray: &Ray) -> Ray {
    Ray {
        t_max: f64::INFINITY,
        ..*ray
    }
}

fn displaced_bounds(window: &Window, leaves: Range<u32>, ray: &Ray) -> Option<Interval> {
    let endless = endless(ray);
    let crossings: Option<Vec<LeafCrossings>> = leaves
        .clone()
        .map(|leaf| displaced_crossings(&window.solids[leaf as usize], &endless))
        .collect();
    let crossings = crossings?;
    let placed = &window.solids[leaves.start as usize];
    let LeafCrossings { outer, inner } = &crossings[0];
    let bounds = if let Some(found) = window.composition_of(leaves.start) {
        composed_bounds(&found.composition, &crossings, ray.t_min)
    } else if shape(&placed.solid).flat().is_some() {
        sheet_bounds(outer, inner, ray.t_min)
    } else {
        let local = LocalRay::new(placed, ray);
        let margin = 2.0 * LEEWAY * local.rounding_at_solid();
        solid_bounds(outer, inner, ray.t_min, |t| {
            is_between_ends(placed, &local, t, margin)
        })
    };
    // The parameters were rounded to nearest.
    let Interval { low, high } = bounds.interval;
    Some(Interval {
        low: if low.is_finite() {
            low.next_down()
        } else {
            low
        },
        high: high.next_up(),
    })
}

/// Whether the point at a parameter is farther than `margin` from the planes
/// of the solid's missing disks, on its side of them.
fn is_between_ends(placed: &PlacedSolid, local: &LocalRay, t: f64, margin: f64) -> bool {
    let anchor = placed.solid.anchor();
    let mut ends = shape(&placed.solid).open_ends();
    ends.all(|(end, inward)| t.is_finite() && (local.at(t) - (end - anchor)).dot(inward) > margin)
}

/// The crossings of a solid grown and shrunk by the leeway; `None` if it is too small.
fn displaced_crossings(placed: &PlacedSolid, ray: &Ray) -> Option<LeafCrossings> {
    let leeway = LEEWAY * LocalRay::new(placed, ray).rounding_at_solid();
    let shape = shape(&placed.solid);
    if leeway > 0.5 * shape.get().half_width() {
        return None;
    }
    if let Some(disk) = shape.flat() {
        return displaced_disk(placed, disk, leeway, ray);
    }
    let of = |outward: f64| {
        let solid = displaced(&placed.solid, outward)?;
        Some(crossings(&solid, &placed.frame.exact, ray))
    };
    Some(LeafCrossings {
        outer: of(leeway)?,
        inner: of(-leeway)?,
    })
}

/// A disk is moved to the origin, and the placement with it: a solid as thin as the
/// leeway would tilt by the rounding of its ends elsewhere.
fn displaced_disk(
    placed: &PlacedSolid,
    (radius, up): (f64, DVec3),
    leeway: f64,
    ray: &Ray,
) -> Option<LeafCrossings> {
    let center = DAffine3::from_translation(placed.solid.center());
    let placement = placed.frame.exact.after(&ExactAffine::new(&center));
    let mut inner = Crossings::NONE;
    for side in [-1.0, 1.0] {
        let sheet = Disk::new(up * (side * leeway), up, radius - leeway).ok()?;
        let hits = placed_hits_of_any(&sheet.into(), &placement, ray);
        if let Some(hit) = hits.first() {
            inner.add(hit.t_f64(), side > 0.0);
        }
    }
    let grown = displaced(&at_origin(&placed.solid)?, leeway)?;
    Some(LeafCrossings {
        outer: crossings(&grown, &placement, ray),
        inner,
    })
}

/// The entry and the exit of a closed solid.
fn crossings(solid: &AnySolid, placement: &ExactAffine, ray: &Ray) -> Crossings {
    let mut crossings = Crossings::NONE;
    for hit in placed_hits_of_any(solid, placement, ray) {
        crossings.add(hit.t_f64(), hit.crossing == Crossing::Enter);
    }
    crossings
}
