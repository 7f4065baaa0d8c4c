//! Gathers the cylinders of one prototype: single ones, and the rows of tables.

use glam::DVec3;
use toml::Spanned;

use super::cylinder_list::{CylinderList, Records};
use super::description::{CylinderRecord, MaterialIndex};
use super::document::{CylinderColumns, CylinderKeys, CylinderTableKeys, ThreeNames};
use super::error::SceneError;
use super::settings::vector;
use super::source::Source;
use super::table::{Column, Table};
use super::values::Keys;
use crate::math::unit;
use crate::solid::{Caps, Cylinder, CylinderError};

/// What to say about rows that `degenerate = "skip"` would leave out.
pub(super) const SKIP_HELP: &str =
    "degenerate = \"skip\" in the scene file leaves such rows out and counts them";

/// What to say about a cylinder that f32 does not hold.
const F64_HELP: &str = "records = \"f64\", the default, keeps every number as it is stated";

/// The cylinders of one prototype.
#[derive(Default)]
pub(super) struct Solids {
    pub records: CylinderList,
    /// How many primitive numbers are given away.
    numbers: u32,
    /// Rows that were left out, though they have a number.
    pub skipped: u64,
    /// At least the size of every coordinate of a point of the solids.
    pub reach: f64,
}

/// What the cylinders of an entry have in common.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub caps: Caps,
    pub material: MaterialIndex,
}

/// Why a cylinder is not added.
#[derive(Debug, PartialEq)]
pub(super) enum Refusal {
    /// No primitive number is left.
    Numbers,
    /// Rounded to f32 it is no cylinder.
    Rounded(CylinderError),
}

impl Refusal {
    /// What to say, and what to do about it.
    pub fn told(&self) -> (String, Option<&'static str>) {
        match self {
            Self::Numbers => {
                let most = u32::MAX;
                (format!("a prototype holds at most {most} primitives"), None)
            }
            Self::Rounded(error) => (
                format!("rounded to f32 this is no cylinder: {error}"),
                Some(F64_HELP),
            ),
        }
    }

    /// That a row of a table which the scene file names is refused.
    pub fn in_row(
        &self,
        source: &Source,
        file: &Spanned<String>,
        row: impl FnOnce(String, Option<&str>) -> SceneError,
    ) -> SceneError {
        let (message, help) = self.told();
        match self {
            Self::Numbers => source.error(file.span(), message),
            Self::Rounded(_) => row(message, help),
        }
    }
}

/// What happens to rows that are no solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Degenerate {
    Error,
    Skip,
}

impl Solids {
    /// No cylinders, to be kept so.
    pub fn new(records: Records) -> Self {
        Self {
            records: CylinderList::new(records),
            ..Self::default()
        }
    }

    /// The next primitive number.
    fn number(&mut self) -> Result<u32, Refusal> {
        let number = self.numbers;
        // The greatest u32 is left out: Embree's mark for "no primitive".
        self.numbers = number.checked_add(1).ok_or(Refusal::Numbers)?;
        Ok(number)
    }

    /// Adds a cylinder.
    pub fn push(&mut self, cylinder: &Cylinder, material: MaterialIndex) -> Result<(), Refusal> {
        let number = self.number()?;
        self.records
            .push(CylinderRecord::new(cylinder, number, material))
            .map_err(Refusal::Rounded)?;
        let kept = self.records.get(self.records.len() - 1).cylinder();
        let farthest = kept.p0().abs().max(kept.p1().abs()).max_element();
        self.reach = self.reach.max(farthest + kept.radius());
        Ok(())
    }

    /// Leaves a row out; it keeps its primitive number.
    pub fn skip(&mut self) -> Result<(), Refusal> {
        self.skipped += 1;
        self.number().map(drop)
    }

    /// Adds a `[[cylinder]]`.
    pub fn add_cylinder(
        &mut self,
        source: &Source,
        keys: &CylinderKeys,
        look: Look,
    ) -> Result<(), SceneError> {
        let radius = keys.radius.get_ref().0;
        let cylinder = Cylinder::new(vector(&keys.p0), vector(&keys.p1), radius, look.caps)
            .map_err(|error| {
                let place = match error {
                    CylinderError::Endpoint { which: "p0", .. } => keys.p0.span(),
                    CylinderError::Endpoint { .. } | CylinderError::Length { .. } => keys.p1.span(),
                    CylinderError::Radius { .. } => keys.radius.span(),
                };
                source.error(place, error.to_string())
            })?;
        self.push(&cylinder, look.material).map_err(|refusal| {
            let (message, help) = refusal.told();
            match help {
                Some(help) => source.error_with_help(keys.p0.span(), message, help),
                None => source.error(keys.p0.span(), message),
            }
        })
    }

    /// Adds the rows of a `[[cylinder_table]]`.
    pub fn add_table(
        &mut self,
        source: &Source,
        keys: &CylinderTableKeys,
        look: Look,
        degenerate: Degenerate,
    ) -> Result<(), SceneError> {
        let mut table = Table::open(source, &keys.file)?;
        let layout = Layout::new(source, &table, &keys.columns)?;
        let before = self.numbers;
        self.records.reserve(table.most_rows());
        while table.next_row()? {
            match layout.cylinder(&table, look.caps)? {
                Ok(cylinder) => self.push(&cylinder, look.material),
                Err(fault) if degenerate == Degenerate::Error => {
                    return Err(table.row_error_with_help(
                        fault.column,
                        fault.message,
                        Some(SKIP_HELP),
                    ));
                }
                Err(_) => self.skip(),
            }
            .map_err(|refusal| {
                refusal.in_row(source, &keys.file, |message, help| {
                    table.row_error_with_help(None, message, help)
                })
            })?;
        }
        if self.numbers == before {
            return Err(source.error(keys.file.span(), "the table has a header but no rows"));
        }
        Ok(())
    }
}

/// Whether a row that gives this error counts as degenerate. Negative radii
/// and numbers out of range are not: those are mistakes, whatever was asked.
pub(super) fn is_degenerate(error: &CylinderError) -> bool {
    match error {
        CylinderError::Endpoint { .. } => false,
        CylinderError::Radius { radius } => (0.0..Cylinder::LEAST).contains(radius),
        CylinderError::Length { .. } => true,
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primitive_numbers_that_run_out_are_refused() {
        let mut solids = Solids {
            numbers: u32::MAX - 1,
            ..Solids::default()
        };
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::X, 1.0, Caps::Both).expect("valid");
        assert_eq!(solids.push(&cylinder, MaterialIndex(0)), Ok(()));
        assert_eq!(solids.records.primitive(0), u32::MAX - 1);
        let refusal = solids.skip().expect_err("no number is left");
        assert_eq!(refusal, Refusal::Numbers);
        let (message, _) = refusal.told();
        assert!(
            message.contains("at most 4294967295 primitives"),
            "{message}"
        );
    }

    #[test]
    fn degenerate_rows_are_those_without_extent_only() {
        let error = |p1, radius| {
            Cylinder::new(DVec3::ZERO, p1, radius, Caps::Both).expect_err("not a cylinder")
        };
        assert!(is_degenerate(&error(DVec3::X, 0.0)));
        assert!(is_degenerate(&error(DVec3::ZERO, 1.0)));
        assert!(!is_degenerate(&error(DVec3::X, -1.0)));
        assert!(!is_degenerate(&error(DVec3::X, 1e60)));
        assert!(!is_degenerate(&error(DVec3::splat(1e60), 1.0)));
    }
}
