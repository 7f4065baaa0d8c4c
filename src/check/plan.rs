//! What a check will take, before anything is built.

use super::compare::chosen_windows;
use super::prism::bytes_needed;
use super::{CheckError, Settings};
use crate::scene::Scene;

/// The memory that the largest meshes of a check take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Parts of the scene that are checked one after the other.
    pub windows: usize,
    /// Solids in the largest part.
    pub solids: usize,
    /// Bytes of its meshes with Embree's hierarchy, about.
    pub bytes: u64,
}

/// Says what a check with these settings will take.
///
/// # Errors
/// When the settings are wrong, the scene is empty, or not even the smallest
/// part of it fits into [`Settings::max_memory`].
pub fn plan(scene: &Scene, settings: &Settings) -> Result<Plan, CheckError> {
    let windows = chosen_windows(scene, settings)?;
    let solids = windows.iter().map(|window| window.solids.len()).max();
    let solids = solids.unwrap_or(0);
    let segments = settings.segments.iter().copied().max().unwrap_or(3);
    Ok(Plan {
        windows: windows.len(),
        solids,
        bytes: bytes_needed(solids as u64, segments),
    })
}
