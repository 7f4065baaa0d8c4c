//! The kinds of materials, and the numbers that materials of a kind have.

use std::ops::RangeInclusive;

use toml::Spanned;

use super::error::SceneError;
use super::material::MaterialKind;
use super::names::quoted;
use super::source::Source;
use super::values::Number;

/// Every kind, with the default values of its numbers.
const KINDS: [MaterialKind; 5] = [
    MaterialKind::Diffuse,
    MaterialKind::Metal { roughness: 0.3 },
    MaterialKind::Plastic {
        roughness: 0.2,
        ior: 1.5,
    },
    MaterialKind::Glass {
        roughness: 0.0,
        ior: 1.5,
    },
    MaterialKind::Light { strength: 1.0 },
];

/// The keys of the numbers, and the values that are accepted.
const NUMBERS: [(&str, RangeInclusive<f64>); 3] = [
    ("roughness", 0.0..=1.0),
    ("ior", 1.0..=10.0),
    ("strength", 0.0..=f64::INFINITY),
];

/// The numbers of a material, as stated.
pub(super) struct KindNumbers<'a> {
    pub roughness: Option<&'a Spanned<Number>>,
    pub ior: Option<&'a Spanned<Number>>,
    pub strength: Option<&'a Spanned<Number>>,
}

/// A number that a kind of material cannot have.
struct WrongNumber {
    /// The position of the number among roughness, index of refraction and strength.
    number: usize,
    message: String,
}

impl MaterialKind {
    /// The kind with the stated numbers: roughness, index of refraction and strength.
    fn with_numbers(mut self, stated: [Option<f64>; 3]) -> Result<Self, WrongNumber> {
        for (number, value) in stated.into_iter().enumerate() {
            let Some(value) = value else {
                continue;
            };
            let (name, range) = &NUMBERS[number];
            let message = match &mut numbers(&mut self)[number] {
                Some(kept) if range.contains(&value) && value.is_finite() => {
                    **kept = value;
                    continue;
                }
                Some(_) => {
                    let accepted = match range.end().is_finite() {
                        true => format!("be between {} and {}", range.start(), range.end()),
                        false if value < 0.0 => "not be negative".to_owned(),
                        false => "be finite".to_owned(),
                    };
                    format!("{name} is {value}: it must {accepted}")
                }
                None => format!(
                    "{name} is for {}: this material is {}",
                    kinds_with(number),
                    quoted(self.name())
                ),
            };
            return Err(WrongNumber { number, message });
        }
        Ok(self)
    }
}

/// The kind of a material with its numbers.
pub(super) fn kind(
    source: &Source,
    word: Option<&Spanned<String>>,
    stated: &KindNumbers,
) -> Result<MaterialKind, SceneError> {
    let kind = match word {
        None => MaterialKind::default(),
        Some(word) => source.choose("kind", word, &KINDS.map(|kind| (kind.name(), kind)))?,
    };
    let keys = [stated.roughness, stated.ior, stated.strength];
    let with_numbers = kind.with_numbers(keys.map(|key| Some(key?.get_ref().0)));
    with_numbers.map_err(|error| {
        let place = keys[error.number].map_or(0..0, Spanned::span);
        source.error(place, error.message)
    })
}

/// The numbers of a kind with their keys, for saving.
pub(super) fn keys_of(mut kind: MaterialKind) -> impl Iterator<Item = (&'static str, f64)> {
    let values = numbers(&mut kind).map(|value| value.copied());
    let keys = NUMBERS.map(|(name, _)| name);
    keys.into_iter()
        .zip(values)
        .filter_map(|(name, value)| Some((name, value?)))
}

/// The numbers that a kind has, in the order of [`NUMBERS`].
fn numbers(kind: &mut MaterialKind) -> [Option<&mut f64>; 3] {
    match kind {
        MaterialKind::Diffuse => [None, None, None],
        MaterialKind::Metal { roughness } => [Some(roughness), None, None],
        MaterialKind::Plastic { roughness, ior } | MaterialKind::Glass { roughness, ior } => {
            [Some(roughness), Some(ior), None]
        }
        MaterialKind::Light { strength } => [None, None, Some(strength)],
    }
}

/// The kinds that have a number, as a list of words.
fn kinds_with(index: usize) -> String {
    let has_it = |kind: &MaterialKind| numbers(&mut kind.clone())[index].is_some();
    let names: Vec<String> = KINDS
        .iter()
        .filter(|kind| has_it(kind))
        .map(|kind| quoted(kind.name()))
        .collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}
