//! Numbers in the cells of a table, and cells that mark a missing one.

use super::format::Decimal;
use crate::scene::limits::LONGEST_NUMBER;

/// Whether a cell marks a missing value, in the notation of pandas, R, Excel and others.
pub(super) fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 10] = [
        "", "na", "n/a", "#n/a", "<na>", "nan", "-nan", "+nan", "null", "none",
    ];
    cell.len() <= 4 && WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// The number in a cell, if it is one; NaN is not.
pub(in crate::scene) fn number_of(cell: &str, decimal: Decimal) -> Option<f64> {
    if cell.len() > LONGEST_NUMBER {
        return None;
    }
    let parsed: Option<f64> = match decimal {
        Decimal::Point => cell.parse().ok(),
        Decimal::Comma if cell.contains('.') => None,
        Decimal::Comma if cell.contains(',') => cell.replacen(',', ".", 1).parse().ok(),
        Decimal::Comma => cell.parse().ok(),
    };
    parsed.filter(|number| !number.is_nan())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_either_separator_and_words_for_missing_values() {
        let point = |cell: &str| number_of(cell, Decimal::Point);
        let comma = |cell: &str| number_of(cell, Decimal::Comma);
        assert_eq!(point("-2.5e-1"), Some(-0.25));
        assert_eq!(point("Inf"), Some(f64::INFINITY));
        assert_eq!(point("1,5"), None);
        assert_eq!(comma("1,5"), Some(1.5));
        assert_eq!(comma("-,5E2"), Some(-50.0));
        assert_eq!(comma("7"), Some(7.0));
        assert_eq!(comma("1.5"), None);
        assert_eq!(comma("1.234,5"), None);
        assert_eq!(comma("1,234,5"), None);
        assert_eq!(point(&"9".repeat(LONGEST_NUMBER + 1)), None);
        for word in [
            "", "NA", "nan", "NaN", "-nan", "N/A", "<NA>", "None", "NULL",
        ] {
            assert!(is_missing(word) && point(word).is_none(), "{word}");
        }
        assert!(!is_missing("0") && !is_missing("nano"));
    }
}
