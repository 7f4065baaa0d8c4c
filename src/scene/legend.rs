//! `[legend]`: what a picture shows of a data color, and where.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::colors::reflectance;
use super::error::SceneError;
use super::material::Color;
use super::materials::Materials;
use super::names::quoted;
use super::record::MaterialIndex;
use super::source::Source;
use super::values::{Number, Triple, vector};

/// The legend of a data color, which is drawn over the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The material whose color it explains, a [`Color::Data`].
    pub material: MaterialIndex,
    /// The line above it; none if empty.
    pub title: String,
    /// The corner of the picture that it is in.
    pub corner: Corner,
    /// The height of its text over the height of the picture, in [0.005, 0.2].
    pub size: f64,
    /// The color of its text, linear RGB, each component in [0, 1].
    pub color: DVec3,
    /// The color behind the text, linear RGB, each component in [0, 1].
    pub background: DVec3,
    /// The opacity of the color behind, in [0, 1].
    pub opacity: f64,
}

/// A corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Corner {
    TopLeft,
    TopRight,
    BottomLeft,
    BottomRight,
}

impl Corner {
    const NAMES: [(&'static str, Self); 4] = [
        ("top left", Self::TopLeft),
        ("top right", Self::TopRight),
        ("bottom left", Self::BottomLeft),
        ("bottom right", Self::BottomRight),
    ];

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let [top_left, top_right, bottom_left, bottom_right] = Self::NAMES.map(|(name, _)| name);
        match self {
            Self::TopLeft => top_left,
            Self::TopRight => top_right,
            Self::BottomLeft => bottom_left,
            Self::BottomRight => bottom_right,
        }
    }
}

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
