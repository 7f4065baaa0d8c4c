//! Tables: text with one row on each line, and columns with names or numbers. This is the
//! reader for all tables: cylinders, placements, rays, points and hits.
//!
//! `input` opens files and pipes; `records` finds the rows in the text and enforces the
//! limits of `scene::limits`; `format` defines delimiters and decimal separators; `header`
//! detects the columns; `cells` splits a row, and `row` reads its `numbers`.
//! `docs/formats.md` describes the formats to users.

mod cells;
mod format;
mod header;
pub(super) mod input;
mod numbers;
mod records;
mod row;

#[cfg(test)]
mod tests;

use std::io::Read;
use std::ops::Range;
use std::path::Path;

pub use format::{Decimal, Delimiter, TableFormat};
pub use header::{Column, ColumnKey, Layout};
pub use records::Block;
pub(super) use records::Records;
pub use row::{Fault, Row};
pub(super) use {
    cells::{Cells, Splitter},
    format::of_names as delimiter_of,
    numbers::number_of,
};

use self::header::Beginning;
use self::records::ROW_OF_LINES;
use super::error::SceneError;
use super::limits::MOST_COLUMNS;

/// A table that is being read.
pub struct Table<I> {
    records: Records<I>,
    layout: Layout,
    /// The first row, which was read for the layout.
    first: Option<Block>,
}

/// The rows of a table, one after the other.
pub struct Rows<I> {
    table: Table<I>,
    block: Block,
    next: usize,
    splitter: Splitter,
}

impl<I: Read> Table<I> {
    /// Begins to read the wanted columns of a table; errors name it `path`.
    ///
    /// # Errors
    /// If the table cannot be read, is empty, is not UTF-8, or exceeds a limit.
    pub fn new(
        input: I,
        path: &Path,
        format: TableFormat,
        wanted: &[ColumnKey],
    ) -> Result<Self, SceneError> {
        let mut records = Records::new(input, path);
        let (mut first, mut format) = (Block::default(), format);
        let mut is_there = records.next_record(&mut first, format.delimiter)?;
        if is_there && let Some(delimiter) = format::stated_in(first.text(path, 0)?.0) {
            format.delimiter.get_or_insert(delimiter);
            first = Block::default();
            is_there = records.next_record(&mut first, format.delimiter)?;
        }
        if !is_there {
            let wanted: Vec<String> = wanted.iter().map(ToString::to_string).collect();
            let wanted = wanted.join(",");
            let message = format!("the table is empty: it needs a header or rows with {wanted}");
            return Err(SceneError::row(path, records.line() + 1, message));
        }
        let (text, line) = first.text(path, 0)?;
        let beginning = Beginning {
            path,
            line,
            format,
            wanted,
            comments: records.comments.make_contiguous(),
        };
        let (mut layout, is_header) = beginning.layout(text);
        if is_header {
            first = Block::default();
            records.next_record(&mut first, Some(layout.delimiter))?;
        }
        records.comments.clear();
        if !first.is_empty() {
            let (text, _) = first.text(path, 0)?;
            let mut splitter = Splitter::default();
            // A row with too many cells is an error when it is read.
            if let Ok(cells) = splitter.split(text, layout.delimiter) {
                layout.adapt(text, cells, wanted);
            }
        }
        Ok(Self {
            records,
            layout,
            first: Some(first).filter(|first| !first.is_empty()),
        })
    }

    /// Restricts a table, before its first row is read, to the rows that begin in `range`, in
    /// bytes from its beginning. `reopened` opens the table at a place. Returns the place of
    /// the line that errors call line 2, or `None` if they number the lines of the whole table.
    ///
    /// # Errors
    /// If the table cannot be read.
    pub fn restrict(
        &mut self,
        range: Range<u64>,
        reopened: impl FnOnce(u64) -> Result<I, SceneError>,
    ) -> Result<Option<u64>, SceneError> {
        let first_row = self.records.row_start();
        if self.first.is_none() || range.start <= first_row {
            self.records.end_at(range.end);
            self.first = self.first.take().filter(|_| first_row < range.end);
            if let Some(first) = &self.first {
                let (text, line) = first.text(&self.layout.path, 0)?;
                if text.contains('\n') {
                    return Err(SceneError::row(&self.layout.path, line, ROW_OF_LINES));
                }
            }
            return Ok(None);
        }
        let before = range.start - 1;
        self.first = None;
        self.records = Records::within(reopened(before)?, &self.layout.path, range)?;
        Ok(Some(self.records.row_start()))
    }

    /// The layout of the table.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The next rows, or `None` at the end.
    ///
    /// # Errors
    /// If the table cannot be read or exceeds a limit.
    pub fn next_block(&mut self) -> Result<Option<Block>, SceneError> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        let block = self.records.next_block(self.layout.delimiter)?;
        Ok(Some(block).filter(|block| !block.is_empty()))
    }

    /// The rows, one after the other.
    #[must_use]
    pub fn rows(self) -> Rows<I> {
        Rows {
            table: self,
            block: Block::default(),
            next: 0,
            splitter: Splitter::default(),
        }
    }
}

impl<I: Read> Rows<I> {
    /// The layout of the table.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        self.table.layout()
    }

    /// The next row, or `None` at the end.
    ///
    /// # Errors
    /// If the table cannot be read or exceeds a limit, or if the row is not UTF-8 or has
    /// another number of cells than the header.
    pub fn next_row(&mut self) -> Result<Option<Row<'_>>, SceneError> {
        if self.next == self.block.len() {
            let Some(block) = self.table.next_block()? else {
                return Ok(None);
            };
            (self.block, self.next) = (block, 0);
        }
        self.next += 1;
        let layout = &self.table.layout;
        row(layout, &self.block, self.next - 1, &mut self.splitter).map(Some)
    }
}

impl Layout {
    /// Calls `action` with each row of a block.
    ///
    /// # Errors
    /// The first error of `action`, or of a row that is not UTF-8 or has another number of
    /// cells than the header.
    pub fn for_each_row(
        &self,
        block: &Block,
        mut action: impl FnMut(&Row) -> Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        let mut splitter = Splitter::default();
        (0..block.len()).try_for_each(|index| action(&row(self, block, index, &mut splitter)?))
    }
}

/// A row of a block.
fn row<'a>(
    layout: &'a Layout,
    block: &'a Block,
    index: usize,
    splitter: &'a mut Splitter,
) -> Result<Row<'a>, SceneError> {
    let (text, line) = block.text(&layout.path, index)?;
    let Ok(cells) = splitter.split(text, layout.delimiter) else {
        let message = format!("the row has more than {MOST_COLUMNS} cells, the limit for a row");
        return Err(SceneError::row(&layout.path, line, &message));
    };
    match layout.fault(cells) {
        Some(message) => Err(SceneError::row(&layout.path, line, &message)),
        None => Ok(Row {
            layout,
            cells,
            line,
        }),
    }
}
