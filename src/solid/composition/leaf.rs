//! A leaf of a composition and its intersection with a line.

use glam::DVec3;
use smallvec::SmallVec;

use super::super::spawn::SOLVER_DISPLACEMENT;
use super::piece::{Nearness, Pieces, Viewed};
use crate::solid::{AnySolid, Chord, ChordEnd, Part};

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    Enter,
    Leave,
    /// Two walls that touch along the line have the same curvature here.
    Osculation,
}

/// A leaf and the interval of the line inside it.
pub(super) struct Leaf<'a> {
    pub solid: &'a AnySolid,
    pub from_anchor: DVec3,
    pub chord: Option<Chord>,
    /// The stations of the chord's two ends.
    pub stations: [usize; 2],
}

impl Leaf<'_> {
    /// Bounds the displacement of solid and line.
    pub fn displacement(&self) -> f64 {
        let anchor = self.solid.anchor().length();
        SOLVER_DISPLACEMENT * (self.from_anchor.length() + anchor + self.solid.size())
    }

    /// The point at a parameter, relative to the anchor.
    pub fn at(&self, direction: DVec3, t: f64) -> DVec3 {
        self.from_anchor + direction * t
    }

    /// `|n·d|` at one of the chord's ends.
    pub fn steepness(&self, end: &ChordEnd, direction: DVec3) -> f64 {
        let surface = self
            .solid
            .surface_point(end.part, self.at(direction, end.t));
        surface.normal.dot(direction).abs()
    }

    /// The part that contains the line between the ends of the chord.
    pub fn lies_on(&self) -> Option<Part> {
        self.chord.as_ref()?.lies_on
    }

    /// The ends of the chord at a station.
    pub fn ends_at(&self, station: usize) -> SmallVec<[ChordEnd; 2]> {
        let ends = self
            .chord
            .iter()
            .flat_map(|chord| [chord.enter, chord.leave]);
        let ends = ends.zip(self.stations);
        ends.filter_map(|(end, at)| (at == station).then_some(end))
            .collect()
    }

    /// Whether the closed leaf contains the line behind a station.
    pub fn has_behind(&self, station: usize) -> bool {
        let [enter, leave] = self.stations;
        self.chord.is_some() && enter <= station && station < leave
    }

    /// The radius of curvature across the line, at a parameter, of the wall that contains the
    /// line.
    pub fn ruling_radius(&self, leaf: u32, direction: DVec3, t: f64) -> Option<f64> {
        let viewed = Viewed {
            leaf,
            solid: self.solid,
            from_anchor: self.at(direction, t),
            displacement: self.displacement(),
            nearness: Nearness::Within {
                distance: 0.0,
                named: &[Part::Side],
            },
        };
        let mut pieces = Pieces::new();
        viewed.add_pieces(&mut pieces);
        let wall = pieces.iter().find(|piece| piece.part == Part::Side)?;
        Some(1.0 / wall.bend.curvature_around())
    }
}

/// An end of a leaf's chord, or an osculation of the leaf's wall.
#[derive(Clone, Copy)]
pub(super) struct Event {
    pub t: f64,
    pub leaf: u32,
    pub what: What,
}
