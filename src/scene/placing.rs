//! Collects the placements of a prototype: single instances, the rows of tables, and
//! scattered items.

use std::ops::Range;

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;
use toml::Spanned;

use super::colors::{DataColumn, DataColumns, Found, PlacementValues, ValueList, union};
use super::description::{Placement, PrototypeIndex};
use super::document::{InstanceKeys, InstanceTableKeys};
use super::error::SceneError;
use super::instance_rows::Layout;
use super::named_table::{TableKeys, Tables};
use super::pose;
use super::scatter::Scatter;
use super::source::Source;
use super::transform::{Reach, checked};
use super::values::{Keys, NumberOrList, vector};
use crate::math::{rotation, sin_cos_degrees};

/// The placements of one prototype.
pub(super) struct Placements<'c> {
    pub list: Vec<Placement>,
    /// The entries of the scene file that place prototypes.
    pub edges: Vec<Edge>,
    /// The columns of data colors.
    columns: Vec<PlacedColumn<'c>>,
    /// The columns of tables that lack one of these.
    others: Vec<String>,
}

/// A column of data colors.
struct PlacedColumn<'c> {
    column: &'c DataColumn,
    values: ValueList,
}

/// An entry of a scene file that places a prototype, once or many times.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    pub of: PrototypeIndex,
    /// The place of the entry in the scene file.
    pub place: Range<usize>,
    pub reach: Reach,
}

impl<'c> Placements<'c> {
    /// No placements, which may have values of these columns.
    pub fn new(columns: &'c DataColumns) -> Self {
        let columns = columns.iter().map(|column| PlacedColumn {
            column,
            values: ValueList::default(),
        });
        Self {
            list: Vec::new(),
            edges: Vec::new(),
            columns: columns.collect(),
            others: Vec::new(),
        }
    }

    /// The values of the placements, for columns that have any.
    pub fn values(&mut self, found: &mut Found) -> Vec<PlacementValues> {
        found.others(self.others.drain(..));
        let mut all = Vec::new();
        for PlacedColumn { column, mut values } in self.columns.drain(..) {
            values.finish();
            let known = values.iter().map(|(_, value)| value);
            let known = known.filter(|value| !value.is_nan());
            if let Some(range) = known.map(|value| [value; 2]).reduce(union) {
                found.placed_range(&column.name, range);
                let column = column.name.clone();
                all.push(PlacementValues { column, values });
            }
        }
        all
    }

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
        let number = self.list.len() as u32;
        for placed in &mut self.columns {
            if let Some(value) = placed.column.stated(source, keys.values.as_ref())? {
                placed.values.push(number, value);
            }
        }
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
        let mut wanted = keys.columns.get_ref().0.all();
        wanted.extend(self.columns.iter().map(|placed| placed.column.key()));
        let mut table = tables.open(table, &wanted)?;
        let layout = Layout::new(source, &table, &keys.columns)?;
        let mut read = layout.all();
        let mut cells = Vec::with_capacity(self.columns.len());
        for placed in &mut self.columns {
            let cell = placed.column.in_table(&table, keys.columns.span())?;
            if cell.is_some() {
                placed.values.reserve(table.most_rows());
            } else {
                self.others.extend(table.header().iter().cloned());
            }
            read.extend(cell);
            cells.push(cell);
        }
        table.note_unread(&read);
        let values_bytes = cells.iter().flatten().count() * size_of::<f32>();
        let mut reach = Reach::default();
        let before = self.list.len();
        // If the reservation fails, `make_room` allocates row by row.
        let _ = self.list.try_reserve_exact(table.most_rows());
        while let Some(row) = table.next_row(size_of::<Placement>() + values_bytes)? {
            let parent_from_child = layout.placement(&row).map_err(|fault| row.refused(fault))?;
            let row_reach =
                checked(&parent_from_child).map_err(|error| row.error(None, error.to_string()))?;
            reach = reach.union(row_reach);
            self.make_room(source, &keys.of, 1)?;
            let number = self.list.len() as u32;
            for (placed, cell) in self.columns.iter_mut().zip(&cells) {
                if let Some(cell) = cell {
                    let value = placed.column.value(&row, *cell)?;
                    placed.values.push(number, value);
                }
            }
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
