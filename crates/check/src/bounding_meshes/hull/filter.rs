//! The proofs of `proof` in f64, which decide nearly all cases.
//!
//! Everything is in the meshes' units, with the errors of
//! `mesh_map` for the point `y` of a vertex ([`MeshAnchor::seen`]). Every product below
//! rounds by a few u of the sizes of its factors; the bounds count 8, twice. NaN fails.

use glam::DVec3;

use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::mesh_map::{MeshAnchor, MeshMap};
use crate::bounding_meshes::window::PlacedSolid;
use crate::solids::taper::UNIT;
use crate::solids::{Shape, shape};

/// A placed solid in the meshes' space, for the proofs in f64.
pub(super) struct Rounded<'a> {
    anchor: MeshAnchor<'a>,
    shape: Shape,
    /// The length of the shape's axis.
    length: f64,
    /// The middle in the mesh and the bound of its error.
    middle: (DVec3, f64),
}

impl<'a> Rounded<'a> {
    pub fn new(frame: &MeshFrame, map: &'a MeshMap, placed: &PlacedSolid) -> Self {
        let shape = shape(&placed.solid);
        let [start, end] = shape.get().end_points();
        let anchor = MeshAnchor::new(frame, map, placed, start);
        let between = end - start;
        let half = map.matrix * (0.5 * between);
        let size = anchor.base.length() + map.stretch * between.length();
        Self {
            anchor,
            shape,
            length: shape.get().axis().length(),
            middle: (anchor.base + half, 8.0 * UNIT * size),
        }
    }

    /// The anchor.
    pub fn anchor(&self) -> &MeshAnchor<'a> {
        &self.anchor
    }

    /// True only if the solid contains the point of the mesh.
    pub fn surely_contains(&self, vertex: DVec3) -> bool {
        self.anchor.seen(vertex).is_some_and(|(y, error)| {
            let error = error + 8.0 * UNIT * (y.length() + self.length);
            self.shape.get().surely_contains(y, error)
        })
    }

    /// True only if (1) is true for a vertex and `m`.
    pub fn is_surely_beyond(&self, vertex: DVec3, m: DVec3) -> bool {
        let seen = self.anchor.seen(vertex);
        seen.is_some_and(|(y, error)| self.shape.get().is_surely_beyond(y, error, m))
    }

    /// True only if a point of the mesh is above (1) or below (-1) the disk.
    pub fn is_surely_on_side(&self, vertex: DVec3, side: f64) -> bool {
        let (Some((y, error)), Some((radius, axis))) =
            (self.anchor.seen(vertex), self.shape.flat())
        else {
            return false;
        };
        let (height, off) = (y.dot(axis), y.cross(axis).length());
        let error = error + 8.0 * UNIT * y.length();
        side * height > error && off + error <= radius * (1.0 - 8.0 * UNIT)
    }

    /// True only if the solid's middle is strictly behind the plane of a triangle.
    pub fn is_surely_around_middle(&self, [v0, v1, v2]: [DVec3; 3]) -> bool {
        let (d1, d2) = (v1 - v0, v2 - v0);
        let n = d1.cross(d2);
        let n_error = 8.0 * UNIT * d1.length() * d2.length();
        let (middle, middle_error) = self.middle;
        let q = v0 - middle;
        let reach = q.length() + middle_error;
        n.dot(q) > n_error * reach + n.length() * (8.0 * UNIT * reach + middle_error)
    }
}
