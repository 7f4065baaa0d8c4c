//! The formats of triangle meshes: a file or a folder each, reading beside writing.
//!
//! A new format is a module with an implementation of [`MeshFormat`] and a line in the list
//! at the end of this file; `docs/formats.md` contains what [`Format`] says of each.

mod obj;
mod ply;
mod stl;

use std::io::Write;
use std::path::Path;

use super::reading::MeshFile;
use super::{MeshError, MeshFileError, Plan, Progress};
use crate::scene::Scene;

/// What a format of meshes implements.
trait MeshFormat {
    /// What the format is called.
    const NAME: &'static str;

    /// The ending of its files' names, in lower case.
    const EXTENSION: &'static str;

    /// How it is written; `None` of a format that is only read.
    const WRITER: Option<Writer>;

    /// Reads a mesh from the bytes of a file.
    ///
    /// # Errors
    /// When the content is malformed, a number is out of range, a face names a vertex that
    /// does not exist, or there is no face.
    fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError>;
}

/// How a format is written.
struct Writer {
    /// Refuses a mesh that the format cannot contain.
    check: fn(&Plan) -> Result<(), MeshFileError>,
    /// The size of the file, given what it calls the scene.
    bytes: fn(&Plan, &str) -> u128,
    /// Whether the file has that size, not at most that size.
    is_size_exact: bool,
    /// Writes the mesh of a plan, given what the file calls the scene.
    write: WriteMesh,
}

type WriteMesh =
    fn(&Scene, &Plan, &str, &mut dyn Write, &mut Progress) -> Result<(), MeshFileError>;

/// Declares [`Format`] from one line a format.
macro_rules! formats {
    ($($(#[$meta:meta])* $format:ident = $module:ident,)*) => {
        /// A format of triangle meshes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Format {
            $($(#[$meta])* $format,)*
        }

        impl Format {
            /// All formats.
            pub const ALL: &[Self] = &[$(Self::$format),*];

            /// What the format is called.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$format => $module::$format::NAME,)*
                }
            }

            /// The ending of its files' names, in lower case.
            #[must_use]
            pub fn extension(self) -> &'static str {
                match self {
                    $(Self::$format => $module::$format::EXTENSION,)*
                }
            }

            /// Reads a mesh from the bytes of a file.
            ///
            /// # Errors
            /// When the content is malformed, a number is out of range, a face names a
            /// vertex that does not exist, or there is no face.
            pub fn parse(self, bytes: &[u8]) -> Result<MeshFile, MeshError> {
                match self {
                    $(Self::$format => $module::$format::parse(bytes),)*
                }
            }

            fn writer(self) -> Option<&'static Writer> {
                match self {
                    $(Self::$format => const { $module::$format::WRITER.as_ref() },)*
                }
            }
        }
    };
}

impl Format {
    /// The format whose files end as this one does, in upper or lower case.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        let mut all = Self::ALL.iter().copied();
        all.find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// The format to write a file in, by the ending of its name.
    ///
    /// # Errors
    /// When the file does not end as those of a format that is written.
    pub fn to_write(path: &Path) -> Result<Self, MeshFileError> {
        let format = Self::of(path).filter(|format| format.is_written());
        format.ok_or_else(|| MeshFileError::Format { path: path.into() })
    }

    /// Whether meshes are written in it; all formats are read.
    #[must_use]
    pub fn is_written(self) -> bool {
        self.writer().is_some()
    }

    /// The size of a plan's file in bytes, or at most its size where that depends on the
    /// digits of its numbers; see [`is_size_exact`](Self::is_size_exact). `scene` is what
    /// the file calls the scene. 0 of a format that is not written.
    #[must_use]
    pub fn file_bytes(self, plan: &Plan, scene: &str) -> u128 {
        self.writer()
            .map_or(0, |writer| (writer.bytes)(plan, scene))
    }

    /// Whether [`file_bytes`](Self::file_bytes) is the size of the file, and not a bound.
    #[must_use]
    pub fn is_size_exact(self) -> bool {
        self.writer().is_some_and(|writer| writer.is_size_exact)
    }

    /// Refuses a file of more than `most_bytes`, or a mesh that the format cannot contain.
    ///
    /// # Errors
    /// In these cases, and of a format that is not written.
    pub fn check(self, plan: &Plan, scene: &str, most_bytes: u64) -> Result<(), MeshFileError> {
        let needed = self.file_bytes(plan, scene);
        if needed > u128::from(most_bytes) {
            let allowed = most_bytes;
            return Err(MeshFileError::TooLarge { needed, allowed });
        }
        (self.writer_or_error()?.check)(plan)
    }

    /// Writes the mesh of a plan. `name` is what the file calls the scene.
    ///
    /// # Errors
    /// When the writer refuses, `progress` asks to stop, or the format cannot contain the
    /// mesh or is not written.
    pub fn write(
        self,
        scene: &Scene,
        plan: &Plan,
        name: &str,
        writer: &mut dyn Write,
        progress: &mut Progress,
    ) -> Result<(), MeshFileError> {
        let format = self.writer_or_error()?;
        (format.check)(plan)?;
        (format.write)(scene, plan, name, writer, progress)
    }

    fn writer_or_error(self) -> Result<&'static Writer, MeshFileError> {
        let name = self.name();
        self.writer().ok_or(MeshFileError::NotWritten { name })
    }

    /// The endings of the formats' names in a sentence: `.obj, .ply or .stl`.
    pub(super) fn endings(formats: impl Iterator<Item = Self>) -> String {
        let endings: Vec<_> = formats.map(|one| format!(".{}", one.extension())).collect();
        match endings.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        }
    }
}

formats! {
    /// Wavefront OBJ, written as text with a group for each placed prototype.
    Obj = obj,
    /// Stanford PLY, written as binary, little endian, with f64 vertices.
    Ply = ply,
    /// STL, which is only read.
    Stl = stl,
}
