//! Stanford PLY.

mod data;
mod header;
mod read;
mod write;

use super::{MeshFormat, Writer};
use crate::meshes::MeshError;
use crate::meshes::reading::MeshFile;

/// Binary or text; written as binary, little endian, with f64 vertices.
pub(super) struct Ply;

impl MeshFormat for Ply {
    const NAME: &'static str = "Stanford PLY";
    const EXTENSION: &'static str = "ply";
    const WRITER: Option<Writer> = Some(Writer {
        check: write::check,
        bytes: write::bytes,
        is_size_exact: true,
        write: write::write,
    });

    fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
        read::parse(bytes)
    }
}
