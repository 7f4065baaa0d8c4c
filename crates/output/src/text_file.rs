//! Text in a file.

use std::io::Write;
use std::path::Path;

use super::new_file::{FileError, NewFile};

/// Writes a text file that is complete or absent.
///
/// # Errors
/// If the file cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    let mut file = NewFile::create(path)?;
    let written = file.write_all(text.as_bytes());
    written.map_err(|source| FileError::System {
        path: path.into(),
        source,
    })?;
    file.finish()
}
