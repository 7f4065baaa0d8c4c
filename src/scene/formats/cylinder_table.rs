//! Cylinders from the rows of a table.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::{Context, SolidFile, SolidFormat};
use crate::math::unit;
use crate::scene::colors::{DataColumn, ValueList};
use crate::scene::contents::ExpectedSolids;
use crate::scene::error::SceneError;
use crate::scene::named_table::{NamedTable, TableKeys, keys_of, table_rows};
use crate::scene::record::{CylinderRecord, Records};
use crate::scene::solid_collector::{Degenerate, SKIP_HELP, SolidCollector, is_degenerate};
use crate::scene::source::Source;
use crate::scene::table::{Column, ColumnKey, Fault, Row};
use crate::scene::values::{Keys, ThreeColumns};
use crate::solid::{Caps, Cylinder, CylinderError, SolidKind};

/// `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CylinderTableKeys {
    file: Spanned<String>,
    columns: Spanned<Keys<CylinderColumns>>,
    delimiter: Option<Spanned<String>>,
    decimal: Option<Spanned<String>>,
    degenerate: Option<Spanned<String>>,
    caps: Option<Spanned<String>>,
    material: Option<Spanned<String>>,
}

/// `columns` of `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CylinderColumns {
    #[serde(alias = "start")]
    p0: ThreeColumns,
    p1: Option<ThreeColumns>,
    axis: Option<ThreeColumns>,
    length: Option<Spanned<ColumnKey>>,
    radius: Option<Spanned<ColumnKey>>,
    diameter: Option<Spanned<ColumnKey>>,
    primitive: Option<Spanned<ColumnKey>>,
}

impl SolidFormat for CylinderTableKeys {
    const WHAT: &'static str = "a table";
    const EXTENSIONS: &'static [&'static str] = &["csv", "tsv"];
    const EXAMPLE: &'static str = r#"columns = { p0 = ["startX", "startY", "startZ"], p1 = ["endX", "endY", "endZ"], radius = "radius" }"#;
}

impl SolidFile for CylinderTableKeys {
    fn file(&self) -> &Spanned<String> {
        &self.file
    }

    fn material(&self) -> Option<&Spanned<String>> {
        self.material.as_ref()
    }

    fn value_bytes(&self) -> u64 {
        // Stated numbers may all differ by more than 1.
        match self.columns.get_ref().0.primitive {
            None => ValueList::VALUE_BYTES,
            Some(_) => ValueList::VALUE_BYTES + ValueList::RUN_BYTES,
        }
    }

    fn has_rows(&self) -> bool {
        true
    }

    fn count(&self, source: &Source, records: Records, solids: &mut ExpectedSolids) {
        let Keys(columns) = self.columns.get_ref();
        let rows = table_rows(source, &self.file, Some(columns.p0.0[0].get_ref()));
        solids.add(SolidKind::Cylinder, rows, records);
    }

    fn add(&self, context: &Context, solids: &mut SolidCollector) -> Result<(), SceneError> {
        let source = context.source;
        let look = context.look(self.caps.as_ref(), self.material.as_ref())?;
        let degenerate = context.degenerate(self.degenerate.as_ref())?;
        let table = TableKeys {
            file: &self.file,
            delimiter: self.delimiter.as_ref(),
            decimal: self.decimal.as_ref(),
        };
        let columns = &self.columns;
        let shown = context.columns.of(look.material);
        let mut wanted = columns.get_ref().0.all();
        wanted.extend(shown.map(DataColumn::key));
        let mut table = context.tables.open(table, &wanted)?;
        let layout = Layout::new(source, &table, columns)?;
        let shown = match shown {
            Some(shown) => shown
                .in_table(&table, columns.span())?
                .map(|cell| (shown, cell)),
            None => None,
        };
        let mut read = layout.all();
        match shown {
            Some((_, cell)) => {
                solids.values.reserve(table.most_rows());
                read.push(cell);
            }
            None => solids.found.others(table.header()),
        }
        table.note_unread(&read);
        let mut is_empty = true;
        solids.solids.cylinders.reserve(table.most_rows());
        let value_bytes = shown.map_or(0, |_| self.value_bytes() as usize);
        let bytes = size_of::<CylinderRecord>() + value_bytes;
        while let Some(row) = table.next_row(bytes)? {
            is_empty = false;
            let numbered = match layout.primitive {
                None => Ok(()),
                Some(column) => solids.number_from(number(&row, column)?, columns.span()),
            };
            let added = match layout.cylinder(&row, look.caps) {
                Ok(cylinder) => numbered.and_then(|()| solids.push(cylinder, look.material)),
                Err(Fault::Degenerate { .. }) if degenerate == Degenerate::Skip => {
                    numbered.and_then(|()| solids.skip())
                }
                Err(fault) => return Err(row.refused_with_help(fault, Some(SKIP_HELP))),
            };
            added.map_err(|refusal| {
                refusal.in_row(source, &self.file, |message, help| {
                    row.error_with_help(None, message, help)
                })
            })?;
            if let Some((shown, cell)) = shown {
                solids.value(look.material, shown.value(&row, cell)?);
            }
        }
        if is_empty {
            return Err(source.error(self.file.span(), "the table has a header but no rows"));
        }
        Ok(())
    }
}

/// The primitive number in a row.
fn number(row: &Row, column: Column) -> Result<u64, SceneError> {
    let number = row.number(column).map_err(|fault| row.refused(fault))?;
    match number >= 0.0 && number.fract() == 0.0 {
        // A number beyond u64 becomes the greatest, which is refused.
        true => Ok(number as u64),
        false => {
            let message = format!("primitive is {number}: it must be a whole number, 0 or more");
            Err(row.error(Some(column), message))
        }
    }
}

impl CylinderColumns {
    /// All columns that the keys name.
    fn all(&self) -> Vec<ColumnKey> {
        let threes = [Some(&self.p0), self.p1.as_ref(), self.axis.as_ref()];
        let threes = threes.into_iter().flatten().flat_map(|three| &three.0);
        let ones = [&self.length, &self.radius, &self.diameter, &self.primitive];
        keys_of(threes.chain(ones.into_iter().flatten()))
    }
}

/// The columns of a cylinder's numbers.
struct Layout {
    p0: [Column; 3],
    end: End,
    radius: Column,
    /// The factor of the radius column: 1, or 1/2 for a diameter.
    factor: f64,
    primitive: Option<Column>,
}

/// The columns of the second endpoint.
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
            primitive: names
                .primitive
                .as_ref()
                .map(|key| table.column(key))
                .transpose()?,
        })
    }

    /// All columns in use.
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
        all.extend(self.primitive);
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
