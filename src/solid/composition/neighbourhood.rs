//! Classifies the neighbourhood of a point by the set operations.
//!
//! Surfaces that pass through a point `p` divide a small ball around it into open cells. In
//! each cell every leaf is inside or outside, so the formula of the operations has one value
//! there. The regularized set contains `p` if the value is true in some cell, and `p` is
//! interior if it is true in all. A piece of a leaf's surface is part of the set's surface if
//! the values on its two sides differ.
//!
//! **Every cell is beside a piece**, so it is enough to examine both sides of each piece:
//!
//! 1. *First order.* Seen from `p`, pieces are circles on the sphere of directions: great
//!    circles for tangent planes, small ones for apexes ([`Piece`]). Pieces with one tangent
//!    plane are one circle, a *group*. The points where other circles cross the circle of a
//!    group, and those where the heights of its own members change their order, divide it into
//!    arcs. One direction in each arc represents the whole arc: every other group is on one
//!    known side there.
//! 2. *Second order.* In a direction `v`, at the distance `s`, the plane across it is taken at
//!    the scale `s²`. A piece whose circle contains `v` is a straight line there, with the
//!    offset `h(v)` of its [`Bend`](super::bend::Bend). Members of one group are parallel
//!    lines, and between two of them is a sliver between surfaces that touch. Where two or more
//!    circles cross at one point, all their lines together divide that plane (`across.rs`).
//!    This detects a face that cuts off nothing to first order, like a sphere that touches an
//!    edge of a cuboid.
//!
//! Pieces that are equal to second order count as coinciding. Planes, spheres, cylinders and
//! cones with this property are the same surface, or they touch along a curve or in a point of
//! third order. There neither is on one side of the other on both sides of the point, and the
//! gap between them is thinner than any angle.

use glam::DVec3;
use smallvec::SmallVec;

use super::across::{Across, Sides};
use super::bend::Angles;
use super::circle::Circle;
use super::first_order::{FirstOrder, Place};
use super::piece::{Piece, Pieces};
use crate::solid::{Location, Part};

/// A piece of the surface of a composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    /// The leaf with this piece.
    pub leaf: u32,
    pub part: Part,
    /// Whether the composition is outside of the leaf there.
    pub is_reversed: bool,
}

/// The cells around a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Neighbourhood {
    /// Whether the formula is true in some cell.
    pub has_inside: bool,
    /// Whether it is false in some cell.
    pub has_outside: bool,
    /// The pieces of the surface, each once.
    pub faces: SmallVec<[Face; 4]>,
}

impl Neighbourhood {
    /// The location of the point in the regularized set.
    pub fn location(&self) -> Location {
        match (self.has_inside, self.has_outside) {
            (true, true) => Location::Boundary,
            (true, false) => Location::Inside,
            (false, _) => Location::Outside,
        }
    }

    fn add(&mut self, is_inside: bool) {
        self.has_inside |= is_inside;
        self.has_outside |= !is_inside;
    }

    pub fn add_face(&mut self, face: Face) {
        if !self.faces.contains(&face) {
            self.faces.push(face);
        }
    }

    /// The neighbourhood of a point on the surface of one leaf alone: one cell inside of the
    /// leaf and one outside.
    pub fn of_one_leaf(
        leaf: u32,
        parts: impl IntoIterator<Item = Part>,
        leaves: &mut [bool],
        is_inside: impl Fn(&[bool]) -> bool,
    ) -> Self {
        let [within, beyond] = [true, false].map(|is_within| {
            leaves[leaf as usize] = is_within;
            is_inside(leaves)
        });
        let mut found = Self::default();
        found.add(within);
        found.add(beyond);
        if within != beyond {
            for part in parts {
                found.add_face(Face {
                    leaf,
                    part,
                    is_reversed: beyond,
                });
            }
        }
        found
    }

    /// The neighbourhood of a point on the surfaces of several leaves. `leaves` has for every
    /// other leaf whether the point is inside of it, and `is_inside` evaluates the formula.
    pub fn of_pieces(
        pieces: &Pieces,
        first_order: &impl FirstOrder,
        leaves: &mut [bool],
        is_inside: impl Fn(&[bool]) -> bool,
    ) -> Self {
        let mut explorer = Explorer {
            pieces,
            first_order,
            groups: groups(pieces.len(), first_order),
            is_within: pieces.iter().map(|_| false).collect(),
            leaves,
            is_inside,
            found: Self::default(),
        };
        explorer.explore();
        explorer.found
    }
}

/// The group of each piece, given by its first member.
fn groups(count: usize, first_order: &impl FirstOrder) -> SmallVec<[usize; 8]> {
    let mut groups = SmallVec::<[usize; 8]>::new();
    for index in 0..count {
        let first = (0..index).find(|&one| groups[one] == one && first_order.are_one(index, one));
        groups.push(first.unwrap_or(index));
    }
    groups
}

struct Explorer<'a, A, F> {
    pieces: &'a Pieces,
    first_order: &'a A,
    groups: SmallVec<[usize; 8]>,
    /// For each piece, whether the cell is inside of it.
    is_within: SmallVec<[bool; 8]>,
    leaves: &'a mut [bool],
    is_inside: F,
    found: Neighbourhood,
}

impl<A: FirstOrder, F: Fn(&[bool]) -> bool> Explorer<'_, A, F> {
    fn explore(&mut self) {
        // Faces in one plane, as at the mouth of a bore, have only two sides.
        if self.groups.iter().all(|group| *group == 0) && self.pieces.iter().all(Piece::is_plane) {
            return self.compare(&Sides::of_plane(self.pieces), DVec3::ZERO);
        }
        for group in 0..self.pieces.len() {
            if self.groups[group] == group {
                self.explore_group(group);
            }
        }
    }

    /// Examines both sides of the members of a group, all around.
    fn explore_group(&mut self, group: usize) {
        let circle = Circle::new(&self.pieces[group]);
        let others: SmallVec<[usize; 8]> = (0..self.pieces.len())
            .filter(|&other| other != group && self.groups[other] == other)
            .collect();
        let changes = self.changes(group, &circle);
        self.first_order
            .for_each_place(&circle, group, &others, &changes, |place| self.look(place));
    }

    /// The angles at which members of a group change their order.
    fn changes(&self, group: usize, circle: &Circle) -> Angles {
        let (axes, mut angles) = ([circle.x, circle.y], Angles::new());
        if !self.pieces[group].is_flat_to_first_order() {
            return angles;
        }
        // The members of the group, one for each surface.
        let mut distinct = SmallVec::<[&Piece; 8]>::new();
        for (piece, _) in (self.pieces.iter().zip(&self.groups)).filter(|(_, of)| **of == group) {
            if distinct.iter().any(|one| one.coincides_with(piece)) {
                continue;
            }
            piece.bend.add_seam(axes, &mut angles);
            for other in &distinct {
                let sign = piece.normal.dot(other.normal).signum();
                piece
                    .bend
                    .add_crossings(&other.bend, sign, axes, &mut angles);
            }
            distinct.push(piece);
        }
        angles
    }

    /// Examines all cells around a place of a group's circle.
    fn look(&mut self, place: &Place<A::Exact>) {
        let mut across = Across::new(place, self.first_order);
        for (index, piece) in self.pieces.iter().enumerate() {
            if place.groups.contains(&self.groups[index]) {
                across.add(index, piece, self.groups[index]);
            } else {
                self.is_within[index] = self.first_order.is_within(place, index);
            }
        }
        across.for_each_border(|sides| self.compare(sides, place.direction));
    }

    /// Compares the cells on both sides of a line.
    fn compare(&mut self, sides: &Sides, direction: DVec3) {
        for (index, is_within) in sides.others() {
            self.is_within[index] = is_within;
        }
        let mut values = [false; 2];
        let mut leaves: [SmallVec<[bool; 8]>; 2] = Default::default();
        for (side, is_inner) in [true, false].into_iter().enumerate() {
            for (index, is_turned) in sides.on_the_line() {
                self.is_within[index] = is_inner != is_turned;
            }
            values[side] = self.evaluate();
            let pieces = sides.on_the_line();
            leaves[side] = pieces
                .map(|(index, _)| self.leaves[self.pieces[index].leaf as usize])
                .collect();
            self.found.add(values[side]);
        }
        if values[0] == values[1] || !self.are_one_surface(sides) {
            return;
        }
        for (position, (index, is_turned)) in sides.on_the_line().enumerate() {
            if leaves[0][position] != leaves[1][position] {
                let piece = &self.pieces[index];
                let Some(part) = piece.part_towards(direction) else {
                    continue;
                };
                // The outer side of the first line is the second side.
                self.found.add_face(Face {
                    leaf: piece.leaf,
                    part,
                    is_reversed: values[1] != is_turned,
                });
            }
        }
    }

    /// Whether the pieces of a line are the same surface. If they are surfaces that touch along
    /// this direction, each has sides of its own in the directions beside it.
    fn are_one_surface(&self, sides: &Sides) -> bool {
        let mut pieces = sides.on_the_line().map(|(index, _)| &self.pieces[index]);
        let first = pieces.next();
        first.is_none_or(|first| pieces.all(|piece| piece.coincides_with(first)))
    }

    fn evaluate(&mut self) -> bool {
        for piece in self.pieces {
            self.leaves[piece.leaf as usize] = true;
        }
        for (piece, is_within) in self.pieces.iter().zip(&self.is_within) {
            self.leaves[piece.leaf as usize] &= *is_within;
        }
        (self.is_inside)(self.leaves)
    }
}
