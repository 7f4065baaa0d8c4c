//! Placements from matrices.

use cyltrace::scene::{Placement, PrototypeIndex};
use glam::{DAffine3, DMat4};

/// The placement of a prototype by a matrix of four rows of four numbers.
///
/// # Errors
/// When it is not affine, not finite or singular.
pub fn placement(of: u32, matrix: &[f64]) -> Result<Placement, String> {
    // Rows of numbers, as NumPy keeps a matrix.
    let matrix = DMat4::from_cols_slice(matrix).transpose();
    if !matrix.is_finite() {
        return Err("it has an entry that is no finite number".to_owned());
    }
    let last = matrix.row(3).to_array();
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(format!("its last row is {last:?}: it must be 0, 0, 0, 1"));
    }
    let parent_from_child = DAffine3::from_mat4(matrix);
    if parent_from_child.matrix3.determinant() == 0.0 {
        return Err("it is singular: it must not flatten what it places".to_owned());
    }
    Ok(Placement {
        of: PrototypeIndex(of),
        parent_from_child,
    })
}
