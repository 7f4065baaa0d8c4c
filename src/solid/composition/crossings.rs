//! The crossings of a line with the surface of a composition.
//!
//! The composition is a closed set that contains closed intervals of the line. Each interval
//! begins with an entry and ends with an exit; `line.rs` classifies the stretches before and
//! after each station. Where the line is outside on both sides, or inside on both, the
//! neighbourhood of the point decides whether it is a *touch*. From outside, the point is an
//! interval of its own: an entry and an exit. From inside, where the point is not interior to
//! the set, it is an exit and an entry. A change from the surface to the inside is no crossing.
//!
//! A crossing has the `t` and the part of a leaf, bit for bit: of the first leaf whose chord
//! ends there and whose surface is the composition's surface there, if such a leaf exists. The
//! normal points out of the composition, whichever side of the leaf that is.

use glam::DVec3;
use smallvec::{SmallVec, smallvec};

use super::Composition;
use super::line::{Line, Stretch};
use super::neighbourhood::{Face, Neighbourhood};
use crate::solid::Crossing::{self, Enter, Leave};
use crate::solid::{ChordEnd, Intersection, Location};

/// An intersection of a ray and a composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComposedIntersection {
    /// The point, with the part of the leaf.
    pub intersection: Intersection,
    /// The operand with this surface, as a position in [`Composition::operands`].
    pub leaf: u32,
    /// Whether the composition is on the outer side of the leaf's surface, so that its normal
    /// is the leaf's reversed.
    pub is_reversed: bool,
    /// The number of the crossing on the whole line, independent of the ray's range. It
    /// orders crossings at the same `t`.
    pub rank: u32,
}

impl Composition {
    /// The intersections of a ray with the surface with `t_min <= t + shift <= t_max`, in
    /// order.
    ///
    /// `origin_from` returns the ray's origin relative to an anchor. The range, `shift` and the
    /// direction are as for [`ConvexSolid::first`](crate::solid::ConvexSolid::first).
    pub fn intersections(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        [t_min, t_max]: [f64; 2],
        mut keep: impl FnMut(ComposedIntersection),
    ) {
        let range = [t_min, t_max];
        self.for_each_hit(origin_from, direction, shift, range, |hit| {
            keep(hit);
            false
        });
    }

    /// The first of [`Composition::intersections`].
    #[must_use]
    pub fn first(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        range: [f64; 2],
    ) -> Option<ComposedIntersection> {
        let mut first = None;
        self.for_each_hit(origin_from, direction, shift, range, |hit| {
            first = Some(hit);
            true
        });
        first
    }

    /// Passes the intersections to `is_enough` until it returns true.
    fn for_each_hit(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        [t_min, t_max]: [f64; 2],
        mut is_enough: impl FnMut(ComposedIntersection) -> bool,
    ) {
        let line = Line::new(self, origin_from, direction);
        let mut rank = 0;
        let mut before = Stretch::OUTSIDE;
        let mut passed = f64::NEG_INFINITY;
        for station in 0..line.stations() {
            let (begins, behind) = (line.range_of(station), line.behind(station));
            if before.location == Location::Boundary && t_min <= t_max {
                let start = t_min - shift;
                let is_between = passed < start && start < begins.start;
                let is_here = begins.start <= start && start <= begins.end;
                let continues = behind.location == Location::Boundary;
                if (is_between || is_here && continues)
                    && let Some(hit) = start_within(&line, &before, shift, t_min)
                    && is_enough(hit)
                {
                    return;
                }
            }
            for (face, crossing, end) in crossings(&line, station, &before, &behind) {
                rank += 1;
                let t = end.t + shift;
                let hit = ComposedIntersection {
                    intersection: Intersection {
                        t,
                        t_local: end.t,
                        part: face.part,
                        crossing,
                    },
                    leaf: face.leaf,
                    is_reversed: face.is_reversed,
                    rank,
                };
                if t_min <= t && t <= t_max && is_enough(hit) {
                    return;
                }
            }
            (before, passed) = (behind, begins.end);
        }
    }
}

/// The intersection at the start of the range of a ray that runs within the surface: with the
/// first leaf that has the surface. If the ray starts at a station, it is a face of the stretch
/// before, which reaches up to the station.
fn start_within(
    line: &Line,
    before: &Stretch,
    shift: f64,
    t_min: f64,
) -> Option<ComposedIntersection> {
    let faces = before.within.as_ref()?.faces.iter();
    let face = faces.min_by_key(|face| (face.leaf, line.lies_on(face.leaf) != Some(face.part)))?;
    Some(ComposedIntersection {
        intersection: Intersection {
            t: t_min,
            t_local: t_min - shift,
            part: face.part,
            crossing: Enter,
        },
        leaf: face.leaf,
        is_reversed: face.is_reversed,
        rank: 0,
    })
}

/// The crossings at a station, each with the face that is crossed and a point of the line.
fn crossings(
    line: &Line,
    station: usize,
    before: &Stretch,
    behind: &Stretch,
) -> SmallVec<[(Face, Crossing, ChordEnd); 2]> {
    use Location::{Inside, Outside};
    // Where only one leaf is entered or left, the stretches before and behind decide.
    if let Some((leaf, end, enters)) = line.only_change_at(station) {
        if before.location == behind.location {
            return SmallVec::new();
        }
        let is_inside = behind.location == Inside;
        let face = Face {
            leaf,
            part: end.part,
            is_reversed: enters != is_inside,
        };
        return smallvec![(face, if is_inside { Enter } else { Leave }, end)];
    }
    let touched = line.touched_at(station);
    let around = || line.around_station(station, &touched);
    let (around, crossings): (_, SmallVec<[Crossing; 2]>) = match (before.location, behind.location)
    {
        (Outside, Outside) => {
            let around = around();
            let crossings = if around.has_inside {
                smallvec![Enter, Leave]
            } else {
                smallvec![]
            };
            (around, crossings)
        }
        (Inside, Inside) => {
            let around = around();
            let crossings = if around.has_outside {
                smallvec![Leave, Enter]
            } else {
                smallvec![]
            };
            (around, crossings)
        }
        (Outside, _) => (around(), smallvec![Enter]),
        (_, Outside) => (around(), smallvec![Leave]),
        // From the surface to the inside, or along the surface.
        _ => return SmallVec::new(),
    };
    let is_touch = crossings.len() > 1;
    let crossings = crossings.into_iter().enumerate();
    crossings
        .filter_map(|(position, crossing)| {
            let which = if is_touch { position } else { 0 };
            let (face, end) = face_at_end(line, station, &touched, &around, which)
                .or_else(|| face_beside(line, station, &around, [before, behind]))
                .or_else(|| any_face(line, station, &touched, crossing))?;
            Some((face, crossing, end))
        })
        .collect()
}

/// The face that is crossed at a station: that of the first leaf with a face there whose chord
/// ends there. `which` selects one of two ends of one chord.
fn face_at_end(
    line: &Line,
    station: usize,
    touched: &[u32],
    around: &Neighbourhood,
    which: usize,
) -> Option<(Face, ChordEnd)> {
    touched.iter().find_map(|&leaf| {
        let ends = line.ends_at(leaf, station);
        let end = ends.get(which).or(ends.first())?;
        let faces = around.faces.iter().filter(|face| face.leaf == leaf);
        let face = faces.min_by_key(|face| face.part != end.part)?;
        Some((*face, *end))
    })
}

/// A face that the line lies in or touches at a station, where no chord of a leaf with a face
/// ends. Where walls change places along a ruling, they have no face at that point, but beside
/// it.
fn face_beside(
    line: &Line,
    station: usize,
    around: &Neighbourhood,
    stretches: [&Stretch; 2],
) -> Option<(Face, ChordEnd)> {
    let beside = stretches.into_iter().filter_map(|one| one.within.as_ref());
    let mut around = std::iter::once(around).chain(beside);
    let face = *around.find_map(|around| around.faces.first())?;
    let end = ChordEnd {
        t: line.range_of(station).start,
        part: face.part,
        on_rim: false,
    };
    Some((face, end))
}

/// The end of a chord. It serves where the roundings of turned solids make the stretches differ
/// while no face around the station does.
fn any_face(
    line: &Line,
    station: usize,
    touched: &[u32],
    crossing: Crossing,
) -> Option<(Face, ChordEnd)> {
    touched.iter().find_map(|&leaf| {
        let end = *line.ends_at(leaf, station).first()?;
        let face = Face {
            leaf,
            part: end.part,
            is_reversed: line.has_behind(leaf, station) != (crossing == Enter),
        };
        Some((face, end))
    })
}
