//! Lines and words of a text that may contain any bytes.

use crate::meshes::error::MeshError;

/// The most characters of a word that a message shows.
const LONGEST_WORD: usize = 40;

/// The lines of a text with their numbers. A line ends with a line feed, with or without a
/// carriage return before it; the lines do not include their ends.
pub(in crate::meshes) fn lines(bytes: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    let lines = bytes.split(|&byte| byte == b'\n');
    let lines = lines.map(|line| line.strip_suffix(b"\r").unwrap_or(line));
    (1..).zip(lines)
}

/// The words of a line.
pub(in crate::meshes) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let words = line.split(u8::is_ascii_whitespace);
    words.filter(|word| !word.is_empty())
}

/// A line up to the first of some bytes.
pub(in crate::meshes) fn before<'a>(line: &'a [u8], marks: &[u8]) -> &'a [u8] {
    let end = line.iter().position(|byte| marks.contains(byte));
    &line[..end.unwrap_or(line.len())]
}

/// The text without a byte order mark.
pub(in crate::meshes) fn without_mark(bytes: &[u8]) -> Result<&[u8], MeshError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let message = "the file looks like UTF-16: save it as UTF-8";
        return Err(MeshError::in_line(1, message));
    }
    Ok(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// Parses a word as a number, which may be infinite or NaN.
pub(in crate::meshes) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word for messages: in quotes, control characters escaped, a long one cut.
pub(in crate::meshes) fn shown(word: &[u8]) -> String {
    let word = String::from_utf8_lossy(word);
    match word.char_indices().nth(LONGEST_WORD) {
        None => format!("{word:?}"),
        Some((end, _)) => format!("{:?}...", &word[..end]),
    }
}
