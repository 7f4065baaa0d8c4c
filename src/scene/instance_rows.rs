//! The columns of an `[[instance_table]]`, and the placement in a row.

use glam::{DAffine3, DMat3, DVec3};
use toml::Spanned;

use super::document::InstanceColumns;
use super::error::SceneError;
use super::named_table::{NamedTable, keys_of};
use super::source::Source;
use super::table::{Column, ColumnKey, Fault, Row};
use super::transform::quaternion_rotation;
use super::values::{ColumnOrList, Keys, List};
use crate::math::{rotation, sin_cos_degrees, unit};

impl InstanceColumns {
    /// All columns that are stated.
    pub fn all(&self) -> Vec<ColumnKey> {
        let threes = [&self.position, &self.axis];
        let threes = threes.into_iter().flatten().flat_map(|three| &three.0);
        let four = self.quaternion.iter().flat_map(|four| &four.0);
        let rows = self.matrix.iter().flat_map(|rows| &rows.0);
        let matrix = rows.flat_map(|row| &row.0);
        let mut all = keys_of(threes.chain(&self.degrees).chain(four).chain(matrix));
        match self.scale.as_ref().map(Spanned::get_ref) {
            None => {}
            Some(ColumnOrList::One(key)) => all.push(key.clone()),
            Some(ColumnOrList::Many(keys)) => all.extend(keys.iter().cloned()),
        }
        all
    }

    /// Whether it states a part of a placement other than `matrix`.
    fn states_parts(&self) -> bool {
        let turns = self.axis.is_some() || self.degrees.is_some() || self.quaternion.is_some();
        turns || self.position.is_some() || self.scale.is_some()
    }
}

/// Where a placement's numbers are in a row.
pub(super) enum Layout {
    Parts(Parts),
    Matrix([[Column; 4]; 3]),
}

/// A placement that is composed of a scale, a rotation and a translation.
pub(super) struct Parts {
    position: [Column; 3],
    turn: Turn,
    scale: Scale,
}

enum Turn {
    None,
    About { axis: [Column; 3], degrees: Column },
    Quaternion([Column; 4]),
}

enum Scale {
    None,
    One(Column),
    Three([Column; 3]),
}

impl Layout {
    pub fn new(
        source: &Source,
        table: &NamedTable,
        columns: &Spanned<Keys<InstanceColumns>>,
    ) -> Result<Self, SceneError> {
        let Keys(names) = columns.get_ref();
        let wrong = |message: &str| Err(source.error(columns.span(), message));
        match (&names.matrix, &names.position) {
            (None, None) => wrong("columns must name either position or matrix"),
            (None, Some(position)) => {
                let position = table.three(position)?;
                Parts::new(source, table, columns, position).map(Self::Parts)
            }
            (Some(_), _) if names.states_parts() => {
                wrong("columns must name matrix or the parts of a placement, not both")
            }
            (Some(List(rows)), _) => {
                let mut matrix = Vec::with_capacity(rows.len());
                for List([x, y, z, translation]) in rows {
                    let [x, y, z] = [table.column(x)?, table.column(y)?, table.column(z)?];
                    matrix.push([x, y, z, table.column(translation)?]);
                }
                Ok(Self::Matrix([matrix[0], matrix[1], matrix[2]]))
            }
        }
    }

    /// All columns that are read.
    pub fn all(&self) -> Vec<Column> {
        match self {
            Self::Parts(parts) => parts.all(),
            Self::Matrix(rows) => rows.concat(),
        }
    }

    /// The placement of a row.
    pub fn placement(&self, row: &Row) -> Result<DAffine3, Fault> {
        match self {
            Self::Parts(parts) => parts.placement(row),
            Self::Matrix(rows) => {
                let [x, y, z] = rows.map(|columns| row.numbers(columns));
                let rows = [x?, y?, z?];
                let column = |index: usize| DVec3::from(rows.map(|row: [f64; 4]| row[index]));
                let [x, y, z, translation] = [0, 1, 2, 3].map(column);
                Ok(DAffine3::from_cols(x, y, z, translation))
            }
        }
    }
}

impl Parts {
    fn new(
        source: &Source,
        table: &NamedTable,
        columns: &Spanned<Keys<InstanceColumns>>,
        position: [Column; 3],
    ) -> Result<Self, SceneError> {
        let names = &columns.get_ref().0;
        let turn = match (&names.axis, &names.degrees, &names.quaternion) {
            (None, None, None) => Turn::None,
            (Some(axis), Some(degrees), None) => Turn::About {
                axis: table.three(axis)?,
                degrees: table.column(degrees)?,
            },
            (None, None, Some(quaternion)) => {
                let [x, y, z, w] = &quaternion.0;
                Turn::Quaternion([
                    table.column(x)?,
                    table.column(y)?,
                    table.column(z)?,
                    table.column(w)?,
                ])
            }
            _ => {
                return Err(source.error(
                    columns.span(),
                    "columns must name both axis and degrees, or quaternion, or none of them",
                ));
            }
        };
        let scale = match &names.scale {
            None => Scale::None,
            Some(scale) => {
                let column = |key| table.column_at(key, scale.span());
                match scale.get_ref() {
                    ColumnOrList::One(key) => Scale::One(column(key)?),
                    ColumnOrList::Many([x, y, z]) => {
                        Scale::Three([column(x)?, column(y)?, column(z)?])
                    }
                }
            }
        };
        Ok(Self {
            position,
            turn,
            scale,
        })
    }

    /// All columns that are read.
    fn all(&self) -> Vec<Column> {
        let mut all = self.position.to_vec();
        match self.turn {
            Turn::None => {}
            Turn::About { axis, degrees } => {
                all.extend(axis);
                all.push(degrees);
            }
            Turn::Quaternion(columns) => all.extend(columns),
        }
        match self.scale {
            Scale::None => {}
            Scale::One(column) => all.push(column),
            Scale::Three(columns) => all.extend(columns),
        }
        all
    }

    /// The placement of a row.
    fn placement(&self, row: &Row) -> Result<DAffine3, Fault> {
        let scale = match &self.scale {
            Scale::None => DVec3::ONE,
            Scale::One(column) => DVec3::splat(row.number(*column)?),
            Scale::Three(columns) => DVec3::from(row.numbers(*columns)?),
        };
        let turn = match &self.turn {
            Turn::None => DMat3::IDENTITY,
            Turn::About { axis, degrees } => {
                let direction = unit(DVec3::from(row.numbers(*axis)?)).ok_or_else(|| {
                    row.error(
                        Some(axis[0]),
                        "the rotation axis is zero: it must be a direction, of any length",
                    )
                })?;
                rotation(direction, sin_cos_degrees(row.number(*degrees)?))
            }
            Turn::Quaternion(columns) => {
                quaternion_rotation(row.numbers(*columns)?).ok_or_else(|| {
                    row.error(
                        Some(columns[0]),
                        "the quaternion is zero: it must have a nonzero length",
                    )
                })?
            }
        };
        let position = DVec3::from(row.numbers(self.position)?);
        Ok(DAffine3::from_mat3_translation(
            turn * DMat3::from_diagonal(scale),
            position,
        ))
    }
}
