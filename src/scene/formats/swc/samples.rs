//! The samples of a neuron, line by line.
//!
//! A sample has seven cells separated by blanks, commas or semicolons. Further cells and a
//! comment after them are ignored. A line of column names may precede the samples.

use std::io::Read;
use std::path::Path;

use glam::DVec3;

use crate::scene::error::SceneError;
use crate::scene::limits::MOST_COLUMNS;
use crate::scene::names::quoted;
use crate::scene::table::{
    Block, Cells, Decimal, Delimiter, Records, Splitter, delimiter_of, number_of,
};

const COLUMNS: [&str; 7] = ["id", "type", "x", "y", "z", "radius", "parent"];

/// The column of the type.
const TYPE: usize = 1;

/// The greatest whole number such that no other whole number rounds to it in f64.
const GREATEST_WHOLE: f64 = 9_007_199_254_740_991.0;

/// The type of samples of the soma.
const SOMA: i64 = 1;

/// A line of the file.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub line: u64,
    pub id: i64,
    /// The number of the type.
    pub kind: i64,
    pub point: DVec3,
    pub radius: f64,
    pub parent: i64,
}

impl Sample {
    /// Whether it is part of a soma.
    pub fn is_soma(&self) -> bool {
        self.kind == SOMA
    }
}

/// A file that is being read.
pub(super) struct SwcFile<'a> {
    pub path: &'a Path,
}

impl SwcFile<'_> {
    pub fn error(
        &self,
        line: u64,
        column: Option<&str>,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        SceneError::Row {
            path: self.path.to_owned(),
            line,
            column: column.map(str::to_owned),
            message: message.into(),
            help: help.map(str::to_owned),
        }
    }

    /// All samples, in the order of the file, and whether any has more than seven
    /// cells. `admit` gets the line of each sample and may reject it for lack of memory.
    pub fn samples(
        &self,
        input: impl Read,
        mut admit: impl FnMut(u64) -> Result<(), SceneError>,
    ) -> Result<(Vec<Sample>, bool), SceneError> {
        let (mut samples, mut has_more_cells, mut is_first) = (Vec::new(), false, true);
        let last_line = self.each_row(input, |line, cells| {
            let all: [&str; 7] = std::array::from_fn(|index| cells.get(index));
            if cells.len() < COLUMNS.len() {
                let count = cells.len();
                let message =
                    format!("the row has {count} cells: SWC has 7, id type x y z radius parent");
                return Err(self.error(line, None, message, None));
            }
            if std::mem::take(&mut is_first) && self.is_header(line, &all)? {
                return Ok(());
            }
            let mut rest = (COLUMNS.len()..cells.len()).map(|index| cells.get(index));
            has_more_cells |= rest.any(|cell| !cell.is_empty());
            admit(line)?;
            samples.push(self.sample(line, all)?);
            Ok(())
        })?;
        if samples.is_empty() {
            let line = last_line.max(1);
            return Err(self.error(line, None, "the file contains no samples", None));
        }
        Ok((samples, has_more_cells))
    }

    /// The number of samples of somata, up to the first row that cannot be read.
    pub fn soma_samples(&self, input: impl Read) -> u64 {
        let mut count = 0;
        // Loading reports the row.
        let _ = self.each_row(input, |_, cells| {
            count += u64::from(whole(cells.get(TYPE)) == Some(SOMA));
            Ok(())
        });
        count
    }

    /// Calls `visit` with the line and the cells of every row, and returns the last line.
    fn each_row(
        &self,
        input: impl Read,
        mut visit: impl FnMut(u64, Cells) -> Result<(), SceneError>,
    ) -> Result<u64, SceneError> {
        let mut records = Records::new(input, self.path);
        let mut splitter = Splitter::default();
        loop {
            let block: Block = records.next_block(Delimiter::Blanks)?;
            if block.is_empty() {
                return Ok(records.line());
            }
            for index in 0..block.len() {
                let (text, line) = block.text(self.path, index)?;
                let text = match memchr::memchr(b'#', text.as_bytes()) {
                    Some(comment) => &text[..comment],
                    None => text,
                };
                let cells = splitter.split(text, delimiter(text));
                let cells = cells.map_err(|_| {
                    let message = format!("the row has more than {MOST_COLUMNS} cells: SWC has 7");
                    self.error(line, None, message, None)
                })?;
                visit(line, cells)?;
            }
        }
    }

    /// Whether the first row names the columns. The names of SWC's columns must be in their
    /// places.
    fn is_header(&self, line: u64, cells: &[&str]) -> Result<bool, SceneError> {
        if cells
            .iter()
            .any(|cell| number_of(cell, Decimal::Point).is_some())
        {
            return Ok(false);
        }
        for (place, cell) in cells.iter().enumerate() {
            let known = COLUMNS
                .iter()
                .position(|name| cell.eq_ignore_ascii_case(name));
            if known.is_some_and(|known| known != place) {
                let message = format!(
                    "{} is column {}: the columns of SWC are id type x y z radius parent",
                    quoted(cell),
                    place + 1
                );
                return Err(self.error(line, None, message, None));
            }
        }
        Ok(true)
    }

    fn sample(&self, line: u64, cells: [&str; 7]) -> Result<Sample, SceneError> {
        let wrong = |index: usize, what: &str| {
            let message = format!("{} is not a {what} number", quoted(cells[index]));
            self.error(line, Some(COLUMNS[index]), message, None)
        };
        let whole = |index: usize| whole(cells[index]).ok_or_else(|| wrong(index, "whole"));
        let number = |index: usize| {
            let number = number_of(cells[index], Decimal::Point);
            let number = number.filter(|number| number.is_finite());
            number.ok_or_else(|| wrong(index, "finite"))
        };
        Ok(Sample {
            line,
            id: whole(0)?,
            kind: whole(TYPE)?,
            point: DVec3::new(number(2)?, number(3)?, number(4)?),
            radius: number(5)?,
            parent: whole(6)?,
        })
    }
}

/// The delimiter of a sample's cells: blanks, unless the row contains a comma or a semicolon.
fn delimiter(text: &str) -> Delimiter {
    match memchr::memchr2(b',', b';', text.as_bytes()) {
        Some(_) => delimiter_of(text.as_bytes()),
        None => Delimiter::Blanks,
    }
}

/// Parses a whole number, which some programs write as `1.0`.
fn whole(cell: &str) -> Option<i64> {
    cell.parse().ok().or_else(|| {
        let number = number_of(cell, Decimal::Point)?;
        let is_whole = number.trunc() == number && number.abs() <= GREATEST_WHOLE;
        // The conversion is exact: the number is whole and small.
        is_whole.then_some(number as i64)
    })
}
