//! Printing to standard output and to standard error.

use std::fmt;
use std::io::{self, Write};

/// Standard output cannot be written to.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output: {0}")]
pub struct StandardOutputError(String);

impl StandardOutputError {
    /// An error of the same kind that names standard output, so that a broken pipe is
    /// recognized as one.
    pub fn of(error: &io::Error) -> io::Error {
        io::Error::new(error.kind(), Self(error.to_string()))
    }
}

/// Writes text to standard output.
pub fn print(text: &str) -> anyhow::Result<()> {
    let mut output = io::stdout().lock();
    let written = output.write_all(text.as_bytes());
    written
        .and_then(|()| output.flush())
        .map_err(|error| StandardOutputError::of(&error).into())
}

/// Writes a note to standard error, unless the command is quiet.
pub fn note(is_quiet: bool, note: &str) {
    if !is_quiet {
        let _ = writeln!(io::stderr(), "note: {note}");
    }
}

/// Writes a message to standard error, if it still has a reader.
pub fn print_error(error: &dyn fmt::Display) {
    let _ = writeln!(io::stderr(), "error: {error}");
}
