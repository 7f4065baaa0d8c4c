//! Tables of hits of another program: the columns `hit` and `t` of `trace`.
//!
//! The first line that is neither blank nor a comment (`#`) names the columns,
//! in any order; others than `hit`, `t` and `ray` are not looked at.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use csv::{ReaderBuilder, StringRecord, Trim};

/// A row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToldHit {
    /// The ray's parameter; `None` for a miss.
    pub t: Option<f64>,
    /// The line in the file, from 1.
    pub line: u64,
}

/// Reads a table of one row a ray.
pub fn read_hits(path: &Path) -> anyhow::Result<Vec<ToldHit>> {
    let name = path.display();
    let mut reader = ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_path(path)
        .with_context(|| format!("cannot read {name}"))?;
    let header = reader.headers().map_err(|error| message(path, &error))?;
    let find = |column: &str| {
        header
            .iter()
            .position(|cell| cell.trim_start_matches('\u{feff}') == column)
    };
    let need = |column: &str| {
        find(column).ok_or_else(|| {
            anyhow!("{name}: column {column:?} is missing: the header must name hit,t")
        })
    };
    let (hit, t, ray) = (need("hit")?, need("t")?, find("ray"));
    let mut hits = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| message(path, &error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let at = || format!("{name}:{line}");
        if let Some(told) = ray.and_then(|column| record.get(column)) {
            check_number(told, hits.len()).with_context(at)?;
        }
        let t = parameter(&record, hit, t).with_context(at)?;
        hits.push(ToldHit { t, line });
    }
    Ok(hits)
}

/// The `t` of a row; `None` for a miss.
fn parameter(record: &StringRecord, hit: usize, t: usize) -> anyhow::Result<Option<f64>> {
    let (hit, t) = (&record[hit], &record[t]);
    match hit {
        "0" => Ok(None),
        "1" => match t.parse() {
            Ok(t) if f64::is_finite(t) => Ok(Some(t)),
            _ => bail!("column \"t\": {t:?} must be a finite number where hit is 1"),
        },
        _ => bail!("column \"hit\": {hit:?} must be 0 or 1"),
    }
}

/// A table with several rows a ray, or in another order, is not compared.
fn check_number(told: &str, row: usize) -> anyhow::Result<()> {
    if told.parse() == Ok(row) {
        return Ok(());
    }
    bail!("column \"ray\": {told:?} where {row} is due: there must be one row a ray, in order")
}

fn message(path: &Path, error: &csv::Error) -> anyhow::Error {
    let line = error.position().map_or(0, csv::Position::line);
    let name = path.display();
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => anyhow!("{name}:{line}: the row has {len} cells where the header has {expected_len}"),
        csv::ErrorKind::Utf8 { .. } => anyhow!("{name}:{line}: the line is not UTF-8 text"),
        _ => anyhow!("cannot read {name}: {error}"),
    }
}
