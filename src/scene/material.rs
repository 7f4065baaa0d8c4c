//! How surfaces scatter and emit light, as a scene states it.

use std::sync::Arc;

use glam::DVec3;

use super::colors::{Checker, DataColor, Stripes, Texture};

/// How a surface scatters or emits light.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the scene file; empty for the default material.
    pub name: String,
    /// The reflectance, or the factor on what a material of another kind transmits or emits.
    pub color: Color,
    /// What the surface does with light.
    pub kind: MaterialKind,
}

impl Material {
    /// A diffuse material of one reflectance, linear RGB, each component in [0, 1].
    #[must_use]
    pub fn diffuse(name: impl Into<String>, color: DVec3) -> Self {
        Self {
            name: name.into(),
            color: Color::Constant(color),
            kind: MaterialKind::Diffuse,
        }
    }
}

/// The color of a surface, linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub enum Color {
    /// The same everywhere: each component in [0, 1].
    Constant(DVec3),
    /// A pattern of rectangles.
    Checker(Checker),
    /// A pattern of stripes.
    Stripes(Stripes),
    /// An image.
    Image(Arc<Texture>),
    /// Shows the value of a solid in a column.
    Data(DataColor),
}

impl Color {
    /// One color for uses that cannot show several: the mean of a pattern or an image, and the
    /// middle of a gradient.
    #[must_use]
    pub fn average(&self) -> DVec3 {
        match self {
            Self::Constant(color) => *color,
            Self::Checker(checker) => (checker.colors[0] + checker.colors[1]) / 2.0,
            Self::Stripes(stripes) => {
                stripes.colors.iter().sum::<DVec3>() / stripes.colors.len() as f64
            }
            Self::Image(image) => image.average(),
            Self::Data(data) => data.middle(),
        }
    }

    /// The column that it shows, if it shows one.
    #[must_use]
    pub fn column(&self) -> Option<&str> {
        match self {
            Self::Data(data) => Some(&data.column),
            Self::Constant(_) | Self::Checker(_) | Self::Stripes(_) | Self::Image(_) => None,
        }
    }
}

/// What a surface does with light.
///
/// A roughness is in [0, 1]: 0 is a mirror or clear glass, and the square of it is the width α of
/// the distribution of microfacets. An index of refraction is at least 1 and relative to the
/// surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MaterialKind {
    /// Scatters light equally in all directions.
    #[default]
    Diffuse,
    /// Reflects like a metal whose reflectance is the color where light comes in vertically.
    Metal {
        /// The roughness.
        roughness: f64,
    },
    /// A diffuse surface of the color under a clear coat.
    Plastic {
        /// The roughness of the coat.
        roughness: f64,
        /// The index of refraction of the coat.
        ior: f64,
    },
    /// Reflects and refracts, and filters what it transmits by the color.
    Glass {
        /// The roughness.
        roughness: f64,
        /// The index of refraction of the inside.
        ior: f64,
    },
    /// Emits light of the color and scatters none.
    Light {
        /// Factor on the color; the radiance, which is 0 or greater.
        strength: f64,
    },
}

impl MaterialKind {
    /// The names of the kinds in scene files.
    pub const NAMES: [&'static str; 5] = ["diffuse", "metal", "plastic", "glass", "light"];

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let [diffuse, metal, plastic, glass, light] = Self::NAMES;
        match self {
            Self::Diffuse => diffuse,
            Self::Metal { .. } => metal,
            Self::Plastic { .. } => plastic,
            Self::Glass { .. } => glass,
            Self::Light { .. } => light,
        }
    }
}
