//! Detects the layout of a table in its first lines: the names of its columns, the delimiter,
//! and the number of cells in a row.
//!
//! The names are in the first row, or in a comment before it, as numpy and CloudCompare
//! write them. The first row counts as names unless all of its cells are numbers. If
//! columns are selected by number, the table needs no names.

use std::fmt;
use std::path::{Path, PathBuf};

use super::cells::{Cells, Splitter};
use super::format::{Decimal, Delimiter, TableFormat, of_names, of_numbers};
use super::numbers::{is_missing, number_of};
use crate::scene::error::SceneError;
use crate::scene::names::{quoted, suggestion};

/// The selection of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ColumnKey {
    /// By its exact name in the header.
    Name(String),
    /// By its name, ignoring case unless a name matches exactly.
    AnyCase(&'static str),
    /// By its number, from 0.
    Number(u64),
}

/// A column of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column(pub(super) usize);

/// The columns and the format of a table.
#[derive(Clone, Debug)]
pub struct Layout {
    pub(super) path: PathBuf,
    /// The line of the header, or of the first row.
    line: u64,
    pub(super) delimiter: Delimiter,
    pub(super) decimal: Decimal,
    /// The names of the columns; empty if the table has none.
    header: Vec<String>,
    /// The number of cells in a row.
    cells: usize,
    /// The number of cells that a row must have. The others are empty cells from
    /// delimiters at the end of a line.
    needed: usize,
    /// Whether each row begins with a row name without a column name, as R writes them.
    has_row_names: bool,
}

/// The first row and the comments before it.
pub(super) struct Beginning<'a> {
    pub path: &'a Path,
    pub line: u64,
    pub format: TableFormat,
    pub wanted: &'a [ColumnKey],
    pub comments: &'a [String],
}

impl ColumnKey {
    fn name(&self) -> Option<&str> {
        match self {
            Self::Name(name) => Some(name),
            Self::AnyCase(name) => Some(name),
            Self::Number(_) => None,
        }
    }
}

impl fmt::Display for ColumnKey {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Name(name) => formatter.write_str(&name.escape_debug().to_string()),
            Self::AnyCase(name) => formatter.write_str(name),
            Self::Number(number) => write!(formatter, "{number}"),
        }
    }
}

impl From<&str> for ColumnKey {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

/// The positions of a key's name in a header; none if the key is a number.
fn places(header: &[String], key: &ColumnKey) -> Vec<usize> {
    let with = |is_same: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let all = header.iter().enumerate();
        all.filter_map(|(index, cell)| is_same(cell).then_some(index))
            .collect()
    };
    let same = with(&|cell| key.name() == Some(cell));
    match key {
        ColumnKey::AnyCase(name) if same.is_empty() => {
            with(&|cell| cell.eq_ignore_ascii_case(name))
        }
        _ => same,
    }
}

impl Beginning<'_> {
    /// The layout given by the first row, and whether that row is the header.
    pub fn layout(&self, first: &str) -> (Layout, bool) {
        let stated = self.format.delimiter;
        let of_names = stated.unwrap_or_else(|| of_names(first.as_bytes()));
        let of_numbers =
            stated.unwrap_or_else(|| of_numbers(first.as_bytes(), self.format.decimal));
        let names = split(first, of_names);
        let numbers = split(first, of_numbers);
        if self.wanted_names(&names) > 0 {
            return (self.with(names, of_names), true);
        }
        if let Some(names) = self.commented_header(numbers.len()) {
            return (self.with(names, of_numbers), false);
        }
        match self.has_text(&numbers) {
            true => (self.with(names, of_names), true),
            false => (self.with(Vec::new(), of_numbers), false),
        }
    }

    /// The number of wanted columns among the names.
    fn wanted_names(&self, names: &[String]) -> usize {
        let wanted = self.wanted.iter();
        wanted.filter(|key| !places(names, key).is_empty()).count()
    }

    /// Whether a cell of the first row is text. If columns are wanted by number, only those
    /// count.
    fn has_text(&self, numbers: &[String]) -> bool {
        let is_value =
            |cell: &str| is_missing(cell) || number_of(cell, self.format.decimal).is_some();
        let numbered: Vec<&String> = self
            .wanted
            .iter()
            .filter_map(|key| match key {
                ColumnKey::Number(number) => numbers.get(usize::try_from(*number).ok()?),
                ColumnKey::Name(_) | ColumnKey::AnyCase(_) => None,
            })
            .collect();
        match numbered.is_empty() {
            // Other columns may contain anything.
            false => numbered.iter().any(|cell| !is_value(cell)),
            true => numbers.iter().any(|cell| !is_value(cell)),
        }
    }

    /// The names in a comment. Comments with one name for each cell of the row take
    /// precedence, then those with the most wanted columns, then the last one.
    fn commented_header(&self, cells: usize) -> Option<Vec<String>> {
        let comments = self.comments.iter();
        let candidates = comments.map(|comment| split(comment, of_names(comment.as_bytes())));
        candidates
            .filter(|names| self.wanted_names(names) > 0)
            .max_by_key(|names| (names.len() == cells, self.wanted_names(names)))
    }

    fn with(&self, header: Vec<String>, delimiter: Delimiter) -> Layout {
        let mut layout = Layout {
            path: self.path.to_owned(),
            line: self.line,
            delimiter,
            decimal: self.format.decimal,
            header,
            cells: 0,
            needed: 0,
            has_row_names: false,
        };
        layout.count(layout.header.clone().iter().map(String::as_str));
        layout
    }
}

impl Layout {
    /// The name of the table in errors.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Sets the number of cells from a row.
    fn count<'a>(&mut self, cells: impl Iterator<Item = &'a str>) {
        (self.cells, self.needed) = (0, 0);
        for cell in cells {
            self.cells += 1;
            if !cell.is_empty() {
                self.needed = self.cells;
            }
        }
    }

    /// Adapts to the first row after the header, `row`. If no column is wanted by name, this
    /// row determines the number of cells. Otherwise it shows whether rows have names.
    pub(super) fn adapt(&mut self, row: &str, cells: Cells, wanted: &[ColumnKey]) {
        if wanted.iter().all(|key| key.name().is_none()) {
            self.count(cells.iter());
            // An empty cell at the end of the first row counts if it is wanted.
            self.needed = self
                .needed
                .max(wanted.iter().map(ColumnKey::end).max().unwrap_or(0));
            if self.header.len() != self.cells {
                self.header.clear();
            }
            return;
        }
        // R quotes the names of rows, but no numbers.
        let is_quoted = row.trim_start().starts_with('"');
        let are_all_quoted = row.matches('"').count() >= 2 * cells.len();
        self.has_row_names = cells.len() == self.cells + 1 && is_quoted && !are_all_quoted;
    }

    /// The message if a row has too many or too few cells.
    pub(super) fn fault(&self, cells: Cells) -> Option<String> {
        let (names, found) = (usize::from(self.has_row_names), cells.len());
        let (least, most) = (self.needed + names, self.cells + names);
        if found == most || (found >= least && (least..found).all(|at| cells.get(at).is_empty())) {
            return None;
        }
        let other = match self.header.is_empty() {
            true => "the first row",
            false => "the header",
        };
        Some(format!("the row has {found} cells, but {other} has {most}"))
    }

    /// Finds a column.
    ///
    /// # Errors
    /// If the table has no such column, or several.
    pub fn column(&self, key: &ColumnKey) -> Result<Column, SceneError> {
        self.find(key).map_err(|(message, help)| SceneError::Row {
            path: self.path.clone(),
            line: self.line,
            column: None,
            message: format!("the table {message}"),
            help: Some(help),
        })
    }

    /// Finds a column, or returns a message that begins after the name of the table, and a
    /// help text.
    pub(in crate::scene) fn find(&self, key: &ColumnKey) -> Result<Column, (String, String)> {
        let names = usize::from(self.has_row_names);
        let name = match key {
            ColumnKey::Name(name) => name.as_str(),
            ColumnKey::AnyCase(name) => name,
            ColumnKey::Number(number) => {
                return match usize::try_from(*number).ok().filter(|at| *at < self.cells) {
                    Some(at) => Ok(Column(at)),
                    None => Err((
                        format!("has no column {number}"),
                        format!("it has {} columns, numbered from 0", self.cells),
                    )),
                };
            }
        };
        match places(&self.header, key)[..] {
            [index] => Ok(Column(index + names)),
            [_, _, ..] => Err((
                format!("has more than one column {}", quoted(name)),
                "column names must differ".to_owned(),
            )),
            [] => Err((
                format!("has no column {}", quoted(name)),
                self.missing_help(name),
            )),
        }
    }

    /// Whether any column has the name of a key.
    pub(in crate::scene) fn names(&self, key: &ColumnKey) -> bool {
        !places(&self.header, key).is_empty()
    }

    /// The names of the columns; empty if the table has none.
    pub(in crate::scene) fn header(&self) -> &[String] {
        &self.header
    }

    fn missing_help(&self, name: &str) -> String {
        if self.header.is_empty() {
            return "its first line contains numbers: add a header with column names, or give columns by their numbers from 0".to_owned();
        }
        suggestion(name, self.header.iter().map(String::as_str), "columns")
    }

    /// The name of a column in messages.
    pub(super) fn name(&self, column: Column) -> String {
        let index = column.0.checked_sub(usize::from(self.has_row_names));
        match index.and_then(|index| self.header.get(index)) {
            Some(name) => name.clone(),
            None => column.0.to_string(),
        }
    }

    /// A note on the columns that are not read; `None` if all are read.
    #[must_use]
    pub fn unread(&self, read: &[Column]) -> Option<String> {
        const MOST_NAMED: usize = 20;
        let first = usize::from(self.has_row_names);
        let is_read = |index: &usize| read.contains(&Column(index + first));
        let (named, unnamed): (Vec<usize>, Vec<usize>) = (0..self.cells.max(self.header.len()))
            .filter(|index| !is_read(index))
            .partition(|index| self.header.get(*index).is_some_and(|name| !name.is_empty()));
        // After the last name only delimiters at line ends leave cells.
        let unnamed = unnamed.iter().filter(|index| **index < self.needed).count() + first;
        let mut names: Vec<String> = named
            .iter()
            .take(MOST_NAMED)
            .map(|index| quoted(&self.header[*index]))
            .collect();
        if named.len() > MOST_NAMED {
            names.push(format!("{} more", named.len() - MOST_NAMED));
        }
        if unnamed > 0 {
            names.push(format!("{unnamed} without a name"));
        }
        match names.is_empty() {
            true => None,
            false => Some(format!(
                "{}: ignored columns: {}",
                self.path.display(),
                names.join(", ")
            )),
        }
    }
}

impl ColumnKey {
    /// The number of cells that a row needs for this column.
    fn end(&self) -> usize {
        match self {
            Self::Name(_) | Self::AnyCase(_) => 0,
            Self::Number(number) => usize::try_from(*number).map_or(0, |at| at.saturating_add(1)),
        }
    }
}

/// The cells of a row; none if it has too many.
fn split(row: &str, delimiter: Delimiter) -> Vec<String> {
    let mut splitter = Splitter::default();
    let cells = splitter.split(row, delimiter);
    cells.map_or_else(
        |_| Vec::new(),
        |cells| cells.iter().map(str::to_owned).collect(),
    )
}
