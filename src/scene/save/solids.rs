//! The solids of a prototype, in the order in which a scene file numbers them.

use std::borrow::Borrow;
use std::io::Write;

use super::text::Entry;
use super::{SaveError, Saver};
use crate::for_each_solid;
use crate::scene::colors::ValueList;
use crate::scene::description::Prototype;
use crate::scene::solid_lists::SolidList;
use crate::scene::solids::SceneSolid;

/// The primitive numbers of the solids of a prototype, and their values.
pub(super) struct Numbers<'a> {
    /// The number that a scene file gives to the next solid.
    pub next: u32,
    /// The values by primitive number.
    pub values: &'a ValueList,
}

impl Numbers<'_> {
    /// States the number of a solid, if it does not follow from the one before, and its value,
    /// if its material shows a column.
    pub fn state(&mut self, entry: &mut Entry, primitive: u32, column: Option<&str>) {
        if primitive != self.next {
            entry.whole("primitive", primitive);
        }
        self.next = primitive.wrapping_add(1);
        entry.values(column.zip(self.values.get(primitive)));
    }
}

/// The positions of the solids of a list, in the order of their numbers.
pub(super) fn numbered<L: SolidList>(list: &L) -> Vec<u32> {
    let mut positions: Vec<u32> = (0..list.len() as u32).collect();
    positions.sort_by_key(|&position| list.primitive(position as usize));
    positions
}

/// States the lists but the first, which is that of the cylinders.
macro_rules! state_in_order {
    (
        $saver:ident $numbers:ident $prefix:ident $solids:ident;
        { $first_type:ident $first:ident $first_list:ident $($first_rest:tt)* }
        $({ $type:ident $name:ident $list:ident $($rest:tt)* })*
    ) => {
        $saver.cylinders(&mut $numbers, $prefix, &$solids.$first_list)?;
        $($saver.list(&mut $numbers, $prefix, stringify!($name), &$solids.$list)?;)*
    };
}

impl<W: Write> Saver<'_, W> {
    /// All solids of a prototype.
    pub fn solids(&mut self, prefix: &str, prototype: &Prototype) -> Result<(), SaveError> {
        let solids = &prototype.solids;
        let mut numbers = Numbers {
            next: 0,
            values: &prototype.solid_values,
        };
        for_each_solid!(state_in_order self numbers prefix solids;);
        self.operations(&mut numbers, prefix, &solids.compositions)
    }

    /// The solids of a list, each with a table of its own.
    pub fn list<L: SolidList<Solid: SceneSolid>>(
        &mut self,
        numbers: &mut Numbers,
        prefix: &str,
        name: &str,
        list: &L,
    ) -> Result<(), SaveError> {
        let header = format!("[[{prefix}{name}]]");
        for position in numbered(list) {
            let position = position as usize;
            let material = list.material(position);
            let (column, material) = (self.column(material), self.material(material)?);
            let mut entry = self.text.table(&header);
            list.solid(position).borrow().state(&mut entry);
            entry.material(material);
            numbers.state(&mut entry, list.primitive(position), column);
            self.text.check()?;
        }
        Ok(())
    }
}
