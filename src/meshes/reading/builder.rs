//! Builds a mesh while it is read: checks limits, splits polygons into fans, and accepts
//! vertices that are named before they are defined.

use glam::DVec3;

use crate::meshes::error::{MeshError, MeshPlace};
use crate::scene::{GREATEST_MESH_COORDINATE, MOST_FACE_CORNERS};
use crate::solid::tessellation::Mesh;

/// The error of a face with more corners than [`MOST_FACE_CORNERS`].
pub(in crate::meshes) fn too_many_corners() -> String {
    format!("the face has more than {MOST_FACE_CORNERS} corners")
}

/// Vertices and triangles so far.
#[derive(Default)]
pub(in crate::meshes) struct Builder {
    mesh: Mesh,
    /// Corners that named no vertex when they were read, in increasing order, with their
    /// places. The first that names none at the end is the error.
    beyond: Vec<(u64, MeshPlace)>,
}

impl Builder {
    /// Vertices so far.
    pub fn vertices(&self) -> u64 {
        self.mesh.vertices.len() as u64
    }

    /// Adds a vertex.
    pub fn push_vertex(&mut self, point: DVec3, place: MeshPlace) -> Result<(), MeshError> {
        // Written so that NaN fails.
        if !(point.abs().max_element() <= GREATEST_MESH_COORDINATE) || point.is_nan() {
            return Err(MeshError::new(
                place,
                format!(
                    "the vertex is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {GREATEST_MESH_COORDINATE:.1e} in size",
                    point.x, point.y, point.z
                ),
            ));
        }
        if self.vertices() == u64::from(u32::MAX) {
            let message = format!("the mesh has more than {} vertices", u32::MAX);
            return Err(MeshError::new(place, message));
        }
        self.mesh.vertices.push(point);
        Ok(())
    }

    /// Adds a polygon as a fan about its first corner. A polygon of fewer than three corners
    /// has no area and adds nothing.
    pub fn push_face(&mut self, corners: &[u64], place: MeshPlace) -> Result<(), MeshError> {
        for &corner in corners {
            let greatest = self.beyond.last().map_or(0, |&(greatest, _)| greatest);
            if corner >= self.vertices() && (corner > greatest || self.beyond.is_empty()) {
                self.beyond.push((corner, place));
            }
        }
        let index = |corner: u64| {
            u32::try_from(corner).map_err(|_| {
                let message = format!(
                    "the face names vertex {corner} (counted from 0), but a mesh has at most {} vertices",
                    u32::MAX
                );
                MeshError::new(place, message)
            })
        };
        let [first, rest @ ..] = corners else {
            return Ok(());
        };
        for pair in rest.windows(2) {
            if self.mesh.triangles.len() as u64 == u64::from(u32::MAX) {
                let message = format!("the mesh has more than {} triangles", u32::MAX);
                return Err(MeshError::new(place, message));
            }
            let triangle = [index(*first)?, index(pair[0])?, index(pair[1])?];
            self.mesh.triangles.push(triangle);
        }
        Ok(())
    }

    /// Returns the mesh.
    ///
    /// # Errors
    /// If a face names a vertex that does not exist, or the mesh has no triangles.
    pub fn finish(self) -> Result<Mesh, MeshError> {
        let count = self.vertices();
        if let Some(&(corner, place)) = self.beyond.iter().find(|&&(corner, _)| corner >= count) {
            return Err(MeshError::new(
                place,
                format!(
                    "the face names vertex {corner} ({} if counted from 1), but the mesh has {count} vertices",
                    corner.saturating_add(1)
                ),
            ));
        }
        if self.mesh.triangles.is_empty() {
            return Err(MeshError::in_file("the mesh has no faces"));
        }
        Ok(self.mesh)
    }
}
