//! The plane across a direction, divided by the surfaces that contain the direction.
//!
//! At the scale of `neighbourhood.rs` a surface with the outward normal `n` and the height `h`
//! of its bend is the line `w·n = h`, inside where `w·n < h`. Every cell of the arrangement of
//! lines has a segment of a line at its border. So both sides of every segment between the
//! crossings of a line are examined; lines that coincide are crossed together.
//!
//! Members of a group are parallel. Lines of different groups cross, unless one belongs to an
//! apex that a plane touches along this direction. Heights of parallel lines are equal if they
//! differ by no more than the error of curvatures ([`Piece::height_error`]). Crossings of a
//! line are one if they differ by no more than two such errors move them.
//!
//! Where first order is exact, planes may differ by far less than the errors of their normals
//! in f64. Then the sines between lines come from the exact normals, and a point of a line is
//! inside or outside of another line by its side of their crossing, never by a product of
//! normals in f64.

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::first_order::{FirstOrder, Place};
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
    /// The error bound of the height.
    height_error: f64,
    /// θ of the piece.
    turned: f64,
    is_of_apex: bool,
}

/// The relation of a line to another.
#[derive(Clone, Copy, Debug)]
enum Relation {
    /// They coincide; their normals may be opposite.
    Coincides { is_turned: bool },
    /// They are parallel, and the first is inside or outside of the other.
    IsParallel { is_within: bool },
    /// They cross, at this position along the first.
    Crosses {
        place: f64,
        /// The error bound of the position.
        error: f64,
        /// Whether positions beyond are outside of the other.
        leaves: bool,
    },
}

/// The plane across a direction.
pub(super) struct Across<'a, A: FirstOrder> {
    place: &'a Place<'a, A::Exact>,
    first_order: &'a A,
    axes: [DVec3; 2],
    lines: SmallVec<[Line; 8]>,
}

/// The two sides of a segment of a line: the inner and the outer side of its piece.
pub(super) struct Sides {
    /// The pieces whose lines coincide here, and whether the inner side is outside of them.
    on_the_line: SmallVec<[(usize, bool); 8]>,
    /// The other pieces, and whether both sides are inside of them.
    others: SmallVec<[(usize, bool); 8]>,
}

impl Sides {
    /// The sides of a plane that contains all pieces.
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

impl<'a, A: FirstOrder> Across<'a, A> {
    pub fn new(place: &'a Place<'a, A::Exact>, first_order: &'a A) -> Self {
        let (x, y) = place.direction.any_orthonormal_pair();
        Self {
            place,
            first_order,
            axes: [x, y],
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
            height: piece.bend.height(self.place.direction),
            height_error: piece.height_error(),
            turned: piece.turned,
            is_of_apex: !piece.is_flat_to_first_order(),
        });
    }

    /// Passes both sides of every segment of every line to `look`.
    pub fn for_each_border(&self, mut look: impl FnMut(&Sides)) {
        for (index, line) in self.lines.iter().enumerate() {
            let mut relations = SmallVec::<[Relation; 8]>::new();
            relations.extend(self.lines.iter().map(|other| self.relation(line, other)));
            let mut earlier = relations[..index].iter();
            if earlier.any(|relation| matches!(relation, Relation::Coincides { .. })) {
                continue;
            }
            for place in stretches(&relations) {
                look(&self.sides(line, place, &relations));
            }
        }
    }

    fn are_parallel(&self, one: &Line, other: &Line) -> bool {
        one.group == other.group
            || (one.is_of_apex || other.is_of_apex)
                && one.normal.perp_dot(other.normal).abs()
                    <= self.place.error + 2.0 * one.turned.max(other.turned)
    }

    fn relation(&self, line: &Line, other: &Line) -> Relation {
        let cosine = line.normal.dot(other.normal);
        let height_error = 2.0 * line.height_error.max(other.height_error);
        if self.are_parallel(line, other) {
            let sign = cosine.signum();
            return if (line.height - sign * other.height).abs() <= height_error {
                let is_turned = cosine < 0.0;
                Relation::Coincides { is_turned }
            } else {
                let is_within = sign * line.height < other.height;
                Relation::IsParallel { is_within }
            };
        }
        let exact = (self.first_order).sine(self.place, line.piece, other.piece);
        let sine = exact.unwrap_or_else(|| line.normal.perp().dot(other.normal));
        Relation::Crosses {
            place: (other.height - line.height * cosine) / sine,
            error: height_error / sine.abs(),
            leaves: sine > 0.0,
        }
    }

    fn sides(&self, line: &Line, place: f64, relations: &[Relation]) -> Sides {
        let point = line.normal * line.height + line.normal.perp() * place;
        let mut sides = Sides {
            on_the_line: SmallVec::new(),
            others: SmallVec::new(),
        };
        for (other, relation) in self.lines.iter().zip(relations) {
            let is_within = match *relation {
                Relation::Coincides { is_turned } => {
                    sides.on_the_line.push((other.piece, is_turned));
                    continue;
                }
                _ if !A::IS_EXACT => point.dot(other.normal) < other.height,
                Relation::IsParallel { is_within } => is_within,
                Relation::Crosses {
                    place: crossing,
                    leaves,
                    ..
                } => (place < crossing) == leaves,
            };
            sides.others.push((other.piece, is_within));
        }
        sides
    }
}

/// A position on each segment of a line, counted from the point nearest to the origin.
fn stretches(relations: &[Relation]) -> SmallVec<[f64; 8]> {
    let mut crossings = SmallVec::<[(f64, f64); 8]>::new();
    for relation in relations {
        if let Relation::Crosses { place, error, .. } = *relation {
            crossings.push((place, error));
        }
    }
    crossings.sort_by(|one, other| one.0.total_cmp(&other.0));
    crossings.dedup_by(|next, last| next.0 - last.0 <= next.1 + last.1);
    let (Some(first), Some(last)) = (crossings.first(), crossings.last()) else {
        return SmallVec::from_slice(&[0.0]);
    };
    // Any distance beyond the first and the last crossing serves.
    let beyond = 1.0 + first.0.abs().max(last.0.abs());
    let mut places = SmallVec::new();
    places.push(first.0 - beyond);
    for pair in crossings.windows(2) {
        places.push(0.5 * (pair[0].0 + pair[1].0));
    }
    places.push(last.0 + beyond);
    places
}
