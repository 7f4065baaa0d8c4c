//! From the two ends of a line's way through a convex solid to its hits.
//!
//! The line of a ray is inside a closed convex solid from the least to the
//! greatest of the points where it is on the boundary. What of that is a hit
//! depends on which parts the surface has, and on the ray's range.

use std::cmp::Ordering;

use super::cylinder::TrueHit;
use super::number::{Surd, exact};
use super::ray::ExactRay;
use cyltrace::solid::{Caps, Crossing, Part};

/// A point of the boundary.
#[derive(Clone, Debug)]
pub(super) struct TrueEnd {
    pub t: Surd,
    /// The disk or sphere that the point belongs to, if any.
    pub cap: Option<Part>,
    /// Whether it is on the wall.
    pub on_side: bool,
}

/// All hits, in order: an entry and an exit at most.
///
/// `points` are all points in which the line crosses or touches the boundary, and
/// those that end a stretch within it; `lies_on` is the part of that stretch.
pub(super) fn hits(
    points: &[TrueEnd],
    lies_on: Option<Part>,
    caps: Caps,
    ray: &ExactRay,
) -> Vec<TrueHit> {
    let by_t = |one: &&TrueEnd, other: &&TrueEnd| one.t.value().cmp(&other.t.value());
    let (Some(enter), Some(leave)) = (points.iter().min_by(by_t), points.iter().max_by(by_t))
    else {
        return Vec::new();
    };
    let has = |part| match part {
        Part::Cap0 => caps.at_p0(),
        Part::Cap1 => caps.at_p1(),
        _ => true,
    };
    let hit = |end: &TrueEnd, crossing| {
        let cap = end.cap.filter(|part| has(*part));
        let part = cap.or(end.on_side.then_some(Part::Side))?;
        let is_in_range = end.t.cmp_f64(ray.t_min) != Ordering::Less
            && end.t.cmp_f64(ray.t_max) != Ordering::Greater;
        is_in_range.then(|| TrueHit {
            t: end.t.value(),
            part,
            crossing,
        })
    };
    let entry = match lies_on.filter(|part| has(*part)) {
        Some(part)
            if enter.t.cmp_f64(ray.t_min) == Ordering::Less
                && leave.t.cmp_f64(ray.t_min) == Ordering::Greater
                && ray.t_min <= ray.t_max =>
        {
            Some(TrueHit {
                t: exact(ray.t_min),
                part,
                crossing: Crossing::Enter,
            })
        }
        _ => hit(enter, Crossing::Enter),
    };
    entry
        .into_iter()
        .chain(hit(leave, Crossing::Leave))
        .collect()
}
