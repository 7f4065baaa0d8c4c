//! The key `color` of a material: three numbers, or a table that describes a pattern, an image
//! or a column of data.

use std::sync::Arc;

use glam::DVec3;
use toml::Spanned;

use super::columns::check_name;
use super::data::{DataColor, MISSING};
use super::key_types::{ColorKey, ColorKeys, CountKey, RangeKey, TableKeys};
use super::map::ColorMap;
use super::pattern::{Along, Checker, Stripes};
use super::texture::{Texture, TextureError};
use crate::scene::error::SceneError;
use crate::scene::material::Color;
use crate::scene::names::{quoted, suggestion};
use crate::scene::source::Source;
use crate::scene::values::{List, Triple, vector};

/// What a table describes.
enum Kind<'k> {
    Checker(&'k List<Triple, 2>),
    Stripes(&'k Spanned<Vec<Triple>>),
    Image(&'k Spanned<String>),
    Data(&'k Spanned<String>),
}

impl Kind<'_> {
    fn name(&self) -> &'static str {
        match self {
            Self::Checker(_) => "checker",
            Self::Stripes(_) => "stripes",
            Self::Image(_) => "image",
            Self::Data(_) => "column",
        }
    }
}

impl ColorKey {
    /// The image file, if it names one.
    pub fn image(&self) -> Option<&Spanned<String>> {
        self.table().and_then(|keys| keys.image.as_ref())
    }

    /// The column, if it shows one.
    pub fn column(&self) -> Option<&Spanned<String>> {
        self.table().and_then(|keys| keys.column.as_ref())
    }

    /// The place of the labels.
    pub fn labels(&self) -> Option<&Spanned<Vec<String>>> {
        self.table().and_then(|keys| keys.labels.as_ref())
    }

    /// Whether the range follows from the values.
    pub fn has_automatic_range(&self) -> bool {
        let range = self.table().and_then(|keys| keys.range.as_ref());
        range.is_none_or(|range| matches!(range.get_ref(), RangeKey::Word(_)))
    }

    fn table(&self) -> Option<&TableKeys> {
        match self {
            Self::Constant(_) => None,
            Self::Table(keys) => Some(keys),
        }
    }
}

/// The color that keys describe. An automatic range is not known yet: it is that of no values.
pub(in crate::scene) fn color(source: &Source, keys: &ColorKeys) -> Result<Color, SceneError> {
    match keys.get_ref() {
        ColorKey::Constant(List(numbers)) => {
            let color = DVec3::from(numbers.map(|number| number.0));
            reflectance(source, keys.span(), color).map(Color::Constant)
        }
        ColorKey::Table(table) => table.color(source, keys.span()),
    }
}

/// A color, if each of its components is in [0, 1].
pub(in crate::scene) fn reflectance(
    source: &Source,
    place: std::ops::Range<usize>,
    color: DVec3,
) -> Result<DVec3, SceneError> {
    match (color.cmpge(DVec3::ZERO) & color.cmple(DVec3::ONE)).all() {
        true => Ok(color),
        false => Err(source.error(
            place,
            format!(
                "color is [{}, {}, {}]: its components must be in [0, 1]",
                color.x, color.y, color.z
            ),
        )),
    }
}

impl TableKeys {
    fn color(&self, source: &Source, place: std::ops::Range<usize>) -> Result<Color, SceneError> {
        let triple = |triple: &Triple| reflectance(source, triple.span(), vector(triple));
        let kind = self.kind(source, place)?;
        self.check_others(source, &kind)?;
        match kind {
            Kind::Checker(List([first, second])) => Ok(Color::Checker(Checker {
                colors: [triple(first)?, triple(second)?],
                count: self.counts(source)?,
            })),
            Kind::Stripes(stated) => {
                let colors = stated
                    .get_ref()
                    .iter()
                    .map(triple)
                    .collect::<Result<Vec<_>, _>>()?;
                let along = self.along.as_ref();
                let along = along.map(|word| source.choose("along", word, &Along::NAMES));
                Ok(Color::Stripes(Stripes {
                    count: self.count(source, stated)?,
                    colors,
                    along: along.transpose()?.unwrap_or(Along::V),
                }))
            }
            Kind::Image(file) => {
                let path = source.resolve(file.get_ref());
                let image = Texture::read(&path).map_err(|error| {
                    let message = format!("cannot read {}: {error}", path.display());
                    let help = match error {
                        TextureError::Unreadable(_) => {
                            "file names are relative to the folder of the scene file"
                        }
                        _ => "an image on a surface is an opaque PNG file",
                    };
                    source.error_with_help(file.span(), message, help)
                });
                Ok(Color::Image(Arc::new(image?)))
            }
            Kind::Data(column) => self.data(source, column).map(Color::Data),
        }
    }

    /// The one key that determines the others.
    fn kind(&self, source: &Source, place: std::ops::Range<usize>) -> Result<Kind<'_>, SceneError> {
        let checker = self.checker.as_ref().map(Kind::Checker);
        let stripes = self.stripes.as_ref().map(Kind::Stripes);
        let image = self.image.as_ref().map(Kind::Image);
        let data = self.column.as_ref().map(Kind::Data);
        let mut kinds = [checker, stripes, image, data].into_iter().flatten();
        match (kinds.next(), kinds.next()) {
            (Some(kind), None) => Ok(kind),
            _ => Err(source.error_with_help(
                place,
                "color must have exactly one of the keys checker, stripes, image and column",
                "color = [r, g, b] is the same everywhere",
            )),
        }
    }

    /// Rejects keys that belong to another kind.
    fn check_others(&self, source: &Source, kind: &Kind) -> Result<(), SceneError> {
        let name = kind.name();
        let span = |key: Option<std::ops::Range<usize>>, kinds: &[&str]| {
            key.filter(|_| !kinds.contains(&name))
        };
        let data = &["column"];
        let others = [
            (
                "count",
                span(
                    self.count.as_ref().map(Spanned::span),
                    &["checker", "stripes"],
                ),
            ),
            (
                "along",
                span(self.along.as_ref().map(Spanned::span), &["stripes"]),
            ),
            ("map", span(self.map.as_ref().map(Spanned::span), data)),
            ("range", span(self.range.as_ref().map(Spanned::span), data)),
            (
                "labels",
                span(self.labels.as_ref().map(Spanned::span), data),
            ),
            (
                "missing",
                span(self.missing.as_ref().map(Spanned::span), data),
            ),
        ];
        let other = others
            .into_iter()
            .find_map(|(key, place)| Some((key, place?)));
        other.map_or(Ok(()), |(key, place)| {
            Err(source.error(
                place,
                format!("a color with the key {name} has no key {key}"),
            ))
        })
    }

    /// The two counts of a checker.
    fn counts(&self, source: &Source) -> Result<[u32; 2], SceneError> {
        let Some(key) = &self.count else {
            return Ok([8, 8]);
        };
        let counts = match key.get_ref() {
            CountKey::Two(counts) => counts.map(|count| u32::try_from(count).unwrap_or(0)),
            CountKey::One(_) => [0; 2],
        };
        match counts.contains(&0) {
            false => Ok(counts),
            true => Err(source.error(
                key.span(),
                format!(
                    "count of a checker must be two whole numbers [nu, nv] from 1 to {}",
                    u32::MAX
                ),
            )),
        }
    }

    /// The count of stripes, by default one of each color.
    fn count(&self, source: &Source, colors: &Spanned<Vec<Triple>>) -> Result<u32, SceneError> {
        if colors.get_ref().is_empty() {
            let message = "stripes is empty: it needs at least one color";
            return Err(source.error(colors.span(), message));
        }
        let Some(key) = &self.count else {
            return Ok(u32::try_from(colors.get_ref().len()).unwrap_or(u32::MAX));
        };
        let count = match key.get_ref() {
            CountKey::One(count) => u32::try_from(*count).unwrap_or(0),
            CountKey::Two(_) => 0,
        };
        match count {
            0 => Err(source.error(
                key.span(),
                format!(
                    "count of stripes must be a whole number from 1 to {}",
                    u32::MAX
                ),
            )),
            count => Ok(count),
        }
    }

    fn data(&self, source: &Source, column: &Spanned<String>) -> Result<DataColor, SceneError> {
        check_name(source, column)?;
        let map = match &self.map {
            None => ColorMap::default(),
            Some(name) => ColorMap::named(name.get_ref()).ok_or_else(|| {
                let names = ColorMap::all().map(ColorMap::name);
                source.error_with_help(
                    name.span(),
                    format!("unknown color map {}", quoted(name.get_ref())),
                    suggestion(name.get_ref(), names, "color maps"),
                )
            })?,
        };
        let labels = self.labels(source)?;
        let missing = self.missing.as_ref();
        let missing = missing.map(|color| reflectance(source, color.span(), vector(color)));
        Ok(DataColor {
            column: column.get_ref().clone(),
            map,
            range: self.ends(source, map)?,
            labels,
            missing: missing.transpose()?.unwrap_or(MISSING),
        })
    }

    /// The labels. None looks like another cell of a table.
    fn labels(&self, source: &Source) -> Result<Vec<String>, SceneError> {
        let Some(labels) = &self.labels else {
            return Ok(Vec::new());
        };
        let is_label = |label: &&String| {
            label.trim() == label.as_str() && !label.is_empty() && label.parse::<f64>().is_err()
        };
        match labels.get_ref().iter().find(|label| !is_label(label)) {
            None => Ok(labels.get_ref().clone()),
            Some(label) => Err(source.error(
                labels.span(),
                format!(
                    "the label {} must not be empty or a number, or begin or end with blanks",
                    quoted(label)
                ),
            )),
        }
    }

    fn ends(&self, source: &Source, map: ColorMap) -> Result<[f64; 2], SceneError> {
        let Some(key) = &self.range else {
            return Ok(DataColor::automatic_range(None));
        };
        if map.has_categories() {
            let name = map.name();
            let message = format!("the color map {name} shows categories, which have no range");
            return Err(source.error(key.span(), message));
        }
        match key.get_ref() {
            RangeKey::Word(word) if word == "auto" => Ok(DataColor::automatic_range(None)),
            RangeKey::Word(word) => Err(source.error_with_help(
                key.span(),
                format!("{} is not a value of range", quoted(word)),
                "range is \"auto\" or [least, greatest]",
            )),
            RangeKey::Ends([first, last]) if first < last && (last - first).is_finite() => {
                Ok([*first, *last])
            }
            RangeKey::Ends([first, last]) => Err(source.error(
                key.span(),
                format!(
                    "range is [{first}, {last}]: the first number must be less than the second"
                ),
            )),
        }
    }
}
