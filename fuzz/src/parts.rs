//! Files of parts.

use std::io::Read;

use cyltrace_parts::{PartError, PartFile};

/// A part, or a message that says what is wrong with the file.
///
/// # Panics
/// If a valid part cannot be read again.
pub fn part_file(bytes: &[u8]) {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), bytes).expect("written");
    match PartFile::read(file.path()) {
        Ok(part) => {
            let mut payload = Vec::new();
            let mut reader = part.payload().expect("it was readable");
            reader.read_to_end(&mut payload).expect("it was readable");
            assert!(PartFile::existing(file.path(), part.header()).is_some());
            assert!(payload.len() < bytes.len());
        }
        Err(PartError::Unreadable { source, .. }) => panic!("{source}"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
