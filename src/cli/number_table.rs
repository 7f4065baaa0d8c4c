//! Tables of rays, `ox,oy,oz,dx,dy,dz` and optionally `t_min,t_max`, and of points,
//! `x,y,z`.
//!
//! The first line that is neither blank nor a comment (`#`) names the columns,
//! in any order. Spaces and double quotes around cells are ignored. The table
//! is read in blocks of whole lines, so that blocks can be parsed by many
//! threads and a table of any length needs little memory.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::marker::PhantomData;
use std::path::Path;

use anyhow::{Context, anyhow, bail};
use cyltrace::math::Ray;
use glam::DVec3;

use super::target::is_standard_stream;

/// What a row of a table says.
pub trait Row: Sized + Send {
    /// The columns' names, at most [`MOST_COLUMNS`]: first those that hold finite
    /// numbers and must be there, then those that may be absent.
    const NAMES: &'static [&'static str];

    /// Columns that a table must have.
    const REQUIRED: usize;

    /// What stands for the columns that are absent.
    const DEFAULTS: &'static [f64];

    /// The row of numbers, one a column.
    fn of(values: &[f64]) -> anyhow::Result<Self>;
}

impl Row for Ray {
    const NAMES: &'static [&'static str] = &["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max"];
    const REQUIRED: usize = 6;
    const DEFAULTS: &'static [f64] = &[0.0, f64::INFINITY];

    fn of(values: &[f64]) -> anyhow::Result<Self> {
        let ray = Self {
            origin: DVec3::from_slice(values),
            direction: DVec3::from_slice(&values[3..]),
            t_min: values[6],
            t_max: values[7],
        };
        if ray.direction == DVec3::ZERO {
            bail!("columns \"dx\", \"dy\", \"dz\": the direction is zero; it must have a length");
        }
        ray.check_sizes()?;
        let (t_min, t_max) = (ray.t_min, ray.t_max);
        if t_min > t_max {
            bail!("columns \"t_min\", \"t_max\": {t_min:?} is greater than {t_max:?}");
        }
        Ok(ray)
    }
}

/// A point.
impl Row for DVec3 {
    const NAMES: &'static [&'static str] = &["x", "y", "z"];
    const REQUIRED: usize = 3;
    const DEFAULTS: &'static [f64] = &[];

    fn of(values: &[f64]) -> anyhow::Result<Self> {
        Ok(Self::from_slice(values))
    }
}

/// The most columns of any table.
const MOST_COLUMNS: usize = 8;

/// Bytes of a block, about 1000 rows: enough that handing it to a thread costs
/// nothing, few enough to share the work evenly.
const BLOCK_BYTES: usize = 1 << 16;

/// A table that is being read.
pub struct NumberTable<R> {
    name: String,
    reader: BufReader<Box<dyn Read>>,
    line: u64,
    columns: Columns<R>,
}

/// What each cell of a row is: a position in [`Row::NAMES`].
pub struct Columns<R>(Vec<usize>, PhantomData<fn() -> R>);

/// Some whole lines of a table.
pub struct Block {
    first_line: u64,
    text: Vec<u8>,
}

/// What messages call a table; `-` is standard input.
pub fn name(path: &Path) -> String {
    if is_standard_stream(path) {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

impl<R: Row> NumberTable<R> {
    /// Opens a table and reads its header.
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let name = name(path);
        let cannot_read = || format!("cannot read {name}");
        let input: Box<dyn Read> = if is_standard_stream(path) {
            Box::new(io::stdin())
        } else {
            let file = File::open(path).with_context(cannot_read)?;
            if file.metadata().with_context(cannot_read)?.is_dir() {
                bail!("cannot read {name}: it is a directory");
            }
            Box::new(file)
        };
        let mut table = Self {
            name: name.clone(),
            reader: BufReader::with_capacity(BLOCK_BYTES, input),
            line: 0,
            columns: Columns(Vec::new(), PhantomData),
        };
        let mut line = Vec::new();
        loop {
            line.clear();
            if table
                .reader
                .read_until(b'\n', &mut line)
                .with_context(cannot_read)?
                == 0
            {
                bail!(
                    "{name}: there is no header; it must name the columns {}",
                    R::NAMES[..R::REQUIRED].join(",")
                );
            }
            table.line += 1;
            let text = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line);
            let at = || format!("{name}:{}", table.line);
            if let Some(row) = content(text).with_context(at)? {
                table.columns = Columns::named(row).with_context(at)?;
                return Ok(table);
            }
        }
    }

    /// What the cells are.
    pub fn columns(&self) -> Columns<R> {
        Columns(self.columns.0.clone(), PhantomData)
    }

    /// The next lines, or `None` at the end.
    pub fn next_block(&mut self) -> anyhow::Result<Option<Block>> {
        let mut block = Block {
            first_line: self.line + 1,
            text: Vec::with_capacity(BLOCK_BYTES + 256),
        };
        while block.text.len() < BLOCK_BYTES {
            let read = self.reader.read_until(b'\n', &mut block.text);
            if read.with_context(|| format!("cannot read {}", self.name))? == 0 {
                break;
            }
            self.line += 1;
        }
        Ok((!block.text.is_empty()).then_some(block))
    }

    /// The rows of a block of the table of that name.
    pub fn rows(name: &str, columns: &Columns<R>, block: &Block) -> anyhow::Result<Vec<R>> {
        let mut rows = Vec::with_capacity(block.text.len() / 32);
        for (number, line) in (block.first_line..).zip(block.text.split(|&byte| byte == b'\n')) {
            let at = || format!("{name}:{number}");
            if let Some(row) = content(line).with_context(at)? {
                rows.push(columns.row(row).with_context(at)?);
            }
        }
        Ok(rows)
    }
}

impl<R: Row> Columns<R> {
    /// The columns of a header.
    fn named(header: &str) -> anyhow::Result<Self> {
        let mut columns = Vec::new();
        for name in header.split(',').map(cell) {
            let Some(column) = R::NAMES.iter().position(|known| *known == name) else {
                bail!(
                    "there is no column {name:?}: columns are {}",
                    R::NAMES.join(",")
                );
            };
            if columns.contains(&column) {
                bail!("column {name:?} stands twice in the header");
            }
            columns.push(column);
        }
        if let Some(missing) = (0..R::REQUIRED).find(|column| !columns.contains(column)) {
            bail!(
                "column {:?} is missing: the header must name {}",
                R::NAMES[missing],
                R::NAMES[..R::REQUIRED].join(",")
            );
        }
        Ok(Self(columns, PhantomData))
    }

    /// What a row says.
    fn row(&self, row: &str) -> anyhow::Result<R> {
        let mut values = [0.0; MOST_COLUMNS];
        values[R::REQUIRED..R::NAMES.len()].copy_from_slice(R::DEFAULTS);
        let mut cells = row.split(',').map(cell);
        for &column in &self.0 {
            let text = cells.next().ok_or_else(|| self.wrong_width(row))?;
            values[column] = number::<R>(column, text)?;
        }
        if cells.next().is_some() {
            return Err(self.wrong_width(row));
        }
        R::of(&values[..R::NAMES.len()])
    }

    fn wrong_width(&self, row: &str) -> anyhow::Error {
        anyhow!(
            "the row has {} cells where the header has {}",
            row.split(',').count(),
            self.0.len()
        )
    }
}

/// A line without its end, or `None` when it is blank or a comment.
fn content(line: &[u8]) -> anyhow::Result<Option<&str>> {
    let line = std::str::from_utf8(line).map_err(|_| anyhow!("the line is not UTF-8 text"))?;
    let line = line.trim();
    Ok((!line.is_empty() && !line.starts_with('#')).then_some(line))
}

/// A cell without what surrounds it.
fn cell(text: &str) -> &str {
    let text = text.trim();
    let unquoted = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
    unquoted.map_or(text, str::trim)
}

/// The value of a cell: finite, or at least not NaN where it may be absent, as the
/// ray's range.
fn number<R: Row>(column: usize, text: &str) -> anyhow::Result<f64> {
    let range = column >= R::REQUIRED;
    let value: f64 = text.parse().unwrap_or(f64::NAN);
    if value.is_nan() || (!range && value.is_infinite()) {
        bail!(
            "column {:?}: {:?} must be a {}number",
            R::NAMES[column],
            shortened(text),
            if range { "" } else { "finite " }
        );
    }
    Ok(value)
}

/// The start of a cell, short enough for a message.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}
