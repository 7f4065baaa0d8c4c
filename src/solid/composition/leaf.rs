//! A leaf of a composition as a line meets it.

use glam::DVec3;
use smallvec::SmallVec;

use super::super::spawn::SOLVER_DISPLACEMENT;
use super::piece::{Nearness, Pieces, Viewed};
use crate::solid::{AnySolid, Chord, ChordEnd, Part};

/// What an end of a chord or another station is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    Enter,
    Leave,
    /// Two walls that touch along the line have the same curvature.
    Osculation,
}

/// A leaf and where the line is inside it.
pub(super) struct Leaf<'a> {
    pub solid: &'a AnySolid,
    pub from_anchor: DVec3,
    pub chord: Option<Chord>,
    /// The stations of the chord's two ends.
    pub stations: [usize; 2],
}

impl Leaf<'_> {
    /// Bounds how far solid and line may be displaced.
    pub fn displacement(&self) -> f64 {
        let anchor = self.solid.anchor().length();
        SOLVER_DISPLACEMENT * (self.from_anchor.length() + anchor + self.solid.size())
    }

    /// The point at a parameter, from the anchor.
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

    /// The part within which the line runs between the ends of the chord.
    pub fn lies_on(&self) -> Option<Part> {
        self.chord.as_ref()?.lies_on
    }

    /// The ends of the chord that are at a station.
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

    /// The part of the wall along which the line runs, as the radius of curvature across
    /// the line at a parameter.
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

/// An end of a leaf's chord, or an osculation that the leaf has part in.
#[derive(Clone, Copy)]
pub(super) struct Event {
    pub t: f64,
    pub leaf: u32,
    pub what: What,
}
