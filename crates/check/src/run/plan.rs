//! The windows of a check, and the memory that it takes, before anything is built.

use crate::bounding_meshes::hull_list::{bytes_needed, triangles_within, window_bytes};
use crate::bounding_meshes::placed::{Budget, windows};
use crate::bounding_meshes::window::Window;
use crate::settings::{CheckError, Settings};
use cyltrace::scene::Scene;

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

/// Computes what a check with these settings will take.
///
/// # Errors
/// If the settings are wrong, the scene is empty, or not even the smallest
/// part of it fits into [`Settings::max_memory`].
pub fn plan(scene: &Scene, settings: &Settings) -> Result<Plan, CheckError> {
    let windows = chosen_windows(scene, settings)?;
    let segments = settings.segments.iter().copied().max().unwrap_or(3);
    let largest = windows
        .iter()
        .map(|window| window_bytes(window, segments))
        .max();
    let solids = windows.iter().map(Window::count).max();
    Ok(Plan {
        windows: windows.len(),
        solids: solids.unwrap_or(0),
        bytes: largest.unwrap_or(0),
    })
}

/// The windows in which a scene is checked.
pub(super) fn chosen_windows(
    scene: &Scene,
    settings: &Settings,
) -> Result<Vec<Window>, CheckError> {
    if settings.rays == 0 || settings.classes.is_empty() || settings.segments.is_empty() {
        return Err(CheckError::NothingToCheck);
    }
    for &segments in &settings.segments {
        if !(3..=4096).contains(&segments) {
            return Err(CheckError::Segments { segments });
        }
    }
    let scene_stats = scene.scene_stats();
    if scene_stats.instanced.total() == 0 {
        return Err(CheckError::Empty);
    }
    let segments = settings.segments.iter().copied().max().unwrap_or(3);
    let budget = Budget {
        triangles: triangles_within(settings.max_memory),
        segments,
    };
    let windows = windows(scene, budget, settings.seed);
    if windows.is_empty() {
        return Err(CheckError::Memory {
            needed: bytes_needed(8 * 4 * u64::from(segments)),
            allowed: settings.max_memory,
        });
    }
    Ok(windows)
}
