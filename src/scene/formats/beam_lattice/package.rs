//! The parts of a 3MF file: `_rels/.rels` names the part with the model, an XML text.

use std::path::PathBuf;

use roxmltree::{Document, ParsingOptions};
use toml::Spanned;

use super::archive::Package;
use super::limits;
use crate::scene::error::SceneError;
use crate::scene::limits::MOST_XML_NODES;
use crate::scene::names::printable;
use crate::scene::source::Source;

const RELATIONSHIPS: &str = "_rels/.rels";
/// The type of the relationship that names the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// A part of the file.
pub(super) struct Part {
    /// The archive's path, followed by the part's.
    pub path: PathBuf,
    pub text: String,
}

/// Reads the model of a 3MF file named in a scene file.
pub(super) fn model_part(source: &Source, file: &Spanned<String>) -> Result<Part, SceneError> {
    let mut package = Package::open(source, file)?;
    let relationships = package.read(RELATIONSHIPS)?;
    let document = parsed(&relationships)?;
    let model = document
        .descendants()
        .filter(|node| {
            node.has_tag_name((
                "http://schemas.openxmlformats.org/package/2006/relationships",
                "Relationship",
            ))
        })
        .find(|node| node.attribute("Type") == Some(MODEL))
        .and_then(|node| node.attribute("Target"));
    let Some(model) = model else {
        return Err(package.error(format!("{RELATIONSHIPS} names no 3D model")));
    };
    package.read(model.trim_start_matches('/'))
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
