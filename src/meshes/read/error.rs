//! What is wrong with a mesh file, and where.

use std::fmt;
use std::io;
use std::path::PathBuf;

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
    #[error("{}: the name of a mesh must end in .stl, .obj or .ply", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
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
