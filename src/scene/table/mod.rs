//! Tables: text with a row a line, and columns with names or numbers. This is the one
//! reader for all of them: cylinders, placements, rays, points and hits.
//!
//! `input` opens files and pipes; `records` finds the rows in their text and keeps the
//! limits of `scene::limits`; `format` is what separates cells, and how numbers are
//! written; `header` finds out what the columns are; `cells` splits a row, and `row`
//! reads numbers in it. `docs/formats.md` describes the formats to users.

mod cells;
mod format;
mod header;
pub(super) mod input;
mod records;
mod row;

#[cfg(test)]
mod tests;

use std::io::Read;
use std::path::Path;

pub use format::{Decimal, Delimiter, TableFormat};
pub use header::{Column, ColumnKey, Layout};
pub use records::Block;
pub(super) use records::Records;
pub use row::{Fault, Row};
pub(super) use {
    cells::{Cells, Splitter},
    format::of_names as delimiter_of,
    row::number_of,
};

use self::header::Beginning;
use super::error::SceneError;
use super::limits::MOST_COLUMNS;

/// A table that is being read.
pub struct Table<I> {
    records: Records<I>,
    layout: Layout,
    /// The first rows, which are read for the layout.
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
    /// Begins to read a table, which errors call `path`, for some columns.
    ///
    /// # Errors
    /// When it cannot be read, is empty, is not UTF-8, or goes beyond a limit.
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
            let message =
                format!("the table is empty: there is no header and no row with {wanted}");
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

    /// How it is laid out.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The next rows, `None` at the end.
    ///
    /// # Errors
    /// When the table cannot be read or goes beyond a limit.
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
    /// How the table is laid out.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        self.table.layout()
    }

    /// The next row, `None` at the end.
    ///
    /// # Errors
    /// When the table cannot be read, goes beyond a limit, or the row is not UTF-8 or
    /// has not as many cells as the header.
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
    /// Reads the rows of a block in turn.
    ///
    /// # Errors
    /// The first of `action`, or of a row that is not UTF-8 or has not as many cells as
    /// the header.
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
        let message = format!("the row has more than {MOST_COLUMNS} cells, the most that are read");
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
