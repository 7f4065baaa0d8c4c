//! Tables of rays: `ox,oy,oz,dx,dy,dz` and optionally `t_min,t_max`.
//!
//! The first line that is neither blank nor a comment (`#`) names the columns,
//! in any order. Spaces and double quotes around cells are ignored. The table
//! is read in blocks of whole lines, so that blocks can be parsed by many
//! threads and a table of any length needs little memory.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use anyhow::{Context, anyhow, bail};
use cyltrace::math::Ray;
use glam::DVec3;

use super::target::is_standard_stream;

/// The columns' names; the last two may be absent.
const NAMES: [&str; 8] = ["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max"];

/// What stands for a column that is absent.
const DEFAULTS: [f64; 8] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f64::INFINITY];

/// Columns that a table must have.
const REQUIRED: usize = 6;

/// Bytes of a block, about 1000 rays: enough that handing it to a thread costs
/// nothing, few enough to share the work evenly.
const BLOCK_BYTES: usize = 1 << 16;

/// A table that is being read.
pub struct RayTable {
    name: String,
    reader: BufReader<Box<dyn Read>>,
    line: u64,
    columns: Columns,
}

/// What each cell of a row is: a position in [`NAMES`].
#[derive(Clone)]
pub struct Columns(Vec<usize>);

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

impl RayTable {
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
            columns: Columns(Vec::new()),
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
                    NAMES[..REQUIRED].join(",")
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
    pub fn columns(&self) -> Columns {
        self.columns.clone()
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

    /// The rays of a block of the table of that name.
    pub fn rays(name: &str, columns: &Columns, block: &Block) -> anyhow::Result<Vec<Ray>> {
        let mut rays = Vec::with_capacity(block.text.len() / 32);
        for (number, line) in (block.first_line..).zip(block.text.split(|&byte| byte == b'\n')) {
            let at = || format!("{name}:{number}");
            if let Some(row) = content(line).with_context(at)? {
                rays.push(columns.ray(row).with_context(at)?);
            }
        }
        Ok(rays)
    }
}

impl Columns {
    /// The columns of a header.
    fn named(header: &str) -> anyhow::Result<Self> {
        let mut columns = Vec::new();
        for name in header.split(',').map(cell) {
            let Some(column) = NAMES.iter().position(|known| *known == name) else {
                bail!(
                    "there is no column {name:?}: columns are {}",
                    NAMES.join(",")
                );
            };
            if columns.contains(&column) {
                bail!("column {name:?} stands twice in the header");
            }
            columns.push(column);
        }
        if let Some(missing) = (0..REQUIRED).find(|column| !columns.contains(column)) {
            bail!(
                "column {:?} is missing: the header must name {}",
                NAMES[missing],
                NAMES[..REQUIRED].join(",")
            );
        }
        Ok(Self(columns))
    }

    /// The ray of a row.
    fn ray(&self, row: &str) -> anyhow::Result<Ray> {
        let mut values = DEFAULTS;
        let mut cells = row.split(',').map(cell);
        for &column in &self.0 {
            let text = cells.next().ok_or_else(|| self.wrong_width(row))?;
            values[column] = number(column, text)?;
        }
        if cells.next().is_some() {
            return Err(self.wrong_width(row));
        }
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = values;
        let ray = Ray {
            origin: DVec3::new(ox, oy, oz),
            direction: DVec3::new(dx, dy, dz),
            t_min,
            t_max,
        };
        if ray.direction == DVec3::ZERO {
            bail!("columns \"dx\", \"dy\", \"dz\": the direction is zero; it must have a length");
        }
        if t_min > t_max {
            bail!("columns \"t_min\", \"t_max\": {t_min:?} is greater than {t_max:?}");
        }
        Ok(ray)
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

/// The value of a cell: finite, or at least not NaN for the ray's range.
fn number(column: usize, text: &str) -> anyhow::Result<f64> {
    let range = column >= REQUIRED;
    let value: f64 = text.parse().unwrap_or(f64::NAN);
    if value.is_nan() || (!range && value.is_infinite()) {
        bail!(
            "column {:?}: {:?} must be a {}number",
            NAMES[column],
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
