//! What the readers of mesh files share.
//!
//! The readers are our own for two reasons: an error has to name its line, and a header may
//! declare more than the file contains, so no memory is reserved for data not yet seen. Each
//! reader parses bytes in time and memory proportional to their number, and returns a mesh or
//! an error for any input. `docs/formats.md` lists what is read, ignored and rejected.

pub(super) mod builder;
pub(super) mod remarks;
pub(super) mod text;

use self::remarks::Made;
use crate::solid::tessellation::Mesh;

/// 2^-24, the greatest relative error of rounding to f32.
pub(super) const ROUNDING_32: f64 = 0.5 * f32::EPSILON as f64;

/// The content of a mesh file.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// The triangles; a polygon is split into a fan.
    pub mesh: Mesh,
    /// The distance of the mesh from the solids' surface, in scene units, if a comment
    /// contains `deviation X`, as in files of `cyltrace tessellate`.
    pub deviation: Option<f64>,
    /// How the mesh was made, if comments state it as those of `cyltrace tessellate` do.
    /// Any program can write such comments.
    pub made: Option<Made>,
    /// The relative error of rounding a coordinate: 2^-24 for STL and for f32 properties of
    /// PLY, 0 otherwise.
    pub rounding: f64,
}
