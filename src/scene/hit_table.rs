//! Tables of hits of another program: the columns `hit` and `t` of `trace`, one row for each
//! ray in order. A column `ray`, if present, must number the rows.

use std::io::Read;
use std::path::Path;

use super::error::SceneError;
use super::names::quoted;
use super::table::{Column, ColumnKey, Row, Table, TableFormat, input};

/// Columns of `trace` that are not compared.
const KNOWN: [&str; 15] = [
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "prototype",
    "solid",
    "primitive",
    "part",
    "crossing",
    "instance",
    "u",
    "v",
    "error",
];

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenHit {
    /// The ray's parameter; `None` for a miss.
    pub t: Option<f64>,
    /// The line in the file, from 1.
    pub line: u64,
}

/// All rows of a table, and a note on ignored columns.
#[derive(Debug)]
pub struct GivenHits {
    /// One row for each ray.
    pub hits: Vec<GivenHit>,
    /// A sentence that names the unknown columns.
    pub unread: Option<String>,
}

impl GivenHits {
    /// Reads the table of a file or a pipe, up to `most + 1` rows.
    ///
    /// # Errors
    /// If the table cannot be read, or a cell is malformed.
    pub fn open(path: &Path, format: TableFormat, most: usize) -> Result<Self, SceneError> {
        Self::read(input::open(path)?, path, format, most)
    }

    /// As [`GivenHits::open`], from any reader; errors name it `path`.
    ///
    /// # Errors
    /// If the table cannot be read, or a cell is malformed.
    pub fn read(
        input: impl Read,
        path: &Path,
        format: TableFormat,
        most: usize,
    ) -> Result<Self, SceneError> {
        let wanted = ["hit", "t", "ray"].map(ColumnKey::AnyCase);
        let table = Table::new(input, path, format, &wanted)?;
        let layout = table.layout();
        let (hit, t) = (layout.column(&wanted[0])?, layout.column(&wanted[1])?);
        let find = |name| layout.column(&ColumnKey::AnyCase(name)).ok();
        let ray = find("ray");
        let mut known: Vec<Column> = KNOWN.iter().filter_map(|name| find(name)).collect();
        known.extend([hit, t].into_iter().chain(ray));
        let unread = layout.unread(&known);
        let mut rows = table.rows();
        let mut hits = Vec::new();
        // One row more than `most` shows that the table has too many.
        while hits.len() <= most {
            let Some(row) = rows.next_row()? else {
                break;
            };
            if let Some(ray) = ray {
                check_number(&row, ray, hits.len())?;
            }
            let is_hit = row.flag(hit).ok_or_else(|| {
                let cell = quoted(row.cell(hit));
                row.error(
                    Some(hit),
                    format!("{cell} must be 0 or 1, or True or False"),
                )
            })?;
            let t = match is_hit {
                true => Some(row.number(t).map_err(|fault| row.refused(fault))?),
                false => None,
            };
            hits.push(GivenHit { t, line: row.line });
        }
        Ok(Self { hits, unread })
    }
}

/// Rejects a table with several rows for a ray, or in another order.
fn check_number(row: &Row, column: Column, expected: usize) -> Result<(), SceneError> {
    let number = row.any_number(column).map_err(|fault| row.refused(fault))?;
    if number == expected as f64 {
        return Ok(());
    }
    let cell = quoted(row.cell(column));
    let message =
        format!("{cell} must be {expected}: the table must have one row per ray, in their order");
    Err(row.error(Some(column), message))
}
