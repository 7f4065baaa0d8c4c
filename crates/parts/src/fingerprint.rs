//! A hash of everything that determines a result.

use std::fmt::Write;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::PartError;

/// Bytes that are read at a time.
const BUFFER: usize = 1 << 16;

/// A SHA-256 of files and texts. Files count by their contents, not by their names, so that
/// copies of a scene on several machines have one fingerprint.
#[derive(Clone, Default)]
pub struct Fingerprint {
    hasher: Sha256,
}

impl Fingerprint {
    /// Adds a text.
    pub fn text(&mut self, text: &str) {
        self.length(text.len() as u64);
        self.hasher.update(text);
    }

    /// Adds the content of a file.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a regular file, whose content could be read again.
    pub fn file(&mut self, path: &Path) -> Result<(), PartError> {
        self.range(path, 0..u64::MAX)
    }

    /// Adds the length and both ends of a table that each part reads only in part: a hash of
    /// all of it would make each of a thousand parts read the whole table.
    ///
    /// # Errors
    /// Those of [`Fingerprint::file`].
    pub fn long_table(&mut self, path: &Path) -> Result<(), PartError> {
        let end = u64::MAX - BUFFER as u64;
        self.ranges(path, &[0..BUFFER as u64, end..u64::MAX])
    }

    /// Adds the bytes of a range of a file.
    ///
    /// # Errors
    /// Those of [`Fingerprint::file`].
    pub fn range(&mut self, path: &Path, range: Range<u64>) -> Result<(), PartError> {
        self.ranges(path, std::slice::from_ref(&range))
    }

    /// Adds the length of a file and the bytes of some ranges. Where the file is shorter, a
    /// range is moved to end with it.
    fn ranges(&mut self, path: &Path, ranges: &[Range<u64>]) -> Result<(), PartError> {
        let unreadable = |source| PartError::Unreadable {
            path: path.into(),
            source,
        };
        let metadata = path.metadata().map_err(unreadable)?;
        if !metadata.is_file() {
            return Err(PartError::NotRegular { path: path.into() });
        }
        self.length(metadata.len());
        let mut file = File::open(path).map_err(unreadable)?;
        for range in ranges {
            let beyond = range.end.saturating_sub(metadata.len());
            let start = SeekFrom::Start(range.start.saturating_sub(beyond));
            file.seek(start).map_err(unreadable)?;
            let mut bytes = (&mut file).take(range.end - range.start);
            self.hasher = hash(&mut bytes, self.hasher.clone()).map_err(unreadable)?;
        }
        Ok(())
    }

    /// The hash in hexadecimal digits.
    #[must_use]
    pub fn digits(self) -> String {
        digits(self.hasher)
    }

    /// Lengths part what follows one another: "ab", "c" differs from "a", "bc".
    fn length(&mut self, length: u64) {
        self.hasher.update(length.to_le_bytes());
    }
}

/// Adds what a reader gives to a hash.
pub(crate) fn hash(reader: &mut impl Read, mut hasher: Sha256) -> io::Result<Sha256> {
    let mut buffer = vec![0; BUFFER];
    loop {
        match reader.read(&mut buffer) {
            Ok(0) => return Ok(hasher),
            Ok(count) => hasher.update(&buffer[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// The hexadecimal digits of a hash.
pub(crate) fn digits(hasher: Sha256) -> String {
    let mut digits = String::new();
    for byte in hasher.finalize() {
        write!(digits, "{byte:02x}").expect("a string takes all text");
    }
    digits
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn digits_are_those_of_sha256sum() {
        let hasher = Sha256::new().chain_update("cyltrace");
        // printf cyltrace | sha256sum
        assert_eq!(
            digits(hasher),
            "9ea28ca446405c532f0f29deb70a2dd73b15913d0662a8c2d411239288b26624"
        );
    }

    #[test]
    fn each_change_of_an_input_changes_the_fingerprint() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("file");
        let of = |texts: &[&str], content: &str| {
            let mut fingerprint = Fingerprint::default();
            texts.iter().for_each(|text| fingerprint.text(text));
            fs::write(&path, content).expect("written");
            fingerprint.file(&path).expect("regular");
            fingerprint.digits()
        };
        let first = of(&["ab", "c"], "content");
        assert_eq!(first, of(&["ab", "c"], "content"));
        for (texts, content) in [
            (&["a", "bc"], "content"),
            (&["ab", "d"], "content"),
            (&["ab", "c"], "Content"),
            (&["ab", "c"], "content\n"),
        ] {
            assert_ne!(first, of(texts, content), "{texts:?} {content:?}");
        }
    }
}
