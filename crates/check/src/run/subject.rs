//! A window of the scene and what the rays through it need.

use cyltrace::scene::Scene;

use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::window::Window;
use crate::rays::RaySource;
use crate::verdict::judge::Directory;

/// A window, the space of its meshes, and its rays.
pub(super) struct Subject<'a> {
    /// The window's number.
    pub number: u64,
    pub window: &'a Window,
    pub frame: &'a MeshFrame,
    pub source: RaySource<'a>,
    pub directory: Directory<'a>,
}

impl<'a> Subject<'a> {
    pub fn new(
        scene: &Scene,
        (number, window): (u64, &'a Window),
        frame: &'a MeshFrame,
        seed: u64,
    ) -> Self {
        Self {
            number,
            window,
            frame,
            source: RaySource::new(scene, window, frame, number, seed),
            directory: Directory::new(window),
        }
    }
}
