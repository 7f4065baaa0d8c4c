//! Classifies the neighbourhood of a point by the set operations.
//!
//! Surfaces that pass through a point `p` divide a small ball around it into open cells. In
//! each of them every leaf is inside or outside, so the formula of the operations has one
//! value there. The regularised set contains `p` if the value is true in some cell, and `p`
//! is inside of it if it is true in all; a piece of a leaf's surface is part of the set's
//! surface where the values on its two sides differ.
//!
//! **Every cell is beside a piece**, so it is enough to look at both sides of each:
//!
//! 1. *First order.* Seen from `p`, pieces are circles on the sphere of directions: great
//!    circles for tangent planes, small ones for apexes ([`Piece`]). Pieces with one
//!    tangent plane are one circle, a *group*. On the circle of each group the points where
//!    others cross it, and those where the heights of its own members change their
//!    order, leave arcs. One direction in each arc represents all of it: there
//!    every other group is on one known side.
//! 2. *Second order.* In a direction `v`, at the distance `s`, the plane across it is taken
//!    at the scale `s²`. A piece whose circle contains `v` is a straight line there, with the
//!    offset `h(v)` of its [`Bend`](super::bend::Bend). Members of one group are parallel lines, and what is
//!    between two is a sliver between surfaces that touch. Where circles cross, also
//!    three or more at one point, all their lines together divide that plane
//!    (`across.rs`): so a face that cuts off nothing at first order, like a sphere
//!    that touches an edge of a cuboid, is seen to do so.
//!
//! Pieces that are equal to second order count as coinciding. In the planes, spheres,
//! cylinders and cones of a composition they then are the same surface, or touch along a
//! curve or in a point of third order, where neither is on one side of the other on
//! both sides of the point; what is between them is thinner than any angle.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use smallvec::SmallVec;

use super::across::{Across, Sides};
use super::bend::Angles;
use super::piece::{Piece, Pieces};
use crate::solid::{Location, Part};

/// A piece of the surface of a composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    /// The leaf that has it.
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
    /// What the regularised set has at the point.
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

    /// That of a point on the surface of one leaf alone: it is inside or outside of it.
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

    /// That of a point on the surfaces of several. `leaves` contains for every other leaf
    /// whether the point is inside of it, and `is_inside` evaluates the formula.
    pub fn of_pieces(
        pieces: &Pieces,
        leaves: &mut [bool],
        is_inside: impl Fn(&[bool]) -> bool,
    ) -> Self {
        let mut explorer = Explorer {
            pieces,
            groups: groups(pieces),
            is_within: pieces.iter().map(|_| false).collect(),
            leaves,
            is_inside,
            found: Self::default(),
        };
        explorer.explore();
        explorer.found
    }
}

/// The group of each piece, named by its first member.
fn groups(pieces: &Pieces) -> SmallVec<[usize; 8]> {
    let mut groups = SmallVec::<[usize; 8]>::new();
    for (index, piece) in pieces.iter().enumerate() {
        let first = (0..index).find(|&one| groups[one] == one && piece.is_tangent_to(&pieces[one]));
        groups.push(first.unwrap_or(index));
    }
    groups
}

/// Where a group is crossed by others.
struct Crossing {
    angle: f64,
    /// By how much the angle may be off.
    error: f64,
    /// The groups that contain the direction; none where only members change their order.
    groups: SmallVec<[usize; 4]>,
}

/// The circle of a group, as `n k + √(1 - k²) (cos φ x + sin φ y)`.
struct Circle {
    middle: DVec3,
    x: DVec3,
    y: DVec3,
}

impl Circle {
    fn new(piece: &Piece) -> Self {
        let (x, y) = piece.normal.any_orthonormal_pair();
        let radius = (1.0 - piece.cosine * piece.cosine).sqrt();
        Self {
            middle: piece.normal * piece.cosine,
            x: x * radius,
            y: y * radius,
        }
    }

    fn at(&self, angle: f64) -> DVec3 {
        self.middle + self.x * libm::cos(angle) + self.y * libm::sin(angle)
    }

    /// The directions that another piece has too, and by how much they may be off.
    ///
    /// On the circle `v·n' - k'` is `M cos(φ - φ0) - K`. A piece that is turned by θ
    /// moves the roots by `2 θ / (M sin(φ - φ0))`, and circles whose distance from touching is below `2 θ`
    /// touch.
    fn crossings(&self, own: &Piece, other: &Piece) -> SmallVec<[(f64, f64); 2]> {
        let error = 2.0 * own.turned.max(other.turned);
        let (a, b) = (self.x.dot(other.normal), self.y.dot(other.normal));
        let amplitude = libm::hypot(a, b);
        let mut found = SmallVec::new();
        if amplitude <= error {
            return found;
        }
        let middle = libm::atan2(b, a);
        let cosine = (other.cosine - self.middle.dot(other.normal)) / amplitude;
        let beyond = (cosine.abs() - 1.0) * amplitude;
        if beyond.abs() <= error {
            let angle = if cosine > 0.0 { middle } else { middle + PI };
            found.push((angle, error / amplitude));
        } else if beyond < 0.0 {
            let half = libm::acos(cosine);
            let error = error / (amplitude * libm::sin(half));
            found.extend([(middle + half, error), (middle - half, error)]);
        }
        found
    }
}

struct Explorer<'a, F> {
    pieces: &'a Pieces,
    groups: SmallVec<[usize; 8]>,
    /// Of each piece, whether the cell is inside of it.
    is_within: SmallVec<[bool; 8]>,
    leaves: &'a mut [bool],
    is_inside: F,
    found: Neighbourhood,
}

impl<F: Fn(&[bool]) -> bool> Explorer<'_, F> {
    fn explore(&mut self) {
        // Faces in one plane, as at the mouth of a bore, have two sides and no more.
        if self.groups.iter().all(|group| *group == 0) && self.pieces.iter().all(Piece::is_plane) {
            return self.compare(&Sides::of_plane(self.pieces), DVec3::ZERO);
        }
        for group in 0..self.pieces.len() {
            if self.groups[group] == group {
                self.explore_group(group);
            }
        }
    }

    /// Looks at both sides of the members of a group, all around.
    fn explore_group(&mut self, group: usize) {
        let circle = Circle::new(&self.pieces[group]);
        let crossings = self.crossings(group, &circle);
        let Some(last) = crossings.last() else {
            return self.look(circle.at(0.0), &[group], 0.0);
        };
        let mut before = last.angle - TAU;
        for crossing in crossings {
            let middle = 0.5 * (before + crossing.angle);
            self.look(circle.at(middle), &[group], 0.0);
            if !crossing.groups.is_empty() {
                let mut groups = crossing.groups;
                groups.push(group);
                self.look(circle.at(crossing.angle), &groups, crossing.error);
            }
            before = crossing.angle;
        }
    }

    /// The directions on the circle of a group that bound its arcs, in order.
    fn crossings(&self, group: usize, circle: &Circle) -> SmallVec<[Crossing; 8]> {
        let own = &self.pieces[group];
        let mut all = SmallVec::<[Crossing; 8]>::new();
        let mut add = |angle: f64, error: f64, group: Option<usize>| {
            let turns = libm::floor(angle / TAU);
            all.push(Crossing {
                angle: angle - TAU * turns,
                error,
                groups: group.into_iter().collect(),
            });
        };
        let (axes, mut angles) = ([circle.x, circle.y], Angles::new());
        // The members of the group, one of each surface.
        let mut distinct = SmallVec::<[&Piece; 8]>::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            let other = self.groups[index];
            if other == group {
                if !distinct.iter().any(|one| one.coincides_with(piece)) {
                    distinct.push(piece);
                }
            } else if other == index {
                for (angle, error) in circle.crossings(own, piece) {
                    add(angle, error, Some(other));
                }
            }
        }
        if own.is_flat_to_first_order() {
            for (index, one) in distinct.iter().enumerate() {
                one.bend.add_seam(axes, &mut angles);
                for other in &distinct[..index] {
                    let sign = one.normal.dot(other.normal).signum();
                    one.bend.add_crossings(&other.bend, sign, axes, &mut angles);
                }
            }
        }
        for angle in angles {
            add(angle, own.turned, None);
        }
        all.sort_by(|one, other| one.angle.total_cmp(&other.angle));
        let mut merged = SmallVec::<[Crossing; 8]>::new();
        for crossing in all {
            match merged.last_mut() {
                Some(last) if last.is_one_with(&crossing, 0.0) => last.merge(crossing),
                _ => merged.push(crossing),
            }
        }
        // Around the circle the last may be the first.
        if merged.len() > 1 && merged[merged.len() - 1].is_one_with(&merged[0], TAU) {
            let last = merged.pop().expect("there are two");
            merged[0].merge(last);
        }
        merged
    }

    /// Looks at all cells around a direction that one group contains, or in which several
    /// cross.
    fn look(&mut self, direction: DVec3, groups: &[usize], error: f64) {
        let mut across = Across::new(direction, error);
        for (index, piece) in self.pieces.iter().enumerate() {
            if groups.contains(&self.groups[index]) {
                across.add(index, piece, self.groups[index]);
            } else {
                self.is_within[index] = direction.dot(piece.normal) < piece.cosine;
            }
        }
        across.each_border(|sides| self.compare(sides, direction));
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
                // Outside of the first line is the second side.
                self.found.add_face(Face {
                    leaf: piece.leaf,
                    part,
                    is_reversed: values[1] != is_turned,
                });
            }
        }
    }

    /// Whether the pieces of a line are the same surface, not surfaces that touch along this
    /// direction: of those each has its own sides in directions beside it.
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

impl Crossing {
    /// Whether another may be the same direction; `turn` is added to its angle.
    fn is_one_with(&self, next: &Self, turn: f64) -> bool {
        next.angle + turn - self.angle <= self.error + next.error
    }

    fn merge(&mut self, other: Self) {
        // The angle of two groups' crossing rather than one of a mere change of order.
        if self.groups.is_empty() {
            self.angle = other.angle;
        }
        self.error = self.error.max(other.error);
        for group in other.groups {
            if !self.groups.contains(&group) {
                self.groups.push(group);
            }
        }
    }
}
