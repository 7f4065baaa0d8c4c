//! The sink of a table: standard output, or a file that is complete or absent.

use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use cyltrace_output::{FileError, NewFile};

use super::print::StandardOutputError;

/// Standard output, or a new file.
pub enum OutputSink {
    StandardOutput(BufWriter<Stdout>),
    File(NewFile, PathBuf),
}

impl OutputSink {
    /// Checks before any work that `path` can be written.
    pub fn check(path: &Path) -> Result<(), FileError> {
        if is_standard_stream(path) {
            return Ok(());
        }
        NewFile::check(path)
    }

    /// Opens `path`; `-` is standard output.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        if is_standard_stream(path) {
            return Ok(Self::StandardOutput(BufWriter::new(io::stdout())));
        }
        Ok(Self::File(NewFile::create(path)?, path.into()))
    }

    /// Whether readers see the output before its end.
    pub fn shows_parts(&self) -> bool {
        match self {
            Self::StandardOutput(_) => true,
            Self::File(file, _) => !file.is_replacing(),
        }
    }

    /// Writes what is buffered and moves the file to its place.
    pub fn finish(self) -> anyhow::Result<()> {
        match self {
            Self::StandardOutput(mut writer) => {
                Ok(writer.flush().map_err(|e| StandardOutputError::of(&e))?)
            }
            Self::File(file, _) => Ok(file.finish()?),
        }
    }
}

impl Write for OutputSink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::StandardOutput(writer) => writer
                .write(bytes)
                .map_err(|error| StandardOutputError::of(&error)),
            Self::File(file, path) => file
                .write(bytes)
                .map_err(|error| FileError::of_write(path, error)),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::StandardOutput(writer) => writer
                .flush()
                .map_err(|error| StandardOutputError::of(&error)),
            Self::File(file, path) => file
                .flush()
                .map_err(|error| FileError::of_write(path, error)),
        }
    }
}

/// Creates the directory of a report if it does not exist.
pub fn make_directory(directory: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(directory)
        .with_context(|| format!("cannot create the directory {}", directory.display()))
}

/// Whether a file's name is `-`, for standard output or standard input.
pub fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}
