//! Parts of a table of hits: the rows of the rays, or points, that begin in a range of bytes of
//! the table that is read. Rows of the output are numbered from 0 in each part; `merge`
//! adds the rows of the parts before. So no part has to read the rows of another.

use std::io::{BufRead, Write};
use std::path::Path;

use anyhow::{Context, bail};
use cyltrace_parts::{PartError, PartFile, PartSet};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::value;
use crate::arguments::TraceArguments;
use crate::hit_table;
use crate::output_sink::{OutputSink, is_standard_stream};

/// Rows and results of a part.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Rays, or points.
    pub rows: u64,
    /// Rays with a hit, or points inside a solid.
    pub hit_rows: u64,
    /// Hits, or solids that contain a point; a row may have many.
    pub hits: u64,
}

/// The settings that determine a table.
pub fn settings(arguments: &TraceArguments) -> Value {
    let format = &arguments.format;
    json!({
        "points": arguments.table.points.is_some(),
        "all": arguments.all,
        "exact": arguments.decisions.exact,
        "delimiter": format.delimiter.map(|name| format!("{name:?}")),
        "decimal": format.decimal.map(|name| format!("{name:?}")),
        "columns": format.columns,
    })
}

/// The length of the table that is read in parts.
pub fn table_bytes(path: &Path) -> anyhow::Result<u64> {
    if is_standard_stream(path) {
        bail!(
            "--part: every part reads the table, so it cannot be standard input: save it to a file"
        );
    }
    let metadata = path.metadata();
    let metadata = metadata.with_context(|| format!("cannot read {}", path.display()))?;
    match metadata.is_file() {
        true => Ok(metadata.len()),
        false => Err(PartError::NotRegular { path: path.into() })?,
    }
}

/// Writes the table of a whole set. Returns its totals.
pub fn merge(set: &PartSet, output: &Path) -> anyhow::Result<Totals> {
    let first = &set.parts()[0];
    let is_of_points: bool = value(first, &set.header().settings["points"])?;
    let mut target = OutputSink::create(output)?;
    target.write_all(match is_of_points {
        true => hit_table::POINTS_HEADER.as_bytes(),
        false => hit_table::HEADER.as_bytes(),
    })?;
    let mut all = Totals::default();
    for part in set.parts() {
        let totals: Totals = value(part, &part.summary()["totals"])?;
        renumber(part, all.rows, &mut target)?;
        all.rows += totals.rows;
        all.hit_rows += totals.hit_rows;
        all.hits += totals.hits;
    }
    target.finish()?;
    Ok(all)
}

/// Copies the rows of a part with their numbers increased.
fn renumber(part: &PartFile, by: u64, target: &mut impl Write) -> anyhow::Result<()> {
    let mut rows = part.payload()?;
    let mut row = Vec::new();
    loop {
        row.clear();
        let read = rows.read_until(b'\n', &mut row);
        let read = read.with_context(|| format!("cannot read {:?}", part.path()))?;
        if read == 0 {
            return Ok(());
        }
        let renumbered =
            number_and_rest(&row).and_then(|(number, rest)| Some((number.checked_add(by)?, rest)));
        let (number, rest) =
            renumbered.with_context(|| format!("{:?} has a row without a number", part.path()))?;
        write!(target, "{number}")?;
        target.write_all(rest)?;
    }
}

/// The number in the first cell of a row, and the rest of the row.
fn number_and_rest(row: &[u8]) -> Option<(u64, &[u8])> {
    let end = row.iter().position(|&byte| byte == b',')?;
    let (digits, rest) = row.split_at(end);
    Some((std::str::from_utf8(digits).ok()?.parse().ok()?, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn row_begins_with_its_number() {
        assert_eq!(number_and_rest(b"95,1,a\n"), Some((95, &b",1,a\n"[..])));
        for wrong in ["", "\n", "x,1\n", ",1\n", "-1,1\n", "95\n"] {
            assert_eq!(number_and_rest(wrong.as_bytes()), None, "{wrong:?}");
        }
    }
}
