//! What the readers of mesh files share.
//!
//! The readers are ours because an error has to name its line, and a header that promises
//! more than the file contains must not be believed: nothing is reserved for what has not
//! been seen. Each one parses bytes, in time and memory that grow with their number alone,
//! and any bytes end in a mesh or an error. `docs/formats.md` lists what is read, ignored and
//! refused.

pub(super) mod builder;
pub(super) mod remarks;
pub(super) mod text;

use self::remarks::Made;
use crate::solid::tessellation::Mesh;

/// 2^-24, what rounding to f32 changes at most, as a share.
pub(super) const ROUNDING_32: f64 = 0.5 * f32::EPSILON as f64;

/// A mesh as a file states it.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// The triangles; a polygon is a fan of them.
    pub mesh: Mesh,
    /// How far the mesh may be from the solids' surface, in scene units, where a
    /// comment contains `deviation X`, as those of `cyltrace tessellate` do.
    pub deviation: Option<f64>,
    /// How the mesh was made, where comments say so as those of `cyltrace tessellate` do.
    /// Anybody can write them.
    pub made: Option<Made>,
    /// How far the format rounds a coordinate, as a share of it: 2^-24 where coordinates are
    /// stored as f32, 0 for f64 and for text.
    pub rounding: f64,
}
