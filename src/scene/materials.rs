//! The materials of a scene file.

use std::collections::HashMap;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::colors::{ColorKeys, color};
use super::defaults;
use super::error::SceneError;
use super::material::{Color, Material, MaterialKind};
use super::material_kinds::{self, KindNumbers};
use super::names::{quoted, suggestion};
use super::record::MaterialIndex;
use super::source::Source;
use super::values::{Keys, Number};

/// `[[material]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialKeys {
    pub name: Spanned<String>,
    pub kind: Option<Spanned<String>>,
    pub color: Option<ColorKeys>,
    pub roughness: Option<Spanned<Number>>,
    pub ior: Option<Spanned<Number>>,
    pub strength: Option<Spanned<Number>>,
}

impl MaterialKeys {
    /// Whether the surface scatters light equally in all directions.
    pub fn is_diffuse(&self) -> bool {
        let kind = self.kind.as_ref();
        kind.is_none_or(|kind| kind.get_ref() == MaterialKind::Diffuse.name())
    }
}

/// The materials of a scene and their names.
pub(super) struct Materials {
    pub list: Vec<Material>,
    index: HashMap<String, MaterialIndex>,
}

impl Materials {
    /// The default material and all `[[material]]`s.
    pub fn new(source: &Source, entries: &[Keys<MaterialKeys>]) -> Result<Self, SceneError> {
        let mut materials = Self {
            list: vec![defaults::material()],
            index: HashMap::new(),
        };
        check_names(
            source,
            "material",
            entries.iter().map(|Keys(keys)| &keys.name),
        )?;
        for Keys(keys) in entries {
            materials.add(source, keys)?;
        }
        Ok(materials)
    }

    fn add(&mut self, source: &Source, keys: &MaterialKeys) -> Result<(), SceneError> {
        let name = keys.name.get_ref();
        let numbers = KindNumbers {
            roughness: keys.roughness.as_ref(),
            ior: keys.ior.as_ref(),
            strength: keys.strength.as_ref(),
        };
        let kind = material_kinds::kind(source, keys.kind.as_ref(), &numbers)?;
        let color = color_of(source, keys, kind)?;
        let index = u16::try_from(self.list.len()).map_err(|_| {
            source.error(
                keys.name.span(),
                format!("a scene can contain at most {} materials", u16::MAX),
            )
        })?;
        self.index.insert(name.clone(), MaterialIndex(index));
        self.list.push(Material {
            name: name.clone(),
            color,
            kind,
        });
        Ok(())
    }

    /// The material of a name, or the default material without a name.
    pub fn find(
        &self,
        source: &Source,
        name: Option<&Spanned<String>>,
    ) -> Result<MaterialIndex, SceneError> {
        let Some(name) = name else {
            return Ok(MaterialIndex::default());
        };
        self.index.get(name.get_ref()).copied().ok_or_else(|| {
            let names = self.list[1..].iter().map(|material| material.name.as_str());
            source.error_with_help(
                name.span(),
                format!("unknown material {}", quoted(name.get_ref())),
                suggestion(name.get_ref(), names, "materials"),
            )
        })
    }
}

/// The color of a material. Glass and lights are white by default.
fn color_of(source: &Source, keys: &MaterialKeys, kind: MaterialKind) -> Result<Color, SceneError> {
    match (&keys.color, kind) {
        (Some(key), _) => color(source, key),
        (None, MaterialKind::Glass { .. } | MaterialKind::Light { .. }) => {
            Ok(Color::Constant(DVec3::ONE))
        }
        (None, _) => Err(source.error_with_help(
            keys.name.span(),
            format!("the material {} has no color", quoted(keys.name.get_ref())),
            "such as color = [0.8, 0.5, 0.2], from 0 to 1 in linear RGB",
        )),
    }
}

/// Checks that no name is empty and that names are unique.
pub(super) fn check_names<'n>(
    source: &Source,
    what: &str,
    names: impl Iterator<Item = &'n Spanned<String>>,
) -> Result<(), SceneError> {
    let mut lines = HashMap::new();
    for name in names {
        if name.get_ref().is_empty() {
            return Err(source.error(name.span(), format!("the name of a {what} is empty")));
        }
        if let Some(first) = lines.insert(name.get_ref(), name.span()) {
            return Err(source.error(
                name.span(),
                format!(
                    "the {what} {} is already defined on line {}: names must differ",
                    quoted(name.get_ref()),
                    source.line(&first)
                ),
            ));
        }
    }
    Ok(())
}
