//! What is behind the scene: a color, or nothing.

use std::fmt;

use glam::DVec3;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected, Visitor};
use toml::Spanned;

use super::error::SceneError;
use super::source::Source;
use super::values::{List, Number};

/// What camera rays see that miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// This linear RGB, if the scene has no sky.
    Color(DVec3),
    /// Nothing, not even the sky: pictures have opacity, the part of a pixel's samples that hit.
    Transparent,
}

impl Background {
    /// The background of a scene that states none.
    pub(super) const DEFAULT: Self = Self::Color(DVec3::new(0.8, 0.9, 1.0));
    /// How a scene file states [`Self::Transparent`].
    pub(super) const TRANSPARENT: &'static str = "transparent";

    /// The color, black if there is none.
    #[must_use]
    pub fn color(self) -> DVec3 {
        match self {
            Self::Color(color) => color,
            Self::Transparent => DVec3::ZERO,
        }
    }

    /// Whether pictures have opacity.
    #[must_use]
    pub fn is_transparent(self) -> bool {
        self == Self::Transparent
    }
}

/// `background` in a scene file.
#[derive(Clone, Copy, Debug)]
pub(super) struct BackgroundKey(Background);

impl<'de> Deserialize<'de> for BackgroundKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BackgroundVisitor;
        impl<'de> Visitor<'de> for BackgroundVisitor {
            type Value = BackgroundKey;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a color, an array of length 3, or \"transparent\"")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<BackgroundKey, E> {
                match text {
                    Background::TRANSPARENT => Ok(BackgroundKey(Background::Transparent)),
                    other => Err(E::invalid_value(Unexpected::Str(other), &self)),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<BackgroundKey, A::Error> {
                let color = List::<Number, 3>::deserialize(SeqAccessDeserializer::new(elements))?;
                let color = DVec3::from(color.0.map(|number| number.0));
                Ok(BackgroundKey(Background::Color(color)))
            }
        }
        deserializer.deserialize_any(BackgroundVisitor)
    }
}

/// The background of the scene file.
pub(super) fn background(
    source: &Source,
    key: Option<&Spanned<BackgroundKey>>,
) -> Result<Background, SceneError> {
    let Some(key) = key else {
        return Ok(Background::DEFAULT);
    };
    let BackgroundKey(background) = *key.get_ref();
    let color = background.color();
    if color.cmplt(DVec3::ZERO).any() {
        return Err(source.error(
            key.span(),
            format!(
                "the color is [{}, {}, {}]: a background's components must not be negative",
                color.x, color.y, color.z
            ),
        ));
    }
    Ok(background)
}
