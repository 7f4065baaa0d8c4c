//! The types of values that the keys of a color accept.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use toml::Spanned;

use crate::scene::values::{List, Number, Triple, Whole};

/// The value of the key `color`, with its place.
pub(in crate::scene) type ColorKeys = Spanned<ColorKey>;

/// The keys of a color that is a table: exactly one of the first four, and others that
/// belong to it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct TableKeys {
    pub(super) checker: Option<List<Triple, 2>>,
    pub(super) stripes: Option<Spanned<Vec<Triple>>>,
    pub(super) image: Option<Spanned<String>>,
    pub(super) column: Option<Spanned<String>>,
    pub(super) count: Option<Spanned<CountKey>>,
    pub(super) along: Option<Spanned<String>>,
    pub(super) map: Option<Spanned<String>>,
    pub(super) range: Option<Spanned<RangeKey>>,
    pub(super) labels: Option<Spanned<Vec<String>>>,
    pub(super) missing: Option<Triple>,
}

/// The value of the key `color`.
pub(in crate::scene) enum ColorKey {
    Constant(List<Number, 3>),
    Table(Box<TableKeys>),
}

/// `count`: a whole number or two.
pub(super) enum CountKey {
    One(u64),
    Two([u64; 2]),
}

/// `range`: a word or two numbers.
pub(super) enum RangeKey {
    Word(String),
    Ends([f64; 2]),
}

/// Declares a type that is a value or a sequence.
macro_rules! value_or_sequence {
    ($type:ident $expecting:literal $($visit:item)*) => {
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct TypeVisitor;
                impl<'de> Visitor<'de> for TypeVisitor {
                    type Value = $type;
                    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                        formatter.write_str($expecting)
                    }
                    $($visit)*
                }
                deserializer.deserialize_any(TypeVisitor)
            }
        }
    };
}

/// The elements of a sequence.
fn elements<'de, T: Deserialize<'de>, A: SeqAccess<'de>>(sequence: A) -> Result<T, A::Error> {
    T::deserialize(SeqAccessDeserializer::new(sequence))
}

value_or_sequence! {
    ColorKey "a color [r, g, b], or a table with one of the keys checker, stripes, image and column"
    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<ColorKey, A::Error> {
        elements(sequence).map(ColorKey::Constant)
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ColorKey, A::Error> {
        TableKeys::deserialize(MapAccessDeserializer::new(map)).map(|keys| ColorKey::Table(Box::new(keys)))
    }
}

value_or_sequence! {
    CountKey "a whole number or two"
    fn visit_i64<E: Error>(self, count: i64) -> Result<CountKey, E> {
        // A negative number becomes 0, which is refused with its place.
        Ok(CountKey::One(u64::try_from(count).unwrap_or(0)))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<CountKey, A::Error> {
        let List(counts): List<Whole, 2> = elements(sequence)?;
        Ok(CountKey::Two(counts.map(|count| count.0)))
    }
}

value_or_sequence! {
    RangeKey "\"auto\" or two numbers"
    fn visit_str<E: Error>(self, word: &str) -> Result<RangeKey, E> {
        Ok(RangeKey::Word(word.to_owned()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<RangeKey, A::Error> {
        let List(ends): List<Number, 2> = elements(sequence)?;
        Ok(RangeKey::Ends(ends.map(|end| end.0)))
    }
}
