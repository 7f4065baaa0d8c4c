//! Why a mesh is not read or not written: what is wrong, and where.

use std::fmt;
use std::io;
use std::path::PathBuf;

use super::Format;
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

/// Why no mesh was read.
#[derive(Debug, thiserror::Error)]
pub enum MeshReadError {
    /// The name ends in no format that is read.
    #[error("{}: the name of a mesh must end in {}", path.display(), Format::endings(Format::ALL.iter().copied()))]
    Extension {
        /// The file.
        path: PathBuf,
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
    #[error("{}: the file has more than {most_bytes} bytes, the most that is read of a mesh here", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit.
        most_bytes: u64,
    },
    /// The content is no mesh.
    #[error("{}{error}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: MeshError,
    },
}

/// Why there is no mesh file.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// The name says nothing of the format.
    #[error(
        "cannot write {path:?}: the name of a mesh must end in {}",
        written_endings()
    )]
    Format {
        /// The file as requested.
        path: PathBuf,
    },
    /// The format is only read.
    #[error("{name} is read and not written: write {}", written_endings())]
    NotWritten {
        /// What the format is called.
        name: &'static str,
    },
    /// No such meshes.
    #[error(
        "{segments} segments: a mesh has at least {LEAST_SEGMENTS} and at most {GREATEST_SEGMENTS}"
    )]
    Segments {
        /// The number given.
        segments: u32,
    },
    /// There are solids that have no mesh of their own.
    #[error(
        "solids composed by union, intersection or difference have no mesh of their own, and the scene holds {solids}: leave them out, or state the solids that they are composed of by themselves"
    )]
    ComposedSolids {
        /// How many, as they are stored.
        solids: u64,
    },
    /// A PLY file counts vertices in 32 bits.
    #[error(
        "the mesh has {vertices} vertices, and a .ply file can name {}: write an .obj file, or use fewer segments",
        u32::MAX
    )]
    Vertices {
        /// Vertices of the mesh.
        vertices: u128,
    },
    /// More than may be written.
    #[error("the file needs up to {needed} bytes, which is more than the {allowed} allowed")]
    TooLarge {
        /// At least what the file takes.
        needed: u128,
        /// What was allowed.
        allowed: u64,
    },
    /// The caller asked to stop.
    #[error("stopped before the mesh was complete")]
    Cancelled,
    /// The system refuses to write.
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// The endings of the formats that are written.
fn written_endings() -> String {
    let all = Format::ALL.iter().copied();
    Format::endings(all.filter(|format| format.is_written()))
}
