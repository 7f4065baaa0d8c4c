//! The groups of rows that a figure marks alike.

use cyltrace_output::{Mark, Series, Symbol};

/// Rows of type `R` that have one symbol in a figure.
pub struct Group<R> {
    /// The name in the legend.
    pub name: &'static str,
    pub symbol: Symbol,
    /// Whether a curve joins the marks.
    pub is_curve: bool,
    /// Whether a row is of the group.
    pub contains: fn(&R) -> bool,
}

impl<R> Group<R> {
    /// The marks of the group's rows; a row without a mark is left out.
    pub fn series<'r>(
        &self,
        rows: impl Iterator<Item = &'r R>,
        mark: impl Fn(&R) -> Option<Mark>,
    ) -> Series
    where
        R: 'r,
    {
        let rows = rows.filter(|row| (self.contains)(row));
        Series {
            name: self.name.to_owned(),
            symbol: self.symbol,
            is_curve: self.is_curve,
            marks: rows.filter_map(mark).collect(),
        }
    }
}
