//! A placed solid in the space of the meshes, in f64 with bounds of the errors.
//!
//! With `M = 2^k L` of the placement's matrix `L` and `b` the image of `p0`, the
//! solid's point `p0 + x` is `b + M x` in the mesh. A [`MeshMap`] holds `M`,
//! which is rounded from the exact product of all placements, so off by at most
//! `u |M|` (Frobenius norm, u = 2^-53), and a computed inverse `G`, whose defect
//! `‖M G - I‖` is measured:
//!
//! ```text
//! ‖M_exact G - I‖ <= ‖fl(M G - I)‖ + 4 u |M| |G| + u |M| |G| = defect
//! ```
//!
//! `b` is the f64 vector nearest to the exact image.

use glam::{DMat3, DVec3};

use crate::math::{UNIT_ROUNDOFF, frobenius_norm};
use crate::oracle::{ExactVector, exact};

use super::mesh_frame::MeshFrame;
use super::placed::{PlacedFrame, PlacedSolid};

/// From the space of a placed prototype to the meshes and back; vectors only.
#[derive(Clone, Debug)]
pub(in crate::check) struct MeshMap {
    /// `M`: to the mesh.
    pub matrix: DMat3,
    /// `G`: from the mesh.
    pub inverse: DMat3,
    /// At least `|M|`: how much vectors grow on the way to the mesh.
    pub stretch: f64,
    /// At least `|G|`.
    pub squeeze: f64,
    /// At least `‖M G - I‖` for the exact `M`.
    pub defect: f64,
    /// Whether it mirrors.
    pub is_mirrored: bool,
}

impl MeshMap {
    pub fn new(frame: &MeshFrame, placed: &PlacedFrame) -> Self {
        let matrix = placed.world_from_object.matrix3 * frame.scale();
        let inverse = matrix.inverse();
        let growth = 1.0 + 16.0 * UNIT_ROUNDOFF;
        let stretch = frobenius_norm(&matrix) * growth;
        let squeeze = frobenius_norm(&inverse) * growth;
        let residual = frobenius_norm(&(matrix * inverse - DMat3::IDENTITY));
        let (_, determinant) = placed.exact.adjugate();
        Self {
            matrix,
            inverse,
            stretch,
            squeeze,
            defect: residual * growth + 6.0 * UNIT_ROUNDOFF * stretch * squeeze,
            is_mirrored: determinant < exact(0.0),
        }
    }
}

/// A placed solid as the meshes have it.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) struct MeshSolid<'a> {
    /// The solid as it was stated.
    pub placed: &'a PlacedSolid,
    /// Where it stands.
    pub map: &'a MeshMap,
    /// `b`: where `p0` is in the mesh.
    pub base: DVec3,
    /// `p1 - p0` in the solid's own space, rounded.
    pub axis: DVec3,
    /// Its length, rounded.
    pub length: f64,
    /// The radius in the solid's own space.
    pub radius: f64,
}

impl<'a> MeshSolid<'a> {
    pub fn new(frame: &MeshFrame, map: &'a MeshMap, placed: &'a PlacedSolid) -> Self {
        let cylinder = &placed.cylinder;
        let in_world = placed.frame.exact.point(&ExactVector::new(cylinder.p0()));
        let from_centre = &in_world - &ExactVector::new(frame.centre());
        let axis = cylinder.p1() - cylinder.p0();
        Self {
            placed,
            map,
            base: from_centre.rounded() * frame.scale(),
            axis,
            length: axis.length(),
            radius: cylinder.radius(),
        }
    }
}
