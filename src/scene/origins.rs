//! The source files of solids and placements, for messages about single ones.

use std::sync::Arc;

/// The source files of a prototype's entries, in runs of consecutive numbers.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    runs: Vec<Run>,
}

/// The entries of one file.
#[derive(Clone, Debug)]
struct Run {
    first: u32,
    file: Arc<str>,
    /// The row of the first, from 0, where each row is an entry, including skipped rows.
    first_row: Option<u32>,
    count: u32,
}

/// The source of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin<'a> {
    /// The file, as the scene file names it.
    pub file: &'a str,
    /// The number of the row, from 1 without the header, if the file is a table.
    pub row: Option<u32>,
}

impl Origins {
    /// Adds the entries of a file, from `first` up to but not including `end`; in a table,
    /// from the row `first_row` on.
    pub(super) fn add(&mut self, file: Arc<str>, first_row: Option<u32>, first: u32, end: u32) {
        self.runs.push(Run {
            first,
            file,
            first_row,
            count: end - first,
        });
    }

    /// The source of the entry with this number; `None` if it is in the scene file itself.
    #[must_use]
    pub fn of(&self, number: u32) -> Option<Origin<'_>> {
        let mut runs = self.runs.iter();
        let run = runs.find(|run| (run.first..run.first + run.count).contains(&number))?;
        Some(Origin {
            file: &run.file,
            row: run.first_row.map(|row| row + (number - run.first) + 1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_have_the_rows_of_their_table() {
        let mut origins = Origins::default();
        origins.add("twigs.csv".into(), Some(0), 2, 5);
        origins.add("cell.swc".into(), None, 5, 9);
        origins.add("twigs.csv".into(), Some(3), 20, 22);
        assert_eq!(origins.of(1), None);
        let row = |file, row| Some(Origin { file, row });
        assert_eq!(origins.of(2), row("twigs.csv", Some(1)));
        assert_eq!(origins.of(4), row("twigs.csv", Some(3)));
        assert_eq!(origins.of(5), row("cell.swc", None));
        assert_eq!(origins.of(9), None);
        assert_eq!(origins.of(21), row("twigs.csv", Some(5)));
    }
}
