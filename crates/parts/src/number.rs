//! The number of a part and its share of the work.

use std::fmt;
use std::num::NonZeroU64;
use std::ops::Range;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Most parts of a result.
pub const GREATEST_PARTS: u64 = 1_000_000;

/// Part `number` of `of`, from 1; written `3/16`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Stated", into = "Stated")]
pub struct PartNumber {
    number: NonZeroU64,
    of: NonZeroU64,
}

/// The numbers as a file has them.
#[derive(Serialize, Deserialize)]
struct Stated {
    part: u64,
    of: u64,
}

impl TryFrom<Stated> for PartNumber {
    type Error = String;

    fn try_from(Stated { part, of }: Stated) -> Result<Self, String> {
        Self::new(part, of).ok_or_else(|| format!("there is no part {part} of {of}"))
    }
}

impl From<PartNumber> for Stated {
    fn from(number: PartNumber) -> Self {
        Self {
            part: number.number(),
            of: number.of(),
        }
    }
}

impl PartNumber {
    /// Part `number` of `of`; `None` unless `1 <= number <= of <= GREATEST_PARTS`.
    #[must_use]
    pub fn new(number: u64, of: u64) -> Option<Self> {
        let (number, of) = (NonZeroU64::new(number)?, NonZeroU64::new(of)?);
        (number <= of && of.get() <= GREATEST_PARTS).then_some(Self { number, of })
    }

    /// The number of the part, from 1.
    #[must_use]
    pub fn number(self) -> u64 {
        self.number.get()
    }

    /// The number of all parts.
    #[must_use]
    pub fn of(self) -> u64 {
        self.of.get()
    }

    /// The part's range of `count` units: the ranges of all parts follow one another from 0 to
    /// `count`, and differ in length by at most 1. A range is empty where there are more parts
    /// than units.
    #[must_use]
    pub fn range(self, count: u64) -> Range<u64> {
        let before = |parts: u64| {
            let units = u128::from(count) * u128::from(parts) / u128::from(self.of());
            u64::try_from(units).expect("at most `count`")
        };
        before(self.number() - 1)..before(self.number())
    }
}

impl fmt::Display for PartNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for PartNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        numbers
            .and_then(|(number, of)| Self::new(number, of))
            .ok_or_else(|| {
                format!(
                    "it must be K/N, such as 3/16, with K from 1 to N and N at most {GREATEST_PARTS}"
                )
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_cover_the_work_once_and_evenly() {
        for (count, of) in [
            (0, 3),
            (1, 1),
            (2, 7),
            (3600, 7),
            (3600, 64),
            (u64::MAX, 1000),
        ] {
            let parts = (1..=of).map(|number| PartNumber::new(number, of).expect("valid"));
            let mut end = 0;
            for part in parts {
                let range = part.range(count);
                assert_eq!(range.start, end, "{part} of {count}");
                let length = range.end - range.start;
                assert!(length == count / of || length == count.div_ceil(of));
                end = range.end;
            }
            assert_eq!(end, count);
        }
    }

    #[test]
    fn number_read_back() {
        let part: PartNumber = "3/16".parse().expect("valid");
        assert_eq!((part.number(), part.of()), (3, 16));
        assert_eq!(part.to_string(), "3/16");
        for wrong in [
            "",
            "3",
            "0/4",
            "5/4",
            "1/0",
            "-1/4",
            "1/4/4",
            "1/1000001",
            "a/b",
        ] {
            let message = wrong.parse::<PartNumber>().expect_err(wrong);
            assert!(message.contains("K/N"), "{message}");
        }
    }

    #[test]
    fn number_in_a_file_is_one_that_can_be() {
        let read = |text: &str| serde_json::from_str::<PartNumber>(text).ok();
        let part = read(r#"{"part":3,"of":16}"#).expect("valid");
        let written = serde_json::to_string(&part).expect("numbers");
        assert_eq!(written, r#"{"part":3,"of":16}"#);
        for wrong in [
            r#"{"part":0,"of":1}"#,
            r#"{"part":5,"of":4}"#,
            r#"{"part":1,"of":18446744073709551615}"#,
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
