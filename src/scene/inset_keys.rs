//! The keys of what is drawn over a corner of a picture.

use glam::DVec3;
use toml::Spanned;

use super::colors::reflectance;
use super::error::SceneError;
use super::inset::{Corner, Inset};
use super::names::quoted;
use super::source::Source;
use super::values::{Number, Triple, vector};

/// The keys of an inset, which the tables of all kinds repeat.
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

/// Rejects two insets in one corner. Each has the name of its table and the key of its corner.
pub(super) fn check_corners(
    source: &Source,
    insets: &[(&str, Corner, Option<&Spanned<String>>)],
) -> Result<(), SceneError> {
    for (number, (name, corner, key)) in insets.iter().enumerate() {
        let before = insets[..number].iter();
        let Some((other, _, other_key)) = before.clone().find(|(_, other, _)| other == corner)
        else {
            continue;
        };
        // The default corners differ, so one of the two is stated.
        let place = key.or(*other_key).map_or(0..0, Spanned::span);
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
