//! `[legend]` of a scene file.

use serde::Deserialize;
use toml::Spanned;

use super::error::SceneError;
use super::inset::Corner;
use super::inset_keys::InsetKeys;
use super::legend::Legend;
use super::material::Color;
use super::materials::Materials;
use super::names::quoted;
use super::source::Source;
use super::values::{Number, Triple};

/// `[legend]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LegendKeys {
    material: Spanned<String>,
    title: Option<String>,
    pub corner: Option<Spanned<String>>,
    size: Option<Spanned<Number>>,
    color: Option<Triple>,
    background: Option<Triple>,
    opacity: Option<Spanned<Number>>,
}

impl LegendKeys {
    /// The legend that the keys state.
    pub fn legend(&self, source: &Source, materials: &Materials) -> Result<Legend, SceneError> {
        let material = materials.find(source, Some(&self.material))?;
        let name = self.material.get_ref();
        let Color::Data(data) = &materials.list[usize::from(material.0)].color else {
            return Err(source.error_with_help(
                self.material.span(),
                format!("the color of the material {} shows no data", quoted(name)),
                "color = { column = \"NAME\" } shows the values of a column",
            ));
        };
        let keys = InsetKeys {
            corner: self.corner.as_ref(),
            size: self.size.as_ref(),
            color: self.color.as_ref(),
            background: self.background.as_ref(),
            opacity: self.opacity.as_ref(),
        };
        Ok(Legend {
            material,
            title: self.title.clone().unwrap_or_else(|| data.column.clone()),
            inset: keys.inset(source, Corner::BottomRight)?,
        })
    }
}
