//! Parts of results: what `--part` writes, `cyltrace merge`, and `cyltrace parts`.
//!
//! Each command that can be split has a file here with the payload of its parts: how a part is
//! written, and how a whole set becomes the command's output. Units are chosen so that a
//! part is a pure function of its range: the pixels of tiles, rows of a table, rays of a check.

pub mod check;
pub mod checkpoint;
mod folder;
pub mod list;
pub mod merge;
pub mod parent;
mod passed_on;
pub mod render;
pub mod trace;
pub mod workers;

use std::path::Path;

use anyhow::{Context, bail};
use cyltrace::scene::SceneFile;
use cyltrace_output::NewFile;
use cyltrace_parts::{Fingerprint, Header, PartFile, PartNumber, PartWriter};
use serde_json::Value;

use super::arguments::{Common, PartArguments};
use super::json;
use super::output_sink::is_standard_stream;
use super::print::print;

/// The whole that a part is of.
pub struct Work<'a> {
    pub command: &'static str,
    /// What is divided, such as `tiles`, and its number.
    pub unit: &'static str,
    pub whole: u64,
    /// The settings that determine the result; not those that only determine its time.
    pub settings: Value,
    pub scene: &'a SceneFile,
    /// A table of which each part reads only its rows.
    pub long_table: Option<&'a Path>,
}

impl Work<'_> {
    /// The header of a part.
    pub fn header(self, number: PartNumber) -> anyhow::Result<Header> {
        let version = env!("CARGO_PKG_VERSION");
        let mut fingerprint = Fingerprint::default();
        for text in [version, self.command, &self.settings.to_string()] {
            fingerprint.text(text);
        }
        fingerprint.file(self.scene.path())?;
        for file in self.scene.files() {
            fingerprint.file(&file)?;
        }
        let range = number.range(self.whole);
        let mut own_input = None;
        if let Some(table) = self.long_table {
            fingerprint.long_table(table)?;
            let mut rows = Fingerprint::default();
            rows.range(table, range.clone())?;
            own_input = Some(rows.digits());
        }
        Ok(Header {
            version: version.into(),
            command: self.command.into(),
            number,
            unit: self.unit.into(),
            range,
            whole: self.whole,
            settings: self.settings,
            fingerprint: fingerprint.digits(),
            own_input,
        })
    }
}

/// Rejects a part that cannot be written to `output`, or would replace another kind of file.
pub fn check(arguments: &PartArguments, output: &Path) -> anyhow::Result<()> {
    if arguments.part.is_none() {
        return Ok(());
    }
    if is_standard_stream(output) {
        bail!("-o -: a part is written to a file, not to standard output");
    }
    NewFile::check(output)?;
    if output.metadata().is_ok_and(|file| file.is_file()) && !PartFile::is_begun(output) {
        bail!(
            "-o {output:?} is there already and is not a part: choose another name, or remove it"
        );
    }
    Ok(())
}

/// Whether the part is there and `--resume` leaves it as it is. Then its figures are written
/// again.
pub fn is_done(
    arguments: &PartArguments,
    common: &Common,
    output: &Path,
    header: &Header,
) -> anyhow::Result<bool> {
    let existing = PartFile::existing(output, header).filter(|_| arguments.resume);
    let Some(existing) = existing else {
        return Ok(false);
    };
    json::write(common, &existing.summary()["figures"])?;
    if common.prints() {
        let (path, number) = (output.display(), header.number);
        print(&format!("{path}: part {number} is already there\n"))?;
    }
    Ok(true)
}

/// Begins to write a part.
pub fn create(output: &Path, header: &Header) -> anyhow::Result<PartWriter> {
    Ok(PartWriter::create(output, header)?)
}

/// A part's range in words.
pub fn range_text(header: &Header) -> String {
    let (range, number) = (&header.range, header.number);
    let (unit, whole) = (&header.unit, header.whole);
    match range.end.checked_sub(1).filter(|_| !range.is_empty()) {
        Some(last) => format!("part {number}, {unit} {} to {last} of {whole}", range.start),
        None => format!("part {number}, none of the {whole} {unit}"),
    }
}

/// A value of a header or a summary that this version writes.
fn value<T: serde::de::DeserializeOwned>(part: &PartFile, of: &Value) -> anyhow::Result<T> {
    serde_json::from_value(of.clone())
        .with_context(|| format!("{:?} is a part that this version cannot read", part.path()))
}
