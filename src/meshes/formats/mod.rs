//! The formats of triangle meshes: one file or folder each, with the reader and the writer.
//!
//! A new format is a module with an implementation of [`MeshFormat`] and a line in the list
//! at the end of this file; `docs/formats.md` lists what [`Format`] reports for each.

mod obj;
mod ply;
mod stl;

use std::io::Write;
use std::path::Path;

use super::reading::MeshFile;
use super::{MeshError, MeshFileError, Plan, Progress};
use crate::scene::Scene;

/// The interface of a mesh format.
trait MeshFormat {
    /// The name of the format.
    const NAME: &'static str;

    /// The extension of its files, in lower case.
    const EXTENSION: &'static str;

    /// The writer; `None` for a format that is only read.
    const WRITER: Option<Writer>;

    /// Reads a mesh from the bytes of a file.
    ///
    /// # Errors
    /// If the content is malformed, a number is out of range, a face names a vertex that
    /// does not exist, or the mesh has no faces.
    fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError>;
}

/// The functions that write a format.
struct Writer {
    /// Rejects a mesh that the format cannot represent.
    check: fn(&Plan) -> Result<(), MeshFileError>,
    /// The size of the file, or an upper bound. The text is the name of the scene in the file.
    bytes: fn(&Plan, &str) -> u128,
    /// Whether `bytes` is the exact size.
    is_size_exact: bool,
    /// Writes the mesh of a plan. The text is the name of the scene in the file.
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

            /// The name of the format.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$format => $module::$format::NAME,)*
                }
            }

            /// The extension of its files, in lower case.
            #[must_use]
            pub fn extension(self) -> &'static str {
                match self {
                    $(Self::$format => $module::$format::EXTENSION,)*
                }
            }

            /// Reads a mesh from the bytes of a file.
            ///
            /// # Errors
            /// If the content is malformed, a number is out of range, a face names a
            /// vertex that does not exist, or the mesh has no faces.
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
    /// The format of a file, by its extension in upper or lower case.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        let mut all = Self::ALL.iter().copied();
        all.find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// The format in which to write a file, by its extension.
    ///
    /// # Errors
    /// If no format with this extension can be written.
    pub fn to_write(path: &Path) -> Result<Self, MeshFileError> {
        let format = Self::of(path).filter(|format| format.is_written());
        format.ok_or_else(|| MeshFileError::Format {
            path: path.into(),
            endings: Self::written_endings(),
        })
    }

    /// Whether the format can be written; all formats can be read.
    #[must_use]
    pub fn is_written(self) -> bool {
        self.writer().is_some()
    }

    /// The size of a plan's file in bytes, or an upper bound where the size depends on the
    /// digits of the numbers; see [`is_size_exact`](Self::is_size_exact). `scene` is the name
    /// of the scene in the file. 0 if the format cannot be written.
    #[must_use]
    pub fn file_bytes(self, plan: &Plan, scene: &str) -> u128 {
        self.writer()
            .map_or(0, |writer| (writer.bytes)(plan, scene))
    }

    /// Whether [`file_bytes`](Self::file_bytes) is exact rather than an upper bound.
    #[must_use]
    pub fn is_size_exact(self) -> bool {
        self.writer().is_some_and(|writer| writer.is_size_exact)
    }

    /// Rejects a file of more than `most_bytes` and a mesh that the format cannot represent.
    ///
    /// # Errors
    /// In these cases, and if the format cannot be written.
    pub fn check(self, plan: &Plan, scene: &str, most_bytes: u64) -> Result<(), MeshFileError> {
        let needed = self.file_bytes(plan, scene);
        if needed > u128::from(most_bytes) {
            let allowed = most_bytes;
            return Err(MeshFileError::TooLarge { needed, allowed });
        }
        (self.writer_or_error()?.check)(plan)
    }

    /// Writes the mesh of a plan. `name` is the name of the scene in the file.
    ///
    /// # Errors
    /// If `writer` fails, `progress` breaks, or the format cannot represent the mesh or
    /// cannot be written.
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
        self.writer().ok_or_else(|| MeshFileError::NotWritten {
            name: self.name(),
            endings: Self::written_endings(),
        })
    }

    /// The extensions of all formats, for a message.
    pub(super) fn all_endings() -> String {
        Self::endings(Self::ALL.iter().copied())
    }

    /// The extensions of the formats that can be written.
    fn written_endings() -> String {
        let all = Self::ALL.iter().copied();
        Self::endings(all.filter(|format| format.is_written()))
    }

    /// The extensions of formats for a message: `.obj, .ply or .stl`.
    fn endings(formats: impl Iterator<Item = Self>) -> String {
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
