//! Tables for a terminal.

use std::fmt;

/// Rows of text under headings. Columns are as wide as they need to be; the
/// first ones are names and flush left, figures are flush right.
#[derive(Clone, Debug)]
pub struct Table {
    rows: Vec<Vec<String>>,
    names: usize,
}

impl Table {
    /// A table with these headings; the first `names` columns contain names.
    #[must_use]
    pub fn new(headings: &[&str], names: usize) -> Self {
        let headings = headings.iter().map(|&heading| heading.to_owned());
        Self {
            rows: vec![headings.collect()],
            names,
        }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If the number of its cells is not that of the headings.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(
            row.len(),
            self.rows[0].len(),
            "a row fills its table: {row:?}"
        );
        self.rows.push(row);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widths: Vec<usize> = (0..self.rows[0].len())
            .map(|column| {
                self.rows
                    .iter()
                    .map(|row| row[column].chars().count())
                    .max()
                    .unwrap_or(0)
            })
            .collect();
        for row in &self.rows {
            let mut line = String::new();
            for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
                let padded = if column < self.names {
                    format!("{cell:<width$}")
                } else {
                    format!("{cell:>width$}")
                };
                line.push_str(&padded);
                line.push_str("  ");
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// A figure in about three digits.
#[must_use]
pub fn figure(x: f64) -> String {
    match x.abs() {
        0.0 => String::from("0"),
        1e-3..1e4 => {
            let text = format!("{x:.4}");
            let short: String = text.chars().take(6).collect();
            short.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{x:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_aligns_names_left_and_figures_right() {
        let mut table = Table::new(&["name", "n"], 1);
        table.push(vec![String::from("a"), String::from("12")]);
        assert_eq!(table.to_string(), "name   n\na     12\n");
    }

    #[test]
    fn figures_are_short() {
        let shown = [0.0, 0.49951, 1234.5, 2e-8, 3.25e7, 1.0, 1000.0].map(figure);
        assert_eq!(
            shown,
            ["0", "0.4995", "1234.5", "2.0e-8", "3.2e7", "1", "1000"]
        );
    }
}
