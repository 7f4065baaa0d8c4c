//! What a line meets of a composition.
//!
//! Each leaf is met in one interval of `t`, its [`Chord`]. All ends of all chords, in
//! order, are the *stations* of the line. Between two stations nothing changes, and a
//! leaf has the line inside, outside or, where the line runs within the leaf's
//! surface, on the boundary. The tree of operations says which of the three the
//! composition has there, as it says for points. Where what is before a station
//! belongs to the composition and what is behind it does not, or the other way
//! round, the line crosses the surface. So entries and exits alternate, and:
//!
//! - **Nothing of no length is left.** What ends where another thing begins is not
//!   kept as a point: a block without itself is empty, two blocks side by side are
//!   one for a line across the face that they share, and have nothing in common.
//! - **Tangents count.** Where the line touches a leaf in a point, and the point is of
//!   the composition's surface, it is met twice at the same `t`: an entry and an exit,
//!   or for a hole an exit and an entry.
//! - **A line within a face** follows the sets themselves: what is subtracted takes
//!   away its open inside only.
//!
//! A crossing has the `t` and the part of its leaf, bit for bit.
//!
//! **Stations that are one.** Faces are meant to coincide (a bore as long as its block),
//! but the numbers that state turned ones are rounded, and so is each leaf's `t`. A
//! solver's answer is exact for solids and rays displaced by at most
//! [`SOLVER_DISPLACEMENT`] times the sizes that it sees ([`spawn`](super::super::spawn)),
//! and rounding the numbers of a turned solid moves it by a few u of its coordinates,
//! which are among these sizes. A plane displaced by δ is met elsewhere by `δ / |n·d|`,
//! `n` its unit normal. So two ends are one station if
//!
//! ```text
//! |t - t'| |n·d| <= 2 δ, δ the greater of both                             (1)
//! ```
//!
//! with the normal that has the greater `|n·d|`: of parallel faces either. What
//! (1) passes over is thinner than what displacements can make or remove. Normals are
//! worked out only where (1) may hold at an angle that is not below 2^-26.

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::super::spawn::SOLVER_DISPLACEMENT;
use super::Composition;
use super::change::Change;
use crate::math::power_of_two;
use crate::solid::{AnySolid, Chord, ChordEnd, Crossing, Location, Meeting};

/// A point where a ray meets a composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComposedMeeting {
    /// The point, the part being that of the leaf.
    pub meeting: Meeting,
    /// Whose surface is met, a position in [`Composition::operands`].
    pub leaf: u32,
    /// The number of the crossing on the whole line, whatever the ray's range. It
    /// orders what is met at the same `t`.
    pub rank: u32,
}

impl Composition {
    /// The points at which a ray is on the surface, among those with `t_min <= t +
    /// shift <= t_max`, in order.
    ///
    /// `origin_from` answers with the ray's origin as seen from an anchor. The
    /// range, `shift` and the direction are as for
    /// [`ConvexSolid::first`](crate::solid::ConvexSolid::first).
    pub fn meetings(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        [t_min, t_max]: [f64; 2],
        mut keep: impl FnMut(ComposedMeeting),
    ) {
        let range = [t_min, t_max];
        self.each_meeting(origin_from, direction, shift, range, |met| {
            keep(met);
            false
        });
    }

    /// The first of [`Composition::meetings`].
    #[must_use]
    pub fn first(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        range: [f64; 2],
    ) -> Option<ComposedMeeting> {
        let mut first = None;
        self.each_meeting(origin_from, direction, shift, range, |met| {
            first = Some(met);
            true
        });
        first
    }

    /// Hands on the meetings until it is told that it is enough.
    fn each_meeting(
        &self,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
        shift: f64,
        [t_min, t_max]: [f64; 2],
        mut is_enough: impl FnMut(ComposedMeeting) -> bool,
    ) {
        let mut line = Line::new(self, origin_from, direction);
        let stations = line.find_stations(direction);
        let mut rank = 0;
        let mut passed = f64::NEG_INFINITY;
        for station in 0..stations {
            let change = line.change(self, station);
            let (leaf, crossings) = match change.mark {
                Some(leaf) => (leaf, line.leaves[leaf as usize].crossings(change, station)),
                None => (0, SmallVec::new()),
            };
            let begins = line.range_of(station);
            // A line within the surface is on it all the way.
            if change.before == Location::Boundary
                && passed < t_min - shift
                && t_min - shift < begins.start
                && t_min <= t_max
                && let Some((leaf, met)) = line.start_within(station, shift, t_min)
            {
                let met = ComposedMeeting {
                    meeting: met,
                    leaf,
                    rank: 0,
                };
                if is_enough(met) {
                    return;
                }
            }
            for (crossing, end) in crossings {
                rank += 1;
                let t = end.t + shift;
                let met = ComposedMeeting {
                    meeting: Meeting {
                        t,
                        t_local: end.t,
                        part: end.part,
                        crossing,
                    },
                    leaf,
                    rank,
                };
                if t_min <= t && t <= t_max && is_enough(met) {
                    return;
                }
            }
            passed = begins.end;
        }
    }
}

/// A leaf and where the line is inside it.
struct Leaf<'a> {
    solid: &'a AnySolid,
    from_anchor: DVec3,
    chord: Option<Chord>,
    /// The stations of the chord's two ends.
    stations: [usize; 2],
}

impl Leaf<'_> {
    fn end(&self, is_exit: bool) -> Option<&ChordEnd> {
        let chord = self.chord.as_ref()?;
        Some(if is_exit { &chord.leave } else { &chord.enter })
    }

    /// What of the leaf the line is in, between the ends of the chord.
    fn within(chord: &Chord) -> Location {
        match chord.lies_on {
            Some(_) => Location::Boundary,
            None => Location::Inside,
        }
    }

    fn change(&self, leaf: u32, station: usize) -> Change {
        let [enter, leave] = self.stations;
        let within = self.chord.as_ref().map(Self::within);
        let Some(within) = within.filter(|_| (enter..=leave).contains(&station)) else {
            return Change::NONE;
        };
        let at = |is_within| {
            if is_within { within } else { Location::Outside }
        };
        let is_end = station == enter || station == leave;
        Change {
            before: at(station > enter),
            after: at(station < leave),
            mark: is_end.then_some(leaf),
        }
    }

    /// The crossings of the surface that a change makes, at the ends of the chord.
    fn crossings(&self, change: Change, station: usize) -> SmallVec<[(Crossing, ChordEnd); 2]> {
        let mut is_held = change.before.is_held();
        if !change.is_touched() && is_held == change.after.is_held() {
            // From the surface to the inside.
            return SmallVec::new();
        }
        let ends = [false, true].into_iter().filter_map(|is_exit| {
            let is_here = self.stations[usize::from(is_exit)] == station;
            self.end(is_exit).filter(|_| is_here).copied()
        });
        ends.map(|end| {
            is_held = !is_held;
            let crossing = if is_held {
                Crossing::Enter
            } else {
                Crossing::Leave
            };
            (crossing, end)
        })
        .collect()
    }

    /// Bounds how far solid and line may be displaced.
    fn displacement(&self) -> f64 {
        let anchor = self.solid.anchor().length();
        SOLVER_DISPLACEMENT * (self.from_anchor.length() + anchor + self.solid.size())
    }

    /// `|n·d|` at one of the chord's ends.
    fn steepness(&self, end: &ChordEnd, direction: DVec3) -> f64 {
        let from_anchor = self.from_anchor + direction * end.t;
        let surface = self.solid.surface_point(end.part, from_anchor);
        surface.normal.dot(direction).abs()
    }
}

/// An end of a leaf's chord.
#[derive(Clone, Copy)]
struct Event {
    t: f64,
    leaf: u32,
    is_exit: bool,
}

/// The line through all leaves.
struct Line<'a> {
    leaves: SmallVec<[Leaf<'a>; 8]>,
    /// In order of `t`.
    events: SmallVec<[Event; 16]>,
    /// The events of each station.
    stations: SmallVec<[Range<usize>; 16]>,
}

impl<'a> Line<'a> {
    fn new(
        composition: &'a Composition,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
    ) -> Self {
        let mut line = Self {
            leaves: SmallVec::new(),
            events: SmallVec::new(),
            stations: SmallVec::new(),
        };
        composition.for_each_leaf(false, &mut |solid, _| {
            let from_anchor = origin_from(solid.anchor());
            let chord = solid.chord(from_anchor, direction);
            let leaf = line.leaves.len() as u32;
            if let Some(chord) = &chord {
                for (t, is_exit) in [(chord.enter.t, false), (chord.leave.t, true)] {
                    line.events.push(Event { t, leaf, is_exit });
                }
            }
            line.leaves.push(Leaf {
                solid,
                from_anchor,
                chord,
                stations: [0; 2],
            });
        });
        line
    }

    /// Puts the ends in order and finds out which are one station; answers with the
    /// number of stations.
    fn find_stations(&mut self, direction: DVec3) -> usize {
        self.events
            .sort_unstable_by(|one, other| one.t.total_cmp(&other.t));
        for position in 0..self.events.len() {
            let is_same = position > 0 && self.are_one(position - 1, position, direction);
            match self.stations.last_mut() {
                Some(station) if is_same => station.end = position + 1,
                _ => self.stations.push(position..position + 1),
            }
            let event = self.events[position];
            self.leaves[event.leaf as usize].stations[usize::from(event.is_exit)] =
                self.stations.len() - 1;
        }
        self.stations.len()
    }

    /// Whether (1) holds for two events.
    fn are_one(&self, one: usize, other: usize, direction: DVec3) -> bool {
        let events = [one, other].map(|position| self.events[position]);
        let apart = events[1].t - events[0].t;
        if apart == 0.0 {
            return true;
        }
        let leaves = events.map(|event| &self.leaves[event.leaf as usize]);
        let [one, other] = leaves.map(Leaf::displacement);
        let allowed = 2.0 * one.max(other);
        if apart * direction.length() > allowed * power_of_two(26) {
            return false;
        }
        let steepest = events
            .iter()
            .zip(leaves)
            .filter_map(|(event, leaf)| Some(leaf.steepness(leaf.end(event.is_exit)?, direction)))
            .fold(0.0, f64::max);
        apart * steepest <= allowed
    }

    /// The least and the greatest `t` of a station.
    fn range_of(&self, station: usize) -> Range<f64> {
        let Range { start, end } = self.stations[station];
        self.events[start].t..self.events[end - 1].t
    }

    /// What of the composition the line is in before and behind a station.
    fn change(&self, composition: &Composition, station: usize) -> Change {
        let mut next = 0;
        Change::of(composition, &mut || {
            let leaf = next;
            next += 1;
            self.leaves[leaf as usize].change(leaf, station)
        })
    }

    /// The meeting where the range of a ray starts that runs within the surface
    /// up to a station: with the first leaf in whose surface it runs.
    fn start_within(&self, station: usize, shift: f64, t_min: f64) -> Option<(u32, Meeting)> {
        let mut leaves = self.leaves.iter().enumerate();
        leaves.find_map(|(index, leaf)| {
            let [enter, leave] = leaf.stations;
            let part = leaf.chord.as_ref()?.lies_on?;
            (enter < station && station <= leave).then_some((
                index as u32,
                Meeting {
                    t: t_min,
                    t_local: t_min - shift,
                    part,
                    crossing: Crossing::Enter,
                },
            ))
        })
    }
}
