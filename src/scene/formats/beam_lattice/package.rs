//! The parts of a 3MF file: `_rels/.rels` names the part with the model, an XML text.

use toml::Spanned;

use super::archive::Package;
use super::part::{Part, parsed};
use crate::scene::error::SceneError;
use crate::scene::source::Source;

const RELATIONSHIPS: &str = "_rels/.rels";
/// The type of the relationship that names the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

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
