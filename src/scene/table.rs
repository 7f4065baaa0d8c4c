//! Tables of numbers with named columns: CSV, read row by row.
//!
//! The first line that is neither blank nor a comment (`#`) is the header. Its
//! delimiter is the one of comma, semicolon and tab that stands there most
//! often outside quotes, a comma in doubt. Spaces around cells do not count.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Chain, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use csv::{ErrorKind, Reader, ReaderBuilder, StringRecord, Trim};
use toml::Spanned;

use super::error::SceneError;
use super::lines::lines;
use super::names::{quoted, suggestion};
use super::source::Source;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A table and its current row.
pub(super) struct Table {
    path: PathBuf,
    reader: Reader<Chain<Cursor<Vec<u8>>, BufReader<File>>>,
    header: Vec<String>,
    row: StringRecord,
    /// The length of the byte order mark, which the reader does not see.
    mark: u64,
}

/// A column that a scene asks for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column(usize);

impl Table {
    /// Opens the table that a scene file names, and reads its header.
    pub fn open(source: &Source, file: &Spanned<String>) -> Result<Self, SceneError> {
        let path = source.resolve(file.get_ref());
        Self::open_path(&path).map_err(|error| source.unreadable(file, error))
    }

    fn open_path(path: &Path) -> Result<Self, SceneError> {
        let unreadable = |source| SceneError::Unreadable {
            path: path.to_owned(),
            source,
        };
        let mut rest = BufReader::with_capacity(1 << 16, File::open(path).map_err(unreadable)?);
        let (mut start, header_start) = up_to_header(&mut rest).map_err(unreadable)?;
        if start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) {
            return Err(SceneError::Encoding {
                path: path.to_owned(),
                line: 1,
                column: None,
                utf16: true,
            });
        }
        let delimiter = delimiter(&start[header_start..]);
        let mark = if start.starts_with(BYTE_ORDER_MARK) {
            start.drain(..BYTE_ORDER_MARK.len());
            BYTE_ORDER_MARK.len() as u64
        } else {
            0
        };
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .delimiter(delimiter)
            .trim(Trim::All)
            .from_reader(Cursor::new(start).chain(rest));
        let mut table = Self {
            path: path.to_owned(),
            reader,
            header: Vec::new(),
            row: StringRecord::new(),
            mark,
        };
        if !table.read()? {
            return Err(table.row_error(
                None,
                "the table is empty: a header with the names of the columns is needed",
            ));
        }
        table.header = table.row.iter().map(|name| bare(name).to_owned()).collect();
        Ok(table)
    }

    /// Finds a column by its name, which a scene file states.
    pub fn column(&self, source: &Source, name: &Spanned<String>) -> Result<Column, SceneError> {
        self.find(name.get_ref())
            .map_err(|(message, help)| source.error_with_help(name.span(), message, help))
    }

    /// Finds a column by its name; else says what is wrong and what to do.
    pub fn find(&self, name: &str) -> Result<Column, (String, String)> {
        let mut places = (0..self.header.len()).filter(|&index| self.header[index] == name);
        match (places.next(), places.next()) {
            (Some(index), None) => Ok(Column(index)),
            (Some(_), Some(_)) => Err((
                format!(
                    "{} has more than one column {}",
                    self.path.display(),
                    quoted(name)
                ),
                "give each column a name of its own".to_owned(),
            )),
            (None, _) => Err((
                format!("{} has no column {}", self.path.display(), quoted(name)),
                self.missing_help(name),
            )),
        }
    }

    fn missing_help(&self, name: &str) -> String {
        if self.header.iter().all(|cell| cell.parse::<f64>().is_ok()) {
            return "its first line holds numbers: a header with the names of the columns is needed, and not behind a #".to_owned();
        }
        suggestion(name, self.header.iter().map(String::as_str), "columns")
    }

    /// At least as many rows as there are: the lines of a file, 0 of a pipe,
    /// which can be read once only.
    pub fn most_rows(&self) -> usize {
        lines(&self.path).map_or(0, |lines| usize::try_from(lines).unwrap_or(0))
    }

    /// Goes to the next row; false at the end.
    ///
    /// # Errors
    /// When the file cannot be read, is not UTF-8, or the row has not as many
    /// cells as the header.
    pub fn next_row(&mut self) -> Result<bool, SceneError> {
        loop {
            if !self.read()? {
                return Ok(false);
            }
            let blank = self.row.len() == 1 && self.row[0].is_empty();
            if blank {
                continue;
            }
            if self.row.len() != self.header.len() {
                let (cells, columns) = (self.row.len(), self.header.len());
                return Err(self.row_error(
                    None,
                    format!("the row has {cells} cells, the header has {columns}"),
                ));
            }
            return Ok(true);
        }
    }

    /// The finite number in a cell of the current row.
    pub fn number(&self, column: Column) -> Result<f64, SceneError> {
        let cell = bare(&self.row[column.0]);
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(self.row_error(
                Some(column),
                format!("{} is not a finite number", quoted(cell)),
            )),
            Err(_) if cell.is_empty() => {
                Err(self.row_error(Some(column), "the cell is empty, a number is needed"))
            }
            Err(_) => Err(self.row_error(
                Some(column),
                format!("{} is not a number (such as 1.5 or 2e-3)", quoted(cell)),
            )),
        }
    }

    /// The finite numbers in some cells of the current row.
    pub fn numbers<const N: usize>(&self, columns: [Column; N]) -> Result<[f64; N], SceneError> {
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(column)?;
        }
        Ok(numbers)
    }

    /// That `message` is true of the current row, or of one cell of it.
    pub fn row_error(&self, column: Option<Column>, message: impl Into<String>) -> SceneError {
        self.row_error_with_help(column, message, None)
    }

    /// The same, and what to do about it.
    pub fn row_error_with_help(
        &self,
        column: Option<Column>,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        SceneError::Row {
            path: self.path.clone(),
            line: self.line(self.row.position()),
            column: column.and_then(|column| self.header.get(column.0).cloned()),
            message: message.into(),
            help: help.map(str::to_owned),
        }
    }

    fn read(&mut self) -> Result<bool, SceneError> {
        self.reader
            .read_record(&mut self.row)
            .map_err(|error| self.csv_error(error))
    }

    fn csv_error(&self, error: csv::Error) -> SceneError {
        let line = self.line(error.position());
        let message = error.to_string();
        match error.into_kind() {
            ErrorKind::Io(source) => SceneError::Unreadable {
                path: self.path.clone(),
                source,
            },
            ErrorKind::Utf8 { .. } => SceneError::Encoding {
                path: self.path.clone(),
                line,
                column: None,
                utf16: false,
            },
            _ => SceneError::Row {
                path: self.path.clone(),
                line,
                column: None,
                message,
                help: None,
            },
        }
    }

    /// The line on which a row starts.
    ///
    /// The reader's positions are those *before* the blank lines and comments
    /// that precede a row, so the file is read once more from there. It is
    /// done for errors only.
    fn line(&self, position: Option<&csv::Position>) -> u64 {
        let Some(position) = position else {
            return 1;
        };
        let skipped = skipped_lines(&self.path, position.byte() + self.mark).unwrap_or(0);
        position.line() + skipped
    }
}

/// Reads up to the end of the header. Returns what was read and where in it
/// the header starts.
fn up_to_header(reader: &mut impl BufRead) -> io::Result<(Vec<u8>, usize)> {
    let mut start = Vec::new();
    loop {
        let line_start = start.len();
        let length = reader.read_until(b'\n', &mut start)?;
        let line = &start[line_start..];
        let line = line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line);
        if length == 0 || !(line.trim_ascii().is_empty() || line.starts_with(b"#")) {
            return Ok((start, line_start));
        }
    }
}

fn delimiter(header: &[u8]) -> u8 {
    let mut counts = [(b',', 0), (b';', 0), (b'\t', 0)];
    let mut in_quotes = false;
    for &byte in header {
        in_quotes ^= byte == b'"';
        for (delimiter, count) in &mut counts {
            *count += usize::from(byte == *delimiter && !in_quotes);
        }
    }
    let [mut best, others @ ..] = counts;
    for other in others {
        if other.1 > best.1 {
            best = other;
        }
    }
    best.0
}

/// A cell without the quotes that the reader leaves when spaces precede them.
fn bare(cell: &str) -> &str {
    cell.strip_prefix('"')
        .and_then(|inner| inner.strip_suffix('"'))
        .map_or(cell, str::trim)
}

/// How many line ends precede the first line with content from `byte` on.
fn skipped_lines(path: &Path, byte: u64) -> io::Result<u64> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(byte))?;
    let mut reader = BufReader::new(file);
    let mut line = Vec::new();
    let mut skipped = 0;
    loop {
        line.clear();
        let length = reader.read_until(b'\n', &mut line)?;
        let content = line.strip_suffix(b"\n").unwrap_or(&line);
        let content = content.strip_suffix(b"\r").unwrap_or(content);
        if length == 0 || !(content.is_empty() || content.starts_with(b"#")) {
            return Ok(skipped);
        }
        skipped += 1;
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn table(text: &[u8]) -> (tempfile::NamedTempFile, Result<Table, SceneError>) {
        let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
        file.write_all(text).expect("writing it");
        let table = Table::open_path(file.path());
        (file, table)
    }

    fn column_sum(text: &str, name: &str) -> Result<f64, SceneError> {
        let (_file, table) = table(text.as_bytes());
        let mut table = table?;
        let column = table.find(name).expect("the column");
        let mut sum = 0.0;
        while table.next_row()? {
            sum += table.number(column)?;
        }
        Ok(sum)
    }

    #[test]
    fn table_in_any_layout_gives_the_same_numbers() {
        let layouts = [
            "x,y\n1,2\n3,4\n",
            "\u{feff}x,y\n1,2\n3,4",
            "\u{feff}# made by hand\nx,y\n1,2\n3,4",
            "# a, comment; with\ttabs\n\n x ,  y \n\n  1, 2 \n# more\n   \n3 , 4\n\n",
            "x;y\r\n1;2\r\n\r\n3;4\r\n",
            "x\ty\n1\t2\n3\t4\n",
            "\"x\",\"y\"\n\"1\", \"2\"\n \" 3 \",\"4\"\n",
            "\"x;1;2;3\",x,y\n\"a;b\n;c\",1,2\n,3,4\n",
        ];
        for text in layouts {
            assert_eq!(column_sum(text, "y").ok(), Some(6.0), "{text:?}");
            assert_eq!(column_sum(text, "x").ok(), Some(4.0), "{text:?}");
        }
    }

    #[test]
    fn row_error_names_the_line_whatever_precedes_it() {
        let beginnings = [
            ("x\n", 2),
            ("x\r\n", 2),
            ("x\r\n1\r\n\r\n# no\r\n\r\n", 6),
            ("\u{feff}x\n1\n\n", 4),
            ("# a\n\n# b\nx\n# c\n1\n  \n\n# d\n2\n\n\n# e\n", 14),
            ("x\n\"1\"\n\"2\"\n", 4),
        ];
        for (beginning, line) in beginnings {
            for end in ["bad", "bad\n", "bad\r\n3\r\n", "bad\n\n# more\n4\n"] {
                let text = format!("{beginning}{end}");
                let message = column_sum(&text, "x")
                    .expect_err("bad is no number")
                    .to_string();
                let place = format!(":{line}: column \"x\": \"bad\" is not a number");
                assert!(message.contains(&place), "{text:?}: {message}");
            }
        }
    }

    #[test]
    fn delimiter_is_the_commonest_outside_quotes() {
        assert_eq!(delimiter(b"x"), b',');
        assert_eq!(delimiter(b"a;b,c;d"), b';');
        assert_eq!(delimiter(b"\"a;b;c\",d"), b',');
        assert_eq!(delimiter(b"a\tb"), b'\t');
    }
}
