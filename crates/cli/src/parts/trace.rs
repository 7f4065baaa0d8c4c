//! Parts of a table of hits: the rows of the rays, or points, that begin in a range of bytes of
//! the table that is read. Rows of the output are numbered from 0 in each part; `merge`
//! adds the rows of the parts before. So no part has to read the rows of another.

use std::io::{self, BufRead, Write};
use std::path::Path;

use anyhow::{Context, bail};
use cyltrace_parts::{PartError, PartSet};
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
        let mut payload = part.payload()?;
        let written = renumber(&mut payload, all.rows, &mut target);
        written.with_context(|| format!("the rows of {:?}", part.path()))?;
        all.rows += totals.rows;
        all.hit_rows += totals.hit_rows;
        all.hits += totals.hits;
    }
    target.finish()?;
    Ok(all)
}

/// Copies rows with the number in their first cell increased.
fn renumber(rows: &mut impl BufRead, by: u64, target: &mut impl Write) -> io::Result<()> {
    let mut row = Vec::new();
    while rows.read_until(b'\n', &mut row)? > 0 {
        let end = row
            .iter()
            .position(|&byte| byte == b',')
            .unwrap_or(row.len());
        let number = std::str::from_utf8(&row[..end]).ok();
        let number: Option<u64> = number.and_then(|digits| digits.parse().ok());
        let number = number.ok_or(io::ErrorKind::InvalidData)?;
        write!(target, "{}", number + by)?;
        target.write_all(&row[end..])?;
        row.clear();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_renumbered() {
        let mut written = Vec::new();
        renumber(&mut &b"0,1,a\n0,1,b\n9,0,,\n"[..], 95, &mut written).expect("rows");
        assert_eq!(written, b"95,1,a\n95,1,b\n104,0,,\n");
        assert!(renumber(&mut &b"x,1\n"[..], 1, &mut Vec::new()).is_err());
    }
}
