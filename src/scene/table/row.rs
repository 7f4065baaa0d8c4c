//! A row of a table: reads its cells as numbers, and reports errors in them.

use std::path::Path;

use super::cells::Cells;
use super::format::Decimal;
use super::header::{Column, Layout};
use super::numbers::{is_missing, number_of};
use crate::scene::error::SceneError;
use crate::scene::limits::LONGEST_NUMBER;
use crate::scene::names::quoted;

/// A row that is being read.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    pub(super) layout: &'a Layout,
    pub(super) cells: Cells<'a>,
    /// The line on which the row begins, from 1.
    pub line: u64,
}

/// Why a row gives no value.
#[derive(Debug)]
pub enum Fault {
    /// The row is degenerate: a reader may skip it.
    Degenerate {
        /// The column at fault, if it is a single one.
        column: Option<Column>,
        /// What is wrong.
        message: String,
    },
    /// The row is wrong.
    Wrong(SceneError),
}

impl From<SceneError> for Fault {
    fn from(error: SceneError) -> Self {
        Self::Wrong(error)
    }
}

impl Row<'_> {
    /// The name of the table in errors.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.layout.path
    }

    /// A cell, without surrounding blanks and quotes.
    #[must_use]
    pub fn cell(&self, column: Column) -> &str {
        self.cells.get(column.0)
    }

    /// The finite number in a cell. A cell without a value makes the row degenerate.
    ///
    /// # Errors
    /// If the cell is empty or contains anything else.
    pub fn number(&self, column: Column) -> Result<f64, Fault> {
        let number = self.any_number(column)?;
        match number.is_finite() {
            true => Ok(number),
            false => Err(self.wrong(column, "is not a finite number").into()),
        }
    }

    /// The number in a cell, which may be infinite.
    ///
    /// # Errors
    /// If the cell is empty or contains anything else.
    pub fn any_number(&self, column: Column) -> Result<f64, Fault> {
        let cell = self.cell(column);
        if let Some(number) = number_of(cell, self.layout.decimal) {
            return Ok(number);
        }
        if is_missing(cell) {
            let message = match cell.is_empty() {
                true => "the cell is empty: a number is needed".to_owned(),
                false => format!("{} is not a finite number", quoted(cell)),
            };
            return Err(Fault::Degenerate {
                column: Some(column),
                message,
            });
        }
        if cell.len() > LONGEST_NUMBER {
            let length = cell.len();
            let message = format!(
                "is not a number: the cell has {length} bytes, but a number may have at most {LONGEST_NUMBER}"
            );
            return Err(self.wrong(column, &message).into());
        }
        let other = match self.layout.decimal {
            Decimal::Point => Decimal::Comma,
            Decimal::Comma => Decimal::Point,
        };
        Err(match (number_of(cell, other), other) {
            (None, Decimal::Comma) => self.wrong(column, "is not a number (such as 1.5 or 2e-3)"),
            (None, Decimal::Point) => self.wrong(column, "is not a number (such as 1,5 or 2e-3)"),
            (Some(_), Decimal::Comma) => self.error_with_help(
                Some(column),
                format!("{} is not a number (such as 1.5 or 2e-3)", quoted(cell)),
                Some("for decimal commas, set decimal = \",\" in the scene file or use --decimal comma"),
            ),
            (Some(_), Decimal::Point) => self.error_with_help(
                Some(column),
                format!(
                    "{} is not a number with a decimal comma (such as 1,5)",
                    quoted(cell)
                ),
                Some("for decimal points, remove decimal = \",\" or --decimal comma"),
            ),
        }
        .into())
    }

    /// The finite numbers in some cells.
    ///
    /// # Errors
    /// See [`Row::number`].
    pub fn numbers<const N: usize>(&self, columns: [Column; N]) -> Result<[f64; N], Fault> {
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(column)?;
        }
        Ok(numbers)
    }

    /// A flag: `true`, `false`, `1`, `0` or another number of these values.
    #[must_use]
    pub fn flag(&self, column: Column) -> Option<bool> {
        let cell = self.cell(column);
        if cell.eq_ignore_ascii_case("true") {
            return Some(true);
        }
        if cell.eq_ignore_ascii_case("false") {
            return Some(false);
        }
        let number = number_of(cell, self.layout.decimal)?;
        (number == 0.0 || number == 1.0).then_some(number == 1.0)
    }

    /// The error of a cell: its text, followed by `message`.
    fn wrong(&self, column: Column, message: &str) -> SceneError {
        let text = format!("{} {message}", quoted(self.cell(column)));
        self.error(Some(column), text)
    }

    /// An error in the row, or in one of its cells.
    pub fn error(&self, column: Option<Column>, message: impl Into<String>) -> SceneError {
        self.error_with_help(column, message, None)
    }

    /// As [`Row::error`], with advice.
    pub fn error_with_help(
        &self,
        column: Option<Column>,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        SceneError::Row {
            path: self.layout.path.clone(),
            line: self.line,
            column: column.map(|column| self.layout.name(column)),
            message: message.into(),
            help: help.map(str::to_owned),
        }
    }

    /// The error of a fault if no row may be skipped.
    #[must_use]
    pub fn refused(&self, fault: Fault) -> SceneError {
        self.refused_with_help(fault, None)
    }

    /// As [`Row::refused`], with advice for a degenerate row.
    #[must_use]
    pub fn refused_with_help(&self, fault: Fault, help: Option<&str>) -> SceneError {
        match fault {
            Fault::Wrong(error) => error,
            Fault::Degenerate { column, message } => self.error_with_help(column, message, help),
        }
    }
}
