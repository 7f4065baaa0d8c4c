//! The types of values in a scene file. They are validated while they are read, so that an
//! error points at the value itself.
//!
//! serde's own types are too lenient: derived structs also accept arrays, arrays ignore
//! extra elements, and floats may be NaN.

use std::fmt;
use std::marker::PhantomData;

use glam::DVec3;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::table::ColumnKey;

/// A finite number, with or without decimals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number(pub f64);

/// A whole number, 0 or more.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole(pub u64);

/// An array of exactly `N` values.
#[derive(Clone, Copy, Debug)]
pub(super) struct List<T, const N: usize>(pub [T; N]);

/// A number, or an array of exactly `N` numbers.
#[derive(Clone, Copy, Debug)]
pub(super) enum NumberOrList<const N: usize> {
    One(f64),
    Many([f64; N]),
}

/// A column, or an array of exactly `N` columns.
#[derive(Clone, Debug)]
pub(super) enum ColumnOrList<const N: usize> {
    One(ColumnKey),
    Many([ColumnKey; N]),
}

/// A TOML table with the keys of `T` and no others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keys<T>(pub T);

/// Three numbers with their place.
pub(super) type Triple = Spanned<List<Number, 3>>;

/// Three columns, each with its place.
pub(super) type ThreeColumns = List<Spanned<ColumnKey>, 3>;

/// The three numbers of a key.
pub(super) fn vector(triple: &Triple) -> DVec3 {
    DVec3::from(triple.get_ref().0.map(|number| number.0))
}

/// Rejects numbers that are not finite, for all number types.
fn finite<E: Error>(number: f64) -> Result<f64, E> {
    if number.is_finite() {
        Ok(number)
    } else {
        Err(E::custom(format!(
            "the number is {number}: it must be finite"
        )))
    }
}

/// Exactly `N` elements, or an error that gives their number.
fn exactly<'de, T, A, const N: usize>(
    mut elements: A,
    expected: &dyn serde::de::Expected,
) -> Result<[T; N], A::Error>
where
    T: Deserialize<'de>,
    A: SeqAccess<'de>,
{
    let mut found = Vec::with_capacity(N);
    while found.len() < N {
        match elements.next_element()? {
            Some(element) => found.push(element),
            None => return Err(A::Error::invalid_length(found.len(), expected)),
        }
    }
    let mut length = N;
    while elements.next_element::<serde::de::IgnoredAny>()?.is_some() {
        length += 1;
    }
    found
        .try_into()
        .ok()
        .filter(|_| length == N)
        .ok_or_else(|| A::Error::invalid_length(length, expected))
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a number")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                finite(value).map(Number)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                Ok(Number(value as f64))
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Number, E> {
                Ok(Number(value as f64))
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WholeVisitor;
        impl Visitor<'_> for WholeVisitor {
            type Value = Whole;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a whole number, 0 or more")
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Whole, E> {
                u64::try_from(value)
                    .map(Whole)
                    .map_err(|_| E::invalid_value(serde::de::Unexpected::Signed(value), &self))
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Whole, E> {
                Ok(Whole(value))
            }
        }
        deserializer.deserialize_any(WholeVisitor)
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for List<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListVisitor<T, const N: usize>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for ListVisitor<T, N> {
            type Value = List<T, N>;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                write!(formatter, "an array of length {N}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Self::Value, A::Error> {
                exactly(elements, &self).map(List)
            }
        }
        deserializer.deserialize_any(ListVisitor(PhantomData))
    }
}

impl<'de, const N: usize> Deserialize<'de> for NumberOrList<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EitherVisitor<const N: usize>;
        impl<'de, const N: usize> Visitor<'de> for EitherVisitor<N> {
            type Value = NumberOrList<N>;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                write!(formatter, "a number or an array of {N} numbers")
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                finite(value).map(NumberOrList::One)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                Ok(NumberOrList::One(value as f64))
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
                Ok(NumberOrList::One(value as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Self::Value, A::Error> {
                let numbers: [Number; N] = exactly(elements, &self)?;
                Ok(NumberOrList::Many(numbers.map(|number| number.0)))
            }
        }
        deserializer.deserialize_any(EitherVisitor)
    }
}

/// The column with a number, from 0.
fn column<E: Error>(number: i64, expected: &dyn serde::de::Expected) -> Result<ColumnKey, E> {
    u64::try_from(number)
        .map(ColumnKey::Number)
        .map_err(|_| E::invalid_value(serde::de::Unexpected::Signed(number), expected))
}

impl<'de> Deserialize<'de> for ColumnKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColumnVisitor;
        impl Visitor<'_> for ColumnVisitor {
            type Value = ColumnKey;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("the name of a column, or its number from 0")
            }
            fn visit_str<E: Error>(self, value: &str) -> Result<ColumnKey, E> {
                Ok(value.into())
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<ColumnKey, E> {
                column(value, &self)
            }
        }
        deserializer.deserialize_any(ColumnVisitor)
    }
}

impl<'de, const N: usize> Deserialize<'de> for ColumnOrList<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ColumnsVisitor<const N: usize>;
        impl<'de, const N: usize> Visitor<'de> for ColumnsVisitor<N> {
            type Value = ColumnOrList<N>;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                write!(
                    formatter,
                    "the name of a column, its number from 0, or an array of {N} of these"
                )
            }
            fn visit_str<E: Error>(self, value: &str) -> Result<Self::Value, E> {
                Ok(ColumnOrList::One(value.into()))
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                column(value, &self).map(ColumnOrList::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<Self::Value, A::Error> {
                exactly(elements, &self).map(ColumnOrList::Many)
            }
        }
        deserializer.deserialize_any(ColumnsVisitor)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Keys<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeysVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for KeysVisitor<T> {
            type Value = Keys<T>;
            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a table of keys")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(Keys)
            }
        }
        deserializer.deserialize_any(KeysVisitor(PhantomData))
    }
}
