//! Why a scene cannot be loaded. Each error's `Display` is the whole message
//! for a user: where, which value, and what would be right.

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
        /// What the operating system says.
        source: io::Error,
    },
    /// A file of another kind is where a scene file is needed.
    #[error("{}: this is {what}; a scene is a TOML file{purpose}, such as:\n\n{example}", path.display())]
    NotAScene {
        /// The file.
        path: PathBuf,
        /// What it is.
        what: &'static str,
        /// What the scene file would do with it.
        purpose: &'static str,
        /// The lines of such a file.
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
        /// Whether the file starts as one in UTF-16 does.
        utf16: bool,
    },
    /// Something in the scene file is wrong.
    #[error(transparent)]
    Statement(Box<Statement>),
    /// Something in a row of a table, or in its header, is wrong.
    #[error("{}:{line}:{} {message}{}", path.display(), column_text(column.as_deref()), help_text(help.as_deref()))]
    Row {
        /// The table.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// The column's name, where one column is to blame.
        column: Option<String>,
        /// The value and what is wrong with it.
        message: String,
        /// What to do about it.
        help: Option<String>,
    },
}

impl SceneError {
    /// That `message` is true of a row of a table.
    pub(super) fn row(path: &Path, line: u64, message: impl Into<String>) -> Self {
        Self::Row {
            path: path.to_owned(),
            line,
            column: None,
            message: message.into(),
            help: None,
        }
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
    /// What to do about it.
    pub help: Option<String>,
    pub(super) excerpt: Option<Excerpt>,
}

/// The line of a wrong place, to be shown below the message.
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
        // The renderer replaces the controls of ASCII; a terminal obeys those from U+0080 on too.
        let text = Renderer::plain().render(&[group]);
        formatter.write_str(&super::names::printable_lines(&text))
    }
}

/// The operating system's reason, or a plainer one.
fn unreadable(path: &std::path::Path, source: &io::Error) -> String {
    if path.is_dir() {
        return "it is a directory, a file is needed".to_owned();
    }
    match source.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => source.to_string(),
    }
}

fn encoding(path: &std::path::Path, line: u64, column: Option<usize>, utf16: bool) -> String {
    let place = match column {
        Some(column) => format!("{}:{line}:{column}", path.display()),
        None => format!("{}:{line}", path.display()),
    };
    let now = if utf16 { ", it looks like UTF-16" } else { "" };
    format!("{place}: the text is not UTF-8{now}; save the file as UTF-8")
}

fn column_text(column: Option<&str>) -> String {
    column.map_or(String::new(), |name| {
        format!(" column {}:", super::names::quoted(name))
    })
}

fn help_text(help: Option<&str>) -> String {
    help.map_or(String::new(), |help| format!("; {help}"))
}
