//! Cylinders from the rows of a table.

use glam::DVec3;
use toml::Spanned;

use super::description::CylinderRecord;
use super::error::SceneError;
use super::named_table::{NamedTable, TableKeys, Tables, keys_of};
use super::solid_collector::{Degenerate, Look, SKIP_HELP, SolidCollector, is_degenerate};
use super::solid_keys::{CylinderColumns, CylinderTableKeys};
use super::source::Source;
use super::table::{Column, ColumnKey, Fault, Row};
use super::values::Keys;
use crate::math::unit;
use crate::solid::{Caps, Cylinder, CylinderError};

/// Adds the rows of a `[[cylinder_table]]`.
pub(super) fn add_table(
    solids: &mut SolidCollector,
    tables: &Tables,
    keys: &CylinderTableKeys,
    look: Look,
    degenerate: Degenerate,
) -> Result<(), SceneError> {
    let source = tables.source;
    let table = TableKeys {
        file: &keys.file,
        delimiter: keys.delimiter.as_ref(),
        decimal: keys.decimal.as_ref(),
    };
    let columns = &keys.columns;
    let mut table = tables.open(table, &columns.get_ref().0.all())?;
    let layout = Layout::new(source, &table, columns)?;
    table.note_unread(&layout.all());
    let before = solids.numbers();
    solids.solids.cylinders.reserve(table.most_rows());
    while let Some(row) = table.next_row(size_of::<CylinderRecord>())? {
        match layout.cylinder(&row, look.caps) {
            Ok(cylinder) => solids.push(cylinder, look.material),
            Err(Fault::Degenerate { .. }) if degenerate == Degenerate::Skip => solids.skip(),
            Err(fault) => return Err(row.refused_with_help(fault, Some(SKIP_HELP))),
        }
        .map_err(|refusal| {
            refusal.in_row(source, &keys.file, |message, help| {
                row.error_with_help(None, message, help)
            })
        })?;
    }
    if solids.numbers() == before {
        return Err(source.error(keys.file.span(), "the table has a header but no rows"));
    }
    Ok(())
}

impl CylinderColumns {
    /// All columns that are stated.
    fn all(&self) -> Vec<ColumnKey> {
        let threes = [Some(&self.p0), self.p1.as_ref(), self.axis.as_ref()];
        let threes = threes.into_iter().flatten().flat_map(|three| &three.0);
        let ones = [&self.length, &self.radius, &self.diameter];
        keys_of(threes.chain(ones.into_iter().flatten()))
    }
}

/// Where a cylinder's numbers are in a row.
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

impl Layout {
    fn new(
        source: &Source,
        table: &NamedTable,
        columns: &Spanned<Keys<CylinderColumns>>,
    ) -> Result<Self, SceneError> {
        let names = &columns.get_ref().0;
        let wrong = |message: &str| Err(source.error(columns.span(), message));
        let p0 = table.three(&names.p0)?;
        let end = match (&names.p1, &names.axis, &names.length) {
            (Some(p1), None, None) => End::Point(table.three(p1)?),
            (None, Some(axis), Some(length)) => End::Along {
                axis: table.three(axis)?,
                length: table.column(length)?,
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
            radius: table.column(radius)?,
            factor,
        })
    }

    /// All columns that are read.
    fn all(&self) -> Vec<Column> {
        let mut all = self.p0.to_vec();
        match self.end {
            End::Point(p1) => all.extend(p1),
            End::Along { axis, length } => {
                all.extend(axis);
                all.push(length);
            }
        }
        all.push(self.radius);
        all
    }

    /// The cylinder of a row.
    fn cylinder(&self, row: &Row, caps: Caps) -> Result<Cylinder, Fault> {
        let p0 = DVec3::from(row.numbers(self.p0)?);
        let radius = row.number(self.radius)? * self.factor;
        let p1 = match &self.end {
            End::Point(columns) => DVec3::from(row.numbers(*columns)?),
            End::Along { axis, length } => {
                let distance = row.number(*length)?;
                if distance < 0.0 {
                    let message = format!("length is {distance}: it must be a positive number");
                    return Err(row.error(Some(*length), message).into());
                }
                let direction = unit(DVec3::from(row.numbers(*axis)?));
                let direction = direction.ok_or_else(|| Fault::Degenerate {
                    column: Some(axis[0]),
                    message: "the axis is zero: it has no direction".to_owned(),
                })?;
                p0 + direction * distance
            }
        };
        Cylinder::new(p0, p1, radius, caps).map_err(|error| {
            let column = match (error, &self.end) {
                (CylinderError::Radius { .. }, _) => Some(self.radius),
                (CylinderError::Length { .. }, End::Along { length, .. }) => Some(*length),
                _ => None,
            };
            let message = error.to_string();
            match is_degenerate(&error) {
                true => Fault::Degenerate { column, message },
                false => row.error(column, message).into(),
            }
        })
    }
}
