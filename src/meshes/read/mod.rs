//! Triangle meshes from OBJ, PLY and STL files: a small reader for each.
//!
//! The readers are ours because an error has to name its line, and a header that promises
//! more than the file contains must not be believed: nothing is reserved for what has not
//! been seen. Each one parses bytes, in time and memory that grow with their number alone,
//! and any bytes end in a mesh or an error. `docs/formats.md` lists what is read, ignored and
//! refused.

mod builder;
mod error;
mod obj;
mod ply;
mod ply_data;
mod ply_header;
mod remarks;
mod stl;
mod text;

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

pub use self::error::{MeshError, MeshPlace, MeshReadError};
pub use self::obj::parse_obj;
pub use self::ply::parse_ply;
pub use self::remarks::Made;
pub use self::stl::parse_stl;
use crate::scene::MOST_MESH_BYTES;
use crate::solid::tessellation::Mesh;

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

/// Reads a mesh in the format that the file's name ends in.
///
/// # Errors
/// When the name ends in none of `.stl`, `.obj` and `.ply`, the file cannot be read, is larger
/// than [`MOST_MESH_BYTES`] or malformed, a face names a vertex that does not exist, or
/// there is no face.
pub fn read_mesh(path: &Path) -> Result<MeshFile, MeshReadError> {
    read_mesh_within(path, MOST_MESH_BYTES)
}

/// As [`read_mesh`], for a file of at most `most_bytes`.
///
/// # Errors
/// As those of [`read_mesh`].
pub fn read_mesh_within(path: &Path, most_bytes: u64) -> Result<MeshFile, MeshReadError> {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    let parse: fn(&[u8]) -> Result<MeshFile, MeshError> =
        match extension.as_ref().and_then(|e| e.to_str()) {
            Some("obj") => parse_obj,
            Some("ply") => parse_ply,
            Some("stl") => parse_stl,
            _ => return Err(MeshReadError::Extension { path: path.into() }),
        };
    let most_bytes = most_bytes.min(MOST_MESH_BYTES);
    let bytes = read_bytes(path, most_bytes).map_err(|source| MeshReadError::Read {
        path: path.into(),
        source,
    })?;
    let bytes = bytes.ok_or_else(|| MeshReadError::TooLarge {
        path: path.into(),
        most_bytes,
    })?;
    parse(&bytes).map_err(|error| MeshReadError::Content {
        path: path.into(),
        error,
    })
}

/// The bytes of a file; `None` if they are more than `most_bytes`.
fn read_bytes(path: &Path, most_bytes: u64) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    // A pipe has no length, so that reading is limited as well.
    if file.metadata()?.len() > most_bytes {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.take(most_bytes + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most_bytes).then_some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_are_too_long_are_refused_before_they_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.obj");
        std::fs::write(&path, "v 0 0 0\n".repeat(200)).expect("a file");
        let message = read_mesh_within(&path, 1000).unwrap_err().to_string();
        assert!(message.contains("more than 1000 bytes"), "{message}");
    }
}
