//! Splits the text of a row into cells.
//!
//! A row without quotes is split at its delimiters. A row with quotes goes through
//! `csv-core`, which implements CSV's rules for them. If blanks are the delimiter, a
//! quoted cell simply ends at the next quote.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use super::format::Delimiter;
use crate::scene::limits::MOST_COLUMNS;

/// The row has more than [`MOST_COLUMNS`] cells.
#[derive(Debug, PartialEq)]
pub(in crate::scene) struct TooManyCells;

/// Splits rows, and reuses its memory from row to row.
#[derive(Default)]
pub(in crate::scene) struct Splitter {
    /// The start and end of each cell in the text.
    places: Vec<(usize, usize)>,
    unquoted: String,
    quoted: Option<Quoted>,
}

/// The state and buffers of `csv-core`.
struct Quoted {
    delimiter: u8,
    reader: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
}

/// A row, split.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Cells<'a> {
    text: &'a str,
    places: &'a [(usize, usize)],
}

impl<'a> Cells<'a> {
    /// The number of cells.
    pub fn len(self) -> usize {
        self.places.len()
    }

    /// A cell without surrounding blanks, and without quotes that remain because blanks
    /// precede them. Empty if the row is too short.
    pub fn get(self, index: usize) -> &'a str {
        let Some(&(start, end)) = self.places.get(index) else {
            return "";
        };
        let cell = self.text[start..end].trim();
        cell.strip_prefix('"')
            .and_then(|inner| inner.strip_suffix('"'))
            .map_or(cell, str::trim)
    }

    /// All cells.
    pub fn iter(self) -> impl Iterator<Item = &'a str> {
        (0..self.len()).map(move |index| self.get(index))
    }
}

impl Splitter {
    /// The cells of a row.
    pub fn split<'a>(
        &'a mut self,
        row: &'a str,
        delimiter: Delimiter,
    ) -> Result<Cells<'a>, TooManyCells> {
        self.places.clear();
        let has_quotes = memchr::memchr(b'"', row.as_bytes()).is_some();
        let text = match delimiter.byte() {
            None => {
                between_blanks(row, &mut self.places)?;
                row
            }
            Some(byte) if has_quotes => {
                self.unquote(row, byte)?;
                &self.unquoted
            }
            Some(byte) => {
                let mut start = 0;
                for end in memchr::memchr_iter(byte, row.as_bytes()) {
                    push(&mut self.places, (start, end))?;
                    start = end + 1;
                }
                push(&mut self.places, (start, row.len()))?;
                row
            }
        };
        Ok(Cells {
            text,
            places: &self.places,
        })
    }

    /// Splits a row with quotes, and stores its text without them.
    fn unquote(&mut self, row: &str, delimiter: u8) -> Result<(), TooManyCells> {
        let quoted = self.quoted.take();
        let quoted = quoted.filter(|quoted| quoted.delimiter == delimiter);
        let quoted = self
            .quoted
            .insert(quoted.unwrap_or_else(|| Quoted::new(delimiter)));
        // A record is never longer than its row.
        quoted.text.resize(row.len() + 1, 0);
        quoted.reader.reset();
        let (mut read, mut written, mut ended) = (0, 0, 0);
        loop {
            let (result, input, output, ends) = quoted.reader.read_record(
                &row.as_bytes()[read..],
                &mut quoted.text[written..],
                &mut quoted.ends[ended..],
            );
            (read, written, ended) = (read + input, written + output, ended + ends);
            match result {
                ReadRecordResult::Record | ReadRecordResult::End => break,
                ReadRecordResult::InputEmpty => {}
                ReadRecordResult::OutputFull | ReadRecordResult::OutputEndsFull => {
                    return Err(TooManyCells);
                }
            }
        }
        let mut start = 0;
        for &end in &quoted.ends[..ended] {
            push(&mut self.places, (start, end))?;
            start = end;
        }
        self.unquoted.clear();
        // Delimiters and quotes are ASCII, so the text remains UTF-8 without them.
        self.unquoted
            .push_str(std::str::from_utf8(&quoted.text[..written]).unwrap_or_default());
        Ok(())
    }
}

impl Quoted {
    fn new(delimiter: u8) -> Self {
        Self {
            delimiter,
            reader: ReaderBuilder::new().delimiter(delimiter).build(),
            text: Vec::new(),
            ends: vec![0; MOST_COLUMNS + 1],
        }
    }
}

fn push(places: &mut Vec<(usize, usize)>, place: (usize, usize)) -> Result<(), TooManyCells> {
    if places.len() == MOST_COLUMNS {
        return Err(TooManyCells);
    }
    places.push(place);
    Ok(())
}

/// Splits a row at runs of blanks. A cell that begins with a quote ends at the next one.
fn between_blanks(row: &str, places: &mut Vec<(usize, usize)>) -> Result<(), TooManyCells> {
    let bytes = row.as_bytes();
    let is_blank = |byte: &u8| byte.is_ascii_whitespace();
    let mut at = 0;
    while let Some(gap) = bytes[at..].iter().position(|byte| !is_blank(byte)) {
        let start = at + gap;
        let quoted = bytes[start..].strip_prefix(b"\"");
        let closing = quoted.and_then(|rest| memchr::memchr(b'"', rest));
        let rest = closing.map_or(start, |closing| start + closing + 2);
        let end = bytes[rest..].iter().position(is_blank);
        let end = end.map_or(bytes.len(), |length| rest + length);
        push(places, (start, end))?;
        at = end;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(row: &str, delimiter: Delimiter) -> Vec<String> {
        let mut splitter = Splitter::default();
        let cells = splitter.split(row, delimiter).expect("few cells");
        cells.iter().map(str::to_owned).collect()
    }

    #[test]
    fn cells_of_every_delimiter_with_and_without_quotes() {
        let comma = |row| cells(row, Delimiter::Comma);
        assert_eq!(comma("1, 2 ,3"), ["1", "2", "3"]);
        assert_eq!(comma("1,,3,"), ["1", "", "3", ""]);
        assert_eq!(comma("\"a,b\",\"c\"\"d\",e"), ["a,b", "c\"d", "e"]);
        assert_eq!(comma("\"a\nb\", \"c\""), ["a\nb", "c"]);
        assert_eq!(comma("\"1\",,"), ["1", "", ""]);
        assert_eq!(comma("5\" pipe,é"), ["5\" pipe", "é"]);
        assert_eq!(cells("1;2,5", Delimiter::Semicolon), ["1", "2,5"]);
        assert_eq!(cells("1\t\t2", Delimiter::Tab), ["1", "", "2"]);
        let blanks = |row| cells(row, Delimiter::Blanks);
        assert_eq!(blanks("  1 \t 2  3 "), ["1", "2", "3"]);
        assert_eq!(blanks("\"a b\" 2 \"c"), ["a b", "2", "\"c"]);
        // One splitter for several delimiters.
        let mut splitter = Splitter::default();
        for (row, delimiter) in [
            ("\"a\",b", Delimiter::Comma),
            ("\"a\";b", Delimiter::Semicolon),
        ] {
            let split = splitter.split(row, delimiter).expect("two cells");
            assert_eq!(split.iter().collect::<Vec<_>>(), ["a", "b"]);
        }
    }

    #[test]
    fn row_with_too_many_cells_is_rejected_in_any_format() {
        let mut splitter = Splitter::default();
        for (cell, delimiter) in [
            ("1,", Delimiter::Comma),
            ("\"\",", Delimiter::Comma),
            ("1 ", Delimiter::Blanks),
        ] {
            let most = cell.repeat(MOST_COLUMNS);
            let most = most.trim_end_matches([',', ' ']);
            assert_eq!(
                splitter.split(most, delimiter).map(Cells::len),
                Ok(MOST_COLUMNS)
            );
            let more = cell.repeat(MOST_COLUMNS) + "1";
            assert!(splitter.split(&more, delimiter).is_err());
        }
    }
}
