//! Whether an answer agrees with the bounds of all solids.

use std::collections::HashMap;

use cyltrace::math::Ray;

use super::sandwich::Interval;
use super::seen::Seen;
use super::surface::{WrongSurface, wrong_surface};
use crate::bounding_meshes::window::Window;
use crate::reported_hit::{Place, ReportedHit};

/// The solids of a window by their paths in the scene.
pub(crate) struct Directory<'a> {
    window: &'a Window,
    /// The numbers of the frames by path; then the solids by frame and
    /// primitive.
    frames: HashMap<&'a [u32], u32>,
    solids: HashMap<(u32, u32), u32>,
}

impl<'a> Directory<'a> {
    /// The directory of a window.
    pub fn new(window: &'a Window) -> Self {
        let mut frames = HashMap::new();
        let mut solids = HashMap::with_capacity(window.solids.len());
        for (number, solid) in window.solids.iter().enumerate() {
            let next = frames.len() as u32;
            let path = solid.frame.instance.as_slice();
            let frame = *frames.entry(path).or_insert(next);
            // The leaves of a composition have its number; the first represents it.
            let leaf = number as u32;
            solids.entry((frame, solid.primitive)).or_insert(leaf);
        }
        Self {
            window,
            frames,
            solids,
        }
    }

    /// The position of a solid in the window.
    pub fn find(&self, place: &Place) -> Option<u32> {
        let frame = self.frames.get(place.instance.as_slice())?;
        self.solids.get(&(*frame, place.primitive)).copied()
    }
}

/// What is wrong with an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wrong {
    /// A miss, but there is a hit within the bounds.
    Missed(Interval),
    /// A hit, but there is none.
    Nothing,
    /// A hit outside of the range of the ray.
    Range,
    /// A hit before or after where the first one can be.
    Outside(Interval),
    /// A hit of a solid that is not in the scene, or that the ray misses.
    Place,
    /// A hit of a solid outside of that solid's bounds.
    Solid(Interval),
    /// The part or the normal.
    Surface(WrongSurface, Interval),
}

impl Wrong {
    /// The bounds that are broken.
    pub fn allowed(&self) -> (f64, f64) {
        match self {
            Self::Missed(bounds)
            | Self::Outside(bounds)
            | Self::Solid(bounds)
            | Self::Surface(_, bounds) => (bounds.low, bounds.high),
            Self::Nothing | Self::Place | Self::Range => (f64::INFINITY, f64::INFINITY),
        }
    }

    /// Whether `t` is right and the part or normal is not.
    pub fn is_surface(&self) -> bool {
        matches!(self, Self::Surface(..))
    }
}

/// The bounds of the scene's first hit.
pub(crate) fn first(seen: &[Seen]) -> Interval {
    seen.iter().fold(Interval::NOTHING, |first, solid| {
        first.first(solid.bounds.interval)
    })
}

/// The solid of an answer: the one it names, or of those whose
/// bounds allow its `t` the one with the least lower bound.
pub(crate) fn solid_of<'s>(
    directory: &Directory,
    finding: &ReportedHit,
    seen: &'s [Seen],
) -> Option<&'s Seen> {
    if let Some(place) = &finding.place {
        let solid = directory.find(place)?;
        return seen.iter().find(|one| one.solid == solid);
    }
    candidates(finding.t, seen).min_by(|one, other| {
        one.bounds
            .interval
            .low
            .total_cmp(&other.bounds.interval.low)
    })
}

fn candidates(t: f64, seen: &[Seen]) -> impl Iterator<Item = &Seen> {
    seen.iter()
        .filter(move |one| one.bounds.interval.allows(Some(t), f64::INFINITY))
}

/// What is wrong with an answer; `None` if it is right.
pub(crate) fn judge(
    directory: &Directory,
    ray: &Ray,
    answer: Option<&ReportedHit>,
    seen: &[Seen],
) -> Option<Wrong> {
    let bounds = first(seen);
    let Some(finding) = answer else {
        return (!bounds.allows(None, ray.t_max)).then_some(Wrong::Missed(bounds));
    };
    let t = finding.t;
    if !(ray.t_min <= t && t <= ray.t_max) {
        return Some(Wrong::Range);
    }
    if bounds.low > ray.t_max {
        return Some(Wrong::Nothing);
    }
    if !bounds.allows(Some(t), ray.t_max) {
        return Some(Wrong::Outside(bounds));
    }
    let part = finding.place.as_ref().map(|place| place.part);
    let surface = |one: &Seen| {
        let interval = one.bounds.interval;
        let last = interval.high.min(one.bounds.last).max(interval.low);
        let (window, range) = (directory.window, (interval.low, last));
        let wrong = wrong_surface(window, one.solid, ray, range, part, finding.normal)?;
        Some(Wrong::Surface(wrong, interval))
    };
    if finding.place.is_some() {
        let Some(named) = solid_of(directory, finding, seen) else {
            return Some(Wrong::Place);
        };
        if !named.bounds.interval.allows(Some(t), f64::INFINITY) {
            return Some(Wrong::Solid(named.bounds.interval));
        }
        return surface(named);
    }
    finding.normal?;
    // The normal may be that of any solid whose bounds allow `t`.
    let mut wrong = None;
    for one in candidates(t, seen) {
        match surface(one) {
            None => return None,
            found => wrong = found,
        }
    }
    wrong
}
