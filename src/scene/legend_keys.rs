//! `[legend]` of a scene file.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::colors::reflectance;
use super::error::SceneError;
use super::legend::{Corner, Legend};
use super::material::Color;
use super::materials::Materials;
use super::names::quoted;
use super::source::Source;
use super::values::{Number, Triple, vector};

/// `[legend]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LegendKeys {
    material: Spanned<String>,
    title: Option<String>,
    corner: Option<Spanned<String>>,
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
        let corner = self.corner.as_ref();
        let corner = corner.map(|word| source.choose("corner", word, &Corner::NAMES));
        let color = |key: &Option<Triple>, default: DVec3| match key {
            None => Ok(default),
            Some(triple) => reflectance(source, triple.span(), vector(triple)),
        };
        let number = |key: &Option<Spanned<Number>>, what: &str, default: f64, range: [f64; 2]| {
            let Some(key) = key else {
                return Ok(default);
            };
            let number = key.get_ref().0;
            match (range[0]..=range[1]).contains(&number) {
                true => Ok(number),
                false => Err(source.error(
                    key.span(),
                    format!(
                        "{what} is {number}: it must be between {} and {}",
                        range[0], range[1]
                    ),
                )),
            }
        };
        Ok(Legend {
            material,
            title: self.title.clone().unwrap_or_else(|| data.column.clone()),
            corner: corner.transpose()?.unwrap_or(Corner::BottomRight),
            size: number(&self.size, "size", 0.03, [0.005, 0.2])?,
            color: color(&self.color, DVec3::ZERO)?,
            background: color(&self.background, DVec3::ONE)?,
            opacity: number(&self.opacity, "opacity", 0.8, [0.0, 1.0])?,
        })
    }
}
