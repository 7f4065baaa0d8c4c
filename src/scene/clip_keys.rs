//! `[[clip]]` of a scene file.

use serde::Deserialize;
use toml::Spanned;

use super::clip::Clip;
use super::error::SceneError;
use super::material::{Color, MaterialKind};
use super::materials::Materials;
use super::names::quoted;
use super::point::point;
use super::record::MaterialIndex;
use super::source::Source;
use super::values::{Keys, Triple, vector};
use crate::math::unit_or_same;

/// `[[clip]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClipKeys {
    point: Triple,
    normal: Triple,
    material: Option<Spanned<String>>,
    #[serde(default = "casts_shadows")]
    shadows: bool,
}

fn casts_shadows() -> bool {
    true
}

/// The planes that the tables state.
pub(super) fn clips(
    source: &Source,
    materials: &Materials,
    tables: &[Keys<ClipKeys>],
) -> Result<Vec<Clip>, SceneError> {
    let clip = |Keys(keys): &Keys<ClipKeys>| {
        let normal = unit_or_same(vector(&keys.normal)).ok_or_else(|| {
            source.error_with_help(
                keys.normal.span(),
                "normal is zero: it must point to what the plane removes",
                "normal = [0, 0, 1] removes what is above point",
            )
        })?;
        Ok(Clip {
            point: point(source, "point", &keys.point)?,
            normal,
            material: material(source, materials, keys.material.as_ref())?,
            casts_shadows: keys.shadows,
        })
    };
    tables.iter().map(clip).collect()
}

/// The material of cut faces, which have no coordinates and no values of solids.
fn material(
    source: &Source,
    materials: &Materials,
    name: Option<&Spanned<String>>,
) -> Result<Option<MaterialIndex>, SceneError> {
    let Some(name) = name else {
        return Ok(None);
    };
    let index = materials.find(source, Some(name))?;
    let material = &materials.list[usize::from(index.0)];
    if let MaterialKind::Glass { .. } = material.kind {
        return Err(source.error_with_help(
            name.span(),
            format!(
                "the material {} is glass, which only whole solids are of",
                quoted(name.get_ref())
            ),
            "without material, each cut face has the material of its solid",
        ));
    }
    match material.color {
        Color::Constant(_) => Ok(Some(index)),
        _ => Err(source.error_with_help(
            name.span(),
            format!(
                "the material {} has not the same color everywhere, which cut faces need",
                quoted(name.get_ref())
            ),
            "without material, each cut face has the material of its solid",
        )),
    }
}
