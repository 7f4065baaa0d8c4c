//! How many lines a file has, before it is read in earnest.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The lines of a file, the last counted also where nothing ends it; 0 of what
/// is no file, such as a pipe, which can be read once only.
pub(super) fn lines(path: &Path) -> io::Result<u64> {
    // Asked before it is opened: opening a pipe waits for somebody to write.
    if !fs::metadata(path)?.is_file() {
        return Ok(0);
    }
    let mut file = File::open(path)?;
    let mut bytes = vec![0; 1 << 16];
    // Lines end with LF, CR LF or CR, in one file maybe with each of them.
    let (mut lines, mut is_after_return) = (1, false);
    loop {
        match file.read(&mut bytes) {
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

/// How often a byte is among others, in shares that a byte can count: so it is as
/// fast as memory is.
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
        // At the end of what is read at a time, too.
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
