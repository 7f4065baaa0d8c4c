//! The keys of what is drawn over a corner of a picture.

use glam::DVec3;
use toml::Spanned;

use super::colors::reflectance;
use super::error::SceneError;
use super::inset::{Corner, Inset};
use super::names::quoted;
use super::source::Source;
use super::values::{Number, Triple, vector};

/// Declares the keys of a table with those of an inset, which `inset_keys` returns. serde's own
/// `flatten` would lose the places of values and accept unknown keys.
macro_rules! with_inset_keys {
    (
        $(#[$attribute:meta])*
        $table:ident { $($field:ident: $type:ty,)* }
    ) => {
        $(#[$attribute])*
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $table {
            $($field: $type,)*
            corner: Option<toml::Spanned<String>>,
            size: Option<toml::Spanned<super::values::Number>>,
            color: Option<super::values::Triple>,
            background: Option<super::values::Triple>,
            opacity: Option<toml::Spanned<super::values::Number>>,
        }

        impl $table {
            /// The keys of the inset.
            pub fn inset_keys(&self) -> super::inset_keys::InsetKeys<'_> {
                super::inset_keys::InsetKeys {
                    corner: self.corner.as_ref(),
                    size: self.size.as_ref(),
                    color: self.color.as_ref(),
                    background: self.background.as_ref(),
                    opacity: self.opacity.as_ref(),
                }
            }
        }
    };
}
pub(super) use with_inset_keys;

/// The keys of an inset.
#[derive(Clone, Copy)]
pub(super) struct InsetKeys<'a> {
    pub corner: Option<&'a Spanned<String>>,
    pub size: Option<&'a Spanned<Number>>,
    pub color: Option<&'a Triple>,
    pub background: Option<&'a Triple>,
    pub opacity: Option<&'a Spanned<Number>>,
}

impl InsetKeys<'_> {
    /// The inset that the keys state, in a corner by default.
    pub fn inset(self, source: &Source, corner: Corner) -> Result<Inset, SceneError> {
        let stated = self.corner;
        let stated = stated.map(|word| source.choose("corner", word, &Corner::NAMES));
        Ok(Inset {
            corner: stated.transpose()?.unwrap_or(corner),
            size: number(source, self.size, "size", 0.03, [0.005, 0.2])?,
            color: color(source, self.color, DVec3::ZERO)?,
            background: color(source, self.background, DVec3::ONE)?,
            opacity: number(source, self.opacity, "opacity", 0.8, [0.0, 1.0])?,
        })
    }
}

/// A color with components in [0, 1].
pub(super) fn color(
    source: &Source,
    key: Option<&Triple>,
    default: DVec3,
) -> Result<DVec3, SceneError> {
    key.map_or(Ok(default), |triple| {
        reflectance(source, triple.span(), vector(triple))
    })
}

/// A number in a closed range.
pub(super) fn number(
    source: &Source,
    key: Option<&Spanned<Number>>,
    what: &str,
    default: f64,
    [least, greatest]: [f64; 2],
) -> Result<f64, SceneError> {
    let Some(key) = key else {
        return Ok(default);
    };
    let number = key.get_ref().0;
    match (least..=greatest).contains(&number) {
        true => Ok(number),
        false => Err(source.error(
            key.span(),
            format!("{what} is {number}: it must be between {least} and {greatest}"),
        )),
    }
}

/// Rejects two insets in one corner. Each has the name of its table, its corner and its keys.
pub(super) fn check_corners(
    source: &Source,
    insets: &[(&str, Corner, InsetKeys)],
) -> Result<(), SceneError> {
    for (number, (name, corner, keys)) in insets.iter().enumerate() {
        let before = insets[..number].iter();
        let Some((other, _, other_keys)) = before.clone().find(|(_, other, _)| other == corner)
        else {
            continue;
        };
        // The default corners differ, so one of the two is stated.
        let place = keys.corner.or(other_keys.corner);
        let place = place.map_or(0..0, Spanned::span);
        let taken: Vec<Corner> = insets.iter().map(|(_, corner, _)| *corner).collect();
        let free = Corner::NAMES
            .iter()
            .filter(|(_, corner)| !taken.contains(corner));
        let free: Vec<String> = free.map(|(name, _)| quoted(name)).collect();
        return Err(source.error_with_help(
            place,
            format!(
                "[{other}] and [{name}] are both in the corner {}",
                quoted(corner.name())
            ),
            format!("free corners: {}", free.join(", ")),
        ));
    }
    Ok(())
}
