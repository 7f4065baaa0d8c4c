//! Prisms inside and around every solid of a window, as f32 triangles.
//!
//! In the solid's own space a prism is right: its faces stand on the lines
//! `x·n_i = d` of the cross-section, with the normals `n_i` at angles of
//! `2π (i + 1/2) / N`, and its caps are across the axis. Without rounding,
//! `d = r cos(π/N)` is inscribed and `d = r` circumscribed.
//!
//! Rounding moves a vertex by at most `ε` in the mesh: 2^-24 of its distance from
//! the mesh's origin (half a unit of the last place is at most 2^-24 of each
//! coordinate), and what computing it in f64 costs. Seen from the solid, with
//! `M` its map to the mesh, it moves along a covector `n` by at most
//! `δ(n) = ε |M⁻ᵀ n|`, the support of the ball of radius `ε` taken back. So each
//! face has a margin of its own, and the vertices are where neighbouring faces
//! meet after they moved.
//!
//! *Inscribed*, faces move inward by `δ(n_i)` and caps by `δ(a/|a|)`. The vertices
//! are then in `{x·n_i <= r cos(π/N) - δ(n_i)}`; adding any rounding keeps them in
//! `{x·n_i <= r cos(π/N)}`, the inscribed prism, and in the solid.
//!
//! *Circumscribed*, the plane of a triangle has to stay outside, and it passes
//! through three rounded vertices, tilted. In the coordinates λ that are 1 at
//! one vertex and 0 at the others, it moves at a point by at most `δ Σ|λ|`. For
//! a side of width `w`, at a point of the solid at the distance `y` from the face's
//! middle line, `Σ|λ| <= 3 + 4 |y| / w`, and the wall recedes there by
//! `r - √(r² - y²) >= y² / 2r`; the greatest of `4 δ |y| / w - y² / 2r` is
//! `8 r δ² / w²`. With `w = 2 r tan(π/N)` the margin is
//!
//! ```text
//! side  δ (3 + 2 δ / (r tan²(π/N)))
//! ```
//!
//! A triangle of a cap has a corner in the middle; it is enough that it is
//! beyond the end and that the solid's middle is behind its plane
//! (`containment`), for which the caps move by `δ(a/|a|)`. A solid so flat that
//! the planes tilt past its middle gets them where they pass over the whole
//! disc, on which `Σ|λ| <= 2 + max(1, cot(π/N))`: that many `δ` away. This grows
//! with N, and so it is not done for all: at 512 sides it is 165 `δ`, and the
//! caps' silhouettes would be wider than the walls'.
//!
//! That takes faces to be as wide as in the regular polygon. Where a map is so
//! flat that margins differ much between neighbours it need not hold, so every
//! prism is verified as built (`containment`). A circumscribed one that fails is
//! built again with its caps over the disc, then with twice the margin, up to
//! [`MOST_DOUBLINGS`] times.
//!
//! A margin that takes an inscribed prism's faces past the axis, or its corners
//! past each other, leaves nothing of it.

use std::f64::consts::PI;
use std::iter;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::embree::GREATEST_COORDINATE;
use crate::math::{UNIT_ROUNDOFF, power_of_two};

use super::containment::{holds_all, is_enclosed};
use super::mesh_frame::MeshFrame;
use super::mesh_solid::{MeshMap, MeshSolid};
use super::placed::Window;

/// How often a circumscribed prism that fails is made looser: 16 margins in the
/// end. What still fails then is not resolved by f32.
const MOST_DOUBLINGS: u32 = 4;

/// Solids that a thread builds at a time.
const CHUNK: usize = 256;

/// Vertices nearer to 0 than this are put there: Embree takes subnormal numbers
/// for 0.
const LEAST: f64 = power_of_two(-100);

/// Bytes that a triangle takes, with its share of the corners, in our lists and
/// with Embree. Measured with Embree 3.13.5 on struts of `scenes/lattice.toml`:
/// 96 with 16 sides, 94 with 64 and 90 with 512.
const BYTES_PER_TRIANGLE: u64 = 93;

/// Which of the two prisms of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// In the capped solid.
    Inscribed,
    /// Around the capped solid.
    Circumscribed,
}

/// Prisms as one mesh; every one is verified.
#[derive(Debug)]
pub(crate) struct Prisms {
    /// The corners, in the mesh's space.
    pub vertices: Vec<[f32; 3]>,
    /// Corners counter-clockwise as seen from outside. Prism after prism.
    pub triangles: Vec<[u32; 3]>,
    /// The number in the window of the solid of each prism, rising.
    pub solid_of: Vec<u32>,
    /// Triangles of each prism, four times its sides: two of every side, then
    /// the disc at `p0` and that at `p1`.
    pub triangles_per_prism: usize,
    /// Solids without an inscribed prism: f32 leaves nothing of it.
    pub empty: Vec<u32>,
    /// Solids without a circumscribed prism: f32 does not resolve them.
    pub unbounded: Vec<u32>,
}

impl Prisms {
    fn new(segments: u32) -> Self {
        Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
            solid_of: Vec::new(),
            triangles_per_prism: 4 * segments as usize,
            empty: Vec::new(),
            unbounded: Vec::new(),
        }
    }

    fn append(&mut self, other: &Self) {
        let first = self.vertices.len() as u32;
        let shifted = other
            .triangles
            .iter()
            .map(|&corners| corners.map(|i| first + i));
        self.triangles.extend(shifted);
        self.vertices.extend_from_slice(&other.vertices);
        self.solid_of.extend_from_slice(&other.solid_of);
        self.empty.extend_from_slice(&other.empty);
        self.unbounded.extend_from_slice(&other.unbounded);
    }

    fn push(&mut self, solid: u32, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let first = self.vertices.len() as u32;
        let shifted = triangles.iter().map(|&corners| corners.map(|i| first + i));
        self.triangles.extend(shifted);
        self.vertices.extend_from_slice(vertices);
        self.solid_of.push(solid);
    }
}

/// The prisms with so many sides of all solids of a window, at least 3 each and
/// fewer than 2^32 corners in all.
pub(crate) fn prisms(window: &Window, frame: &MeshFrame, segments: u32, side: Side) -> Prisms {
    assert!(
        segments >= 3,
        "a prism has at least 3 sides, not {segments}"
    );
    let corners = window.solids.len() as u64 * (2 * u64::from(segments) + 2);
    assert!(
        corners <= u64::from(u32::MAX),
        "{corners} corners are too many for a mesh"
    );
    let builder = Builder::new(segments, side);
    let parts: Vec<Prisms> = window
        .solids
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, solids)| {
            let mut part = Prisms::new(segments);
            let mut maps = None;
            for (solid, number) in solids.iter().zip((chunk * CHUNK) as u32..) {
                // Solids of one place follow each other.
                let (_, map) = match &mut maps {
                    Some((placed, map)) if Arc::ptr_eq(placed, &solid.frame) => (placed, map),
                    other => {
                        let map = MeshMap::new(frame, &solid.frame);
                        let (placed, map) = other.insert((Arc::clone(&solid.frame), map));
                        (placed, map)
                    }
                };
                let solid = MeshSolid::new(frame, map, solid);
                match builder.verified(&solid, frame) {
                    Some(vertices) => {
                        part.push(number, &vertices, builder.triangles(map.is_mirrored));
                    }
                    None if side == Side::Inscribed => part.empty.push(number),
                    None => part.unbounded.push(number),
                }
            }
            part
        })
        .collect();
    let mut all = Prisms::new(segments);
    all.vertices
        .reserve_exact(parts.iter().map(|part| part.vertices.len()).sum());
    all.triangles
        .reserve_exact(parts.iter().map(|part| part.triangles.len()).sum());
    for part in parts {
        all.append(&part);
    }
    all
}

/// Bytes that both meshes of so many solids take, with Embree's trees over them.
/// While the second tree is built, Embree holds up to a third more of its own.
pub(crate) fn bytes_needed(solids: u64, segments: u32) -> u64 {
    let triangles = 2 * 4 * u64::from(segments);
    solids.saturating_mul(triangles * BYTES_PER_TRIANGLE)
}

/// What all prisms with so many sides have in common.
struct Builder {
    side: Side,
    /// cos and sin of the angle of each face's normal.
    normals: Vec<(f64, f64)>,
    /// cos and sin of 2π/N, the turn from one face to the next.
    turn: (f64, f64),
    /// cos and tan of π/N.
    half: (f64, f64),
    /// The corners of each triangle, for a map that does not and one that does
    /// mirror.
    triangles: [Vec<[u32; 3]>; 2],
}

impl Builder {
    fn new(segments: u32, side: Side) -> Self {
        let part = PI / f64::from(segments);
        let normals = (0..segments).map(|face| {
            let (sin, cos) = libm::sincos(part * f64::from(2 * face + 1));
            (cos, sin)
        });
        let (turn_sin, turn_cos) = libm::sincos(2.0 * part);
        let triangles = triangles(segments);
        let mirrored = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Self {
            side,
            normals: normals.collect(),
            turn: (turn_cos, turn_sin),
            half: (libm::cos(part), libm::tan(part)),
            triangles: [triangles, mirrored],
        }
    }

    fn triangles(&self, is_mirrored: bool) -> &[[u32; 3]] {
        &self.triangles[usize::from(is_mirrored)]
    }

    /// The vertices of a prism that was proven to be on its side of the solid.
    fn verified(&self, solid: &MeshSolid, frame: &MeshFrame) -> Option<Vec<[f32; 3]>> {
        if self.side == Side::Inscribed {
            let vertices = self.vertices(solid, 1.0, 1.0)?;
            return holds_all(solid, frame, &vertices).then_some(vertices);
        }
        let over_disc = 2.0 + (1.0 / self.half.1).max(1.0);
        let doubled = (0..=MOST_DOUBLINGS).map(|doublings| f64::from(1 << doublings));
        let looser = doubled.map(|margins| (margins, over_disc * margins));
        iter::once((1.0, 1.0))
            .chain(looser)
            .find_map(|(sides, caps)| {
                let vertices = self.vertices(solid, sides, caps)?;
                let triangles = self.triangles(solid.map.is_mirrored).iter();
                let corners = triangles.map(|corners| corners.map(|i| vertices[i as usize]));
                is_enclosed(solid, frame, corners).then_some(vertices)
            })
    }

    /// The vertices, rounded, with so many times the margins of the sides and so
    /// many `δ` at the caps: first those in the middles of the caps, then those
    /// of the corners, at `p0` and `p1` in turn.
    fn vertices(&self, solid: &MeshSolid, sides: f64, caps: f64) -> Option<Vec<[f32; 3]>> {
        let (radius, map) = (solid.radius, solid.map);
        let (cos, tan) = self.half;
        let unit = solid.axis / solid.length;
        let first = unit.any_orthonormal_vector();
        let second = unit.cross(first);
        let epsilon = vertex_error(solid, cos);
        let back = map.inverse.transpose();
        let (back_first, back_second) = (back * first, back * second);

        let axial = epsilon * (back * unit).length() * caps;
        let (low, high) = match self.side {
            Side::Inscribed => (axial, solid.length - axial),
            Side::Circumscribed => (-axial, solid.length + axial),
        };
        if !(low < high) {
            return None;
        }
        let distance = |&(cos_i, sin_i): &(f64, f64)| {
            let delta = epsilon * (back_first * cos_i + back_second * sin_i).length();
            match self.side {
                Side::Inscribed => radius * cos - delta * sides,
                Side::Circumscribed => {
                    radius + delta * (3.0 + 2.0 * delta / (radius * tan * tan)) * sides
                }
            }
        };
        let distances: Vec<f64> = self.normals.iter().map(distance).collect();

        let across = [map.matrix * first, map.matrix * second];
        let along = map.matrix * unit;
        let ends = [solid.base + along * low, solid.base + along * high];
        let mut vertices = Vec::with_capacity(2 * self.normals.len() + 2);
        vertices.extend(ends.map(rounded));
        let faces = self.normals.len();
        for face in 0..faces {
            let here = distances[face];
            let before = distances[(face + faces - 1) % faces];
            let after = distances[(face + 1) % faces];
            // Where the line meets those before and after it, counted along it
            // from the foot of its normal.
            let start = (here * self.turn.0 - before) / self.turn.1;
            let end = (after - here * self.turn.0) / self.turn.1;
            if !(here > 0.0 && start < end) {
                return None;
            }
            let (cos_i, sin_i) = self.normals[face];
            let corner =
                across[0] * (cos_i * here - sin_i * end) + across[1] * (sin_i * here + cos_i * end);
            vertices.extend(ends.map(|middle| rounded(middle + corner)));
        }
        let is_legal = |vertex: &[f32; 3]| vertex.iter().all(|x| x.abs() < GREATEST_COORDINATE);
        vertices.iter().all(is_legal).then_some(vertices)
    }
}

/// The corners of the triangles of a prism, outward in a map that does not
/// mirror.
fn triangles(segments: u32) -> Vec<[u32; 3]> {
    let corner = |face: u32, end: u32| 2 + 2 * (face % segments) + end;
    let faces = 0..segments;
    let sides = faces.clone().flat_map(|face| {
        let (here, next) = (face, face + 1);
        [
            [corner(here, 0), corner(next, 0), corner(next, 1)],
            [corner(here, 0), corner(next, 1), corner(here, 1)],
        ]
    });
    let bottom = faces
        .clone()
        .map(|face| [0, corner(face + 1, 0), corner(face, 0)]);
    let top = faces.map(|face| [1, corner(face, 1), corner(face + 1, 1)]);
    sides.chain(bottom).chain(top).collect()
}

/// `ε`: by how much a vertex is off in the mesh. `2 r / cos(π/N)` is above the
/// distance of every corner from the axis, with any margin worth having; the
/// corner in f64 is a sum of products that rounds 16 times at most.
fn vertex_error(solid: &MeshSolid, cos: f64) -> f64 {
    let size = solid.map.stretch * (solid.length + 2.0 * solid.radius / cos);
    let far_end = solid.base + solid.map.matrix * solid.axis;
    let beside = solid.map.stretch * 2.0 * solid.radius / cos;
    let reach = solid.base.length().max(far_end.length()) + beside;
    let single = power_of_two(-24) * reach;
    let double = 16.0 * UNIT_ROUNDOFF * (solid.base.length() + size);
    (single + double) * (1.0 + power_of_two(-20)) + 2.0 * LEAST
}

fn rounded(vertex: DVec3) -> [f32; 3] {
    let nearest = |x: f64| if x.abs() < LEAST { 0.0 } else { x as f32 };
    vertex.to_array().map(nearest)
}

#[cfg(test)]
mod tests;
