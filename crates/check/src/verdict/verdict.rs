//! The verdict on one answer: by what Embree sees, and exactly where that is
//! not enough.

use std::f64::consts::PI;

use cyltrace::embree::Ray32;
use cyltrace::math::Ray;

use super::exact_recheck::retry;
use super::judge::{Directory, Wrong, first, judge, solid_of};
use super::sandwich::LATER;
use super::surface::LocalRay;
use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::meshes::{Meshes, Scratch, Seen, may_meet};
use crate::bounding_meshes::window::Window;
use crate::finding::ReportedHit;
use crate::rays::RaySource;
use crate::tally::Tally;

/// How far beyond an answer is looked for the bounds of its solid, in sagittas: the
/// inscribed prism is met within so many where the ray is at more than 4° to
/// the wall.
const SAGITTAS_BEYOND: f64 = 16.0;

/// A window and what belongs to it.
pub(crate) struct Subject<'a> {
    pub number: u64,
    pub window: &'a Window,
    pub frame: &'a MeshFrame,
    pub source: &'a RaySource<'a>,
    pub directory: Directory<'a>,
}

impl<'a> Subject<'a> {
    pub fn new(
        number: u64,
        window: &'a Window,
        frame: &'a MeshFrame,
        source: &'a RaySource<'a>,
    ) -> Self {
        Self {
            number,
            window,
            frame,
            source,
            directory: Directory::new(window),
        }
    }
}

/// What both meshes say of an answer.
pub(crate) enum Verdict {
    /// Nothing bounds this ray's hits.
    Unwitnessed,
    /// Within the bounds.
    Right {
        /// Whether a hit and a miss are both allowed.
        is_band: bool,
        /// Whether that is for want of an inscribed prism.
        is_for_want: bool,
        /// Whether it took exact arithmetic, for an error of Embree's.
        is_cleared: bool,
    },
    /// Outside of the exact bounds.
    Wrong(Wrong),
}

impl Verdict {
    /// Counts it.
    pub fn count(&self, tally: &mut Tally) {
        match self {
            Self::Unwitnessed => tally.unwitnessed += 1,
            Self::Right {
                is_band,
                is_for_want,
                is_cleared,
            } => {
                tally.unwitnessed += u64::from(*is_for_want);
                tally.band += u64::from(*is_band && !is_for_want);
                tally.witnessed += u64::from(!is_band);
                tally.triangle_errors += u64::from(*is_cleared);
            }
            Self::Wrong(wrong) => {
                tally.witnessed += 1;
                tally.violations += 1;
                tally.wrong_normals += u64::from(wrong.is_surface());
            }
        }
    }
}

/// Judges an answer by what Embree sees, and if it is suspect, exactly. What was
/// seen, or found exactly, is left in `scratch.seen`.
pub(crate) fn verdict(
    about: &Subject,
    meshes: &Meshes,
    ray32: &Ray32,
    ray: &Ray,
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
        && is_settled(about, meshes, ray32, ray, finding, scratch)
    {
        return Verdict::Right {
            is_band: first(&scratch.seen).is_open(ray.t_max),
            is_for_want: false,
            is_cleared: false,
        };
    }
    meshes.look(ray32, f32::INFINITY, scratch);
    let is_odd = scratch.seen.iter().any(|seen| seen.bounds.is_odd);
    let is_suspect = is_odd || judge(&about.directory, ray, answer, &scratch.seen).is_some();
    if is_suspect {
        scratch.seen = retry(meshes, ray32, ray);
        if let Some(wrong) = judge(&about.directory, ray, answer, &scratch.seen) {
            return Verdict::Wrong(wrong);
        }
    }
    let bounds = first(&scratch.seen);
    let is_band = bounds.is_open(ray.t_max);
    let lacks_inner =
        |seen: &Seen| seen.bounds.interval.low <= ray.t_max && !meshes.has_inner(seen.solid);
    Verdict::Right {
        is_band,
        is_for_want: is_band && scratch.seen.iter().any(lacks_inner),
        is_cleared: is_suspect,
    }
}

/// Whether an answer that names its solid agrees with what the ray meets up to a
/// little beyond it, where the solid itself has its upper bound. Most of what the
/// whole ray meets in a deep scene lies farther.
fn is_settled(
    about: &Subject,
    meshes: &Meshes,
    ray32: &Ray32,
    ray: &Ray,
    finding: &ReportedHit,
    scratch: &mut Scratch,
) -> bool {
    let place = finding.place.as_ref();
    let Some(solid) = place.and_then(|place| about.directory.find(place)) else {
        return false;
    };
    if meshes.is_composed(solid) {
        return false;
    }
    let local = LocalRay::new(&about.window.solids[solid as usize], ray);
    let sagitta = 1.0 - libm::cos(PI / f64::from(meshes.segments));
    let beyond = SAGITTAS_BEYOND * sagitta / local.radii(1.0);
    let up_to = (finding.t + beyond) as f32;
    if !(finding.t < f64::from(up_to)) {
        return false;
    }
    meshes.look(ray32, up_to, scratch);
    let mut seen = scratch.seen.iter();
    if seen.any(|seen| seen.bounds.is_odd || meshes.is_composed(seen.solid)) {
        return false;
    }
    let has_high = solid_of(&about.directory, finding, &scratch.seen)
        .is_some_and(|seen| seen.bounds.interval.high < LATER);
    has_high && judge(&about.directory, ray, Some(finding), &scratch.seen).is_none()
}
