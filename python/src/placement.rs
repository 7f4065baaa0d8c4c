//! Placements from matrices.

use cyltrace::scene::{Placement, PrototypeIndex};
use glam::{DAffine3, DMat4};
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;

use crate::arrays::value_error;
use crate::scene::PyScene;

/// The placement of a prototype by a matrix of four rows of four numbers.
///
/// # Errors
/// When it is not affine, not finite or singular.
fn placement(of: u32, matrix: &[f64]) -> Result<Placement, String> {
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

impl PyScene {
    /// Places a prototype in another by rows of 16 numbers, and returns the number of the first
    /// placement.
    ///
    /// # Errors
    /// When a matrix is wrong, the prototype would contain itself, or there are too many.
    pub fn place(&mut self, prototype: u32, of: u32, matrices: &[f64]) -> PyResult<u32> {
        if self.reaches(of, prototype) {
            return Err(value_error(
                "a prototype would contain itself: place it in another one",
            ));
        }
        let matrices = matrices.chunks_exact(16);
        let placements: Result<Vec<Placement>, String> = matrices
            .enumerate()
            .map(|(row, matrix)| {
                placement(of, matrix).map_err(|fault| format!("matrices[{row}]: {fault}"))
            })
            .collect();
        let placements = placements.map_err(value_error)?;
        let parent = self.prototype(prototype)?;
        let first = parent.placements.len();
        let end = first as u64 + placements.len() as u64;
        if end > u64::from(u32::MAX) {
            return Err(PyOverflowError::new_err(format!(
                "a prototype has at most {} placements, and this makes {end}",
                u32::MAX
            )));
        }
        parent.placements.extend(placements);
        Ok(first as u32)
    }

    /// Whether a prototype places another, itself or through others, or is the other.
    fn reaches(&self, from: u32, to: u32) -> bool {
        let mut seen = vec![false; self.scene.prototypes.len()];
        let mut stack = vec![from];
        while let Some(index) = stack.pop() {
            if index == to {
                return true;
            }
            if !std::mem::replace(&mut seen[index as usize], true) {
                let placements = self.scene.prototypes[index as usize].placements.iter();
                let mut placed: Vec<u32> = placements.map(|placement| placement.of.0).collect();
                placed.dedup();
                stack.extend(placed);
            }
        }
        false
    }
}
