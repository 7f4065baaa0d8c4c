//! The plane across a direction, divided by the surfaces that contain the direction.
//!
//! At the scale of `neighbourhood.rs` a surface with the outward normal `n` and the height
//! `h` of its bend is the line `w·n = h`, inside where `w·n < h`. Every cell that
//! the lines make has a stretch of a line at its border. So of each line all stretches
//! between its crossings with others are looked at, from both sides; lines
//! that coincide are crossed together.
//!
//! Members of a group are parallel. Lines of different groups cross, unless one belongs to
//! an apex that a plane touches along this direction. Heights of parallel lines are equal
//! within what curvatures may be off ([`Piece::height_error`]), and crossings with a line are one
//! within what two such errors move them.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::piece::{Piece, Pieces};

/// A surface in the plane.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// The position of its piece.
    piece: usize,
    group: usize,
    /// Unit vector.
    normal: DVec2,
    height: f64,
    /// By how much the height may be off.
    height_error: f64,
    /// θ of the piece.
    turned: f64,
    is_of_apex: bool,
}

/// The plane across a direction.
pub(super) struct Across {
    direction: DVec3,
    axes: [DVec3; 2],
    /// By how much the direction may be off.
    error: f64,
    lines: SmallVec<[Line; 8]>,
}

/// The two sides of a stretch of a line: the inner and the outer one of its piece.
pub(super) struct Sides {
    /// The pieces whose lines are this one, and whether the inner side is outside of them.
    on_the_line: SmallVec<[(usize, bool); 8]>,
    /// The other pieces, and whether both sides are inside of them.
    others: SmallVec<[(usize, bool); 8]>,
}

impl Sides {
    /// Those of a plane in which all pieces lie.
    pub fn of_plane(pieces: &Pieces) -> Self {
        let first = pieces.first().map_or(DVec3::ZERO, |piece| piece.normal);
        let pieces = pieces.iter().enumerate();
        Self {
            on_the_line: pieces
                .map(|(index, piece)| (index, piece.normal.dot(first) < 0.0))
                .collect(),
            others: SmallVec::new(),
        }
    }

    pub fn on_the_line(&self) -> impl Iterator<Item = (usize, bool)> + '_ {
        self.on_the_line.iter().copied()
    }

    pub fn others(&self) -> impl Iterator<Item = (usize, bool)> + '_ {
        self.others.iter().copied()
    }
}

impl Across {
    pub fn new(direction: DVec3, error: f64) -> Self {
        let (x, y) = direction.any_orthonormal_pair();
        Self {
            direction,
            axes: [x, y],
            error,
            lines: SmallVec::new(),
        }
    }

    /// Adds a piece whose circle contains the direction.
    pub fn add(&mut self, index: usize, piece: &Piece, group: usize) {
        let normal = self.axes.map(|axis| axis.dot(piece.normal));
        self.lines.push(Line {
            piece: index,
            group,
            normal: DVec2::from_array(normal).normalize(),
            height: piece.bend.height(self.direction),
            height_error: piece.height_error(),
            turned: piece.turned,
            is_of_apex: !piece.is_flat_to_first_order(),
        });
    }

    /// Hands on both sides of every stretch of every line.
    pub fn each_border(&self, mut look: impl FnMut(&Sides)) {
        for (index, line) in self.lines.iter().enumerate() {
            let mut earlier = self.lines[..index].iter();
            if earlier.any(|other| self.coincide(line, other)) {
                continue;
            }
            for place in self.stretches(line) {
                look(&self.sides(line, place));
            }
        }
    }

    fn are_parallel(&self, one: &Line, other: &Line) -> bool {
        one.group == other.group
            || (one.is_of_apex || other.is_of_apex)
                && one.normal.perp_dot(other.normal).abs()
                    <= self.error + 2.0 * one.turned.max(other.turned)
    }

    fn coincide(&self, one: &Line, other: &Line) -> bool {
        let sign = one.normal.dot(other.normal).signum();
        self.are_parallel(one, other)
            && (one.height - sign * other.height).abs()
                <= 2.0 * one.height_error.max(other.height_error)
    }

    /// A place on each stretch of a line, from the foot of the origin.
    fn stretches(&self, line: &Line) -> SmallVec<[f64; 8]> {
        let along = line.normal.perp();
        let mut crossings = SmallVec::<[(f64, f64); 8]>::new();
        for other in &self.lines {
            if !self.are_parallel(line, other) {
                let sine = along.dot(other.normal);
                let place = (other.height - line.height * line.normal.dot(other.normal)) / sine;
                let error = 2.0 * line.height_error.max(other.height_error) / sine.abs();
                crossings.push((place, error));
            }
        }
        crossings.sort_by(|one, other| one.0.total_cmp(&other.0));
        crossings.dedup_by(|next, last| next.0 - last.0 <= next.1 + last.1);
        let (Some(first), Some(last)) = (crossings.first(), crossings.last()) else {
            return SmallVec::from_slice(&[0.0]);
        };
        // Any length will do beyond the first and the last.
        let beyond = 1.0 + first.0.abs().max(last.0.abs());
        let mut places = SmallVec::new();
        places.push(first.0 - beyond);
        for pair in crossings.windows(2) {
            places.push(0.5 * (pair[0].0 + pair[1].0));
        }
        places.push(last.0 + beyond);
        places
    }

    fn sides(&self, line: &Line, place: f64) -> Sides {
        let point = line.normal * line.height + line.normal.perp() * place;
        let mut sides = Sides {
            on_the_line: SmallVec::new(),
            others: SmallVec::new(),
        };
        for other in &self.lines {
            if self.coincide(line, other) {
                let is_turned = line.normal.dot(other.normal) < 0.0;
                sides.on_the_line.push((other.piece, is_turned));
            } else {
                let is_within = point.dot(other.normal) < other.height;
                sides.others.push((other.piece, is_within));
            }
        }
        sides
    }
}
