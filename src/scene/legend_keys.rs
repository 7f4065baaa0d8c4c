//! `[legend]` of a scene file.

use toml::Spanned;

use super::error::SceneError;
use super::inset::Corner;
use super::inset_keys::with_inset_keys;
use super::legend::Legend;
use super::material::Color;
use super::materials::Materials;
use super::names::quoted;
use super::source::Source;

with_inset_keys! {
    /// `[legend]`
    LegendKeys {
        material: Spanned<String>,
        title: Option<String>,
    }
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
        Ok(Legend {
            material,
            title: self.title.clone().unwrap_or_else(|| data.column.clone()),
            inset: self.inset_keys().inset(source, Corner::BottomRight)?,
        })
    }
}
