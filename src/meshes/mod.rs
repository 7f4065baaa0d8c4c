//! Triangle meshes: a scene as one mesh in a file, and meshes of any program.
//!
//! Every placed solid of the scene becomes a mesh of its own in world space: `plan` counts
//! them and derives how far the mesh may be from the true surface, `walk` visits them, and
//! `formats` writes them. Only the mesh of the current solid is in memory, so the disk alone
//! limits the size of a file. `formats` also reads meshes; `reading` contains what its
//! readers share, and `file` opens the files.

mod error;
mod file;
mod formats;
mod plan;
mod reading;
mod walk;

use std::ops::ControlFlow;

pub use error::{MeshError, MeshFileError, MeshPlace, MeshReadError};
pub use file::{read_mesh, read_mesh_within};
pub use formats::Format;
pub use plan::Plan;
pub use reading::MeshFile;
pub use reading::remarks::Made;

/// Called with the number of vertices and triangles written since the last call;
/// returns whether to continue.
pub type Progress<'a> = dyn FnMut(u64) -> ControlFlow<()> + 'a;

/// The number of vertices or triangles written at once: about 100 kB of a mesh, which has
/// millions of them for a ball of 4096 sides.
const AT_ONCE: usize = 4096;

fn proceed(progress: &mut Progress, items: usize) -> Result<(), MeshFileError> {
    match progress(items as u64).is_break() {
        true => Err(MeshFileError::Cancelled),
        false => Ok(()),
    }
}
