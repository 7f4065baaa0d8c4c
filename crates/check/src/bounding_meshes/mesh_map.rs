//! A placed solid in the space of the meshes, in f64 with bounds of the errors.
//!
//! With `M = 2^k L` of the placement's matrix `L` and `b` the image of the solid's
//! *anchor* `p` ([`AnySolid::anchor`](cyltrace::solid::AnySolid::anchor)), the point `p + x` is `b + M x` in the mesh. A [`MeshMap`] contains `M`,
//! rounded from the exact product of all placements, so off by at most
//! `u |M|` (Frobenius norm, u = 2^-53), and a computed inverse `G`, whose defect
//! `‖M G - I‖` is measured:
//!
//! ```text
//! ‖M_exact G - I‖ <= ‖fl(M G - I)‖ + 4 u |M| |G| + u |M| |G| = defect
//! ```
//!
//! `b` is the f64 vector nearest to the exact image.
//!
//! A vertex `v` of the mesh is seen from the anchor as `x` with `M x = v - b`. For `q =
//! fl(v - b)`, off by `u |q| + u |b|`, and `y = fl(G q)`, whose product adds `3 u |G| |q|`:
//!
//! ```text
//! |y - x| <= |G| (4 u |q| + u |b| + 2 defect (|q| + |b| u))       if defect <= 1/4
//! ```
//!
//! since `x = G (I + E)⁻¹ q` with `|E| <= defect`.

use glam::{DMat3, DVec3};

use cyltrace::math::{UNIT_ROUNDOFF, frobenius_norm};
use cyltrace_oracle::{ExactVector, exact};

use super::mesh_frame::MeshFrame;
use super::window::{PlacedFrame, PlacedSolid};

/// From the space of a placed prototype to the meshes and back; vectors only.
#[derive(Clone, Debug)]
pub(crate) struct MeshMap {
    /// `M`: to the mesh.
    pub matrix: DMat3,
    /// `G`: from the mesh.
    pub inverse: DMat3,
    /// At least `|M|`.
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

/// The anchor of a placed solid in the meshes' space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshAnchor<'a> {
    /// To the mesh and back.
    pub map: &'a MeshMap,
    /// `b`.
    pub base: DVec3,
}

/// u, doubled for the roundings of the bounds.
const UNIT: f64 = 2.0 * UNIT_ROUNDOFF;

impl<'a> MeshAnchor<'a> {
    /// The image of `anchor`, a point of the solid's own space.
    pub fn new(frame: &MeshFrame, map: &'a MeshMap, placed: &PlacedSolid, anchor: DVec3) -> Self {
        let in_world = placed.frame.exact.point(&ExactVector::new(anchor));
        let from_center = &in_world - &ExactVector::new(frame.center());
        Self {
            map,
            base: from_center.rounded() * frame.scale(),
        }
    }

    /// `y` for a point of the mesh and the bound of its error; `None` if the defect is too
    /// large.
    pub fn seen(&self, vertex: DVec3) -> Option<(DVec3, f64)> {
        let map = self.map;
        if !(map.defect <= 0.25) {
            return None;
        }
        let q = vertex - self.base;
        let y = map.inverse * q;
        let (reach, base) = (q.length(), self.base.length());
        let defect = 2.5 * map.defect * (reach + UNIT * base);
        Some((y, map.squeeze * (4.0 * UNIT * reach + UNIT * base + defect)))
    }
}
