//! Opens the tables that a scene file names, finds their columns and limits their memory.

use std::cell::RefCell;
use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use toml::Spanned;

use super::error::SceneError;
use super::lines::lines;
use super::source::Source;
use super::table::{Column, ColumnKey, Decimal, Delimiter, Row, Rows, Table, TableFormat, input};
use super::values::ThreeColumns;

/// The data that all tables of a prototype share.
pub(super) struct Tables<'a> {
    pub source: &'a Source,
    memory: &'a PipeMemory,
    notes: RefCell<Vec<String>>,
}

/// The bytes left for the rows of pipes, which cannot be counted in advance, of all prototypes.
pub(super) struct PipeMemory(AtomicU64);

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
    /// An upper bound of the number of rows, if they could be counted.
    lines: Option<u64>,
}

impl PipeMemory {
    /// Memory of this size, or without a limit.
    pub fn new(bytes: Option<u64>) -> Self {
        Self(AtomicU64::new(bytes.unwrap_or(u64::MAX)))
    }

    /// Takes some of it. Returns false if less is left; then nothing is left any more.
    fn take(&self, bytes: u64) -> bool {
        let before = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| {
                Some(left.saturating_sub(bytes))
            });
        before.is_ok_and(|left| left >= bytes)
    }
}

impl<'a> Tables<'a> {
    /// The tables of a prototype.
    pub fn new(source: &'a Source, memory: &'a PipeMemory) -> Self {
        Self {
            source,
            memory,
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

    /// Reserves some of the memory for rows that could not be counted in advance. Returns
    /// false if less is left.
    pub fn take(&self, bytes: u64) -> bool {
        self.memory.take(bytes)
    }

    /// The error that the memory does not suffice for a row of a pipe.
    pub fn refused(&self, path: &Path, line: u64) -> SceneError {
        SceneError::Row {
            path: path.to_owned(),
            line,
            column: None,
            message: "the rows of this pipe take more memory than is left".to_owned(),
            help: Some("--max-memory SIZE allows more".to_owned()),
        }
    }

    /// Adds a note for the user.
    pub fn note(&self, note: String) {
        self.notes.borrow_mut().push(note);
    }

    /// All notes.
    pub fn into_notes(self) -> Vec<String> {
        self.notes.into_inner()
    }
}

impl NamedTable<'_> {
    /// Finds a column that the scene file names.
    pub fn column(&self, key: &Spanned<ColumnKey>) -> Result<Column, SceneError> {
        self.column_at(key.get_ref(), key.span())
    }

    /// As [`NamedTable::column`], with another place in the scene file for errors.
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

    /// Whether any column has the name of a key.
    pub fn has(&self, key: &ColumnKey) -> bool {
        self.rows.layout().names(key)
    }

    /// The names of all columns.
    pub fn header(&self) -> &[String] {
        self.rows.layout().header()
    }

    /// The columns of a point or a vector.
    pub fn three(&self, keys: &ThreeColumns) -> Result<[Column; 3], SceneError> {
        let [x, y, z] = &keys.0;
        Ok([self.column(x)?, self.column(y)?, self.column(z)?])
    }

    /// Adds a note on the columns that are not among those read.
    pub fn note_unread(&self, read: &[Column]) {
        if let Some(note) = self.rows.layout().unread(read) {
            self.tables.note(note);
        }
    }

    /// An upper bound of the number of rows; 0 for a pipe.
    pub fn most_rows(&self) -> usize {
        let lines = self.lines.unwrap_or(0);
        usize::try_from(lines).unwrap_or(0)
    }

    /// The next row, which will be stored as a record of `record_bytes`.
    pub fn next_row(&mut self, record_bytes: usize) -> Result<Option<Row<'_>>, SceneError> {
        let Some(row) = self.rows.next_row()? else {
            return Ok(None);
        };
        if self.lines.is_none() {
            // A growing list is in memory twice while it moves.
            if !self.tables.take(2 * record_bytes as u64) {
                return Err(self.tables.refused(row.path(), row.line));
            }
        }
        Ok(Some(row))
    }
}

/// An upper bound of the rows of a table, one of whose columns is `column`; 0 if it cannot be
/// read. A table whose columns are numbered may have no header.
pub(super) fn table_rows(
    source: &Source,
    file: &Spanned<String>,
    column: Option<&ColumnKey>,
) -> u64 {
    let is_numbered = matches!(column, Some(ColumnKey::Number(_)));
    rows(source, file) + u64::from(is_numbered)
}

/// The number of lines of a file without the first, which is a header, a comment or a sample
/// without a parent; 0 if the file cannot be read.
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
