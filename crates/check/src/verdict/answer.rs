//! The verdict on one answer: by the crossings that Embree finds, and by exact ones for
//! suspects.

use std::f64::consts::PI;

use cyltrace::embree::Ray32;
use cyltrace::math::Ray;

use super::exact_recheck::exact_seen;
use super::judge::{Directory, Wrong, first, judge, solid_of};
use super::seen::{Scratch, Seen, look};
use super::surface::LocalRay;
use crate::bounding_meshes::crossings::LATER;
use crate::bounding_meshes::meshes::{Meshes, may_meet};
use crate::outcome::Row;
use crate::reported_hit::ReportedHit;

/// The distance beyond an answer up to which the ray is traced for the bounds of its solid,
/// in sagittas. A ray at more than 4° to the wall enters the inscribed mesh within it.
const SAGITTAS_BEYOND: f64 = 16.0;

/// What the meshes prove about an answer.
pub(crate) enum Verdict {
    /// Nothing bounds this ray's hits.
    Unwitnessed,
    /// Within the bounds.
    Right {
        /// Whether a hit and a miss are both allowed.
        is_band: bool,
        /// Whether that is because an inscribed mesh is missing.
        lacks_inner: bool,
        /// Whether Embree's triangle test contradicts the answer and exact arithmetic
        /// confirms it.
        is_cleared: bool,
    },
    /// Outside of the exact bounds.
    Wrong(Wrong),
}

impl Verdict {
    /// Counts it in a row.
    pub fn count(&self, row: &mut Row) {
        match self {
            Self::Unwitnessed => row.unwitnessed += 1,
            Self::Right {
                is_band,
                lacks_inner,
                is_cleared,
            } => {
                row.unwitnessed += u64::from(*lacks_inner);
                row.band += u64::from(*is_band && !lacks_inner);
                row.witnessed += u64::from(!is_band);
                row.triangle_errors += u64::from(*is_cleared);
            }
            Self::Wrong(wrong) => {
                row.witnessed += 1;
                row.violations += 1;
                row.wrong_normals += u64::from(wrong.is_surface());
            }
        }
    }
}

/// Judges an answer by the crossings that Embree finds and, if it is a suspect, by exact
/// ones. The bounds of all solids are left in `scratch.seen`.
pub(crate) fn verdict(
    directory: &Directory,
    meshes: &Meshes,
    (ray32, ray): (&Ray32, &Ray),
    answer: Option<&ReportedHit>,
    scratch: &mut Scratch,
) -> Verdict {
    let unbounded = meshes.unbounded().iter();
    if unbounded
        .copied()
        .any(|solid| may_meet(&meshes.boxes[solid as usize], ray))
    {
        return Verdict::Unwitnessed;
    }
    if let Some(finding) = answer
        && is_settled(directory, meshes, (ray32, ray), finding, scratch)
    {
        return Verdict::Right {
            is_band: first(&scratch.seen).is_open(ray.t_max),
            lacks_inner: false,
            is_cleared: false,
        };
    }
    look(meshes, ray32, f32::INFINITY, scratch);
    let is_odd = scratch.seen.iter().any(|seen| seen.bounds.is_odd);
    let is_suspect = is_odd || judge(directory, ray, answer, &scratch.seen).is_some();
    if is_suspect {
        scratch.seen = exact_seen(meshes, ray32, ray);
        if let Some(wrong) = judge(directory, ray, answer, &scratch.seen) {
            return Verdict::Wrong(wrong);
        }
    }
    let bounds = first(&scratch.seen);
    let is_band = bounds.is_open(ray.t_max);
    let has_no_inner =
        |seen: &Seen| seen.bounds.interval.low <= ray.t_max && !meshes.has_inner(seen.solid);
    Verdict::Right {
        is_band,
        lacks_inner: is_band && scratch.seen.iter().any(has_no_inner),
        is_cleared: is_suspect,
    }
}

/// Whether an answer that names its solid agrees with the crossings up to a
/// little beyond it, where the solid itself has its upper bound. In a deep scene most
/// crossings of the whole ray lie farther.
fn is_settled(
    directory: &Directory,
    meshes: &Meshes,
    (ray32, ray): (&Ray32, &Ray),
    finding: &ReportedHit,
    scratch: &mut Scratch,
) -> bool {
    let place = finding.place.as_ref();
    let Some(solid) = place.and_then(|place| directory.find(place)) else {
        return false;
    };
    if meshes.is_composed(solid) {
        return false;
    }
    let local = LocalRay::new(&meshes.window.solids[solid as usize], ray);
    let sagitta = 1.0 - libm::cos(PI / f64::from(meshes.segments));
    let beyond = SAGITTAS_BEYOND * sagitta / local.radii(1.0);
    let up_to = (finding.t + beyond) as f32;
    if !(finding.t < f64::from(up_to)) {
        return false;
    }
    look(meshes, ray32, up_to, scratch);
    let mut seen = scratch.seen.iter();
    if seen.any(|seen| seen.bounds.is_odd || meshes.is_composed(seen.solid)) {
        return false;
    }
    let has_high = solid_of(directory, finding, &scratch.seen)
        .is_some_and(|seen| seen.bounds.interval.high < LATER);
    has_high && judge(directory, ray, Some(finding), &scratch.seen).is_none()
}
