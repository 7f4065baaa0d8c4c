//! The file of a part.
//!
//! ```text
//! #cyltrace-part {"format":1,"version":"0.1.0","command":"render","part":3,"of":16,...}
//! the payload
//! #end {"payload_bytes":...,"summary":{...}} sha256:0123...
//! ```
//!
//! The first line is the [`Header`] as JSON. The payload is what the command writes: text for
//! a table, bytes for a picture. The last line has the length of the payload, a summary of the
//! run, and the SHA-256 of all bytes before ` sha256:`. A file that was cut off has no such
//! line, and one with any changed byte has another hash.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Take, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use cyltrace_output::{FileError, NewFile};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::error::PartError;
use super::fingerprint::{digits, hash};
use super::header::{self, FORMAT, Fault, Header, LONGEST_LINE, json};

const BEGIN: &str = "#cyltrace-part ";
const END: &[u8] = b"\n#end ";
const CHECKSUM: &str = " sha256:";

/// The last line without its checksum.
#[derive(Serialize, Deserialize)]
struct LastLine<S> {
    payload_bytes: u64,
    summary: S,
}

/// A part that is being written. Its file appears when it is complete.
pub struct PartWriter {
    path: PathBuf,
    file: NewFile,
    hasher: Sha256,
    payload_bytes: u64,
}

impl PartWriter {
    /// Begins to write a part.
    ///
    /// # Errors
    /// If no file can be created beside `path`, or it cannot be written to.
    pub fn create(path: &Path, header: &Header) -> Result<Self, FileError> {
        let mut writer = Self {
            path: path.into(),
            file: NewFile::create(path)?,
            hasher: Sha256::new(),
            payload_bytes: 0,
        };
        let line = header::line(BEGIN, header);
        writer.hasher.update(&line);
        let written = writer.file.write_all(line.as_bytes());
        written.map_err(|source| writer.unwritten(source))?;
        Ok(writer)
    }

    /// Writes the last line, syncs the file and moves it to its place.
    ///
    /// # Errors
    /// If writing, syncing or renaming fails. Then no file is left behind.
    pub fn finish(mut self, summary: &Value) -> Result<(), FileError> {
        let line = LastLine {
            payload_bytes: self.payload_bytes,
            summary,
        };
        let mut end = END.to_vec();
        end.extend(json(&line).bytes());
        let hasher = self.hasher.clone().chain_update(&end);
        end.extend(format!("{CHECKSUM}{}\n", digits(hasher)).bytes());
        let written = self.file.write_all(&end);
        written.map_err(|source| self.unwritten(source))?;
        self.file.finish_synced()
    }

    fn unwritten(&self, source: io::Error) -> FileError {
        FileError::System {
            path: self.path.clone(),
            source,
        }
    }
}

/// Writes to the payload.
impl Write for PartWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        let count = written.map_err(|source| FileError::of_write(&self.path, source))?;
        self.hasher.update(&bytes[..count]);
        self.payload_bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        flushed.map_err(|source| FileError::of_write(&self.path, source))
    }
}

/// A part whose checksum was right when it was read.
#[derive(Clone, Debug)]
pub struct PartFile {
    path: PathBuf,
    header: Header,
    /// The bytes of the payload in the file.
    payload: Range<u64>,
    summary: Value,
}

/// The payload of a part.
pub type Payload = BufReader<Take<File>>;

impl PartFile {
    /// Reads a part and verifies its checksum.
    ///
    /// # Errors
    /// If the file cannot be read, is not a part, has another format, or is damaged.
    pub fn read(path: &Path) -> Result<Self, PartError> {
        let mut file = File::open(path).map_err(|source| unreadable(path, source))?;
        let first = header::read(BEGIN, &mut file);
        let (header, start) = first.map_err(|fault| without_header(path, fault))?;
        let (line, end) = last_line(path, &mut file, start)?;
        let range = &header.range;
        if range.start > range.end || range.end > header.whole {
            return Err(damaged(path, "its range is wrong"));
        }
        let payload = start..end;
        if payload.end.checked_sub(payload.start) != Some(line.payload_bytes) {
            return Err(damaged(path, "its length is wrong"));
        }
        Ok(Self {
            path: path.into(),
            header,
            payload,
            summary: line.summary,
        })
    }

    /// The path that the part was read from.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the part is.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The summary of the run.
    #[must_use]
    pub fn summary(&self) -> &Value {
        &self.summary
    }

    /// Reads the payload.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn payload(&self) -> Result<Payload, PartError> {
        let file = File::open(&self.path).and_then(|mut file| {
            file.seek(SeekFrom::Start(self.payload.start))?;
            Ok(file)
        });
        let file = file.map_err(|source| unreadable(&self.path, source))?;
        Ok(BufReader::with_capacity(
            1 << 16,
            file.take(self.payload_bytes()),
        ))
    }

    /// The length of the payload.
    #[must_use]
    pub fn payload_bytes(&self) -> u64 {
        self.payload.end - self.payload.start
    }

    /// The valid part with this header at `path`, if there is one.
    #[must_use]
    pub fn existing(path: &Path, header: &Header) -> Option<Self> {
        Self::read(path).ok().filter(|part| part.header == *header)
    }

    /// Whether a file begins as a part does, damaged or not.
    #[must_use]
    pub fn is_begun(path: &Path) -> bool {
        let mut beginning = Vec::new();
        let file = File::open(path);
        let read = file.and_then(|file| file.take(BEGIN.len() as u64).read_to_end(&mut beginning));
        read.is_ok() && beginning == BEGIN.as_bytes()
    }
}

fn unreadable(path: &Path, source: io::Error) -> PartError {
    PartError::Unreadable {
        path: path.into(),
        source,
    }
}

fn damaged(path: &Path, what: &'static str) -> PartError {
    PartError::Damaged {
        path: path.into(),
        what,
    }
}

/// The error of a first line.
fn without_header(path: &Path, fault: Fault) -> PartError {
    match fault {
        Fault::System(source) => unreadable(path, source),
        Fault::Other => PartError::NotAPart { path: path.into() },
        Fault::Format { format, version } => PartError::Format {
            path: path.into(),
            format,
            own: FORMAT,
            version,
        },
        Fault::Damaged(what) => damaged(path, what),
    }
}

/// The last line, whose checksum is verified, and the place where the payload ends.
fn last_line(
    path: &Path,
    file: &mut File,
    payload: u64,
) -> Result<(LastLine<Value>, u64), PartError> {
    let unreadable = |source| unreadable(path, source);
    let cut_off = || {
        damaged(
            path,
            "its last line is missing, as of a file that was cut off",
        )
    };
    let length = file.metadata().map_err(unreadable)?.len();
    // An empty payload: the line feed before the last line ends the first.
    let start = length.saturating_sub(LONGEST_LINE).max(payload - 1);
    let mut end = Vec::new();
    file.seek(SeekFrom::Start(start)).map_err(unreadable)?;
    file.read_to_end(&mut end).map_err(unreadable)?;
    let last = end.windows(END.len()).rposition(|bytes| bytes == END);
    let last = last.ok_or_else(cut_off)?;
    let line = std::str::from_utf8(&end[last + END.len()..]).map_err(|_| cut_off())?;
    let (line, checksum) = line.rsplit_once(CHECKSUM).ok_or_else(cut_off)?;
    let hashed = start + (last + END.len() + line.len()) as u64;
    file.rewind().map_err(unreadable)?;
    let hasher = hash(&mut file.take(hashed), Sha256::new()).map_err(unreadable)?;
    if checksum.strip_suffix('\n') != Some(&digits(hasher)) {
        return Err(damaged(path, "its checksum is wrong"));
    }
    let line = serde_json::from_str(line).map_err(|_| cut_off())?;
    Ok((line, start + last as u64))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::number::PartNumber;
    use serde_json::json;
    use std::fs;

    /// The header of a part of 100 tiles.
    pub(crate) fn header(number: u64, of: u64) -> Header {
        let number = PartNumber::new(number, of).expect("valid");
        Header {
            version: "0.1.0".into(),
            command: "render".into(),
            number,
            unit: "tiles".into(),
            range: number.range(100),
            whole: 100,
            settings: json!({ "spp": 4, "seed": 0, "text": "a\nb" }),
            fingerprint: "00ff".into(),
            own_input: None,
        }
    }

    /// A part whose payload contains what looks like its last line.
    fn written(path: &Path) -> Vec<u8> {
        let payload = [b"row\n#end {}", &[0, 159, 146, 150][..], b"\n"].concat();
        let mut writer = PartWriter::create(path, &header(3, 16)).expect("created");
        writer.write_all(&payload).expect("written");
        writer.finish(&json!({ "seconds": 0.5 })).expect("finished");
        payload
    }

    #[test]
    fn part_read_back() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("part");
        let payload = written(&path);
        let part = PartFile::read(&path).expect("valid");
        assert_eq!(part.header(), &header(3, 16));
        assert_eq!(part.summary(), &json!({ "seconds": 0.5 }));
        let mut read = Vec::new();
        let mut reader = part.payload().expect("readable");
        reader.read_to_end(&mut read).expect("read");
        assert_eq!(read, payload);
        assert!(PartFile::existing(&path, &header(3, 16)).is_some());
        assert!(PartFile::existing(&path, &header(4, 16)).is_none());
    }

    #[test]
    fn checksum_is_that_of_other_programs() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("part");
        written(&path);
        let bytes = fs::read(&path).expect("read");
        let at = bytes.len() - "0".repeat(64).len() - 1 - CHECKSUM.len();
        let other = Sha256::digest(&bytes[..at]);
        let end = String::from_utf8(bytes[at..].to_vec()).expect("text");
        let digits: String = other.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(end, format!("{CHECKSUM}{digits}\n"));
    }

    #[test]
    fn every_changed_byte_and_every_cut_is_noticed() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("part");
        written(&path);
        let bytes = fs::read(&path).expect("read");
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1;
            fs::write(&path, &changed).expect("written");
            let error = PartFile::read(&path).expect_err("a changed byte");
            let message = error.to_string();
            let is_named = ["is damaged", "is not a part", "has format"]
                .iter()
                .any(|words| message.contains(words));
            assert!(is_named, "byte {at}: {message}");
            fs::write(&path, &bytes[..at]).expect("written");
            assert!(PartFile::read(&path).is_err(), "cut at {at}");
        }
        fs::write(&path, [&bytes[..], b"\n"].concat()).expect("written");
        assert!(PartFile::read(&path).is_err(), "a byte more");
    }
}
