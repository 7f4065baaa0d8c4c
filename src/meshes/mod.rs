//! A scene as one triangle mesh in a file.
//!
//! Every solid of the scene, with all its placements, becomes a mesh of its own in
//! world space: `plan` counts them and derives how far the mesh may be from the true
//! surface, `walk` visits them, `obj` and `ply` write them. Nothing but the
//! mesh of the solid at hand is in memory, so a file may be as large as a disk.
//! `read` reads a mesh of any program.

mod obj;
mod plan;
mod ply;
mod read;
mod walk;

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;

pub use plan::Plan;
pub use read::{
    Made, MeshError, MeshFile, MeshPlace, MeshReadError, parse_obj, parse_ply, parse_stl,
    read_mesh, read_mesh_within,
};

use crate::scene::Scene;
use crate::solid::tessellation::{GREATEST_SEGMENTS, LEAST_SEGMENTS};

/// The kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ: text, a group for each placed prototype.
    Obj,
    /// Stanford PLY: binary, little endian, f64 vertices.
    Ply,
}

impl Format {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// When it ends neither in `.obj` nor in `.ply`.
    pub fn of(path: &Path) -> Result<Self, MeshFileError> {
        let extension = path.extension().unwrap_or_default();
        if extension.eq_ignore_ascii_case("obj") {
            Ok(Self::Obj)
        } else if extension.eq_ignore_ascii_case("ply") {
            Ok(Self::Ply)
        } else {
            Err(MeshFileError::Format { path: path.into() })
        }
    }
}

/// Why there is no mesh file.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// The name says nothing of the format.
    #[error("cannot write {path:?}: the name of a mesh must end in .obj or .ply")]
    Format {
        /// The file as asked for.
        path: std::path::PathBuf,
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

/// Called with the number of vertices and triangles that were written since;
/// says whether to go on.
pub type Progress<'a> = dyn FnMut(u64) -> ControlFlow<()> + 'a;

/// So many vertices or triangles are written at once: some 100 kB of a large mesh,
/// which is millions of them for a ball of 4096 sides.
const AT_ONCE: usize = 4096;

fn proceed(progress: &mut Progress, items: usize) -> Result<(), MeshFileError> {
    match progress(items as u64).is_break() {
        true => Err(MeshFileError::Cancelled),
        false => Ok(()),
    }
}

/// Writes the mesh of a plan. `name` is what the file calls the scene.
///
/// # Errors
/// When the writer refuses, `progress` asks to stop, or the format cannot
/// hold the mesh.
pub fn write(
    scene: &Scene,
    plan: &Plan,
    format: Format,
    name: &str,
    writer: &mut dyn Write,
    progress: &mut Progress,
) -> Result<(), MeshFileError> {
    match format {
        Format::Obj => obj::write(scene, plan, name, writer, progress),
        Format::Ply => ply::write(scene, plan, name, writer, progress),
    }
}
