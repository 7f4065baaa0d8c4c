//! Tables of rays, `ox,oy,oz,dx,dy,dz` and optionally `t_min,t_max`, and of points,
//! `x,y,z`, read by [`Table`].
//!
//! A table is read in blocks of rows, so that many threads can parse blocks and a table of
//! any length needs little memory.

use std::io::{self, Read, Seek, SeekFrom};
use std::marker::PhantomData;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::error::SceneError;
use super::lines::lines_before;
use super::table::{Block, Column, ColumnKey, Layout, Row, Table, TableFormat, input};
use crate::math::Ray;

/// A value given by a row of numbers.
pub trait NumberRow: Sized + Send {
    /// The columns' names: first those that contain finite numbers and must be present,
    /// then those that may be absent.
    const NAMES: &'static [&'static str];

    /// The number of columns that a table must have.
    const REQUIRED: usize;

    /// The values of absent columns.
    const DEFAULTS: &'static [f64];

    /// The value of a row of numbers, one for each column.
    ///
    /// # Errors
    /// If the numbers are not a valid value.
    fn of(values: &[f64]) -> Result<Self, String>;
}

impl NumberRow for Ray {
    const NAMES: &'static [&'static str] = &["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max"];
    const REQUIRED: usize = 6;
    const DEFAULTS: &'static [f64] = &[0.0, f64::INFINITY];

    fn of(values: &[f64]) -> Result<Self, String> {
        let ray = Self {
            origin: DVec3::from_slice(values),
            direction: DVec3::from_slice(&values[3..]),
            t_min: values[6],
            t_max: values[7],
        };
        if ray.direction == DVec3::ZERO {
            return Err(
                "columns \"dx\", \"dy\", \"dz\": the direction is zero; it must have a nonzero length"
                    .to_owned(),
            );
        }
        ray.check_sizes().map_err(|error| error.to_string())?;
        let (t_min, t_max) = (ray.t_min, ray.t_max);
        match t_min > t_max {
            true => Err(format!(
                "columns \"t_min\", \"t_max\": {t_min:?} is greater than {t_max:?}; t_min must not exceed t_max"
            )),
            false => Ok(ray),
        }
    }
}

/// A point.
impl NumberRow for DVec3 {
    const NAMES: &'static [&'static str] = &["x", "y", "z"];
    const REQUIRED: usize = 3;
    const DEFAULTS: &'static [f64] = &[];

    fn of(values: &[f64]) -> Result<Self, String> {
        Ok(Self::from_slice(values))
    }
}

/// The most columns of a [`NumberRow`].
const MOST_NUMBERS: usize = 8;

/// A table that is being read.
pub struct NumberTable<R, I = Box<dyn Read>> {
    table: Table<I>,
    columns: NumberColumns<R>,
}

/// The columns of a table that contain the numbers.
pub struct NumberColumns<R> {
    layout: Layout,
    /// The columns present, each with its position in [`NumberRow::NAMES`].
    columns: Vec<(usize, Column)>,
    range: Option<RangeStart>,
    row: PhantomData<fn() -> R>,
}

/// The beginning of a range in a file, whose lines are numbered from 2 until their numbers are
/// of use, in a message.
#[derive(Clone)]
struct RangeStart {
    path: PathBuf,
    /// The place of the first line of the range, in bytes.
    place: u64,
}

impl RangeStart {
    /// An error with the number of its line in the whole file.
    fn located(&self, error: SceneError) -> SceneError {
        // Of a file that cannot be read any more, the lines are those of the range.
        let lines = lines_before(&self.path, self.place).unwrap_or(1);
        error.lines_later(lines.saturating_sub(1))
    }
}

impl<R: NumberRow> NumberTable<R> {
    /// Opens a table of a file or a pipe; `-` is standard input. `columns` are the
    /// numbers of the columns, from 0, for a table without column names.
    ///
    /// # Errors
    /// If the table cannot be read or a column is missing.
    pub fn open(path: &Path, format: TableFormat, columns: &[u64]) -> Result<Self, SceneError> {
        if path.as_os_str() == "-" {
            let name = Path::new("standard input");
            return Self::new(Box::new(io::stdin()), name, format, columns);
        }
        Self::new(Box::new(input::open(path)?), path, format, columns)
    }

    /// As [`NumberTable::open`], only the rows that begin in a range of a regular file, in bytes
    /// from its beginning. Ranges that follow one another contain each row once. Each row must
    /// be on one line.
    ///
    /// # Errors
    /// Those of [`NumberTable::open`].
    pub fn open_range(
        path: &Path,
        format: TableFormat,
        columns: &[u64],
        range: Range<u64>,
    ) -> Result<Self, SceneError> {
        let mut table = Self::open(path, format, columns)?;
        let place = table.table.restrict(range, |place| {
            let mut file = input::open(path)?;
            let moved = file.seek(SeekFrom::Start(place));
            moved.map_err(|source| SceneError::Unreadable {
                path: path.to_owned(),
                source,
            })?;
            Ok(Box::new(file))
        })?;
        let path = path.to_owned();
        table.columns.range = place.map(|place| RangeStart { path, place });
        Ok(table)
    }
}

impl<R: NumberRow, I: Read> NumberTable<R, I> {
    /// As [`NumberTable::open`], from any reader; errors name the table `path`.
    ///
    /// # Errors
    /// If the table cannot be read or a column is missing.
    pub fn new(
        input: I,
        path: &Path,
        format: TableFormat,
        columns: &[u64],
    ) -> Result<Self, SceneError> {
        let names = R::NAMES[..R::REQUIRED].join(",");
        let is_numbered = !columns.is_empty();
        let keys: Vec<ColumnKey> = match is_numbered {
            true => columns.iter().map(|&at| ColumnKey::Number(at)).collect(),
            false => R::NAMES
                .iter()
                .map(|&name| ColumnKey::AnyCase(name))
                .collect(),
        };
        if is_numbered && ![R::REQUIRED, R::NAMES.len()].contains(&keys.len()) {
            let message = format!(
                "{} column numbers are given: {} are needed, for {names}",
                keys.len(),
                R::REQUIRED
            );
            return Err(SceneError::row(path, 1, message));
        }
        let table = Table::new(input, path, format, &keys)?;
        let layout = table.layout();
        let mut found = Vec::new();
        for (position, key) in keys.iter().enumerate() {
            // An optional column must not occur twice.
            if is_numbered || position < R::REQUIRED || layout.names(key) {
                found.push((position, layout.column(key)?));
            }
        }
        let columns = NumberColumns {
            layout: layout.clone(),
            columns: found,
            range: None,
            row: PhantomData,
        };
        Ok(Self { table, columns })
    }

    /// The next rows, or `None` at the end.
    ///
    /// # Errors
    /// If the table cannot be read or exceeds a limit.
    pub fn next_block(&mut self) -> Result<Option<Block>, SceneError> {
        let block = self.table.next_block();
        block.map_err(|error| self.columns.located(error))
    }

    /// The columns of the table, which other threads may use.
    #[must_use]
    pub fn columns(&self) -> NumberColumns<R> {
        NumberColumns {
            layout: self.columns.layout.clone(),
            columns: self.columns.columns.clone(),
            range: self.columns.range.clone(),
            row: PhantomData,
        }
    }
}

impl<R: NumberRow> NumberColumns<R> {
    /// The rows of a block.
    ///
    /// # Errors
    /// The error in the first invalid row.
    pub fn rows(&self, block: &Block) -> Result<Vec<R>, SceneError> {
        let mut rows = Vec::with_capacity(block.len());
        let read = self.layout.for_each_row(block, |row| {
            rows.push(self.row(row)?);
            Ok(())
        });
        read.map_err(|error| self.located(error))?;
        Ok(rows)
    }

    /// An error with the number of its line in the whole table.
    fn located(&self, error: SceneError) -> SceneError {
        match &self.range {
            Some(range) => range.located(error),
            None => error,
        }
    }

    fn row(&self, row: &Row) -> Result<R, SceneError> {
        let mut values = [0.0; MOST_NUMBERS];
        values[R::REQUIRED..R::NAMES.len()].copy_from_slice(R::DEFAULTS);
        for &(position, column) in &self.columns {
            // The range of a ray may be infinite.
            let value = match position < R::REQUIRED {
                true => row.number(column),
                false => row.any_number(column),
            };
            values[position] = value.map_err(|fault| row.refused(fault))?;
        }
        R::of(&values[..R::NAMES.len()]).map_err(|message| row.error(None, message))
    }

    /// A note on ignored columns.
    #[must_use]
    pub fn unread(&self) -> Option<String> {
        let read: Vec<Column> = self.columns.iter().map(|(_, column)| *column).collect();
        self.layout.unread(&read)
    }
}
