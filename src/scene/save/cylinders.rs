//! Cylinders: tables of their own if they are few, otherwise rows of a `[[cylinder_table]]` for
//! each combination of caps and material.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::Write;

use super::solids::{Numbers, numbered};
use super::tables::{distinct, push_cells, push_value, quoted_name};
use super::{SaveError, Saver};
use crate::scene::cylinder_list::CylinderList;
use crate::scene::record::MaterialIndex;
use crate::solid::{Caps, Cylinder};

/// Most cylinders of a prototype that a scene file states one by one.
const FEW: usize = 16;

/// The columns of a table, the last only if it states primitive numbers.
const NAMES: [&str; 8] = ["x0", "y0", "z0", "x1", "y1", "z1", "radius", "primitive"];

/// The cylinders of one table.
struct Group {
    caps: Caps,
    material: MaterialIndex,
    /// Where they are in their list, in the order of their numbers.
    positions: Vec<u32>,
}

impl<W: Write> Saver<'_, W> {
    /// The cylinders of a prototype.
    pub fn cylinders(
        &mut self,
        numbers: &mut Numbers,
        prefix: &str,
        list: &CylinderList,
    ) -> Result<(), SaveError> {
        if list.len() <= FEW {
            return self.list(numbers, prefix, "cylinder", list);
        }
        for group in groups(list)? {
            self.cylinder_table(numbers, prefix, list, &group)?;
        }
        Ok(())
    }

    fn cylinder_table(
        &mut self,
        numbers: &mut Numbers,
        prefix: &str,
        list: &CylinderList,
        group: &Group,
    ) -> Result<(), SaveError> {
        let primitive = |position: &u32| list.primitive(*position as usize);
        let positions = &group.positions;
        let follows = |(index, position)| {
            u64::from(primitive(position)) == u64::from(numbers.next) + index as u64
        };
        let is_numbered = !positions.iter().enumerate().all(follows);
        let values = numbers.values;
        let has_value = |position: &u32| values.get(primitive(position)).is_some();
        let column = self.column(group.material);
        let column = column.filter(|_| positions.iter().any(has_value));
        let names = distinct(NAMES, &self.columns());
        let [x0, y0, z0, x1, y1, z1, radius, number] = &names;
        let stated = if is_numbered {
            NAMES.len()
        } else {
            NAMES.len() - 1
        };
        let mut header = names[..stated].join(",");
        if let Some(column) = column {
            header = header + "," + &quoted_name(column);
        }
        let tables = &mut self.tables;
        let file = tables.add("cylinders", &header, positions.len(), |row, index| {
            let record = list.get(positions[index] as usize);
            push_cells(row, &cells(&record.cylinder()));
            if is_numbered {
                // A String accepts everything.
                let _ = write!(row, ",{}", record.primitive());
            }
            if column.is_some() {
                push_value(row, values.get(record.primitive()));
            }
        })?;
        let material = self.material(group.material)?;
        let mut entry = self.text.table(&format!("[[{prefix}cylinder_table]]"));
        entry.text("file", &file);
        let ends = format!(
            r#"p0 = ["{x0}", "{y0}", "{z0}"], p1 = ["{x1}", "{y1}", "{z1}"], radius = "{radius}""#
        );
        let columns = match is_numbered {
            false => format!("{{ {ends} }}"),
            true => format!("{{ {ends}, primitive = \"{number}\" }}"),
        };
        entry.verbatim("columns", &columns);
        entry.caps(group.caps);
        entry.material(material);
        if let Some(last) = positions.last() {
            numbers.next = primitive(last).wrapping_add(1);
        }
        Ok(())
    }
}

/// The numbers of a row.
fn cells(cylinder: &Cylinder) -> [f64; 7] {
    let ([x0, y0, z0], [x1, y1, z1]) = (cylinder.p0().to_array(), cylinder.p1().to_array());
    [x0, y0, z0, x1, y1, z1, cylinder.radius()]
}

/// The cylinders by caps and material, in the order of the first of each group.
fn groups(list: &CylinderList) -> Result<Vec<Group>, SaveError> {
    let mut groups: Vec<Group> = Vec::new();
    let mut index = HashMap::new();
    for position in numbered(list) {
        let record = list.get(position as usize);
        let cylinder = record.cylinder();
        if let Some(number) = cells(&cylinder).into_iter().find(|x| !x.is_finite()) {
            return Err(SaveError::NotFinite {
                place: format!("a number of the cylinder {}", record.primitive()),
                number,
            });
        }
        let (caps, material) = (cylinder.caps(), record.material());
        let group = *index.entry((caps, material)).or_insert_with(|| {
            groups.push(Group {
                caps,
                material,
                positions: Vec::new(),
            });
            groups.len() - 1
        });
        groups[group].positions.push(position);
    }
    Ok(groups)
}
