//! Cylinders from the rows of a table.

use glam::DVec3;
use toml::Spanned;

use super::document::ThreeNames;
use super::error::SceneError;
use super::gathered::{Degenerate, Gathered, Look, SKIP_HELP, is_degenerate};
use super::solid_keys::{CylinderColumns, CylinderTableKeys};
use super::source::Source;
use super::table::{Column, Table};
use super::values::Keys;
use crate::math::unit;
use crate::solid::{Caps, Cylinder, CylinderError};

/// Adds the rows of a `[[cylinder_table]]`.
pub(super) fn add_table(
    solids: &mut Gathered,
    source: &Source,
    keys: &CylinderTableKeys,
    look: Look,
    degenerate: Degenerate,
) -> Result<(), SceneError> {
    let mut table = Table::open(source, &keys.file)?;
    let layout = Layout::new(source, &table, &keys.columns)?;
    let before = solids.numbers();
    solids.records.reserve(table.most_rows());
    while table.next_row()? {
        match layout.cylinder(&table, look.caps)? {
            Ok(cylinder) => solids.push(&cylinder, look.material),
            Err(fault) if degenerate == Degenerate::Error => {
                return Err(table.row_error_with_help(
                    fault.column,
                    fault.message,
                    Some(SKIP_HELP),
                ));
            }
            Err(_) => solids.skip(),
        }
        .map_err(|refusal| {
            refusal.in_row(source, &keys.file, |message, help| {
                table.row_error_with_help(None, message, help)
            })
        })?;
    }
    if solids.numbers() == before {
        return Err(source.error(keys.file.span(), "the table has a header but no rows"));
    }
    Ok(())
}

/// Where a cylinder's numbers stand in a row.
struct Layout {
    p0: [Column; 3],
    end: End,
    radius: Column,
    /// What to multiply the radius column with: 1, or 1/2 for a diameter.
    factor: f64,
}

/// How a row states the second endpoint.
enum End {
    Point([Column; 3]),
    Along { axis: [Column; 3], length: Column },
}

/// Why a row is degenerate.
struct Fault {
    column: Option<Column>,
    message: String,
}

impl Layout {
    fn new(
        source: &Source,
        table: &Table,
        columns: &Spanned<Keys<CylinderColumns>>,
    ) -> Result<Self, SceneError> {
        let names = &columns.get_ref().0;
        let wrong = |message: &str| Err(source.error(columns.span(), message));
        let p0 = three(source, table, &names.p0)?;
        let end = match (&names.p1, &names.axis, &names.length) {
            (Some(p1), None, None) => End::Point(three(source, table, p1)?),
            (None, Some(axis), Some(length)) => End::Along {
                axis: three(source, table, axis)?,
                length: table.column(source, length)?,
            },
            _ => return wrong("columns must name either p1, or both axis and length"),
        };
        let (radius, factor) = match (&names.radius, &names.diameter) {
            (Some(radius), None) => (radius, 1.0),
            (None, Some(diameter)) => (diameter, 0.5),
            (Some(_), Some(_)) => return wrong("columns must name radius or diameter, not both"),
            (None, None) => return wrong("columns must name either radius or diameter"),
        };
        Ok(Self {
            p0,
            end,
            radius: table.column(source, radius)?,
            factor,
        })
    }

    /// The cylinder of the current row, or why there is none.
    fn cylinder(&self, table: &Table, caps: Caps) -> Result<Result<Cylinder, Fault>, SceneError> {
        let p0 = DVec3::from(table.numbers(self.p0)?);
        let radius = table.number(self.radius)? * self.factor;
        let p1 = match &self.end {
            End::Point(columns) => DVec3::from(table.numbers(*columns)?),
            End::Along { axis, length } => {
                let distance = table.number(*length)?;
                if distance < 0.0 {
                    return Err(table.row_error(
                        Some(*length),
                        format!("length is {distance}: it must be a positive number"),
                    ));
                }
                match unit(DVec3::from(table.numbers(*axis)?)) {
                    Some(direction) => p0 + direction * distance,
                    None => {
                        return Ok(Err(Fault {
                            column: Some(axis[0]),
                            message: "the axis is zero: it has no direction".to_owned(),
                        }));
                    }
                }
            }
        };
        Cylinder::new(p0, p1, radius, caps)
            .map(Ok)
            .or_else(|error| {
                let column = match (error, &self.end) {
                    (CylinderError::Radius { .. }, _) => Some(self.radius),
                    (CylinderError::Length { .. }, End::Along { length, .. }) => Some(*length),
                    _ => None,
                };
                if is_degenerate(&error) {
                    Ok(Err(Fault {
                        column,
                        message: error.to_string(),
                    }))
                } else {
                    Err(table.row_error(column, error.to_string()))
                }
            })
    }
}

/// The columns of a point or a vector.
pub(super) fn three(
    source: &Source,
    table: &Table,
    names: &ThreeNames,
) -> Result<[Column; 3], SceneError> {
    let [x, y, z] = &names.0;
    Ok([
        table.column(source, x)?,
        table.column(source, y)?,
        table.column(source, z)?,
    ])
}
