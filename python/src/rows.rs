//! Rows of arrays that become solids: all of them or, if one is wrong, none.

use std::sync::Arc;

use cyltrace::scene::{
    CylinderList, CylinderRecord, MaterialIndex, Prototype, Records, SolidRecord,
};
use cyltrace::solid::{AnySolid, Caps, Cylinder, SolidKind};
use glam::DVec3;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::value_error;
use crate::scene::PyScene;

/// Rows of an array that become solids of one kind.
#[derive(FromPyObject)]
pub struct Rows {
    /// The prototype that gets them.
    pub prototype: u32,
    pub count: usize,
    pub material: u16,
    /// Whether rows that are no solid are left out.
    pub skips: bool,
}

impl PyScene {
    /// Adds the solids of all rows, or none of them if a row is wrong. Returns the number of
    /// the first and which rows were left out.
    pub fn add_rows(
        &mut self,
        py: Python<'_>,
        rows: &Rows,
        is_degenerate: impl Fn(usize) -> bool + Sync,
        solid: impl Fn(usize) -> Result<AnySolid, String> + Sync,
    ) -> PyResult<(u32, Vec<i64>)> {
        let records = self.records;
        let is_left_out = |row| rows.skips && is_degenerate(row);
        // Once to find what is wrong, once to add it: a second copy of the solids would take
        // as much memory as the scene.
        let fault = || {
            (0..rows.count).into_par_iter().find_map_first(|row| {
                if is_left_out(row) {
                    return None;
                }
                let fault = match solid(row) {
                    Ok(solid) => rounding_fault(records, &solid)?,
                    Err(fault) => fault,
                };
                Some(format!("row {row}: {fault}"))
            })
        };
        if let Some(fault) = py.detach(fault) {
            return Err(value_error(fault));
        }
        let first = self.next[rows.prototype as usize];
        let prototype = self.prototype(rows.prototype)?;
        let end = u64::from(first) + rows.count as u64;
        if end > u64::from(u32::MAX) {
            return Err(PyOverflowError::new_err(format!(
                "a prototype has at most {} solids, and this makes {end}",
                u32::MAX
            )));
        }
        let material = MaterialIndex(rows.material);
        let left_out = py.detach(|| {
            let mut left_out = Vec::new();
            for row in 0..rows.count {
                if is_left_out(row) {
                    left_out.push(row as i64);
                    continue;
                }
                let solid = solid(row).expect("a row that was checked");
                let record = SolidRecord::new(solid, first + row as u32, material);
                let added = prototype.solids.push(record);
                added.expect("a row that was checked");
            }
            left_out
        });
        self.next[rows.prototype as usize] = end as u32;
        Arc::make_mut(&mut self.scene).skipped_rows += left_out.len() as u64;
        Ok((first, left_out))
    }
}

/// Why a list that rounds cannot keep a solid, if it cannot.
fn rounding_fault(records: Records, solid: &AnySolid) -> Option<String> {
    match (records, solid) {
        (Records::F32, AnySolid::Cylinder(cylinder)) => {
            let record = CylinderRecord::new(cylinder, 0, MaterialIndex(0));
            let pushed = CylinderList::new(Records::F32).push(record);
            pushed.err().map(|error| format!("in f32, {error}"))
        }
        _ => None,
    }
}

/// Whether a row is no solid but no mistake either: as tables have it.
pub fn is_degenerate(p0: DVec3, p1: DVec3, radii: &[f64]) -> bool {
    p0.is_nan() || p1.is_nan() || (p1 - p0).length() < Cylinder::LEAST || has_no_size(radii)
}

/// Whether radii are all zero, or one is NaN.
pub fn has_no_size(radii: &[f64]) -> bool {
    let is_none = |radius: &f64| (0.0..Cylinder::LEAST).contains(radius);
    radii.iter().any(|radius| radius.is_nan()) || radii.iter().all(is_none)
}

/// The number of the next solid: one more than the greatest.
pub fn next_primitive(prototype: &Prototype) -> u32 {
    let last = SolidKind::LISTS.iter().filter_map(|&kind| {
        let count = prototype.solids.len_of(kind);
        (count > 0).then(|| prototype.solids.primitive(kind, count - 1))
    });
    last.max().map_or(0, |last| last + 1)
}

/// The ends that are closed: bit 0 for `p0`, bit 1 for `p1`.
pub fn caps_of(code: u8) -> Caps {
    Caps::at(code & 1 != 0, code & 2 != 0)
}

/// What an error says.
pub fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
