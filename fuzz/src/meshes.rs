//! Meshes of other programs: OBJ, PLY and STL.

use cyltrace::meshes::{Format, MeshPlace};
use cyltrace::scene::GREATEST_MESH_COORDINATE;

/// A mesh in OBJ.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn obj(bytes: &[u8]) {
    judge(bytes, Format::Obj);
}

/// A mesh in PLY, in any of its three forms.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn ply(bytes: &[u8]) {
    judge(bytes, Format::Ply);
}

/// A mesh in STL, as text or binary.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn stl(bytes: &[u8]) {
    judge(bytes, Format::Stl);
}

/// A mesh is one whose corners exist and are numbers, and no larger than its file; an
/// error names a place in the file.
fn judge(bytes: &[u8], format: Format) {
    let file = match format.parse(bytes) {
        Ok(file) => file,
        Err(error) => {
            assert!(!error.message.trim().is_empty(), "{error:?}");
            if let MeshPlace::Line(line) = error.place {
                // CR alone may end a line, too.
                let ends = bytes.iter().filter(|byte| matches!(byte, b'\n' | b'\r'));
                let lines = ends.count() as u64 + 1;
                assert!((1..=lines).contains(&line), "of {lines} lines: {error:?}");
            }
            return;
        }
    };
    let mesh = &file.mesh;
    let parts = mesh.vertices.len() + mesh.triangles.len();
    assert!(
        parts <= bytes.len(),
        "{parts} parts of {} bytes",
        bytes.len()
    );
    let is_point = |point: &glam::DVec3| {
        point.is_finite() && point.abs().max_element() <= GREATEST_MESH_COORDINATE
    };
    assert!(mesh.vertices.iter().all(is_point), "{:?}", mesh.vertices);
    let mut corners = mesh.triangles.iter().flatten();
    let is_corner = |corner: &u32| (*corner as usize) < mesh.vertices.len();
    assert!(corners.all(is_corner), "{:?}", mesh.triangles);
    let deviation = file.deviation.unwrap_or(0.0);
    assert!(deviation.is_finite() && deviation >= 0.0, "{deviation}");
    assert!((0.0..1.0).contains(&file.rounding), "{}", file.rounding);
}
