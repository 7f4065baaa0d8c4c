//! The pieces of a leaf's surface that pass through a point.
//!
//! A leaf is convex, and near a point of its surface it is the intersection of the insides of
//! all pieces there: one for a face, two for an edge, three for a corner of a cuboid. To first
//! order a piece is the set of the directions `v` with
//!
//! ```text
//! v·n < k                                                                  (1)
//! ```
//!
//! where `n` is the outward normal and `k = 0`. At the apex of a cone `n` points from the solid
//! along the axis, and `k` is minus the cosine of the angle between axis and wall. To second
//! order a smooth piece has a [`Bend`].
//!
//! **Which pieces pass through the point of a line** is decided by the displacement δ that
//! `line.rs` derives: those within 2 δ of the point. The same displacement bounds how far a
//! normal may be turned: for a plane whose points are displaced by δ over an extent `l`, by
//! `2 δ / l`, and for a surface of radius `R` by `δ / R` more. Two normals count as parallel if
//!
//! ```text
//! sin of the angle between them <= 2 θ, θ the greater of both              (2)
//! ```
//!
//! A cuboid's normals are stated as unit vectors, with `l = 1`. Curvatures have the relative
//! error θ in the same way.
//!
//! **Which pieces pass through a stated point** is decided exactly, and so is how their tangent
//! planes divide the directions (`planes.rs`).

use glam::DVec3;
use smallvec::SmallVec;

use super::super::spawn::SOLVER_DISPLACEMENT;
use super::bend::Bend;
use crate::solid::{AnySolid, Part};

/// A piece of a leaf's surface at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The position of the leaf among the operands.
    pub leaf: u32,
    pub part: Part,
    /// On a seam, the direction from the sphere (the `part`) into the wall.
    pub to_wall: Option<DVec3>,
    /// `n` of (1), a unit vector.
    pub normal: DVec3,
    /// `k` of (1).
    pub cosine: f64,
    pub bend: Bend,
    /// θ of (2).
    pub turned: f64,
}

/// The pieces at a point, grouped by leaf.
pub(super) type Pieces = SmallVec<[Piece; 8]>;

/// The condition for a piece to pass through a point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nearness<'a> {
    /// Its distance from the point is at most this, or its part is one that the solver reports.
    Within { distance: f64, named: &'a [Part] },
    /// It contains the stated point exactly.
    Exactly(DVec3),
}

/// A leaf as seen from a point of its surface.
pub(super) struct Viewed<'a> {
    pub leaf: u32,
    pub solid: &'a AnySolid,
    /// The point, relative to the solid's anchor.
    pub from_anchor: DVec3,
    /// δ of the point.
    pub displacement: f64,
    pub nearness: Nearness<'a>,
}

impl Viewed<'_> {
    /// Whether a part at this distance from the point passes through it.
    pub fn passes(&self, part: Part, distance: f64) -> bool {
        match self.nearness {
            Nearness::Within {
                distance: least,
                named,
            } => distance <= least || named.contains(&part),
            Nearness::Exactly(point) => self.solid.is_on(part, point),
        }
    }

    /// δ of the solid alone.
    pub fn own_displacement(&self) -> f64 {
        SOLVER_DISPLACEMENT * (self.solid.anchor().length() + self.solid.size())
    }

    pub fn flat(&self, part: Part, normal: DVec3, turned: f64) -> Piece {
        Piece {
            leaf: self.leaf,
            part,
            to_wall: None,
            normal,
            cosine: 0.0,
            bend: Bend::FLAT,
            turned,
        }
    }

    /// An apex from which the solid extends along `axis`. `cosine` is that of the angle between
    /// axis and wall.
    pub fn apex(&self, part: Part, axis: DVec3, cosine: f64, turned: f64) -> Piece {
        Piece {
            cosine: -cosine,
            ..self.flat(part, -axis, turned)
        }
    }
}

impl Piece {
    /// The part in a direction of the tangent plane; `None` if the direction is along a seam.
    pub fn part_towards(&self, direction: DVec3) -> Option<Part> {
        let Some(to_wall) = self.to_wall else {
            return Some(self.part);
        };
        let into_wall = direction.dot(to_wall);
        if into_wall.abs() <= self.turned {
            None
        } else if into_wall > 0.0 {
            Some(Part::Side)
        } else {
            Some(self.part)
        }
    }

    /// Whether two pieces are equal to first order: one plane, or one cone.
    pub fn is_tangent_to(&self, other: &Self) -> bool {
        let allowed = 2.0 * self.turned.max(other.turned);
        let is_parallel = self.normal.cross(other.normal).length() <= allowed;
        is_parallel
            && if self.is_flat_to_first_order() && other.is_flat_to_first_order() {
                true
            } else {
                self.normal.dot(other.normal) > 0.0 && (self.cosine - other.cosine).abs() <= allowed
            }
    }

    /// Whether two pieces are equal to second order.
    pub fn coincides_with(&self, other: &Self) -> bool {
        let allowed = 2.0 * self.height_error().max(other.height_error());
        let sign = self.normal.dot(other.normal).signum();
        let (x, y) = self.normal.any_orthonormal_pair();
        // Heights are quadratic on either side of a seam.
        let directions = [x, y, x + y, x - y, -x, -y, -x - y, y - x];
        self.is_tangent_to(other)
            && directions
                .into_iter()
                .all(|v| (self.bend.height(v) - sign * other.bend.height(v)).abs() <= 2.0 * allowed)
    }

    /// Whether it has a tangent plane, that is, is not an apex.
    pub fn is_flat_to_first_order(&self) -> bool {
        self.cosine == 0.0
    }

    /// Whether it is a plane.
    pub fn is_plane(&self) -> bool {
        self.is_flat_to_first_order() && self.bend.greatest() == 0.0
    }

    /// The error bound of the bend's heights.
    pub fn height_error(&self) -> f64 {
        self.turned * self.bend.greatest()
    }
}
