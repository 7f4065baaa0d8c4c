//! The place and look of what is in a corner, from a scene's numbers to those of pictures.

use cyltrace::scene::{self, Corner as SceneCorner};
use cyltrace_output::{Corner, Inset};
use glam::DVec3;

/// The place and look of an inset.
pub(super) fn inset(inset: &scene::Inset) -> Inset {
    Inset {
        corner: match inset.corner {
            SceneCorner::TopLeft => Corner::TopLeft,
            SceneCorner::TopRight => Corner::TopRight,
            SceneCorner::BottomLeft => Corner::BottomLeft,
            SceneCorner::BottomRight => Corner::BottomRight,
        },
        size: inset.size as f32,
        color: numbers(inset.color),
        background: numbers(inset.background),
        opacity: inset.opacity as f32,
    }
}

/// Three numbers in f32.
pub(super) fn numbers(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}
