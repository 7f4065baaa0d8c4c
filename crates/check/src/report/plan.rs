//! What a check will take before anything is built, and what each part of the
//! scene held.

use crate::bounding_meshes::hull::triangles_needed;
use crate::bounding_meshes::hull_list::bytes_needed;
use crate::bounding_meshes::window::Window;
use crate::compare::chosen_windows;
use crate::{CheckError, Settings};
use cyltrace::scene::Scene;
use cyltrace_output::{figure, readable};

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
    let segments = settings.segments.iter().copied().max().unwrap_or(3);
    let largest = windows.iter().map(|window| bytes(window, segments)).max();
    let solids = windows.iter().map(Window::count).max();
    Ok(Plan {
        windows: windows.len(),
        solids: solids.unwrap_or(0),
        bytes: largest.unwrap_or(0),
    })
}

/// What the meshes of a window take.
fn bytes(window: &Window, segments: u32) -> u64 {
    let solids = window.solids.iter();
    let triangles = solids.map(|placed| triangles_needed(&placed.solid, segments));
    bytes_needed(triangles.sum())
}

/// Solids of a window, or leaves of its compositions, that have no prism of a number of sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Missing {
    /// Sides.
    pub segments: u32,
    /// Solids too small for an inscribed prism in f32.
    pub inscribed: usize,
    /// Solids for which no circumscribed prism could be proven.
    pub circumscribed: usize,
}

/// What a window held, in a line.
pub(crate) fn in_words(window: &Window, number: u64, windows: u64, missing: &[Missing]) -> String {
    let place = match &window.bounds {
        None => String::from("the whole scene"),
        Some(bounds) => format!(
            "part {} of {windows}, {} wide about {:.6}",
            number + 1,
            figure(bounds.extent().max_element()),
            bounds.center()
        ),
    };
    let solids = window.count();
    let segments = missing.iter().map(|one| one.segments).max().unwrap_or(3);
    let bytes = readable(bytes(window, segments));
    let mut text = format!("{place}: {solids} solids, about {bytes} with {segments} sides");
    for (kind, count) in [
        ("inscribed", (|one| one.inscribed) as fn(&Missing) -> usize),
        ("circumscribed", |one| one.circumscribed),
    ] {
        for one in missing.iter().filter(|one| count(one) > 0) {
            let (count, segments) = (count(one), one.segments);
            text += &format!("; {count} without {kind} prism of {segments} sides");
        }
    }
    text
}
