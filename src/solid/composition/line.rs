//! A line through the leaves of a composition.
//!
//! The line intersects each leaf in one interval of `t`, its [`Chord`]. The ends of all chords,
//! in order, are the *stations* of the line; the part between two is a *stretch*. Along a
//! stretch every leaf has the line inside or outside, or within its surface: in a face, along
//! an edge, or along a ruling of a wall. All points of a stretch have the same neighbourhood,
//! so one of them decides whether the composition contains it: by the formula of the operations
//! if the line is in no surface, else by the neighbourhood.
//!
//! **Walls along one ruling.** A line may be a ruling of two walls that touch along it. The
//! wall that bends more is the inner one. A wall's radius of curvature `R(t)` along a ruling is
//! linear: constant on a cylinder, proportional to the distance from the apex on a cone. Where
//! two radii become equal the walls change places, so there is another station. If they are
//! equal at two points they are equal everywhere, and the walls are one. So pieces that are
//! equal to second order along a stretch are equal.
//!
//! **Ends in one station.** Faces are meant to coincide (a bore as long as its block), but the
//! numbers of turned solids are rounded, and so is each leaf's `t`. A solver's result is exact
//! for solids and rays displaced by at most `SOLVER_DISPLACEMENT` times the sizes that it uses
//! ([`spawn`](super::super::spawn)). Rounding the numbers of a turned solid moves it by a few u
//! of its coordinates, which are among these sizes. Displacing a plane by δ moves its
//! intersection by `δ / |n·d|`, `n` its unit normal. So two ends are one station if
//!
//! ```text
//! |t - t'| |n·d| <= 2 δ, δ the greater of both                             (1)
//! ```
//!
//! with the normal of the greater `|n·d|`; of parallel faces, either. What (1) ignores is
//! thinner than what displacements can create or remove. Normals are computed only if (1) may
//! be true at an angle of at least 2^-26. `|t - t'| |n·d|` is the distance of the one point
//! from the plane of the other, so the pieces of a surface that pass through a station are
//! those within 2 δ of it (`piece.rs`).

use std::ops::Range;

use glam::DVec3;
use smallvec::SmallVec;

use super::Composition;
use super::leaf::{Event, Leaf, What};
use super::neighbourhood::Neighbourhood;
use super::piece::{Nearness, Pieces, Viewed};
use super::turned::Turned;
use crate::math::power_of_two;
use crate::solid::{ChordEnd, Location, Part};

/// The location of a stretch in the composition.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub location: Location,
    /// The neighbourhood, if the line runs within a surface.
    pub within: Option<Neighbourhood>,
}

impl Stretch {
    /// Before the first station and behind the last.
    pub const OUTSIDE: Self = Self {
        location: Location::Outside,
        within: None,
    };
}

/// The line through all leaves.
pub(super) struct Line<'a> {
    composition: &'a Composition,
    direction: DVec3,
    leaves: SmallVec<[Leaf<'a>; 8]>,
    /// In order of `t`.
    events: SmallVec<[Event; 16]>,
    /// The events of each station.
    stations: SmallVec<[Range<usize>; 16]>,
    /// Whether the line runs within the surface of a leaf.
    has_within: bool,
}

impl<'a> Line<'a> {
    pub fn new(
        composition: &'a Composition,
        origin_from: impl Fn(DVec3) -> DVec3,
        direction: DVec3,
    ) -> Self {
        let mut line = Self {
            composition,
            direction,
            leaves: SmallVec::new(),
            events: SmallVec::new(),
            stations: SmallVec::new(),
            has_within: false,
        };
        composition.for_each_leaf(false, &mut |solid, _| {
            let from_anchor = origin_from(solid.anchor());
            line.leaves.push(Leaf {
                solid,
                from_anchor,
                chord: solid.chord(from_anchor, direction),
                stations: [0; 2],
            });
        });
        composition.forget_disjoint(&mut line.leaves);
        for (leaf, Leaf { chord, .. }) in (0..).zip(&line.leaves) {
            let Some(chord) = chord else {
                continue;
            };
            line.has_within |= chord.lies_on.is_some();
            for (t, what) in [(chord.enter.t, What::Enter), (chord.leave.t, What::Leave)] {
                line.events.push(Event { t, leaf, what });
            }
        }
        if line.has_within {
            line.add_osculations();
        }
        line.find_stations();
        line
    }

    /// Adds the points where two walls along the line have the same curvature.
    fn add_osculations(&mut self) {
        let rulings: SmallVec<[u32; 8]> = (0..self.leaves.len() as u32)
            .filter(|&leaf| self.leaves[leaf as usize].lies_on() == Some(Part::Side))
            .collect();
        for (position, &one) in rulings.iter().enumerate() {
            for &other in &rulings[position + 1..] {
                if let Some(t) = self.osculation([one, other]) {
                    let what = What::Osculation;
                    self.events.push(Event { t, leaf: one, what });
                }
            }
        }
    }

    /// The parameter at which the linear radii of two walls are equal.
    fn osculation(&self, leaves: [u32; 2]) -> Option<f64> {
        let [one, other] = leaves.map(|leaf| &self.leaves[leaf as usize]);
        let chords = [one.chord.as_ref()?, other.chord.as_ref()?];
        let start = chords[0].enter.t.max(chords[1].enter.t);
        let end = chords[0].leave.t.min(chords[1].leave.t);
        let difference = |share: f64| {
            let t = start + share * (end - start);
            let radius = |leaf: &Leaf, index| leaf.ruling_radius(index, self.direction, t);
            Some(radius(one, leaves[0])? - radius(other, leaves[1])?)
        };
        let [first, second] = [difference(0.25)?, difference(0.75)?];
        let share = 0.25 + 0.5 * first / (first - second);
        (start < end && 0.0 < share && share < 1.0).then_some(start + share * (end - start))
    }

    /// Sorts the events and groups them into stations.
    fn find_stations(&mut self) {
        self.events
            .sort_unstable_by(|one, other| one.t.total_cmp(&other.t));
        for position in 0..self.events.len() {
            let is_same = position > 0 && self.are_one(position - 1, position);
            match self.stations.last_mut() {
                Some(station) if is_same => station.end = position + 1,
                _ => self.stations.push(position..position + 1),
            }
            let event = self.events[position];
            let stations = &mut self.leaves[event.leaf as usize].stations;
            match event.what {
                What::Enter => stations[0] = self.stations.len() - 1,
                What::Leave => stations[1] = self.stations.len() - 1,
                What::Osculation => {}
            }
        }
    }

    /// Whether two events are one station, by (1).
    fn are_one(&self, one: usize, other: usize) -> bool {
        let events = [one, other].map(|position| self.events[position]);
        let apart = events[1].t - events[0].t;
        if apart == 0.0 {
            return true;
        }
        let leaves = events.map(|event| &self.leaves[event.leaf as usize]);
        let [one, other] = leaves.map(Leaf::displacement);
        let allowed = 2.0 * one.max(other);
        if apart * self.direction.length() > allowed * power_of_two(26) {
            return false;
        }
        let ends = events.iter().zip(leaves).filter_map(|(event, leaf)| {
            let chord = leaf.chord.as_ref()?;
            let end = match event.what {
                What::Enter => &chord.enter,
                What::Leave => &chord.leave,
                What::Osculation => return None,
            };
            Some(leaf.steepness(end, self.direction))
        });
        apart * ends.fold(0.0, f64::max) <= allowed
    }

    pub fn stations(&self) -> usize {
        self.stations.len()
    }

    /// The least and the greatest `t` of a station.
    pub fn range_of(&self, station: usize) -> Range<f64> {
        let Range { start, end } = self.stations[station];
        self.events[start].t..self.events[end - 1].t
    }

    /// The ends of a leaf's chord at a station.
    pub fn ends_at(&self, leaf: u32, station: usize) -> SmallVec<[ChordEnd; 2]> {
        self.leaves[leaf as usize].ends_at(station)
    }

    /// The one leaf that changes at a station, with the end of its chord and whether the line
    /// is inside it behind the station; `None` if the station is not as simple.
    pub fn only_change_at(&self, station: usize) -> Option<(u32, ChordEnd, bool)> {
        let range = self.stations[station].clone();
        if self.has_within || range.len() > 1 {
            return None;
        }
        let Event { leaf, what, .. } = self.events[range.start];
        let chord = self.leaves[leaf as usize].chord.as_ref()?;
        let enters = what == What::Enter;
        let end = if enters { chord.enter } else { chord.leave };
        Some((leaf, end, enters))
    }

    /// Whether a closed leaf contains the line behind a station.
    pub fn has_behind(&self, leaf: u32, station: usize) -> bool {
        self.leaves[leaf as usize].has_behind(station)
    }

    /// The part of a leaf that contains the line between the ends of the chord.
    pub fn lies_on(&self, leaf: u32) -> Option<Part> {
        self.leaves[leaf as usize].lies_on()
    }

    /// The leaves whose surfaces contain the point of a station, in order.
    pub fn touched_at(&self, station: usize) -> SmallVec<[u32; 8]> {
        let mut touched: SmallVec<[u32; 8]> = self.events[self.stations[station].clone()]
            .iter()
            .filter(|event| event.what != What::Osculation)
            .map(|event| event.leaf)
            .collect();
        if self.has_within {
            touched.extend(self.running_behind(station));
        }
        touched.sort_unstable();
        touched.dedup();
        touched
    }

    /// The leaves whose surfaces contain the line behind a station.
    fn running_behind(&self, station: usize) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&self.leaves).filter_map(move |(index, leaf)| {
            (leaf.lies_on().is_some() && leaf.has_behind(station)).then_some(index)
        })
    }

    /// Whether each closed leaf contains the line behind a station.
    fn leaves_behind(&self, station: usize) -> SmallVec<[bool; 8]> {
        let leaves = self.leaves.iter();
        leaves.map(|leaf| leaf.has_behind(station)).collect()
    }

    /// The stretch behind a station, up to the next.
    pub fn behind(&self, station: usize) -> Stretch {
        let mut leaves = self.leaves_behind(station);
        if self.has_within {
            let running: SmallVec<[u32; 8]> = self.running_behind(station).collect();
            if !running.is_empty() {
                let within = self.around_stretch(station, &running, &mut leaves);
                return Stretch {
                    location: within.location(),
                    within: Some(within),
                };
            }
        }
        let location = if self.composition.evaluate(&leaves) {
            Location::Inside
        } else {
            Location::Outside
        };
        Stretch {
            location,
            within: None,
        }
    }

    /// The neighbourhood of a point of the stretch behind a station, where the surfaces of the
    /// leaves `running` contain the line.
    fn around_stretch(
        &self,
        station: usize,
        running: &[u32],
        leaves: &mut [bool],
    ) -> Neighbourhood {
        let is_inside = |leaves: &[bool]| self.composition.evaluate(leaves);
        if let &[leaf] = running {
            return Neighbourhood::of_one_leaf(leaf, self.lies_on(leaf), leaves, is_inside);
        }
        let (start, end) = (self.range_of(station).end, self.range_of(station + 1).start);
        let distance = self.distance(running);
        let mut pieces = Pieces::new();
        for &index in running {
            self.view(
                index,
                0.5 * (start + end),
                distance,
                self.lies_on(index).as_slice(),
            )
            .add_pieces(&mut pieces);
        }
        // Pieces that the line crosses are also near the middle of a short stretch; they are
        // removed.
        let half = self.direction * (0.5 * (end - start));
        pieces.retain(|piece| {
            piece.normal.dot(half).abs() <= distance || self.lies_on(piece.leaf) == Some(piece.part)
        });
        Neighbourhood::of_pieces(&pieces, &Turned(&pieces), leaves, is_inside)
    }

    /// The neighbourhood of the point of a station, where the line is on the surfaces of the
    /// leaves `touched`.
    pub fn around_station(&self, station: usize, touched: &[u32]) -> Neighbourhood {
        // A leaf that ends at the station is replaced by its pieces.
        let mut leaves = self.leaves_behind(station);
        let is_inside = |leaves: &[bool]| self.composition.evaluate(leaves);
        if let &[leaf] = touched {
            let ends = self.ends_at(leaf, station);
            let parts = ends.iter().map(|end| end.part);
            return Neighbourhood::of_one_leaf(leaf, parts, &mut leaves, is_inside);
        }
        let distance = self.distance(touched);
        let mut pieces = Pieces::new();
        for &index in touched {
            let ends = self.ends_at(index, station);
            let on_rim = ends.iter().any(|end| end.on_rim).then_some(Part::Side);
            let named: SmallVec<[Part; 4]> = ends
                .iter()
                .map(|end| end.part)
                .chain(on_rim)
                .chain(self.lies_on(index))
                .collect();
            let t = ends
                .first()
                .map_or(self.range_of(station).start, |end| end.t);
            self.view(index, t, distance, &named)
                .add_pieces(&mut pieces);
        }
        Neighbourhood::of_pieces(&pieces, &Turned(&pieces), &mut leaves, is_inside)
    }

    /// The greatest distance at which a piece counts as passing through a point of these
    /// leaves.
    fn distance(&self, leaves: &[u32]) -> f64 {
        let leaves = leaves.iter().map(|&leaf| &self.leaves[leaf as usize]);
        2.0 * leaves.map(Leaf::displacement).fold(0.0, f64::max)
    }

    fn view<'b>(&'b self, index: u32, t: f64, distance: f64, named: &'b [Part]) -> Viewed<'b> {
        let leaf = &self.leaves[index as usize];
        Viewed {
            leaf: index,
            solid: leaf.solid,
            from_anchor: leaf.at(self.direction, t),
            displacement: leaf.displacement(),
            nearness: Nearness::Within { distance, named },
        }
    }
}
