//! Collects the placements of a prototype: single instances, the rows of tables, and
//! scattered items.

use std::ops::Range;

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;
use toml::Spanned;

use super::description::{Placement, PrototypeIndex};
use super::document::{InstanceColumns, InstanceKeys, InstanceTableKeys};
use super::error::SceneError;
use super::named_table::{NamedTable, TableKeys, Tables, keys_of};
use super::pose;
use super::scatter::Scatter;
use super::settings::vector;
use super::source::Source;
use super::table::{Column, ColumnKey, Fault, Row};
use super::transform::{Reach, checked, quaternion_rotation};
use super::values::{ColumnOrList, Keys, NumberOrList};
use crate::math::{rotation, sin_cos_degrees, unit};

/// The placements of one prototype.
#[derive(Default)]
pub(super) struct Placements {
    pub list: Vec<Placement>,
    /// The entries of the scene file that place prototypes.
    pub edges: Vec<Edge>,
}

/// An entry of a scene file that places a prototype, once or many times.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    pub of: PrototypeIndex,
    /// The place of the entry in the scene file.
    pub place: Range<usize>,
    pub reach: Reach,
}

impl Placements {
    /// Adds an `[[instance]]`.
    pub fn add_instance(
        &mut self,
        source: &Source,
        keys: &InstanceKeys,
        of: PrototypeIndex,
    ) -> Result<(), SceneError> {
        let parent_from_child = composed(source, keys)?;
        let blame = match (&keys.matrix, &keys.scale, &keys.translate) {
            (Some(matrix), ..) => matrix.span(),
            (_, Some(scale), _) => scale.span(),
            (_, _, Some(translate)) => translate.span(),
            _ => keys.of.span(),
        };
        let reach =
            checked(&parent_from_child).map_err(|error| source.error(blame, error.to_string()))?;
        self.make_room(source, &keys.of, 1)?;
        self.list.push(Placement {
            of,
            parent_from_child,
        });
        self.placed(of, keys.of.span(), reach);
        Ok(())
    }

    /// Adds the rows of an `[[instance_table]]`.
    pub fn add_table(
        &mut self,
        tables: &Tables,
        keys: &InstanceTableKeys,
        of: PrototypeIndex,
    ) -> Result<(), SceneError> {
        let source = tables.source;
        let table = TableKeys {
            file: &keys.file,
            delimiter: keys.delimiter.as_ref(),
            decimal: keys.decimal.as_ref(),
        };
        let mut table = tables.open(table, &keys.columns.get_ref().0.all())?;
        let layout = Layout::new(source, &table, &keys.columns)?;
        table.note_unread(&layout.all());
        let mut reach = Reach::default();
        let before = self.list.len();
        // If the reservation fails, `make_room` allocates row by row.
        let _ = self.list.try_reserve_exact(table.most_rows());
        while let Some(row) = table.next_row(size_of::<Placement>())? {
            let parent_from_child = layout.placement(&row).map_err(|fault| row.refused(fault))?;
            let row_reach =
                checked(&parent_from_child).map_err(|error| row.error(None, error.to_string()))?;
            reach = reach.union(row_reach);
            self.make_room(source, &keys.of, 1)?;
            self.list.push(Placement {
                of,
                parent_from_child,
            });
        }
        if self.list.len() == before {
            return Err(source.error(keys.file.span(), "the table has a header but no rows"));
        }
        self.placed(of, keys.of.span(), reach);
        Ok(())
    }

    /// Adds the items of all `[[scatter]]` entries, after reserving numbers and memory for
    /// all of them.
    pub fn add_scatters(
        &mut self,
        source: &Source,
        scatters: &[(&Spanned<String>, PrototypeIndex, Scatter)],
    ) -> Result<(), SceneError> {
        let mut more = 0;
        for (of_name, _, scatter) in scatters {
            more += scatter.count as usize;
            self.make_room(source, of_name, more)?;
        }
        for (of_name, of, scatter) in scatters {
            let of = *of;
            let items = scatter.items().map(|parent_from_child| Placement {
                of,
                parent_from_child,
            });
            self.list.par_extend(items);
            self.placed(of, of_name.span(), scatter.reach());
        }
        Ok(())
    }

    /// Reserves numbers and memory for `more` placements.
    fn make_room(
        &mut self,
        source: &Source,
        of: &Spanned<String>,
        more: usize,
    ) -> Result<(), SceneError> {
        let total = self.list.len() as u64 + more as u64;
        if total > u64::from(u32::MAX) {
            let message = format!(
                "this makes {total} placements: a prototype can contain at most {}",
                u32::MAX
            );
            return Err(source.error(of.span(), message));
        }
        let reserved = match more {
            1 => self.list.try_reserve(1),
            // Exact, because doubling the capacity could double the memory.
            _ => self.list.try_reserve_exact(more),
        };
        reserved.map_err(|_| {
            let bytes = total * size_of::<Placement>() as u64;
            let message = format!(
                "not enough memory for {total} placements: they take {:.1} GB",
                bytes as f64 / 1e9
            );
            source.error(of.span(), message)
        })
    }

    fn placed(&mut self, of: PrototypeIndex, place: Range<usize>, reach: Reach) {
        self.edges.push(Edge { of, place, reach });
    }
}

/// The map of an `[[instance]]`.
fn composed(source: &Source, keys: &InstanceKeys) -> Result<DAffine3, SceneError> {
    let about_axes = [keys.rotate_x, keys.rotate_y, keys.rotate_z];
    if let Some(matrix) = &keys.matrix {
        let turns = keys.rotate.is_some() || about_axes.iter().any(Option::is_some);
        if keys.scale.is_some() || turns || keys.translate.is_some() {
            return Err(source.error(
                matrix.span(),
                "matrix excludes scale, rotate, rotate_x, rotate_y, rotate_z and translate: use one or the others",
            ));
        }
        let rows = &matrix.get_ref().0;
        let column =
            |index: usize| DVec3::new(rows[0].0[index].0, rows[1].0[index].0, rows[2].0[index].0);
        return Ok(DAffine3::from_cols(
            column(0),
            column(1),
            column(2),
            column(3),
        ));
    }
    let scale = keys
        .scale
        .as_ref()
        .map_or(DVec3::ONE, |scale| match scale.get_ref() {
            NumberOrList::One(scale) => DVec3::splat(*scale),
            NumberOrList::Many(scale) => DVec3::from(*scale),
        });
    let mut matrix = pose::about_axes(about_axes).world_from_object() * DMat3::from_diagonal(scale);
    for Keys(turn) in keys.rotate.iter().flatten() {
        let axis = pose::axis(source, turn)?;
        matrix = rotation(axis, sin_cos_degrees(turn.degrees.0)) * matrix;
    }
    let translation = keys.translate.as_ref().map_or(DVec3::ZERO, vector);
    Ok(DAffine3::from_mat3_translation(matrix, translation))
}

impl InstanceColumns {
    /// All columns that the keys name.
    fn all(&self) -> Vec<ColumnKey> {
        let threes = [Some(&self.position), self.axis.as_ref()];
        let threes = threes.into_iter().flatten().flat_map(|three| &three.0);
        let four = self.quaternion.iter().flat_map(|four| &four.0);
        let mut all = keys_of(threes.chain(&self.degrees).chain(four));
        match self.scale.as_ref().map(Spanned::get_ref) {
            None => {}
            Some(ColumnOrList::One(key)) => all.push(key.clone()),
            Some(ColumnOrList::Many(keys)) => all.extend(keys.iter().cloned()),
        }
        all
    }
}

/// The columns of a placement's numbers.
struct Layout {
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
    fn new(
        source: &Source,
        table: &NamedTable,
        columns: &Spanned<Keys<InstanceColumns>>,
    ) -> Result<Self, SceneError> {
        let names = &columns.get_ref().0;
        let position = table.three(&names.position)?;
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

    /// All columns in use.
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
