//! Errors of loading a scene. Each error's `Display` is the whole message for a
//! user: the place, the wrong value, and what would be right.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// Why a scene cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file cannot be opened or read.
    #[error("cannot read {}: {}", path.display(), unreadable(path, source))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
    /// The file is of another kind than a scene file.
    #[error("{}: this is {what}; a scene is a TOML file{purpose}, such as:\n\n{example}", path.display())]
    NotAScene {
        /// The file.
        path: PathBuf,
        /// The kind of the file.
        what: &'static str,
        /// How a scene file would use it.
        purpose: &'static str,
        /// An example of such a scene file.
        example: String,
    },
    /// A file is not text in UTF-8.
    #[error("{}", encoding(path, *line, *column, *utf16))]
    Encoding {
        /// The file.
        path: PathBuf,
        /// The line of the first wrong byte, from 1.
        line: u64,
        /// The place in the line, in characters from 1; `None` in tables.
        column: Option<usize>,
        /// Whether the file starts like a UTF-16 file.
        utf16: bool,
    },
    /// A statement of the scene file is wrong.
    #[error(transparent)]
    Statement(Box<Statement>),
    /// A row of a table, or its header, is wrong.
    #[error("{}:{line}:{} {message}{}", path.display(), column_text(column.as_deref()), help_text(help.as_deref()))]
    Row {
        /// The table.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// The column's name, if a single column is wrong.
        column: Option<String>,
        /// The value and what is wrong with it.
        message: String,
        /// How to correct it.
        help: Option<String>,
    },
}

impl SceneError {
    /// An error in a row of a table.
    pub(super) fn row(path: &Path, line: u64, message: impl Into<String>) -> Self {
        Self::Row {
            path: path.to_owned(),
            line,
            column: None,
            message: message.into(),
            help: None,
        }
    }

    /// The error with the number of its line increased.
    pub(super) fn lines_later(mut self, lines: u64) -> Self {
        if let Self::Row { line, .. } | Self::Encoding { line, .. } = &mut self {
            *line += lines;
        }
        self
    }
}

/// A wrong place in a scene file.
#[derive(Debug)]
pub struct Statement {
    /// The scene file.
    pub path: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The place in the line, in characters from 1.
    pub column: usize,
    /// The value and what is wrong with it.
    pub message: String,
    /// How to correct it.
    pub help: Option<String>,
    pub(super) excerpt: Option<Excerpt>,
}

/// The line of a wrong place, shown below the message.
#[derive(Debug)]
pub(super) struct Excerpt {
    pub text: String,
    /// The bytes of `text` that are wrong.
    pub wrong: std::ops::Range<usize>,
}

impl std::error::Error for Statement {}

impl fmt::Display for Statement {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let (line, column) = (self.line, self.column);
        let message = format!("{}:{line}:{column}: {}", self.path.display(), self.message);
        let Some(excerpt) = &self.excerpt else {
            formatter.write_str(&message)?;
            return match &self.help {
                Some(help) => write!(formatter, "\n = help: {help}"),
                None => Ok(()),
            };
        };
        let snippet = Snippet::source(excerpt.text.as_str())
            .line_start(self.line)
            .annotation(AnnotationKind::Primary.span(excerpt.wrong.clone()));
        let title = Level::ERROR.no_name().primary_title(message.as_str());
        let mut group = Group::with_title(title).element(snippet);
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        // The renderer replaces only the control characters of ASCII. A terminal also obeys
        // those from U+0080 on.
        let text = Renderer::plain().render(&[group]);
        formatter.write_str(&super::names::printable_lines(&text))
    }
}

/// The operating system's reason, or a plainer one.
fn unreadable(path: &std::path::Path, source: &io::Error) -> String {
    if path.is_dir() {
        return "it is a directory: a file is needed".to_owned();
    }
    match source.kind() {
        io::ErrorKind::NotFound => "the file does not exist".to_owned(),
        _ => source.to_string(),
    }
}

fn encoding(path: &std::path::Path, line: u64, column: Option<usize>, utf16: bool) -> String {
    let place = match column {
        Some(column) => format!("{}:{line}:{column}", path.display()),
        None => format!("{}:{line}", path.display()),
    };
    let guess = if utf16 { " (it looks like UTF-16)" } else { "" };
    format!("{place}: the text is not UTF-8{guess}: save the file as UTF-8")
}

fn column_text(column: Option<&str>) -> String {
    column.map_or(String::new(), |name| {
        format!(" column {}:", super::names::quoted(name))
    })
}

fn help_text(help: Option<&str>) -> String {
    help.map_or(String::new(), |help| format!("; {help}"))
}
