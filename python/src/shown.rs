//! The values that materials show as colors.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use cyltrace::scene::{Color, DataColor, PlacementValues, Scene, ValueList};
use pyo3::prelude::*;

use crate::arrays::value_error;
use crate::scene::PyScene;

/// The ranges of values that were added, for automatic ranges of colors.
#[derive(Default)]
pub struct Shown {
    /// The materials with automatic ranges.
    pub automatic: BTreeSet<u16>,
    /// The materials of a file, whose values and ranges are complete.
    of_file: usize,
    /// The least and greatest value of the solids of a material.
    solids: BTreeMap<u16, [f32; 2]>,
    /// The same of placements, by column.
    placements: BTreeMap<String, [f32; 2]>,
}

impl Shown {
    /// Those of a scene that was loaded.
    pub fn of_file(scene: &Scene) -> Self {
        let mut placements = BTreeMap::new();
        let lists = scene
            .prototypes
            .iter()
            .flat_map(|one| &one.placement_values);
        for list in lists {
            let values = list.values.iter().map(|(_, value)| value);
            let values = values.filter(|value| !value.is_nan());
            if let Some(added) = values.map(|value| [value; 2]).reduce(union) {
                let range = placements.entry(list.column.clone()).or_insert(added);
                *range = union(*range, added);
            }
        }
        Self {
            of_file: scene.materials.len(),
            placements,
            ..Self::default()
        }
    }
}

impl PyScene {
    fn data(&self, material: u16) -> Option<&DataColor> {
        match &self.scene.materials[usize::from(material)].color {
            Color::Data(data) => Some(data),
            _ => None,
        }
    }

    /// The column that a material shows.
    pub fn column_of(&self, material: u16) -> Option<String> {
        self.data(material).map(|data| data.column.clone())
    }

    /// The texts that stand for the values 0, 1, 2 and so on in a column.
    pub fn labels_of(&self, column: &str) -> Vec<String> {
        let labels = self.showing(column).map(|(_, data)| data.labels.clone());
        labels.max_by_key(Vec::len).unwrap_or_default()
    }

    /// The materials that show a column.
    fn showing<'a>(&'a self, column: &'a str) -> impl Iterator<Item = (u16, &'a DataColor)> {
        let materials = (0..).zip(&self.scene.materials);
        materials.filter_map(move |(index, material)| match &material.color {
            Color::Data(data) if data.column == column => Some((index, data)),
            _ => None,
        })
    }

    /// Checks the values of a column.
    ///
    /// # Errors
    /// When no material shows it, or one shows categories and a value is none.
    pub fn check_column(&self, column: &str, values: &[f64]) -> PyResult<()> {
        let mut showing = self.showing(column).peekable();
        if showing.peek().is_none() {
            let columns = self
                .scene
                .materials
                .iter()
                .filter_map(|one| one.color.column());
            let columns: BTreeSet<String> = columns.map(|name| format!("\"{name}\"")).collect();
            let columns = Vec::from_iter(columns).join(", ");
            let known = match columns.is_empty() {
                true => "none shows any",
                false => &columns,
            };
            return Err(value_error(format!(
                "no material shows the column \"{column}\": {known}"
            )));
        }
        let has_categories = showing.any(|(_, data)| data.map.has_categories());
        let is_wrong = |value: &f64| !value.is_nan() && !DataColor::is_category(*value);
        match values.iter().position(is_wrong) {
            Some(row) if has_categories => Err(value_error(format!(
                "values[\"{column}\"][{row}] is {}: a category must be a whole number from 0 to {}",
                values[row],
                DataColor::GREATEST_CATEGORY
            ))),
            _ => Ok(()),
        }
    }

    /// Adds the values of solids whose numbers count up from `first`.
    pub fn show_solids(
        &mut self,
        prototype: u32,
        material: u16,
        first: u32,
        values: &[f64],
    ) -> PyResult<()> {
        let list = &mut self.prototype(prototype)?.solid_values;
        if let Some(added) = push(list, first, values) {
            let range = self.shown.solids.entry(material).or_insert(added);
            *range = union(*range, added);
        }
        self.update_ranges();
        Ok(())
    }

    /// Adds the values of placements whose numbers count up from `first`.
    pub fn show_placements(
        &mut self,
        prototype: u32,
        column: &str,
        first: u32,
        values: &[f64],
    ) -> PyResult<()> {
        let lists = &mut self.prototype(prototype)?.placement_values;
        let position = lists.iter().position(|list| list.column == column);
        let position = position.unwrap_or_else(|| {
            lists.push(PlacementValues {
                column: column.to_owned(),
                values: ValueList::default(),
            });
            lists.len() - 1
        });
        if let Some(added) = push(&mut lists[position].values, first, values) {
            let placements = &mut self.shown.placements;
            let range = placements.entry(column.to_owned()).or_insert(added);
            *range = union(*range, added);
        }
        self.update_ranges();
        Ok(())
    }

    /// Sets the automatic ranges.
    pub fn update_ranges(&mut self) {
        let range = |&index: &u16| {
            let column = self.column_of(index)?;
            let solids = self.showing(&column);
            let solids = solids.filter_map(|(index, _)| self.shown.solids.get(&index));
            let ranges = solids.chain(self.shown.placements.get(&column)).copied();
            Some((index, DataColor::automatic_range(ranges.reduce(union))))
        };
        let ranges: Vec<(u16, [f64; 2])> = self.shown.automatic.iter().filter_map(range).collect();
        if ranges.is_empty() {
            return;
        }
        let materials = &mut Arc::make_mut(&mut self.scene).materials;
        for (index, range) in ranges {
            if let Color::Data(data) = &mut materials[usize::from(index)].color {
                data.range = range;
            }
        }
    }

    /// Checks that each column that a material shows has values, as loading does.
    ///
    /// # Errors
    /// When one has none.
    pub fn check_columns(&self) -> PyResult<()> {
        let materials = (0..).zip(&self.scene.materials).skip(self.shown.of_file);
        for (index, material) in materials {
            let Some(column) = material.color.column() else {
                continue;
            };
            let (solids, placements) = (&self.shown.solids, &self.shown.placements);
            if !solids.contains_key(&index) && !placements.contains_key(column) {
                return Err(value_error(format!(
                    "no solid with the material \"{}\" and no placement has a value in a column \"{column}\": add some with values={{\"{column}\": ...}}",
                    material.name
                )));
            }
        }
        Ok(())
    }
}

/// Adds values; NaN is none. Returns the least and greatest one.
fn push(list: &mut ValueList, first: u32, values: &[f64]) -> Option<[f32; 2]> {
    let mut range = None;
    for (number, &value) in (first..).zip(values) {
        let value = DataColor::stored(value);
        list.push(number, value);
        if !value.is_nan() {
            range = Some(union(range.unwrap_or([value; 2]), [value; 2]));
        }
    }
    range
}

fn union(one: [f32; 2], other: [f32; 2]) -> [f32; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}
