//! A part of a 3MF file, and its XML.

use std::path::PathBuf;

use roxmltree::{Document, ParsingOptions};

use super::limits;
use crate::scene::error::SceneError;
use crate::scene::limits::MOST_XML_NODES;
use crate::scene::names::printable;

/// A part of the file.
pub(super) struct Part {
    /// The archive's path, followed by the part's.
    pub path: PathBuf,
    pub text: String,
}

/// Parses the XML of a part.
pub(super) fn parsed(part: &Part) -> Result<Document<'_>, SceneError> {
    let error = |line: u64, message| SceneError::Row {
        path: part.path.clone(),
        line,
        column: None,
        message,
        help: None,
    };
    limits::check(&part.text).map_err(|(at, message)| {
        let before = &part.text.as_bytes()[..at];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        error(line, message)
    })?;
    let options = ParsingOptions {
        nodes_limit: MOST_XML_NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(&part.text, options).map_err(|wrong| {
        let line = u64::from(wrong.pos().row);
        let wrong = printable(&wrong.to_string());
        error(line, format!("this is not valid XML: {wrong}"))
    })
}
