//! How surfaces scatter and emit light, as a scene states it.

use glam::DVec3;

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
}

impl Color {
    /// One color for uses that cannot show several.
    #[must_use]
    pub fn average(&self) -> DVec3 {
        match self {
            Self::Constant(color) => *color,
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
