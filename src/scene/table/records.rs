//! Splits the text of a table into rows. A row is one line, or several if quotes span line
//! ends. Comments and blank lines are skipped. Limits are enforced here, before a row takes
//! memory.
//!
//! Rows come in blocks, so that many threads can work on a table of any length with little
//! memory. A line ends with LF, CR LF or CR.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::format::Delimiter;
use crate::scene::error::SceneError;
use crate::scene::limits::{GREATEST_TABLE_BYTES, LONGEST_LINE};

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The marks that begin a comment.
const COMMENT_MARKS: [&[u8]; 2] = [b"#", b"//"];

/// The error in a row of several lines in a range of a table: where they begin is not known
/// to a reader that begins between them.
pub(super) const ROW_OF_LINES: &str = "the row continues on the next line, within quotes: a table that is read in parts must have each row on one line";

/// Bytes of a block, about 1000 rows: large enough to pass to a thread at negligible cost,
/// small enough to share the work evenly.
const BLOCK_BYTES: usize = 1 << 16;

/// The most comments that are stored, because they may contain column names.
const MOST_COMMENTS: usize = 64;
/// The longest comment that is stored, in bytes.
const LONGEST_COMMENT: usize = 1 << 16;

/// Some rows of a table.
#[derive(Default)]
pub struct Block {
    text: Vec<u8>,
    records: Vec<Record>,
}

/// A row in the text of a block.
#[derive(Clone, Copy)]
struct Record {
    start: usize,
    end: usize,
    line: u64,
}

/// Reads the rows of a table.
pub(in crate::scene) struct Records<R> {
    path: PathBuf,
    input: BufReader<R>,
    /// The number of lines read.
    line: u64,
    /// The place in the table, in bytes from its beginning.
    bytes: u64,
    /// Rows that begin here or later are not read.
    end: u64,
    /// The place where the last row began.
    row_start: u64,
    /// Whether the last line ended with CR, so that a following LF belongs to it.
    after_return: bool,
    /// The comments before the first row.
    pub comments: VecDeque<String>,
}

impl Block {
    /// The number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether the block has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The text of a row and its line.
    pub(in crate::scene) fn text(
        &self,
        path: &Path,
        index: usize,
    ) -> Result<(&str, u64), SceneError> {
        let Record { start, end, line } = self.records[index];
        match std::str::from_utf8(&self.text[start..end]) {
            Ok(text) => Ok((text, line)),
            Err(_) => Err(SceneError::Encoding {
                path: path.to_owned(),
                line,
                column: None,
                utf16: false,
            }),
        }
    }
}

/// The mark at the beginning of a line that is a comment. A line that begins with Excel's
/// `#N/A`, a missing value, is a row.
fn comment_mark(line: &[u8]) -> Option<&'static [u8]> {
    let is_row = line
        .strip_prefix(b"#N/A")
        .is_some_and(|rest| rest.first().is_none_or(|next| b",;\t".contains(next)));
    let mut marks = COMMENT_MARKS.into_iter();
    marks.find(|mark| line.starts_with(mark) && !is_row)
}

impl<R: Read> Records<R> {
    /// Begins to read a table; errors name it `path`.
    pub fn new(input: R, path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            input: BufReader::with_capacity(BLOCK_BYTES, input),
            line: 0,
            bytes: 0,
            end: u64::MAX,
            row_start: 0,
            after_return: false,
            comments: VecDeque::new(),
        }
    }

    /// Begins to read within a table: the rows that begin in `range`, in bytes from its
    /// beginning, not at 0. `input` is at the byte before the range. The first line of the range
    /// has number 2; its true number follows from [`Records::row_start`], where it begins.
    pub fn within(input: R, path: &Path, range: Range<u64>) -> Result<Self, SceneError> {
        let mut records = Self {
            line: 1,
            bytes: range.start - 1,
            end: range.end,
            ..Self::new(input, path)
        };
        // The rest of a line that begins before the range, at least its end.
        records.next_line(&mut Vec::new(), 0)?;
        records.line = 1;
        records.row_start = records.line_start()?;
        Ok(records)
    }

    /// Leaves out the rows that begin at `end` or later.
    pub fn end_at(&mut self, end: u64) {
        self.end = end;
    }

    /// The place where the last row began, or the first will, in bytes from the table's
    /// beginning.
    pub fn row_start(&self) -> u64 {
        self.row_start
    }

    /// The number of lines read.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// The next rows; an empty block at the end.
    pub fn next_block(&mut self, delimiter: Delimiter) -> Result<Block, SceneError> {
        let mut block = Block {
            text: Vec::with_capacity(BLOCK_BYTES + 256),
            records: Vec::new(),
        };
        while block.text.len() < BLOCK_BYTES && self.next_record(&mut block, Some(delimiter))? {}
        Ok(block)
    }

    /// Adds the next row to a block; returns false at the end. If the delimiter is not
    /// known yet, quotes may follow any delimiter.
    pub fn next_record(
        &mut self,
        block: &mut Block,
        delimiter: Option<Delimiter>,
    ) -> Result<bool, SceneError> {
        let start = block.text.len();
        loop {
            self.row_start = self.line_start()?;
            if self.row_start >= self.end || !self.next_line(&mut block.text, start)? {
                return Ok(false);
            }
            let content = block.text[start..].trim_ascii();
            if let Some(mark) = comment_mark(content) {
                self.keep_comment(&block.text[start..], mark);
            } else if !content.is_empty() {
                break;
            }
            block.text.truncate(start);
        }
        let line = self.line;
        let mut quotes = Quotes::new(delimiter);
        let mut fed = start;
        while quotes.are_open_after(&block.text[fed..]) {
            if self.end != u64::MAX {
                return Err(self.error(line, ROW_OF_LINES));
            }
            block.text.push(b'\n');
            fed = block.text.len();
            if !self.next_line(&mut block.text, start)? {
                return Err(self.error(line, "a quote opened in this row is never closed"));
            }
        }
        let end = block.text.len();
        block.records.push(Record { start, end, line });
        Ok(true)
    }

    /// Appends the next line, without its end, to the text of a row that begins at
    /// `start`; returns false at the end of the table.
    fn next_line(&mut self, text: &mut Vec<u8>, start: usize) -> Result<bool, SceneError> {
        let line_start = text.len();
        let mut is_ended = false;
        self.line_start()?;
        while !is_ended {
            let buffer = fill(&mut self.input, &self.path)?;
            if buffer.is_empty() {
                break;
            }
            let end = memchr::memchr2(b'\n', b'\r', buffer);
            let piece = &buffer[..end.unwrap_or(buffer.len())];
            if text.len() - start + piece.len() > LONGEST_LINE {
                let message =
                    format!("the line is longer than {LONGEST_LINE} bytes, the limit for a row");
                return Err(self.error(self.line + 1, &message));
            }
            text.extend_from_slice(piece);
            is_ended = end.is_some();
            self.after_return = end.is_some_and(|end| buffer[end] == b'\r');
            let used = piece.len() + usize::from(is_ended);
            self.input.consume(used);
            self.bytes += used as u64;
        }
        if !is_ended && text.len() == line_start {
            return Ok(false);
        }
        self.line += 1;
        if self.bytes > GREATEST_TABLE_BYTES {
            let message = format!(
                "the table has more than {GREATEST_TABLE_BYTES} bytes, the limit for a table"
            );
            return Err(self.error(self.line, &message));
        }
        if self.line == 1 {
            self.strip_mark(text)?;
        }
        Ok(true)
    }

    /// The place where the next line begins: after the LF that belongs to a CR.
    fn line_start(&mut self) -> Result<u64, SceneError> {
        if std::mem::take(&mut self.after_return)
            && fill(&mut self.input, &self.path)?.first() == Some(&b'\n')
        {
            self.input.consume(1);
            self.bytes += 1;
        }
        Ok(self.bytes)
    }

    /// Removes the byte order mark from the first line.
    fn strip_mark(&self, text: &mut Vec<u8>) -> Result<(), SceneError> {
        if text.starts_with(&[0xff, 0xfe]) || text.starts_with(&[0xfe, 0xff]) {
            return Err(SceneError::Encoding {
                path: self.path.clone(),
                line: 1,
                column: None,
                utf16: true,
            });
        }
        if text.starts_with(BYTE_ORDER_MARK) {
            text.drain(..BYTE_ORDER_MARK.len());
        }
        if text.contains(&0) {
            let message = "the first line has a zero byte, so the file is not UTF-8 text: save the table as UTF-8, not as UTF-16 or as a workbook";
            return Err(self.error(1, message));
        }
        Ok(())
    }

    fn keep_comment(&mut self, line: &[u8], mark: &[u8]) {
        let line = line.trim_ascii();
        if line.len() > LONGEST_COMMENT {
            return;
        }
        if self.comments.len() == MOST_COMMENTS {
            self.comments.pop_front();
        }
        let mut text = line;
        while let Some(rest) = text.strip_prefix(mark) {
            text = rest;
        }
        // A comment that is not UTF-8 contains no names.
        self.comments
            .extend(std::str::from_utf8(text).map(str::to_owned));
    }

    fn error(&self, line: u64, message: &str) -> SceneError {
        SceneError::row(&self.path, line, message)
    }
}

/// The bytes that are read next; none at the end.
fn fill<'a, R: Read>(input: &'a mut BufReader<R>, path: &Path) -> Result<&'a [u8], SceneError> {
    while input.buffer().is_empty() {
        match input.fill_buf() {
            Ok(_) => break,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(source) => {
                return Err(SceneError::Unreadable {
                    path: path.to_owned(),
                    source,
                });
            }
        }
    }
    Ok(input.buffer())
}

/// Tracks from line to line of a row whether quotes are open. As in `csv-core`, a quote
/// opens only at the beginning of a cell, and a doubled quote within quotes is a character.
struct Quotes {
    delimiter: Option<Delimiter>,
    state: State,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    CellStart,
    InCell,
    InQuotes,
    /// After a quote within quotes: the end, unless it is doubled.
    AfterQuote,
}

impl Quotes {
    fn new(delimiter: Option<Delimiter>) -> Self {
        Self {
            delimiter,
            state: State::CellStart,
        }
    }

    fn are_open_after(&mut self, line: &[u8]) -> bool {
        if self.state != State::InQuotes && memchr::memchr(b'"', line).is_none() {
            return false;
        }
        let bytes = match self.delimiter {
            Some(delimiter) => match delimiter.byte() {
                Some(byte) => [byte; 3],
                // With blanks as delimiter, quotes end with the line.
                None => return false,
            },
            None => [b',', b';', b'\t'],
        };
        for byte in line {
            self.state = match (self.state, byte) {
                (State::CellStart | State::AfterQuote, b'"') => State::InQuotes,
                (State::InQuotes, b'"') => State::AfterQuote,
                (State::InQuotes, _) => State::InQuotes,
                (_, byte) if bytes.contains(byte) => State::CellStart,
                _ => State::InCell,
            };
        }
        self.state == State::InQuotes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &[u8]) -> Result<Vec<(String, u64)>, String> {
        let mut records = Records::new(text, Path::new("t.csv"));
        let mut rows = Vec::new();
        loop {
            let block = records.next_block(Delimiter::Comma);
            let block = block.map_err(|error| error.to_string())?;
            if block.is_empty() {
                return Ok(rows);
            }
            rows.extend((0..block.len()).map(|index| {
                let (text, line) = block.text(Path::new("t.csv"), index).expect("UTF-8");
                (text.to_owned(), line)
            }));
        }
    }

    #[test]
    fn rows_have_their_line_numbers_with_any_line_end() {
        let expected = [("a", 2), ("b", 4), ("c", 5)];
        let expected = expected.map(|(text, line)| (text.to_owned(), line));
        for end in ["\n", "\r\n", "\r"] {
            let text = format!("# x{end}a{end}{end}b{end}c");
            assert_eq!(rows(text.as_bytes()), Ok(expected.to_vec()), "{end:?}");
            let text = format!("\u{feff}// x{end}a{end}  {end}b{end}c{end}");
            assert_eq!(rows(text.as_bytes()), Ok(expected.to_vec()), "{end:?}");
        }
    }

    #[test]
    fn quotes_span_line_ends_only_if_they_begin_a_cell() {
        let text = b"1,\"a\n# b\",2\n5\" pipe,1\n\"\"\"\",\"\"\"\n\"\nlast";
        let expected = [
            ("1,\"a\n# b\",2", 1),
            ("5\" pipe,1", 3),
            ("\"\"\"\",\"\"\"\n\"", 4),
            ("last", 6),
        ];
        let expected = expected.map(|(text, line)| (text.to_owned(), line));
        assert_eq!(rows(text), Ok(expected.to_vec()));
        let message = rows(b"a\n1,\"b\nc\n").expect_err("never closed");
        assert!(message.starts_with("t.csv:2: a quote"), "{message}");
    }

    #[test]
    fn line_that_never_ends_is_rejected_at_the_limit() {
        let mut records = Records::new(io::repeat(0), Path::new("zero"));
        let error = records.next_block(Delimiter::Comma).map(|_| ());
        let message = error.expect_err("no row").to_string();
        assert!(
            message.contains("zero:1: the line is longer than"),
            "{message}"
        );
        let endless = io::repeat(b'"').take(1 << 30);
        let mut records = Records::new(endless.chain(&b"\n"[..]), Path::new("quotes"));
        assert!(records.next_block(Delimiter::Comma).is_err());
    }
}
