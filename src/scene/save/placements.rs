//! Placements: an `[[instance]]` each if consecutive ones seldom place the same prototype,
//! otherwise rows of an `[[instance_table]]` for each run of those that do.

use std::io::Write;

use glam::DAffine3;

use super::tables::{distinct, push_cells, push_value, quoted_name};
use super::{SaveError, Saver};
use crate::scene::colors::PlacementValues;
use crate::scene::description::{Placement, Prototype};

/// Mean length from which on runs are tables.
const LEAST_RUN: usize = 16;

/// The columns of a table, row by row of the placement.
const NAMES: [&str; 12] = [
    "xx", "xy", "xz", "x", "yx", "yy", "yz", "y", "zx", "zy", "zz", "z",
];

impl<W: Write> Saver<'_, W> {
    /// The placements of a prototype.
    pub fn placements(&mut self, prefix: &str, prototype: &Prototype) -> Result<(), SaveError> {
        let (list, values) = (&prototype.placements, &prototype.placement_values);
        let runs = || list.chunk_by(|one, next| one.of == next.of);
        if list.len() < LEAST_RUN * runs().count() {
            for (number, placement) in (0..).zip(list) {
                self.instance(prefix, placement, number, values)?;
            }
            return Ok(());
        }
        let mut first = 0;
        for run in runs() {
            self.instance_table(prefix, run, first, values)?;
            first += run.len() as u32;
        }
        Ok(())
    }

    fn instance(
        &mut self,
        prefix: &str,
        placement: &Placement,
        number: u32,
        values: &[PlacementValues],
    ) -> Result<(), SaveError> {
        let of = self.placed(placement.of)?;
        let mut entry = self.text.table(&format!("[[{prefix}instance]]"));
        entry.text("of", of);
        entry.rows("matrix", rows(&placement.parent_from_child));
        entry.values(values.iter().filter_map(|shown| {
            let value = shown.values.get(number)?;
            Some((shown.column.as_str(), value))
        }));
        self.text.check()
    }

    /// Placements of one prototype; `first` is the number of the first one.
    fn instance_table(
        &mut self,
        prefix: &str,
        run: &[Placement],
        first: u32,
        values: &[PlacementValues],
    ) -> Result<(), SaveError> {
        let cells = |placement: &Placement| rows(&placement.parent_from_child);
        let numbers = run.iter().map(|one| one.parent_from_child.to_cols_array());
        if let Some(number) = numbers.flatten().find(|number| !number.is_finite()) {
            let place = "an entry of a placement".to_owned();
            return Err(SaveError::NotFinite { place, number });
        }
        let of = self.placed(run[0].of)?;
        let all = first..first + run.len() as u32;
        let has_values =
            |shown: &&PlacementValues| all.clone().any(|number| shown.values.get(number).is_some());
        let values: Vec<&PlacementValues> = values.iter().filter(has_values).collect();
        let names = distinct(NAMES, &self.columns());
        let quoted = values.iter().map(|shown| quoted_name(&shown.column));
        let header: Vec<String> = names.iter().cloned().chain(quoted).collect();
        let tables = &mut self.tables;
        let file = tables.add("instances", &header.join(","), run.len(), |row, index| {
            push_cells(row, cells(&run[index]).as_flattened());
            for shown in &values {
                push_value(row, shown.values.get(first + index as u32));
            }
        })?;
        let mut entry = self.text.table(&format!("[[{prefix}instance_table]]"));
        entry.text("of", of);
        entry.text("file", &file);
        let rows: Vec<&[String]> = names.chunks(4).collect();
        entry.verbatim("columns", &format!("{{ matrix = {rows:?} }}"));
        self.text.check()
    }
}

/// The rows of a placement, each with its entry of the translation.
fn rows(placement: &DAffine3) -> [[f64; 4]; 3] {
    let columns = placement.to_cols_array_2d();
    [0, 1, 2].map(|row| columns.map(|column| column[row]))
}
