//! The verdict on one answer: by what Embree sees, and exactly where that is
//! not enough.

use crate::embree::Ray32;
use crate::math::Ray;

use super::finding::Finding;
use super::judge::{Directory, Wrong, first, judge};
use super::mesh_frame::MeshFrame;
use super::meshes::{Meshes, Scratch, Seen, may_meet};
use super::placed::Window;
use super::rays::RaySource;
use super::retrial::retry;
use super::tally::Tally;

/// A window and what belongs to it.
pub(super) struct Subject<'a> {
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
pub(super) enum Verdict {
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
pub(super) fn verdict(
    about: &Subject,
    meshes: &Meshes,
    ray32: &Ray32,
    ray: &Ray,
    answer: Option<&Finding>,
    scratch: &mut Scratch,
) -> Verdict {
    let unbounded = meshes.unbounded().iter();
    if unbounded
        .copied()
        .any(|solid| may_meet(&meshes.boxes[solid as usize], ray))
    {
        return Verdict::Unwitnessed;
    }
    meshes.look(ray32, scratch);
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
