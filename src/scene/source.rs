//! The text of a scene file, and errors that point into it.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::Spanned;

use super::error::{Excerpt, SceneError, Statement};
use super::limits::GREATEST_SCENE_BYTES;
use super::names::{quoted, suggestion};
use super::regular_file::read_regular;

/// The longest line that an error shows, in bytes. For a longer line, the message gives
/// only the place.
const LONGEST_SHOWN_LINE: usize = 400;

/// A scene file that has been read.
pub(super) struct Source {
    path: PathBuf,
    text: String,
}

impl Source {
    /// Reads a file of UTF-8 text, with or without a byte order mark.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let bytes = read_regular(path, GREATEST_SCENE_BYTES);
        let bytes = bytes.map_err(|source| SceneError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
        let mut text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let before = String::from_utf8_lossy(&error.as_bytes()[..valid]);
            let (line, column, _) = locate(&before, before.len());
            SceneError::Encoding {
                path: path.to_owned(),
                line: line as u64,
                column: Some(column),
                utf16,
            }
        })?;
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        Ok(Self::new(path, text))
    }

    /// The text of a file that is not read.
    pub fn new(path: &Path, text: String) -> Self {
        Self {
            path: path.to_owned(),
            text,
        }
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The text, without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Resolves a path in the scene file relative to the file's folder.
    pub fn resolve(&self, file: &str) -> PathBuf {
        match self.path.parent() {
            Some(folder) => folder.join(file),
            None => PathBuf::from(file),
        }
    }

    /// An error at a place.
    pub fn error(&self, place: Range<usize>, message: impl Into<String>) -> SceneError {
        self.statement(place, message.into(), None)
    }

    /// An error at a place, with advice.
    pub fn error_with_help(
        &self,
        place: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> SceneError {
        self.statement(place, message.into(), Some(help.into()))
    }

    /// The error that a file named in the scene cannot be opened.
    pub fn unreadable(&self, file: &Spanned<String>, error: SceneError) -> SceneError {
        match error {
            SceneError::Unreadable { .. } => self.error_with_help(
                file.span(),
                error.to_string(),
                "file names are relative to the folder of the scene file",
            ),
            other => other,
        }
    }

    /// The meaning of a word that must be one of the choices.
    pub fn choose<T: Copy>(
        &self,
        what: &str,
        word: &Spanned<String>,
        choices: &[(&str, T)],
    ) -> Result<T, SceneError> {
        let text = word.get_ref();
        match choices.iter().find(|(name, _)| name == text) {
            Some((_, meaning)) => Ok(*meaning),
            None => Err(self.error_with_help(
                word.span(),
                format!("{} is not a value of {what}", quoted(text)),
                suggestion(text, choices.iter().map(|(name, _)| *name), "values"),
            )),
        }
    }

    /// The text of the line that contains a byte.
    pub fn line_text(&self, byte: usize) -> &str {
        let (_, _, line_start) = locate(&self.text, byte.min(self.text.len()));
        self.text[line_start..].lines().next().unwrap_or_default()
    }

    /// The line of a place, from 1.
    pub fn line(&self, place: &Range<usize>) -> usize {
        locate(&self.text, place.start).0
    }

    fn statement(&self, place: Range<usize>, message: String, help: Option<String>) -> SceneError {
        let start = place.start.min(self.text.len());
        let (line, column, line_start) = locate(&self.text, start);
        let line_text = self.text[line_start..].lines().next().unwrap_or_default();
        let excerpt = (line_text.len() <= LONGEST_SHOWN_LINE).then(|| {
            let from = (start - line_start).min(line_text.len());
            let to = place.end.saturating_sub(line_start).min(line_text.len());
            Excerpt {
                text: line_text.to_owned(),
                wrong: from..to.max(from),
            }
        });
        SceneError::Statement(Box::new(Statement {
            path: self.path.clone(),
            line,
            column,
            message,
            help,
            excerpt,
        }))
    }
}

/// The line and column of a byte, both from 1, and the start of the line.
fn locate(text: &str, byte: usize) -> (usize, usize, usize) {
    let before = &text[..byte];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.matches('\n').count() + 1;
    let column = before[line_start..].chars().count() + 1;
    (line, column, line_start)
}
