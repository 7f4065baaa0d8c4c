//! Set operations with their operands.

use std::io::Write;

use super::solids::Numbers;
use super::text::Entry;
use super::{SaveError, Saver};
use crate::scene::record::CompositionRecord;
use crate::scene::solids::SceneSolid;
use crate::solid::{Composition, SolidKind};
use crate::with_solid;

/// Most operations inside each other: the parser of scene files accepts 80 nested values, and
/// an operation takes three of them, the numbers of the innermost solid up to two.
const MOST_NESTED: usize = 26;

impl<W: Write> Saver<'_, W> {
    /// The set operations of a prototype, those of one kind after the other.
    pub fn operations(
        &mut self,
        numbers: &mut Numbers,
        prefix: &str,
        records: &[CompositionRecord],
    ) -> Result<(), SaveError> {
        for &kind in SolidKind::OPERATIONS {
            let header = format!("[[{prefix}{kind}]]");
            for record in records.iter().filter(|record| record.solid.kind() == kind) {
                let primitive = record.primitive;
                let operands = operands(&record.solid).ok_or(SaveError::Operation {
                    primitive,
                    reason: "is a single solid, not an operation",
                })?;
                check(operands, MOST_NESTED)
                    .map_err(|reason| SaveError::Operation { primitive, reason })?;
                let (column, material) = (
                    self.column(record.material),
                    self.material(record.material)?,
                );
                let mut entry = self.text.table(&header);
                entry.list("of", operands, operand);
                entry.material(material);
                numbers.state(&mut entry, primitive, column);
                self.text.check()?;
            }
        }
        Ok(())
    }
}

/// The operands of an operation.
fn operands(composition: &Composition) -> Option<&[Composition]> {
    match composition {
        Composition::Solid(_) => None,
        Composition::Union(parts)
        | Composition::Intersection(parts)
        | Composition::Difference(parts) => Some(parts),
    }
}

/// An operand between its braces.
fn operand(entry: &mut Entry, part: &Composition) {
    match part {
        Composition::Solid(solid) => with_solid!(solid, known => {
            entry.inline(solid.kind().name(), |entry| known.state(entry));
        }),
        operation => entry.inline(operation.kind().name(), |entry| {
            entry.list("of", operands(operation).unwrap_or_default(), operand);
        }),
    }
}

/// That a scene file can state an operation, with at most `levels` inside each other.
fn check(operands: &[Composition], levels: usize) -> Result<(), &'static str> {
    if operands.is_empty() {
        return Err("has no operands");
    }
    if levels == 0 {
        return Err("is nested too deep: 26 levels are read");
    }
    operands.iter().try_for_each(|part| match part {
        Composition::Solid(solid) if !solid.is_closed() => Err("has an operand that is not closed"),
        Composition::Solid(_) => Ok(()),
        operation => check(self::operands(operation).unwrap_or_default(), levels - 1),
    })
}
