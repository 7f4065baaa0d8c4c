//! Tables that a scene file names: opens them, finds their columns and limits their
//! memory.

use std::cell::{Cell, RefCell};
use std::fs::File;
use std::path::Path;

use toml::Spanned;

use super::document::ThreeColumns;
use super::error::SceneError;
use super::lines::lines;
use super::source::Source;
use super::table::{Column, ColumnKey, Decimal, Delimiter, Row, Rows, Table, TableFormat, input};

/// What all tables of a scene file share.
pub(super) struct Tables<'a> {
    pub source: &'a Source,
    /// Bytes left for the rows of pipes, which cannot be counted beforehand.
    memory: Cell<u64>,
    notes: RefCell<Vec<String>>,
}

/// The keys of a table in a scene file.
#[derive(Clone, Copy)]
pub(super) struct TableKeys<'a> {
    pub file: &'a Spanned<String>,
    pub delimiter: Option<&'a Spanned<String>>,
    pub decimal: Option<&'a Spanned<String>>,
}

/// A table that is being read.
pub(super) struct NamedTable<'a> {
    tables: &'a Tables<'a>,
    rows: Rows<File>,
    /// At least as many as its rows, where they could be counted.
    lines: Option<u64>,
}

impl<'a> Tables<'a> {
    /// The tables of a scene file, with `memory` bytes for rows that cannot be counted
    /// beforehand.
    pub fn new(source: &'a Source, memory: Option<u64>) -> Self {
        Self {
            source,
            memory: Cell::new(memory.unwrap_or(u64::MAX)),
            notes: RefCell::default(),
        }
    }

    /// Opens a table to read the `wanted` columns.
    pub fn open(
        &'a self,
        keys: TableKeys,
        wanted: &[ColumnKey],
    ) -> Result<NamedTable<'a>, SceneError> {
        let source = self.source;
        let delimiter = keys.delimiter;
        let delimiter = delimiter.map(|word| source.choose("delimiter", word, &Delimiter::NAMES));
        let decimal = keys.decimal;
        let decimal = decimal.map(|word| source.choose("decimal", word, &Decimal::NAMES));
        let format = TableFormat {
            delimiter: delimiter.transpose()?,
            decimal: decimal.transpose()?.unwrap_or_default(),
        };
        let path = source.resolve(keys.file.get_ref());
        let table = input::open(&path)
            .and_then(|file| Table::new(file, &path, format, wanted))
            .map_err(|error| source.unreadable(keys.file, error))?;
        Ok(NamedTable {
            tables: self,
            rows: table.rows(),
            lines: lines(&path).ok().filter(|_| path.is_file()),
        })
    }

    /// Takes some of the memory for what could not be counted beforehand; returns false
    /// if less is left.
    pub fn take(&self, bytes: u64) -> bool {
        let left = self.memory.get().checked_sub(bytes);
        self.memory.set(left.unwrap_or(0));
        left.is_some()
    }

    /// The error for a row of a pipe without memory.
    pub fn refused(&self, path: &Path, line: u64) -> SceneError {
        SceneError::Row {
            path: path.to_owned(),
            line,
            column: None,
            message: "the rows of this pipe take more memory than is left".to_owned(),
            help: Some("--max-memory SIZE allows more".to_owned()),
        }
    }

    /// Keeps a note for the user.
    pub fn note(&self, note: String) {
        self.notes.borrow_mut().push(note);
    }

    /// All notes.
    pub fn into_notes(self) -> Vec<String> {
        self.notes.into_inner()
    }
}

impl NamedTable<'_> {
    /// Finds a column that the scene file states.
    pub fn column(&self, key: &Spanned<ColumnKey>) -> Result<Column, SceneError> {
        self.column_at(key.get_ref(), key.span())
    }

    /// The same, where the place in the scene file is another's.
    pub fn column_at(
        &self,
        key: &ColumnKey,
        place: std::ops::Range<usize>,
    ) -> Result<Column, SceneError> {
        let layout = self.rows.layout();
        layout.find(key).map_err(|(message, help)| {
            let message = format!("{} {message}", layout.path().display());
            self.tables.source.error_with_help(place, message, help)
        })
    }

    /// The columns of a point or a vector.
    pub fn three(&self, keys: &ThreeColumns) -> Result<[Column; 3], SceneError> {
        let [x, y, z] = &keys.0;
        Ok([self.column(x)?, self.column(y)?, self.column(z)?])
    }

    /// Notes which columns are not among those that are read.
    pub fn note_unread(&self, read: &[Column]) {
        if let Some(note) = self.rows.layout().unread(read) {
            self.tables.note(note);
        }
    }

    /// At least as many rows as it has, 0 of a pipe.
    pub fn most_rows(&self) -> usize {
        let lines = self.lines.unwrap_or(0);
        usize::try_from(lines).unwrap_or(0)
    }

    /// The next row, which will be kept as a record of `record_bytes`.
    pub fn next_row(&mut self, record_bytes: usize) -> Result<Option<Row<'_>>, SceneError> {
        let Some(row) = self.rows.next_row()? else {
            return Ok(None);
        };
        if self.lines.is_none() {
            // A list that grows is in memory twice while it is moved.
            if !self.tables.take(2 * record_bytes as u64) {
                return Err(self.tables.refused(row.path(), row.line));
            }
        }
        Ok(Some(row))
    }
}

/// The most rows of a table, one of whose columns is `column`; 0 of one that cannot be read.
/// One whose columns have numbers may have no header.
pub(super) fn table_rows(
    source: &Source,
    file: &Spanned<String>,
    column: Option<&ColumnKey>,
) -> u64 {
    let is_numbered = matches!(column, Some(ColumnKey::Number(_)));
    rows(source, file) + u64::from(is_numbered)
}

/// The lines of a file but the first, which is a header, a comment, or a sample without a
/// parent; 0 of one that cannot be read.
pub(super) fn rows(source: &Source, file: &Spanned<String>) -> u64 {
    let lines = lines(&source.resolve(file.get_ref()));
    lines.map_or(0, |lines| lines.saturating_sub(1))
}

/// The keys of some columns, without their places.
pub(super) fn keys_of<'k>(
    columns: impl IntoIterator<Item = &'k Spanned<ColumnKey>>,
) -> Vec<ColumnKey> {
    let columns = columns.into_iter();
    columns.map(|column| column.get_ref().clone()).collect()
}
