//! The first line of the files here: what a file is of, as JSON behind a word for its kind.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::Range;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::number::PartNumber;

/// The format of the files that this program reads and writes.
pub(crate) const FORMAT: u32 = 1;

/// Most bytes of a line of JSON. Lines are some kilobytes.
pub(crate) const LONGEST_LINE: u64 = 1 << 22;

/// What a part is, or what a checkpoint is of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The version of cyltrace that wrote the part.
    pub version: String,
    /// The command: `render`, `trace` or `check`.
    pub command: String,
    /// The number of the part, from 1, and of all parts.
    #[serde(flatten)]
    pub number: PartNumber,
    /// What the range counts, such as `tiles`.
    pub unit: String,
    /// The part's range of units.
    pub range: Range<u64>,
    /// The number of all units.
    pub whole: u64,
    /// The settings that determine the result.
    pub settings: Value,
    /// The hash of the settings and of the files that determine the result.
    pub fingerprint: String,
    /// The hash of the input that this part alone reads, if there is one.
    pub own_input: Option<String>,
}

/// A header with the format, which is read first.
#[derive(Serialize, Deserialize)]
struct FirstLine<H> {
    format: u32,
    #[serde(flatten)]
    header: H,
}

/// Why a file has no header.
pub(crate) enum Fault {
    /// It cannot be read.
    System(io::Error),
    /// It is a file of another kind.
    Other,
    /// It has another format, written by this version of the program.
    Format { format: u32, version: String },
    /// Its first line is not one that was written.
    Damaged(&'static str),
}

/// The first line of a file whose kind is the word `begin`.
pub(crate) fn line(begin: &str, header: &Header) -> String {
    let line = FirstLine {
        format: FORMAT,
        header,
    };
    format!("{begin}{}\n", json(&line))
}

/// The header of a file that is read from its start, and the length of its first line.
pub(crate) fn read(begin: &str, file: &mut File) -> Result<(Header, u64), Fault> {
    let mut first = Vec::new();
    let mut beginning = BufReader::new(file).take(LONGEST_LINE);
    let read = beginning.read_until(b'\n', &mut first);
    read.map_err(Fault::System)?;
    let text = first.strip_prefix(begin.as_bytes()).ok_or(Fault::Other)?;
    let line: FirstLine<Value> =
        serde_json::from_slice(text).map_err(|_| Fault::Damaged("its first line is not JSON"))?;
    if line.format != FORMAT {
        return Err(Fault::Format {
            format: line.format,
            version: line.header["version"].as_str().unwrap_or("?").into(),
        });
    }
    let header = serde_json::from_value(line.header);
    let header = header.map_err(|_| Fault::Damaged("its first line lacks a value"))?;
    Ok((header, first.len() as u64))
}

pub(crate) fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("keys are texts and writing to a string cannot fail")
}

/// What differs between the results that two files belong to, as a sentence.
pub(crate) fn difference(first: &Header, other: &Header) -> Option<String> {
    let differs = |what: &str, first: &str, other: &str| {
        (first != other).then(|| format!("its {what} is {other}, not {first}"))
    };
    differs("command", &first.command, &other.command)
        .or_else(|| differs("version of cyltrace", &first.version, &other.version))
        .or_else(|| differs_in_settings(&first.settings, &other.settings))
        .or_else(|| {
            let is_other = first.fingerprint != other.fingerprint
                || (&first.unit, first.whole) != (&other.unit, other.whole);
            is_other.then(|| {
                String::from("the scene file, or a file that it reads, has another content")
            })
        })
}

/// The first setting that differs.
fn differs_in_settings(first: &Value, other: &Value) -> Option<String> {
    let keys = |settings: &Value| {
        let keys = settings
            .as_object()
            .into_iter()
            .flat_map(|keys| keys.keys());
        keys.cloned().collect::<Vec<_>>()
    };
    let all = keys(first).into_iter().chain(keys(other));
    let mut differing = all.filter(|key| first[key] != other[key]);
    differing
        .next()
        .map(|key| format!("its {key} is {}, not {}", other[&key], first[&key]))
}
