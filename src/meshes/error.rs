//! Errors of reading and writing meshes: what is wrong, and where.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::solid::tessellation::{GREATEST_SEGMENTS, LEAST_SEGMENTS};

/// Where something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshPlace {
    /// A line, counted from 1.
    Line(u64),
    /// The binary record of an element, both counted from 0: `vertex 3`.
    Record(&'static str, u64),
    /// The file as a whole.
    File,
}

/// What is wrong with the content of a mesh file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    /// Where it is.
    pub place: MeshPlace,
    /// What it is, and what would be right.
    pub message: String,
}

impl MeshError {
    pub(super) fn new(place: MeshPlace, message: impl Into<String>) -> Self {
        Self {
            place,
            message: message.into(),
        }
    }

    pub(super) fn in_line(line: u64, message: impl Into<String>) -> Self {
        Self::new(MeshPlace::Line(line), message)
    }

    pub(super) fn in_file(message: impl Into<String>) -> Self {
        Self::new(MeshPlace::File, message)
    }
}

/// After the path of a file: `:3: message`, `: vertex 3: message` or `: message`.
impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.place {
            MeshPlace::Line(line) => write!(f, ":{line}: {}", self.message),
            MeshPlace::Record(what, number) => write!(f, ": {what} {number}: {}", self.message),
            MeshPlace::File => write!(f, ": {}", self.message),
        }
    }
}

/// Why a mesh cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum MeshReadError {
    /// The extension is that of no mesh format.
    #[error("{}: the name of a mesh must end in {endings}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
        /// The extensions of the formats.
        endings: String,
    },
    /// The file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file is longer than a mesh may be.
    #[error("{}: the file has more than {most_bytes} bytes, the limit for a mesh", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit.
        most_bytes: u64,
    },
    /// The content is not a mesh.
    #[error("{}{error}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: MeshError,
    },
}

/// Why a mesh file cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// The extension is that of no format that can be written.
    #[error("cannot write {path:?}: the name of a mesh must end in {endings}")]
    Format {
        /// The file as requested.
        path: PathBuf,
        /// The extensions of the formats that can be written.
        endings: String,
    },
    /// The format is only read.
    #[error("{name} files can be read but not written: write {endings}")]
    NotWritten {
        /// The name of the format.
        name: &'static str,
        /// The extensions of the formats that can be written.
        endings: String,
    },
    /// The number of segments is out of range.
    #[error(
        "{segments} segments: the number must be between {LEAST_SEGMENTS} and {GREATEST_SEGMENTS}"
    )]
    Segments {
        /// The number given.
        segments: u32,
    },
    /// The scene contains solids that cannot be tessellated.
    #[error(
        "solids composed by union, intersection or difference cannot be tessellated, and the scene contains {solids}: remove them, or list their parts as separate solids"
    )]
    ComposedSolids {
        /// Their number, each counted once however often it is placed.
        solids: u64,
    },
    /// A PLY file counts vertices in 32 bits.
    #[error(
        "the mesh has {vertices} vertices, more than the {} that a .ply file can index: write an .obj file, or use fewer segments",
        u32::MAX
    )]
    Vertices {
        /// Vertices of the mesh.
        vertices: u128,
    },
    /// The file would exceed the limit.
    #[error("the file needs up to {needed} bytes, which is more than the {allowed} allowed")]
    TooLarge {
        /// An upper bound of the size of the file.
        needed: u128,
        /// The limit.
        allowed: u64,
    },
    /// The caller stopped the writing.
    #[error("stopped before the mesh was complete")]
    Cancelled,
    /// The system reports an error.
    #[error(transparent)]
    Write(#[from] io::Error),
}
