//! Stanford PLY, `binary_little_endian 1.0`: three f64 a vertex, and triangles
//! as lists of a `uchar` count and `uint` vertices.
//!
//! All vertices precede all triangles, so the writer walks the scene twice.

use std::io::Write;

use crate::meshes::walk::instances;
use crate::meshes::{AT_ONCE, MeshFileError, Plan, Progress, proceed};
use crate::scene::Scene;
use crate::solid::tessellation::{mesh_size_of, triangles_of};

/// Three f64.
const VERTEX_BYTES: u128 = 24;

/// A `uchar` and three `uint`.
const TRIANGLE_BYTES: u128 = 13;

/// Rejects more vertices than faces can index.
pub(super) fn check(plan: &Plan) -> Result<(), MeshFileError> {
    let vertices = plan.vertices();
    if vertices > u128::from(u32::MAX) {
        return Err(MeshFileError::Vertices { vertices });
    }
    Ok(())
}

pub(super) fn write(
    scene: &Scene,
    plan: &Plan,
    name: &str,
    writer: &mut dyn Write,
    progress: &mut Progress,
) -> Result<(), MeshFileError> {
    writer.write_all(header(plan, name).as_bytes())?;
    let mut bytes = Vec::new();
    instances(scene, &mut |instance| {
        for (_, solid) in instance.prototype.singles() {
            let vertices = instance.vertices(&solid, plan.segments(), plan.fit());
            for vertices in vertices.chunks(AT_ONCE) {
                bytes.clear();
                for vertex in vertices {
                    bytes.extend(vertex.to_array().into_iter().flat_map(f64::to_le_bytes));
                }
                writer.write_all(&bytes)?;
                proceed(progress, vertices.len())?;
            }
        }
        Ok(())
    })?;
    let mut first = 0_u32;
    instances(scene, &mut |instance| {
        for (_, solid) in instance.prototype.singles() {
            let triangles = triangles_of(&solid, plan.segments());
            for triangles in triangles.chunks(AT_ONCE) {
                bytes.clear();
                for &triangle in triangles {
                    let corners = instance.outward(triangle).map(|corner| first + corner);
                    bytes.push(3);
                    bytes.extend(corners.into_iter().flat_map(u32::to_le_bytes));
                }
                writer.write_all(&bytes)?;
                proceed(progress, triangles.len())?;
            }
            // The last sum is the number of all vertices, which fits.
            first += mesh_size_of(&solid, plan.segments()).0 as u32;
        }
        Ok(())
    })
}

/// The size of the file.
pub(super) fn bytes(plan: &Plan, name: &str) -> u128 {
    let vertices = plan.vertices().saturating_mul(VERTEX_BYTES);
    let triangles = plan.triangles().saturating_mul(TRIANGLE_BYTES);
    vertices
        .saturating_add(triangles)
        .saturating_add(header(plan, name).len() as u128)
}

fn header(plan: &Plan, name: &str) -> String {
    let lines = plan.comment(name);
    format!(
        "ply\nformat binary_little_endian 1.0\n{}element vertex {}\nproperty double x\n\
         property double y\nproperty double z\nelement face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        lines.map(|line| format!("comment {line}\n")).concat(),
        plan.vertices(),
        plan.triangles()
    )
}
