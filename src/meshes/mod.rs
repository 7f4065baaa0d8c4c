//! Triangle meshes: a scene as one mesh in a file, and meshes of any program.
//!
//! Every solid of the scene, with all its placements, becomes a mesh of its own in
//! world space: `plan` counts them and derives how far the mesh may be from the true
//! surface, `walk` visits them, `formats` writes them. Nothing but the mesh of the solid at
//! hand is in memory, so a file may be as large as a disk. `formats` also reads meshes, with
//! what its readers share in `reading`; `file` opens them.

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

/// Called with the number of vertices and triangles that were written since;
/// says whether to go on.
pub type Progress<'a> = dyn FnMut(u64) -> ControlFlow<()> + 'a;

/// This many vertices or triangles are written at once: some 100 kB of a large mesh,
/// which is millions of them for a ball of 4096 sides.
const AT_ONCE: usize = 4096;

fn proceed(progress: &mut Progress, items: usize) -> Result<(), MeshFileError> {
    match progress(items as u64).is_break() {
        true => Err(MeshFileError::Cancelled),
        false => Ok(()),
    }
}
