//! The solids of a prototype, in the order in which a scene file numbers them.

use std::borrow::Borrow;
use std::io::Write;

use super::text::Entry;
use super::{SaveError, Saver};
use crate::for_each_solid;
use crate::scene::solid_lists::{SolidList, Solids};
use crate::scene::solids::SceneSolid;

/// The primitive number that a scene file gives to the next solid.
#[derive(Default)]
pub(super) struct Numbers {
    pub next: u32,
}

impl Numbers {
    /// States the number of a solid, if it does not follow from the one before.
    pub fn state(&mut self, entry: &mut Entry, primitive: u32) {
        if primitive != self.next {
            entry.whole("primitive", primitive);
        }
        self.next = primitive.wrapping_add(1);
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
    pub fn solids(&mut self, prefix: &str, solids: &Solids) -> Result<(), SaveError> {
        let mut numbers = Numbers::default();
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
            let material = self.material(list.material(position))?;
            let mut entry = self.text.table(&header);
            list.solid(position).borrow().state(&mut entry);
            entry.material(material);
            numbers.state(&mut entry, list.primitive(position));
            self.text.check()?;
        }
        Ok(())
    }
}
