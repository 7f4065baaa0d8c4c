//! Mesh files on disk.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::reading::MeshFile;
use super::{Format, MeshReadError};
use crate::scene::MOST_MESH_BYTES;

/// Reads a mesh in the format of the file's extension.
///
/// # Errors
/// If the extension is that of no [`Format`], if the file cannot be read, is larger than
/// [`MOST_MESH_BYTES`] or malformed, if a face names a vertex that does not exist, or if
/// the mesh has no faces.
pub fn read_mesh(path: &Path) -> Result<MeshFile, MeshReadError> {
    read_mesh_within(path, MOST_MESH_BYTES)
}

/// As [`read_mesh`], for a file of at most `most_bytes`.
///
/// # Errors
/// See [`read_mesh`].
pub fn read_mesh_within(path: &Path, most_bytes: u64) -> Result<MeshFile, MeshReadError> {
    let format = Format::of(path);
    let format = format.ok_or_else(|| MeshReadError::Extension {
        path: path.into(),
        endings: Format::all_endings(),
    })?;
    let most_bytes = most_bytes.min(MOST_MESH_BYTES);
    let bytes = read_bytes(path, most_bytes).map_err(|source| MeshReadError::Read {
        path: path.into(),
        source,
    })?;
    let bytes = bytes.ok_or_else(|| MeshReadError::TooLarge {
        path: path.into(),
        most_bytes,
    })?;
    format
        .parse(&bytes)
        .map_err(|error| MeshReadError::Content {
            path: path.into(),
            error,
        })
}

/// The bytes of a file; `None` if it has more than `most_bytes`.
fn read_bytes(path: &Path, most_bytes: u64) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    // A pipe reports no length, so the read is limited too.
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
    fn files_that_are_too_long_are_rejected_before_they_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.obj");
        std::fs::write(&path, "v 0 0 0\n".repeat(200)).expect("a file");
        let message = read_mesh_within(&path, 1000).unwrap_err().to_string();
        assert!(message.contains("more than 1000 bytes"), "{message}");
    }
}
