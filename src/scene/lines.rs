//! Counts the lines of a file without parsing it.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The number of lines of a file, including a last line without an end. 0 for a pipe and
/// the like, which can be read only once.
pub(super) fn lines(path: &Path) -> io::Result<u64> {
    // Checked before opening the file: opening a pipe waits for a writer.
    if !fs::metadata(path)?.is_file() {
        return Ok(0);
    }
    Ok(1 + line_ends(File::open(path)?)?)
}

/// The number of lines that end within the first bytes of a file.
pub(super) fn lines_before(path: &Path, place: u64) -> io::Result<u64> {
    line_ends(File::open(path)?.take(place))
}

fn line_ends(mut input: impl Read) -> io::Result<u64> {
    let mut bytes = vec![0; 1 << 16];
    // Lines end with LF, CR LF or CR; one file may contain all three.
    let (mut lines, mut is_after_return) = (0, false);
    loop {
        match input.read(&mut bytes) {
            Ok(0) => return Ok(lines),
            Ok(read) => {
                let bytes = &bytes[..read];
                let returns = count(bytes, b'\r');
                lines += count(bytes, b'\n') + returns;
                if is_after_return && bytes[0] == b'\n' {
                    lines -= 1;
                }
                if returns > 0 {
                    let pairs = bytes.windows(2).filter(|pair| *pair == b"\r\n");
                    lines -= pairs.count() as u64;
                }
                is_after_return = bytes[read - 1] == b'\r';
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// The number of occurrences of a byte. The counts of short chunks fit into a byte, which
/// vectorizes to the speed of memory.
fn count(bytes: &[u8], one: u8) -> u64 {
    let in_share = |share: &[u8]| -> u8 { share.iter().map(|&byte| u8::from(byte == one)).sum() };
    bytes
        .chunks(128)
        .map(|share| u64::from(in_share(share)))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_all_ends_are_counted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table");
        // Also at the end of a buffer.
        let long = "x".repeat((1 << 16) - 1);
        for (text, expected) in [
            ("", 1),
            ("a", 1),
            ("a\nb", 2),
            ("a\r\nb\r\n", 3),
            ("a\rb\rc", 3),
            ("a\rb\nc\r\nd", 4),
            ("\n\r", 3),
            (&format!("{long}\r\nb\rc"), 3),
            (&format!("{long}\rb"), 2),
        ] {
            fs::write(&path, text).unwrap();
            assert_eq!(lines(&path).unwrap(), expected, "{}", text.len());
        }
    }
}
