//! Wavefront OBJ.

mod read;
mod write;

use super::{MeshFormat, Writer};
use crate::meshes::MeshError;
use crate::meshes::reading::MeshFile;

/// Text: vertices, faces, and a group for each placed prototype.
pub(super) struct Obj;

impl MeshFormat for Obj {
    const NAME: &'static str = "Wavefront OBJ";
    const EXTENSION: &'static str = "obj";
    const WRITER: Option<Writer> = Some(Writer {
        check: |_| Ok(()),
        bytes: write::most_bytes,
        is_size_exact: false,
        write: write::write,
    });

    fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
        read::parse(bytes)
    }
}
