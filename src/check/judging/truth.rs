//! Answers against the exact oracle, on a sample.
//!
//! An intersector computes in f64 and cannot be right to the last digit. It is
//! taken to be right if it answers for the scene with every solid displaced by
//! at most `δ` in its own space: [`LEEWAY`] times what taking the ray to that
//! space rounds (`surface`), at the farthest point of the solid. The cylinder
//! with `δ` added to the radius and at both ends holds everything within `δ` of
//! the solid, the one with `δ` taken away is held by whatever is displaced by
//! `δ`. So they stand for the outer and the inner prism, with exact first hits
//! in place of triangles, and the same bounds follow (`sandwich`).
//!
//! A crossing of a tube is certain if its height is more than `2 δ` from the
//! missing discs. A ray that comes in through one and goes out through another
//! has no upper bound: that it misses is not certain to the sandwich.

use crate::math::Ray;
use crate::oracle::{self, ExactAffine};
use crate::solid::{Caps, Crossing, Cylinder};

use super::sandwich::{Crossings, Interval, solid_bounds};
use super::surface::LocalRay;
use crate::check::finding::Finding;
use crate::check::prisms::meshes::may_meet;
use crate::check::prisms::placed::{PlacedSolid, Window};
use crate::check::telling::words::instance_text;

/// Roundings of the ray that an intersector may make up for one of ours: a
/// solver has some 30 operations from the ray to `t`.
const LEEWAY: f64 = 32.0;

/// The bounds of the scene's first hit; `None` if a solid is too small for its
/// distance to be displaced.
pub(crate) fn bounds(window: &Window, ray: &Ray) -> Option<Interval> {
    let mut first = Interval::NOTHING;
    for solid in candidates(window, ray) {
        first = first.first(displaced_bounds(solid, ray)?);
    }
    Some(first)
}

/// The true answer, in words.
pub(crate) fn in_words(window: &Window, ray: &Ray) -> String {
    let hits = candidates(window, ray).filter_map(|solid| {
        let truth = oracle::placed_first_hit(&solid.cylinder, &solid.frame.exact, ray);
        Some((solid, truth.hit?))
    });
    let first = hits.min_by(|(_, one), (_, other)| one.t.cmp(&other.t));
    match first {
        None => String::from("truly a miss"),
        Some((solid, hit)) => format!(
            "truly t {:?} on {} of cylinder {} of {}",
            hit.t_f64(),
            hit.part.name(),
            solid.primitive,
            instance_text(&solid.frame.instance)
        ),
    }
}

/// Whether bounds allow an answer.
pub(crate) fn allows(bounds: &Interval, ray: &Ray, answer: Option<&Finding>) -> bool {
    bounds.allows(answer.map(|finding| finding.t), ray.t_max)
}

fn candidates<'a>(window: &'a Window, ray: &'a Ray) -> impl Iterator<Item = &'a PlacedSolid> {
    // A ray that passes this near to a box may, displaced, meet its solid.
    const NEAR: f64 = 1e-12;
    let farthest = ray.origin.abs().max_element();
    window.solids.iter().filter(move |solid| {
        let bounds = solid.bounds();
        let size = bounds.lower.abs().max(bounds.upper.abs()).max_element() + farthest;
        may_meet(&bounds.grown(NEAR * size), ray)
    })
}

fn displaced_bounds(solid: &PlacedSolid, ray: &Ray) -> Option<Interval> {
    let cylinder = &solid.cylinder;
    let local = LocalRay::new(solid, ray);
    let leeway = LEEWAY * local.rounding_at_solid();
    let grown = displaced(cylinder, leeway)?;
    let shrunk = displaced(cylinder, -leeway)?;
    let endless = Ray {
        t_max: f64::INFINITY,
        ..*ray
    };
    let [outer, inner] =
        [grown, shrunk].map(|cylinder| crossings(&cylinder, &solid.frame.exact, &endless));
    let is_certain = |t: f64| {
        cylinder.caps() == Caps::Both || (t.is_finite() && local.is_between_ends(t, 2.0 * leeway))
    };
    let Interval { low, high } = solid_bounds(&outer, &inner, ray.t_min, is_certain).interval;
    // The parameters were rounded to nearest.
    Some(Interval {
        low: if low.is_finite() {
            low.next_down()
        } else {
            low
        },
        high: high.next_up(),
    })
}

fn displaced(cylinder: &Cylinder, outward: f64) -> Option<Cylinder> {
    let (p0, p1) = (cylinder.p0(), cylinder.p1());
    let along = (p1 - p0).normalize() * outward;
    let radius = cylinder.radius() + outward;
    let is_left = radius > 0.5 * cylinder.radius() && 2.0 * (p1 - p0).length() > -8.0 * outward;
    is_left
        .then(|| Cylinder::new(p0 - along, p1 + along, radius, Caps::Both).ok())
        .flatten()
}

/// Where the ray enters a capped cylinder and where it leaves it. The exit is
/// looked for from the next f64 on.
fn crossings(cylinder: &Cylinder, placement: &ExactAffine, ray: &Ray) -> Crossings {
    let mut crossings = Crossings::NONE;
    let first = |ray: &Ray| oracle::placed_first_hit(cylinder, placement, ray).hit;
    let Some(hit) = first(ray) else {
        return crossings;
    };
    crossings.add(hit.t_f64(), hit.crossing == Crossing::Enter);
    if hit.crossing == Crossing::Enter {
        let t_min = hit.t_f64().next_up();
        if let Some(exit) = first(&Ray { t_min, ..*ray }) {
            crossings.add(exit.t_f64(), exit.crossing == Crossing::Enter);
        }
    }
    crossings
}
