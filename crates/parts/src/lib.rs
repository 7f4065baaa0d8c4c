//! Results in parts: several processes, on one machine or many, each write a part of a result
//! to a file; assembled, they give the bytes that one process would have written.
//!
//! A part is a range of the work's units, such as the tiles of a picture ([`PartNumber`]). Its
//! file ([`PartFile`]) names the version of the program, the command, its settings, a
//! [`Fingerprint`] of the files that it read, and its range, and has a checksum. A
//! [`PartSet`] is a list of files that make up one whole result: it rejects damaged files,
//! parts of something else, gaps and overlaps. A [`Survey`] describes the parts in a folder.
//!
//! A [`Checkpoint`] has the units that one process has finished so far, so that the same command
//! goes on after the process was killed.
//!
//! What a part or a unit contains is a matter of its command.

mod checkpoint;
mod error;
mod file;
mod fingerprint;
mod header;
mod number;
mod set;
mod survey;

pub use checkpoint::{Checkpoint, CheckpointError};
pub use error::PartError;
pub use file::{PartFile, PartWriter, Payload};
pub use fingerprint::Fingerprint;
pub use header::Header;
pub use number::{GREATEST_PARTS, PartNumber};
pub use set::PartSet;
pub use survey::{Damaged, Survey, Whole};
