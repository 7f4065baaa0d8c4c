//! A mesh while it is read: limits of numbers, fans of polygons, vertices that are named
//! before they are stated.

use glam::DVec3;

use crate::meshes::error::{MeshError, MeshPlace};
use crate::scene::{GREATEST_MESH_COORDINATE, MOST_FACE_CORNERS};
use crate::solid::tessellation::Mesh;

/// What is wrong with a face of more corners than [`MOST_FACE_CORNERS`].
pub(in crate::meshes) fn too_many_corners() -> String {
    format!("the face has more than {MOST_FACE_CORNERS} corners")
}

/// Vertices and triangles so far.
#[derive(Default)]
pub(in crate::meshes) struct Builder {
    mesh: Mesh,
    /// Corners that were beyond the vertices of their time, each greater than the one
    /// before, with their places: the first that stays beyond is the error.
    beyond: Vec<(u64, MeshPlace)>,
}

impl Builder {
    /// Vertices so far.
    pub fn vertices(&self) -> u64 {
        self.mesh.vertices.len() as u64
    }

    /// Adds a vertex.
    pub fn push_vertex(&mut self, point: DVec3, place: MeshPlace) -> Result<(), MeshError> {
        // NaN is not below.
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

    /// Adds a polygon as a fan about its first corner. One of less than three corners has
    /// no area and adds nothing.
    pub fn push_face(&mut self, corners: &[u64], place: MeshPlace) -> Result<(), MeshError> {
        for &corner in corners {
            let greatest = self.beyond.last().map_or(0, |&(greatest, _)| greatest);
            if corner >= self.vertices() && (corner > greatest || self.beyond.is_empty()) {
                self.beyond.push((corner, place));
            }
        }
        let index = |corner: u64| {
            u32::try_from(corner).map_err(|_| {
                let message = format!("the face names vertex {corner}, counted from 0");
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

    /// The mesh; one without a triangle is an error.
    pub fn finish(self) -> Result<Mesh, MeshError> {
        let count = self.vertices();
        if let Some(&(corner, place)) = self.beyond.iter().find(|&&(corner, _)| corner >= count) {
            return Err(MeshError::new(
                place,
                format!(
                    "the face names a vertex that does not exist: number {corner} from 0, {} from 1; there are {count}",
                    corner.saturating_add(1)
                ),
            ));
        }
        if self.mesh.triangles.is_empty() {
            return Err(MeshError::in_file("there is no face"));
        }
        Ok(self.mesh)
    }
}
