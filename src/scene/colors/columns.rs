//! The columns that data colors show, while a scene is loaded: which are read, how their cells
//! become values, and which of them files and tables have.

use std::collections::{BTreeMap, BTreeSet};

use toml::Spanned;

use super::data::DataColor;
use super::key_types::{ColorKey, ColorKeys};
use crate::scene::error::SceneError;
use crate::scene::material::{Color, Material};
use crate::scene::named_table::NamedTable;
use crate::scene::names::{quoted, suggestion};
use crate::scene::record::MaterialIndex;
use crate::scene::source::Source;
use crate::scene::table::{Column, ColumnKey, Fault, Row};
use crate::scene::values::Number;

/// The values that the table of a single solid or placement states, by column.
pub(in crate::scene) type ValueKeys = BTreeMap<String, Number>;

/// The columns that the materials of a scene show.
#[derive(Default)]
pub(in crate::scene) struct DataColumns {
    list: Vec<DataColumn>,
    /// The column of each material, in the order of the materials.
    of_material: Vec<Option<usize>>,
    /// The places of the keys `column` in the scene file.
    places: Vec<Option<ColumnPlace>>,
}

/// A column and how its cells are read.
pub(in crate::scene) struct DataColumn {
    pub name: String,
    /// The texts that stand for 0, 1, 2 and so on.
    labels: Vec<String>,
    /// Whether a color map of categories shows it.
    has_categories: bool,
}

/// A key `column` in the scene file.
#[derive(Clone)]
struct ColumnPlace {
    span: std::ops::Range<usize>,
    has_automatic_range: bool,
}

/// The values of these columns that the files and tables of a prototype have.
#[derive(Default)]
pub(in crate::scene) struct Found {
    /// The columns that files of solids of a material have instead, and instance tables.
    others: BTreeSet<String>,
    /// The least and greatest values of the solids of a material.
    ranges: BTreeMap<MaterialIndex, [f32; 2]>,
    /// The least and greatest values of placements.
    placed_ranges: BTreeMap<String, [f32; 2]>,
}

/// That a name can be that of a column in a table.
pub(super) fn check_name(source: &Source, name: &Spanned<String>) -> Result<(), SceneError> {
    let text = name.get_ref();
    let is_name = !text.is_empty()
        && text.trim() == text
        && !text.contains(|c: char| c == '"' || c.is_control());
    match is_name {
        true => Ok(()),
        false => Err(source.error(
            name.span(),
            format!(
                "{} is not the name of a column: it must not be empty, contain quotes or control characters, or begin or end with blanks",
                quoted(text)
            ),
        )),
    }
}

impl DataColumns {
    /// The columns of the materials, given the keys `color` of all but the first, default one.
    pub fn new<'k>(
        source: &Source,
        materials: &[Material],
        keys: impl IntoIterator<Item = Option<&'k ColorKeys>>,
    ) -> Result<Self, SceneError> {
        let mut columns = Self {
            list: Vec::new(),
            of_material: vec![None],
            places: vec![None],
        };
        for (material, keys) in materials.iter().skip(1).zip(keys) {
            let key = keys.map(Spanned::get_ref);
            let column = key.and_then(ColorKey::column);
            let (Color::Data(data), Some(key), Some(column)) = (&material.color, key, column)
            else {
                columns.of_material.push(None);
                columns.places.push(None);
                continue;
            };
            let mut list = columns.list.iter_mut();
            let known = list.find(|known| known.name == data.column);
            match known {
                Some(known) => {
                    known.has_categories |= data.map.has_categories();
                    if known.labels.is_empty() {
                        known.labels.clone_from(&data.labels);
                    } else if let Some(labels) = key.labels()
                        && *labels.get_ref() != known.labels
                    {
                        return Err(source.error(
                            labels.span(),
                            format!(
                                "the labels of the column {} differ from those of another material",
                                quoted(&data.column)
                            ),
                        ));
                    }
                }
                None => columns.list.push(DataColumn {
                    name: data.column.clone(),
                    labels: data.labels.clone(),
                    has_categories: data.map.has_categories(),
                }),
            }
            let place = columns
                .list
                .iter()
                .position(|known| known.name == data.column);
            columns.of_material.push(place);
            columns.places.push(Some(ColumnPlace {
                span: column.span(),
                has_automatic_range: key.has_automatic_range(),
            }));
        }
        Ok(columns)
    }

    /// The column of a material.
    pub fn of(&self, material: MaterialIndex) -> Option<&DataColumn> {
        let place = *self.of_material.get(usize::from(material.0))?;
        place.map(|place| &self.list[place])
    }

    /// All columns.
    pub fn iter(&self) -> impl Iterator<Item = &DataColumn> {
        self.list.iter()
    }

    /// Checks that each column has values, and sets the automatic ranges.
    pub fn complete(
        &self,
        source: &Source,
        materials: &mut [Material],
        found: &Found,
    ) -> Result<(), SceneError> {
        for (index, place) in self.places.iter().enumerate() {
            let Some(place) = place else { continue };
            let Color::Data(data) = &mut materials[index].color else {
                continue;
            };
            let material = MaterialIndex(index as u16);
            let placed = found.placed_ranges.get(&data.column);
            if placed.is_none() && !found.ranges.contains_key(&material) {
                let others = found.others.iter().map(String::as_str);
                return Err(source.error_with_help(
                    place.span.clone(),
                    format!(
                        "no solid with this material and no placement has a value in a column {}",
                        quoted(&data.column)
                    ),
                    suggestion(&data.column, others, "columns"),
                ));
            }
            if place.has_automatic_range && !data.map.has_categories() {
                let ranges = (0..self.of_material.len())
                    .filter(|&other| self.of_material[other] == self.of_material[index])
                    .filter_map(|other| found.ranges.get(&MaterialIndex(other as u16)));
                data.range =
                    DataColor::automatic_range(ranges.chain(placed).copied().reduce(union));
            }
        }
        Ok(())
    }
}

impl DataColumn {
    /// The column in a table, if the table has it.
    pub fn in_table(
        &self,
        table: &NamedTable,
        place: std::ops::Range<usize>,
    ) -> Result<Option<Column>, SceneError> {
        let key = self.key();
        match table.has(&key) {
            true => table.column_at(&key, place).map(Some),
            false => Ok(None),
        }
    }

    /// The key that finds the column in a table.
    pub fn key(&self) -> ColumnKey {
        ColumnKey::Name(self.name.clone())
    }

    /// The value in a row: NaN if the cell marks a missing one.
    pub fn value(&self, row: &Row, column: Column) -> Result<f32, SceneError> {
        let cell = row.cell(column);
        if let Some(number) = self.labels.iter().position(|label| label == cell) {
            return Ok(number as f32);
        }
        let number = match row.number(column) {
            Ok(number) => number,
            Err(Fault::Degenerate { .. }) => return Ok(f32::NAN),
            Err(Fault::Wrong(_)) if self.has_categories => {
                let message = format!("{} is neither a whole number nor a label", quoted(cell));
                let help = "the key labels of the color lists the texts of its column: labels = [\"axon\", \"dendrite\"]";
                return Err(row.error_with_help(Some(column), message, Some(help)));
            }
            Err(Fault::Wrong(error)) => return Err(error),
        };
        if self.has_categories && !DataColor::is_category(number) {
            let message = format!(
                "{number} is not a category: it must be a whole number from 0 to {}",
                DataColor::GREATEST_CATEGORY
            );
            return Err(row.error(Some(column), message));
        }
        Ok(DataColor::stored(number))
    }

    /// The value that the table of a single solid or placement states.
    pub fn stated(
        &self,
        source: &Source,
        keys: Option<&Spanned<ValueKeys>>,
    ) -> Result<Option<f32>, SceneError> {
        let Some((keys, number)) =
            keys.and_then(|keys| Some((keys, keys.get_ref().get(&self.name)?)))
        else {
            return Ok(None);
        };
        if self.has_categories && !DataColor::is_category(number.0) {
            let message = format!(
                "{} is {}: a category must be a whole number from 0 to {}",
                self.name,
                number.0,
                DataColor::GREATEST_CATEGORY
            );
            return Err(source.error(keys.span(), message));
        }
        Ok(Some(DataColor::stored(number.0)))
    }
}

impl Found {
    /// A file has these columns, but not the one that is shown.
    pub fn others(&mut self, columns: impl IntoIterator<Item = impl Into<String>>) {
        self.others.extend(columns.into_iter().map(Into::into));
    }

    /// A solid of a material has a value.
    pub fn value(&mut self, material: MaterialIndex, value: f32) {
        if !value.is_nan() {
            let range = self.ranges.entry(material).or_insert([value; 2]);
            *range = union(*range, [value; 2]);
        }
    }

    /// Placements have values between these.
    pub fn placed_range(&mut self, column: &str, range: [f32; 2]) {
        let known = self.placed_ranges.get(column).copied().unwrap_or(range);
        self.placed_ranges
            .insert(column.to_owned(), union(known, range));
    }

    /// Adds what other prototypes have.
    pub fn extend(&mut self, other: Self) {
        self.others.extend(other.others);
        for (material, range) in other.ranges {
            self.value(material, range[0]);
            self.value(material, range[1]);
        }
        for (column, range) in other.placed_ranges {
            self.placed_range(&column, range);
        }
    }
}

/// The range that contains two others.
pub(in crate::scene) fn union(one: [f32; 2], other: [f32; 2]) -> [f32; 2] {
    [one[0].min(other[0]), one[1].max(other[1])]
}
