//! The delimiter and decimal separator of a table, given by the user or detected in its
//! first lines.

use std::str::FromStr;

/// The delimiter between the cells of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab.
    Tab,
    /// One or more spaces or tabs.
    Blanks,
}

/// The decimal separator of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decimal {
    /// `1.5`
    #[default]
    Point,
    /// `1,5`
    Comma,
}

/// The format of a table as given by the user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableFormat {
    /// The delimiter; `None` detects it in the table's first lines.
    pub delimiter: Option<Delimiter>,
    /// The decimal separator.
    pub decimal: Decimal,
}

impl Delimiter {
    /// The values that a user may write, each with its meaning.
    pub const NAMES: [(&str, Self); 8] = [
        (",", Self::Comma),
        (";", Self::Semicolon),
        ("\t", Self::Tab),
        (" ", Self::Blanks),
        ("comma", Self::Comma),
        ("semicolon", Self::Semicolon),
        ("tab", Self::Tab),
        ("blanks", Self::Blanks),
    ];

    /// The byte between two cells; `None` for runs of blanks.
    pub(super) fn byte(self) -> Option<u8> {
        match self {
            Self::Comma => Some(b','),
            Self::Semicolon => Some(b';'),
            Self::Tab => Some(b'\t'),
            Self::Blanks => None,
        }
    }
}

impl Decimal {
    /// The values that a user may write, each with its meaning.
    pub const NAMES: [(&str, Self); 4] = [
        (".", Self::Point),
        (",", Self::Comma),
        ("point", Self::Point),
        ("comma", Self::Comma),
    ];
}

impl FromStr for Delimiter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        named(text, &Self::NAMES).ok_or_else(|| {
            "it must be comma, semicolon, tab or blanks, or the character itself".to_owned()
        })
    }
}

impl FromStr for Decimal {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        named(text, &Self::NAMES).ok_or_else(|| "it must be point or comma".to_owned())
    }
}

fn named<T: Copy>(text: &str, names: &[(&str, T)]) -> Option<T> {
    let found = names.iter().find(|(name, _)| *name == text);
    found.map(|(_, meaning)| *meaning)
}

/// The delimiter in a first line such as `sep=;`, a convention of Excel.
pub(super) fn stated_in(line: &str) -> Option<Delimiter> {
    let line = line.trim_matches([' ', '"']);
    let stated = line.strip_prefix("sep=")?;
    named(stated, &Delimiter::NAMES)
}

/// The delimiter of a line of names: the most frequent of comma, semicolon and tab outside
/// quotes, the first of these on a tie, and blanks if the line contains none of them.
pub(in crate::scene) fn of_names(line: &[u8]) -> Delimiter {
    most_frequent(
        line,
        [Delimiter::Comma, Delimiter::Semicolon, Delimiter::Tab],
    )
}

/// The delimiter of a line of numbers. With decimal commas, a comma is the delimiter only if
/// the line contains no other.
pub(super) fn of_numbers(line: &[u8], decimal: Decimal) -> Delimiter {
    match decimal {
        Decimal::Point => of_names(line),
        Decimal::Comma => {
            let without = most_frequent(line, [Delimiter::Semicolon, Delimiter::Tab]);
            match without == Delimiter::Blanks && !line.trim_ascii().contains(&b' ') {
                true => of_names(line),
                false => without,
            }
        }
    }
}

fn most_frequent<const N: usize>(line: &[u8], candidates: [Delimiter; N]) -> Delimiter {
    let mut counts = [0; N];
    let mut in_quotes = false;
    for &byte in line.trim_ascii() {
        in_quotes ^= byte == b'"';
        for (count, delimiter) in counts.iter_mut().zip(candidates) {
            *count += usize::from(!in_quotes && delimiter.byte() == Some(byte));
        }
    }
    let mut best = (0, Delimiter::Blanks);
    for (count, delimiter) in counts.into_iter().zip(candidates) {
        if count > best.0 {
            best = (count, delimiter);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delimiter_of_names_is_the_most_frequent_outside_quotes() {
        assert_eq!(of_names(b"x"), Delimiter::Blanks);
        assert_eq!(of_names(b"a;b,c;d"), Delimiter::Semicolon);
        assert_eq!(of_names(b"a;b,c"), Delimiter::Comma);
        assert_eq!(of_names(b"\"a;b;c\",d"), Delimiter::Comma);
        assert_eq!(of_names(b"a\tb c"), Delimiter::Tab);
        assert_eq!(of_names(b"  a   b\t"), Delimiter::Blanks);
    }

    #[test]
    fn decimal_comma_is_a_delimiter_only_without_another() {
        let of = |line: &[u8]| of_numbers(line, Decimal::Comma);
        assert_eq!(of(b"1,5;2,5"), Delimiter::Semicolon);
        assert_eq!(of(b"1,5 2,5"), Delimiter::Blanks);
        assert_eq!(of(b"1,5\t2,5"), Delimiter::Tab);
        assert_eq!(of(b"\"1,5\",\"2,5\""), Delimiter::Comma);
        assert_eq!(of_numbers(b"1.5,2.5", Decimal::Point), Delimiter::Comma);
    }
}
