//! The pieces of a leaf's surface that pass through a point.
//!
//! A leaf is convex, and near a point of its surface it is what all pieces there have
//! inside of them: a face one, an edge two, a corner of a cuboid three. To first order a
//! piece is the set of the directions `v` with
//!
//! ```text
//! v·n < k                                                                  (1)
//! ```
//!
//! where `n` is the outward normal and `k = 0`; at the apex of a cone `n` points from the
//! solid along the axis and `k` is minus the cosine of the angle between axis and wall. To
//! second order a smooth piece has a [`Bend`].
//!
//! **Which pieces pass through the point of a line** is decided by the displacement δ that
//! `line.rs` derives: those within 2 δ of it. The same displacement bounds how far a normal
//! may be turned: a plane whose points are displaced by δ over an extent `l` by `2 δ / l`,
//! and the normal of a surface of radius `R` by `δ / R` more. Two normals count as parallel if
//!
//! ```text
//! sin of the angle between them <= 2 θ, θ the greater of both              (2)
//! ```
//!
//! A cuboid's normals are stated as unit vectors, whose `l` is 1. Curvatures are off by the
//! share θ of themselves in the same way.
//!
//! **Which pieces pass through a stated point** is decided exactly, and so is what their
//! tangent planes divide (`planes.rs`).

use glam::DVec3;
use smallvec::SmallVec;

use super::super::spawn::SOLVER_DISPLACEMENT;
use super::bend::Bend;
use crate::solid::{AnySolid, Cuboid, Part, RoundedCone};

/// A piece of a leaf's surface at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The position of the leaf among the operands.
    pub leaf: u32,
    pub part: Part,
    /// On a seam the direction from the sphere, which `part` is, into the wall.
    pub to_wall: Option<DVec3>,
    /// `n` of (1), a unit vector.
    pub normal: DVec3,
    /// `k` of (1).
    pub cosine: f64,
    pub bend: Bend,
    /// θ of (2).
    pub turned: f64,
}

/// The pieces at a point, those of a leaf side by side.
pub(super) type Pieces = SmallVec<[Piece; 8]>;

/// When a piece passes through a point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nearness<'a> {
    /// When it is at most as far from the point, or has one of the parts that the solver
    /// names.
    Within { distance: f64, named: &'a [Part] },
    /// When the point as stated is on it.
    Exactly(DVec3),
}

/// A leaf as seen from a point of its surface.
pub(super) struct Viewed<'a> {
    pub leaf: u32,
    pub solid: &'a AnySolid,
    /// The point, from the solid's anchor.
    pub from_anchor: DVec3,
    /// δ of the point.
    pub displacement: f64,
    pub nearness: Nearness<'a>,
}

impl Viewed<'_> {
    /// Adds the pieces that pass through the point.
    pub fn add_pieces(&self, pieces: &mut Pieces) {
        match self.solid {
            AnySolid::Cylinder(one) => {
                self.add_cone(one.p1() - one.p0(), [one.radius(); 2], pieces);
            }
            AnySolid::Cone(one) => {
                self.add_cone(one.p1() - one.p0(), [one.radius0(), one.radius1()], pieces);
            }
            AnySolid::RoundedCone(one) => self.add_rounded_cone(one, pieces),
            AnySolid::Sphere(one) => self.add_sphere(Part::Side, DVec3::ZERO, one.radius(), pieces),
            AnySolid::Cuboid(one) => self.add_cuboid(one, pieces),
            // It has no inside.
            AnySolid::Disk(_) => {}
        }
    }

    /// Whether a part passes through the point that is at this distance from it.
    fn passes(&self, part: Part, distance: f64) -> bool {
        match self.nearness {
            Nearness::Within {
                distance: least,
                named,
            } => distance <= least || named.contains(&part),
            Nearness::Exactly(point) => self.solid.is_on(part, point),
        }
    }

    /// δ of the solid alone.
    fn own_displacement(&self) -> f64 {
        SOLVER_DISPLACEMENT * (self.solid.anchor().length() + self.solid.size())
    }

    fn flat(&self, part: Part, normal: DVec3, turned: f64) -> Piece {
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

    fn add_cuboid(&self, cuboid: &Cuboid, pieces: &mut Pieces) {
        const FACES: [[Part; 2]; 3] = [
            [Part::XMin, Part::XMax],
            [Part::YMin, Part::YMax],
            [Part::ZMin, Part::ZMax],
        ];
        let frame = cuboid.orientation().world_from_object();
        for (axis, faces) in FACES.into_iter().enumerate() {
            let (normal, half_width) = (frame.col(axis), cuboid.half_widths()[axis]);
            let height = self.from_anchor.dot(normal);
            for (part, side) in faces.into_iter().zip([-1.0, 1.0]) {
                if self.passes(part, (side * height - half_width).abs()) {
                    pieces.push(self.flat(part, normal * side, SOLVER_DISPLACEMENT));
                }
            }
        }
    }

    fn add_sphere(&self, part: Part, center: DVec3, radius: f64, pieces: &mut Pieces) {
        let normal = (self.from_anchor - center).normalize();
        let (around, along) = normal.any_orthonormal_pair();
        let curvature = 1.0 / radius;
        pieces.push(Piece {
            bend: Bend::new(around, along, curvature, [curvature; 2]),
            ..self.flat(part, normal, self.displacement / radius)
        });
    }

    /// An apex from which the solid reaches along `axis`; the angle between them has the
    /// cosine.
    fn apex(&self, part: Part, axis: DVec3, cosine: f64, turned: f64) -> Piece {
        Piece {
            cosine: -cosine,
            ..self.flat(part, -axis, turned)
        }
    }

    fn add_cone(&self, a: DVec3, [r0, r1]: [f64; 2], pieces: &mut Pieces) {
        let x = self.from_anchor;
        let length = a.length();
        let axis = a / length;
        let turned = 2.0 * self.own_displacement() / length;
        let slope = (r1 - r0) / length;
        let cosine = 1.0 / libm::hypot(1.0, slope);
        let height = x.dot(axis);
        for (part, radius, from, out) in [
            (Part::Cap0, r0, height.abs(), -axis),
            (Part::Cap1, r1, (height - length).abs(), axis),
        ] {
            if !self.passes(part, from) {
                continue;
            }
            if radius == 0.0 {
                pieces.push(self.apex(part, -out, cosine, turned));
                return;
            }
            pieces.push(self.flat(part, out, turned));
        }
        let radial = x - axis * height;
        let (distance, radius) = (radial.length(), r0 + slope * height);
        if self.passes(Part::Side, (distance - radius).abs() * cosine) {
            let outward = radial / distance;
            let curvature = cosine / radius;
            let along = (axis + outward * slope) * cosine;
            pieces.push(Piece {
                bend: Bend::new(axis.cross(outward), along, curvature, [0.0; 2]),
                ..self.flat(
                    Part::Side,
                    (outward - axis * slope) * cosine,
                    turned + self.displacement * curvature,
                )
            });
        }
    }

    fn add_rounded_cone(&self, solid: &RoundedCone, pieces: &mut Pieces) {
        let x = self.from_anchor;
        let (r0, r1) = (solid.radius0(), solid.radius1());
        let a = solid.p1() - solid.p0();
        let Some(taper) = solid.taper() else {
            // One ball contains the other.
            return if r0 >= r1 {
                self.add_sphere(Part::Cap0, DVec3::ZERO, r0, pieces);
            } else {
                self.add_sphere(Part::Cap1, a, r1, pieces);
            };
        };
        let (length, delta, beta) = (a.length(), r1 - r0, taper.beta());
        let axis = a / length;
        let (cosine, sine) = (beta.sqrt() / length, delta / length);
        // From the first seam, and to the second, along the axis.
        let height = x.dot(axis);
        let from_first = height + r0 * sine;
        let to_second = beta / length - from_first;
        let is_wall = self.passes(Part::Side, (-from_first).max(-to_second));
        for (part, from_seam, center, radius, inward) in [
            (Part::Cap0, from_first, DVec3::ZERO, r0, axis),
            (Part::Cap1, to_second, a, r1, -axis),
        ] {
            if !self.passes(part, from_seam) {
                continue;
            }
            if radius == 0.0 {
                let turned = 2.0 * self.own_displacement() / length;
                pieces.push(self.apex(part, inward, cosine, turned));
                return;
            }
            let start = pieces.len();
            self.add_sphere(part, center, radius, pieces);
            if is_wall {
                let piece = &mut pieces[start];
                let around = axis.cross(piece.normal).normalize();
                let along = around.cross(piece.normal).normalize();
                let along = if along.dot(inward) > 0.0 {
                    along
                } else {
                    -along
                };
                let curvature = 1.0 / radius;
                let lengthwise = [curvature, 0.0];
                piece.to_wall = Some(along);
                piece.bend = Bend::new(around, along, curvature, lengthwise);
            }
            return;
        }
        let radial = x - axis * height;
        let outward = radial / radial.length();
        let radius = r0 + delta * (from_first * length / beta);
        let along = axis * cosine + outward * sine;
        let turned = 2.0 * self.own_displacement() / length + self.displacement / radius;
        pieces.push(Piece {
            bend: Bend::new(axis.cross(outward), along, 1.0 / radius, [0.0; 2]),
            ..self.flat(Part::Side, outward * cosine - axis * sine, turned)
        });
    }
}

impl Piece {
    /// The part that it is in a direction of the tangent plane; `None` where that is along a
    /// seam.
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

    /// Whether two pieces are the same to first order: one plane, or one cone.
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

    /// Whether two pieces are the same to second order.
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

    /// Whether it has a tangent plane: all but an apex have.
    pub fn is_flat_to_first_order(&self) -> bool {
        self.cosine == 0.0
    }

    /// Whether it is a plane.
    pub fn is_plane(&self) -> bool {
        self.is_flat_to_first_order() && self.bend.greatest() == 0.0
    }

    /// By how much a height of the bend may be off.
    pub fn height_error(&self) -> f64 {
        self.turned * self.bend.greatest()
    }
}
