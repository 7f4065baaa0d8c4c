//! The file of the units that a process has finished so far.
//!
//! ```text
//! #cyltrace-checkpoint {"format":1,"version":"0.1.0","command":"render",...}
//! a record, a record, ...
//! ```
//!
//! The first line is that of a part, the whole being part 1 of 1. A record has the length of its
//! content in eight bytes, the content, and the SHA-256 of both. The content is a run of units:
//! the number of each in eight bytes, the length of its bytes in eight, and the bytes. All numbers
//! are little-endian.
//!
//! Records are only appended, each by a single write. A process that is killed, or a machine that
//! fails, leaves at most the end of the file wrong: what is from the first wrong record on is
//! removed. The file is locked while a process uses it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::header::{self, FORMAT, Fault, Header, difference};

const BEGIN: &str = "#cyltrace-checkpoint ";

/// Time after which finished units are written. A write costs some microseconds, and after it
/// they outlive the process.
const WRITE_INTERVAL: Duration = Duration::from_millis(200);

/// Time after which the file is synced to the disk, which takes milliseconds; after it, units
/// outlive the machine.
const SYNC_INTERVAL: Duration = Duration::from_secs(5);

/// Bytes of finished units that are written at once, however little time has passed.
const MOST_PENDING: usize = 1 << 20;

/// Bytes of finished units for which a thread waits while another one writes.
const MOST_WAITING: usize = 4 * MOST_PENDING;

/// Bytes of a record beside its content.
const LENGTH: u64 = 8;
const HASH: usize = 32;

/// Bytes of a unit beside its own.
const UNIT: usize = 16;

/// An error of a checkpoint.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be opened, read, written or removed.
    #[error("cannot use the checkpoint {path:?}")]
    System {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file is another one, which is left as it is.
    #[error("{path:?} is there already and is not a checkpoint: choose another name, or remove it")]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
    },
    /// The checkpoint has another format.
    #[error(
        "{path:?} has format {format} of checkpoints and this is format {FORMAT}: use the version of cyltrace that wrote it, {version}, or remove the file to begin again"
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: u32,
        /// The version of the program that wrote it.
        version: String,
    },
    /// The first line is damaged.
    #[error("{path:?} is damaged: {what}; remove the file to begin again")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The damage.
        what: &'static str,
    },
    /// The checkpoint is of another result.
    #[error(
        "{path:?} is the checkpoint of another result: {difference}; repeat the command that began it, or remove the file to begin again"
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What differs.
        difference: String,
    },
    /// Another process uses the checkpoint.
    #[error("another run is using the checkpoint {path:?}")]
    InUse {
        /// The file.
        path: PathBuf,
    },
}

/// A checkpoint that this process alone uses. All functions can be called from any thread.
#[derive(Debug)]
pub struct Checkpoint {
    path: PathBuf,
    file: Mutex<Appended>,
    pending: Mutex<Pending>,
    /// Place and length of the bytes of each unit that an earlier process finished.
    earlier: Vec<Option<(u64, u64)>>,
    dropped_bytes: u64,
}

/// The file, whose writes go to its end.
#[derive(Debug)]
struct Appended {
    file: File,
    /// The end of the last whole record.
    end: u64,
    synced: Instant,
    /// Why there are no more writes.
    failure: Option<io::Error>,
}

/// Units that are not written yet.
#[derive(Debug)]
struct Pending {
    bytes: Vec<u8>,
    /// When units were written last.
    written: Instant,
}

impl Checkpoint {
    /// Opens the checkpoint of the result with this header, or begins one if there is no file, an
    /// empty one or one that was cut off within its first line.
    ///
    /// # Errors
    /// If the file cannot be used, is not a checkpoint or one of another result, or another process
    /// uses it. Then it is left as it is.
    pub fn open(path: &Path, header: &Header) -> Result<Self, CheckpointError> {
        let system = |source| CheckpointError::System {
            path: path.into(),
            source,
        };
        // A named pipe would block, and a device would take anything.
        if fs::metadata(path).is_ok_and(|file| !file.is_file()) {
            return Err(CheckpointError::NotACheckpoint { path: path.into() });
        }
        let mut options = OpenOptions::new();
        let file = options.read(true).append(true).create(true).open(path);
        let mut file = file.map_err(system)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(CheckpointError::InUse { path: path.into() });
            }
            // A file system without locks.
            Err(TryLockError::Error(_)) => {}
        }
        let line = header::line(BEGIN, header);
        let mut first = Vec::new();
        let beginning = (&mut file).take(line.len() as u64);
        { beginning }.read_to_end(&mut first).map_err(system)?;
        let mut earlier = vec![None; header.whole as usize];
        let length = file.metadata().map_err(system)?.len();
        let start = line.len() as u64;
        let end = if first == line.as_bytes() {
            records(&file, start..length, &mut earlier).map_err(system)?
        } else if length < start && line.as_bytes().starts_with(&first) {
            file.set_len(0).map_err(system)?;
            file.write_all(line.as_bytes()).map_err(system)?;
            start
        } else {
            file.rewind().map_err(system)?;
            return Err(rejected(path, header, header::read(BEGIN, &mut file)));
        };
        let dropped_bytes = length.saturating_sub(end.max(first.len() as u64));
        if dropped_bytes > 0 {
            file.set_len(end).map_err(system)?;
        }
        let now = Instant::now();
        Ok(Self {
            path: path.into(),
            file: Mutex::new(Appended {
                file,
                end,
                synced: now,
                failure: None,
            }),
            pending: Mutex::new(Pending {
                bytes: Vec::new(),
                written: now,
            }),
            earlier,
            dropped_bytes,
        })
    }

    /// The number of units that an earlier process finished.
    #[must_use]
    pub fn earlier_units(&self) -> u64 {
        self.earlier.iter().flatten().count() as u64
    }

    /// The bytes that were removed from the end of the file because they were damaged or
    /// incomplete.
    #[must_use]
    pub fn dropped_bytes(&self) -> u64 {
        self.dropped_bytes
    }

    /// The bytes of a unit that an earlier process finished; `None` if it did not, or if they cannot
    /// be read again.
    #[must_use]
    pub fn earlier(&self, unit: u64) -> Option<Vec<u8>> {
        let (start, length) = (*self.earlier.get(unit as usize)?)?;
        let mut bytes = vec![0; length as usize];
        let file = &mut locked(&self.file).file;
        file.seek(SeekFrom::Start(start)).ok()?;
        file.read_exact(&mut bytes).ok()?;
        Some(bytes)
    }

    /// Adds a unit. It is written soon, with others; see [`Checkpoint::failure`].
    pub fn add(&self, unit: u64, bytes: &[u8]) {
        let mut pending = locked(&self.pending);
        pending.bytes.extend(unit.to_le_bytes());
        pending.bytes.extend((bytes.len() as u64).to_le_bytes());
        pending.bytes.extend(bytes);
        let waiting = pending.bytes.len();
        let is_due = waiting >= MOST_PENDING || pending.written.elapsed() >= WRITE_INTERVAL;
        drop(pending);
        // While another thread writes, this one goes on.
        let file = match is_due {
            true if waiting >= MOST_WAITING => Some(locked(&self.file)),
            true => self.file.try_lock().ok(),
            false => None,
        };
        if let Some(mut file) = file {
            self.write(&mut file);
            if file.synced.elapsed() >= SYNC_INTERVAL {
                file.sync();
            }
        }
    }

    /// Writes all units.
    pub fn flush(&self) {
        self.write(&mut locked(&self.file));
    }

    /// Why units could not be written; none is after that, and those before remain.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        let file = locked(&self.file);
        file.failure.as_ref().map(ToString::to_string)
    }

    /// Removes the file.
    ///
    /// # Errors
    /// If the system cannot.
    pub fn remove(self) -> Result<(), CheckpointError> {
        fs::remove_file(&self.path).map_err(|source| CheckpointError::System {
            path: self.path.clone(),
            source,
        })
    }

    fn write(&self, file: &mut Appended) {
        let mut pending = locked(&self.pending);
        let content = mem::take(&mut pending.bytes);
        pending.written = Instant::now();
        drop(pending);
        if !content.is_empty() {
            file.append(&record(&content));
        }
    }
}

impl Appended {
    fn append(&mut self, record: &[u8]) {
        if self.failure.is_some() {
            return;
        }
        match self.file.write_all(record) {
            Ok(()) => self.end += record.len() as u64,
            Err(error) => {
                // Whatever was written of it would be dropped later anyway.
                let _ = self.file.set_len(self.end);
                self.failure = Some(error);
            }
        }
    }

    fn sync(&mut self) {
        if let Err(error) = self.file.sync_data() {
            self.failure.get_or_insert(error);
        }
        self.synced = Instant::now();
    }
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The error of a file that does not begin as the checkpoint does.
fn rejected(path: &Path, own: &Header, read: Result<(Header, u64), Fault>) -> CheckpointError {
    let path = path.to_owned();
    match read {
        Ok((other, _)) => match difference(own, &other) {
            Some(difference) => CheckpointError::Foreign { path, difference },
            None => CheckpointError::Damaged {
                path,
                what: "its first line is not one that was written",
            },
        },
        Err(Fault::System(source)) => CheckpointError::System { path, source },
        Err(Fault::Other) => CheckpointError::NotACheckpoint { path },
        Err(Fault::Format { format, version }) => CheckpointError::Format {
            path,
            format,
            version,
        },
        Err(Fault::Damaged(what)) => CheckpointError::Damaged { path, what },
    }
}

fn record(content: &[u8]) -> Vec<u8> {
    let mut record = Vec::with_capacity(content.len() + LENGTH as usize + HASH);
    record.extend((content.len() as u64).to_le_bytes());
    record.extend(content);
    let hash = Sha256::digest(&record);
    record.extend(hash.as_slice());
    record
}

/// Notes the units of the records in a range of a file, up to the first record that is damaged or
/// cut off, and returns where that begins.
fn records(
    file: &File,
    range: std::ops::Range<u64>,
    units: &mut [Option<(u64, u64)>],
) -> io::Result<u64> {
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let (mut start, mut record) = (range.start, Vec::new());
    loop {
        let mut length = [0; LENGTH as usize];
        let left = range.end - start;
        if left < LENGTH {
            return Ok(start);
        }
        reader.read_exact(&mut length)?;
        let length = u64::from_le_bytes(length);
        let rest = left - LENGTH;
        if length == 0 || length.checked_add(HASH as u64).is_none_or(|all| all > rest) {
            return Ok(start);
        }
        record.clear();
        record.extend(length.to_le_bytes());
        let read = (&mut reader).take(length + HASH as u64);
        { read }.read_to_end(&mut record)?;
        let Some((hashed, hash)) = record.split_last_chunk::<HASH>() else {
            return Err(ErrorKind::UnexpectedEof.into());
        };
        let is_whole = Sha256::digest(hashed).as_slice() == hash;
        if !is_whole || note(&hashed[LENGTH as usize..], start + LENGTH, units).is_none() {
            return Ok(start);
        }
        start += record.len() as u64;
    }
}

/// Notes the units of a record's content, which begins at `start`. `None` if it is not a run of
/// units; a record with a right hash always is.
fn note(mut content: &[u8], mut start: u64, units: &mut [Option<(u64, u64)>]) -> Option<()> {
    while !content.is_empty() {
        let (unit, rest) = content.split_first_chunk()?;
        let (length, rest) = rest.split_first_chunk()?;
        let length = u64::from_le_bytes(*length);
        let place = units.get_mut(usize::try_from(u64::from_le_bytes(*unit)).ok()?)?;
        content = rest.get(usize::try_from(length).ok()?..)?;
        *place = Some((start + UNIT as u64, length));
        start += UNIT as u64 + length;
    }
    Some(())
}

#[cfg(test)]
mod tests;
