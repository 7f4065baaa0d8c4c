//! Placements: an `[[instance]]` each if consecutive ones seldom place the same prototype,
//! otherwise rows of an `[[instance_table]]` for each run of those that do.

use std::io::Write;

use glam::DAffine3;

use super::tables::push_cells;
use super::{SaveError, Saver};
use crate::scene::description::Placement;

/// Mean length from which on runs are tables.
const LEAST_RUN: usize = 16;

const HEADER: &str = "xx,xy,xz,x,yx,yy,yz,y,zx,zy,zz,z";

const COLUMNS: &str =
    r#"{ matrix = [["xx", "xy", "xz", "x"], ["yx", "yy", "yz", "y"], ["zx", "zy", "zz", "z"]] }"#;

impl<W: Write> Saver<'_, W> {
    /// The placements of a prototype.
    pub fn placements(&mut self, prefix: &str, list: &[Placement]) -> Result<(), SaveError> {
        let runs = || list.chunk_by(|one, next| one.of == next.of);
        if list.len() < LEAST_RUN * runs().count() {
            for placement in list {
                self.instance(prefix, placement)?;
            }
            return Ok(());
        }
        runs().try_for_each(|run| self.instance_table(prefix, run))
    }

    fn instance(&mut self, prefix: &str, placement: &Placement) -> Result<(), SaveError> {
        let of = self.placed(placement.of)?;
        let mut entry = self.text.table(&format!("[[{prefix}instance]]"));
        entry.text("of", of);
        entry.rows("matrix", rows(&placement.parent_from_child));
        self.text.check()
    }

    /// Placements of one prototype.
    fn instance_table(&mut self, prefix: &str, run: &[Placement]) -> Result<(), SaveError> {
        let cells = |placement: &Placement| rows(&placement.parent_from_child);
        let numbers = run.iter().map(|one| one.parent_from_child.to_cols_array());
        if let Some(number) = numbers.flatten().find(|number| !number.is_finite()) {
            let place = "an entry of a placement".to_owned();
            return Err(SaveError::NotFinite { place, number });
        }
        let of = self.placed(run[0].of)?;
        let tables = &mut self.tables;
        let file = tables.add("instances", HEADER, run.len(), |row, index| {
            push_cells(row, cells(&run[index]).as_flattened());
        })?;
        let mut entry = self.text.table(&format!("[[{prefix}instance_table]]"));
        entry.text("of", of);
        entry.text("file", &file);
        entry.verbatim("columns", COLUMNS);
        self.text.check()
    }
}

/// The rows of a placement, each with its entry of the translation.
fn rows(placement: &DAffine3) -> [[f64; 4]; 3] {
    let columns = placement.to_cols_array_2d();
    [0, 1, 2].map(|row| columns.map(|column| column[row]))
}
