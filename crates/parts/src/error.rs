//! Why parts cannot be read or assembled.

use std::io;
use std::path::PathBuf;

use cyltrace_output::FileError;

/// An error of a part, or of parts that do not fit together.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PartError {
    /// A file cannot be read.
    #[error("cannot read {path:?}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// An input of a part is a pipe or a device.
    #[error(
        "{path:?} is not a regular file: every part, and every run with a checkpoint, reads the files of a scene again, so none may be a pipe"
    )]
    NotRegular {
        /// The input.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Unwritable(#[from] FileError),
    /// A file is not a part.
    #[error("{path:?} is not a part: a part is a file that `cyltrace ... --part K/N` has written")]
    NotAPart {
        /// The file.
        path: PathBuf,
    },
    /// A part was written by a program with another format of parts.
    #[error(
        "{path:?} has format {format} of parts and this is format {own}: use the version of cyltrace that wrote it, {version}"
    )]
    Format {
        /// The part.
        path: PathBuf,
        /// Its format.
        format: u32,
        /// The format of this program.
        own: u32,
        /// The version of the program that wrote the part.
        version: String,
    },
    /// The bytes of a part are not those that were written.
    #[error("{path:?} is damaged: {what}; make this part again")]
    Damaged {
        /// The part.
        path: PathBuf,
        /// The damage.
        what: &'static str,
    },
    /// There is no part.
    #[error("no part was found")]
    None,
    /// A part belongs to another result.
    #[error("{path:?} does not belong to the same result as {first:?}: {difference}")]
    Foreign {
        /// The part.
        path: PathBuf,
        /// The part it is compared with.
        first: PathBuf,
        /// What differs.
        difference: String,
    },
    /// Two parts contain the same units.
    #[error("{first:?} and {second:?} overlap: both contain {unit} {from} to {to}; leave one out")]
    Overlap {
        /// The part that begins first.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// What is numbered.
        unit: String,
        /// The first unit of both.
        from: u64,
        /// The last unit of both.
        to: u64,
    },
    /// Units are in no part.
    #[error("a part is missing: {unit} {from} to {to} of {whole}{}", after(before.as_ref()))]
    Gap {
        /// The part before the gap.
        before: Option<PathBuf>,
        /// What is numbered.
        unit: String,
        /// The first missing unit, from 0.
        from: u64,
        /// The last missing unit.
        to: u64,
        /// The number of all units.
        whole: u64,
    },
}

/// Where a gap is.
fn after(before: Option<&PathBuf>) -> String {
    match before {
        Some(path) => format!(", after {path:?}"),
        None => String::from(", before the first"),
    }
}
