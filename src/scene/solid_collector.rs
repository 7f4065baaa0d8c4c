//! Collects the solids of a prototype and assigns their primitive numbers.

use std::borrow::Borrow;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;

use super::colors::{Found, ValueList};
use super::cylinder_list::CylinderList;
use super::error::SceneError;
use super::origins::Origins;
use super::record::{MaterialIndex, Records, SolidRecord};
use super::solid_lists::{Listed, SolidList, Solids};
use super::source::Source;
use crate::math::Bounds;
use crate::solid::{
    AnySolid, Caps, Composition, ConeError, ConvexSolid, Cylinder, CylinderError, SolidKind,
};
use crate::with_solid;

/// The help for rows that `degenerate = "skip"` would skip.
pub(super) const SKIP_HELP: &str =
    "degenerate = \"skip\" in the scene file skips such rows and counts them";

/// The help for a cylinder that is invalid in f32.
const F64_HELP: &str = "records = \"f64\", the default, stores every number unrounded";

/// The solids of one prototype.
#[derive(Default)]
pub(super) struct SolidCollector {
    pub solids: Solids,
    /// The next primitive number.
    next: u32,
    /// The number that was left unused last.
    free: Option<u32>,
    /// Where the scene file first states a primitive number.
    pub numbered_at: Option<Range<usize>>,
    /// Rows that were skipped; they keep their numbers.
    pub skipped: u64,
    /// An upper bound of the size of the solids' coordinates.
    pub reach: f64,
    /// Notes on the files for the user.
    pub notes: Vec<String>,
    /// The source files of the solids.
    pub origins: Origins,
    /// The values of solids whose material has a data color.
    pub values: ValueList,
    /// What was found of the columns of data colors.
    pub found: Found,
    /// The file that is being read.
    file: Option<File>,
}

/// A file that is being read, and the solids of it that have consecutive numbers so far.
struct File {
    name: Arc<str>,
    /// The row of the first, in a table.
    first_row: Option<u32>,
    first: u32,
}

/// The properties that the solids of an entry share.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub caps: Caps,
    pub material: MaterialIndex,
}

/// Why a solid cannot be added.
#[derive(Debug, PartialEq)]
pub(super) enum Refusal {
    /// No primitive number is left.
    Numbers,
    /// A primitive number that is stated is too large.
    Number(u64),
    /// After rounding to f32 the solid is invalid, for this reason.
    Rounded { kind: SolidKind, error: String },
}

impl Refusal {
    /// The message, and the help if there is one.
    pub fn message(&self) -> (String, Option<&'static str>) {
        match self {
            Self::Numbers => {
                let most = u32::MAX;
                (
                    format!("a prototype can contain at most {most} primitives"),
                    None,
                )
            }
            Self::Number(number) => {
                let most = u32::MAX - 1;
                (
                    format!("primitive is {number}: it must be at most {most}"),
                    None,
                )
            }
            Self::Rounded { kind, error } => (
                format!("this {kind} is invalid after rounding to f32: {error}"),
                Some(F64_HELP),
            ),
        }
    }

    /// The error for a row of a table that the scene file names.
    pub fn in_row(
        &self,
        source: &Source,
        file: &Spanned<String>,
        row: impl FnOnce(String, Option<&str>) -> SceneError,
    ) -> SceneError {
        let (message, help) = self.message();
        match self {
            Self::Numbers => source.error(file.span(), message),
            Self::Number(_) | Self::Rounded { .. } => row(message, help),
        }
    }
}

/// The treatment of rows that give no valid solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Degenerate {
    Error,
    Skip,
}

impl SolidCollector {
    /// An empty collector that stores cylinders in the given precision.
    pub fn new(records: Records) -> Self {
        Self {
            solids: Solids {
                cylinders: CylinderList::new(records),
                ..Solids::default()
            },
            ..Self::default()
        }
    }

    /// Takes the next primitive number.
    fn number(&mut self) -> Result<u32, Refusal> {
        let number = self.next;
        // The greatest u32 is left out: Embree's mark for "no primitive".
        self.next = number.checked_add(1).ok_or(Refusal::Numbers)?;
        Ok(number)
    }

    /// Sets the value of the solid that was added last; NaN is no value. A number that was left
    /// unused gets none, but keeps its place among those of the file.
    pub fn value(&mut self, material: MaterialIndex, value: f32) {
        let number = self.next - 1;
        let value = match self.free == Some(number) {
            true => f32::NAN,
            false => value,
        };
        self.values.push(number, value);
        self.found.value(material, value);
    }

    /// Continues the primitive numbers from one that the scene file states at a place.
    pub fn number_from(&mut self, number: u64, place: Range<usize>) -> Result<(), Refusal> {
        self.numbered_at.get_or_insert(place);
        let known = u32::try_from(number).ok().filter(|&known| known < u32::MAX);
        let known = known.ok_or(Refusal::Number(number))?;
        if known != self.next {
            let file = self.end_run();
            self.next = known;
            self.file = file.map(|file| File {
                first: known,
                ..file
            });
        }
        Ok(())
    }

    /// Adds a solid.
    pub fn push<S: Listed + ConvexSolid>(
        &mut self,
        solid: S,
        material: MaterialIndex,
    ) -> Result<(), Refusal> {
        let record = SolidRecord::new(solid, self.number()?, material);
        let list = S::list_mut(&mut self.solids);
        list.push(record).map_err(|error| Refusal::Rounded {
            kind: S::KIND,
            error,
        })?;
        // The list may have rounded it.
        let kept: S = *list.solid(list.len() - 1).borrow();
        self.reach_to(&kept.bounds());
        Ok(())
    }

    /// Adds a solid of any kind.
    pub fn push_any(&mut self, solid: &AnySolid, material: MaterialIndex) -> Result<(), Refusal> {
        with_solid!(*solid, solid => self.push(solid, material))
    }

    /// Adds a composed solid.
    pub fn push_composition(
        &mut self,
        solid: Composition,
        material: MaterialIndex,
    ) -> Result<(), Refusal> {
        let primitive = self.number()?;
        // The result of an operation may be empty, so the bound covers all of its parts.
        for part in solid.solids() {
            self.reach_to(&part.bounds());
        }
        let record = SolidRecord::new(solid, primitive, material);
        self.solids.compositions.push(record);
        Ok(())
    }

    fn reach_to(&mut self, bounds: &Bounds) {
        let corner = bounds.lower.abs().max(bounds.upper.abs());
        self.reach = self.reach.max(corner.max_element());
    }

    /// Adds a note, unless it exists.
    pub fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|known| known == note) {
            self.notes.push(note.to_owned());
        }
    }

    /// Begins with the solids of a file. `has_rows` is true of a table.
    pub fn begin_file(&mut self, name: &str, has_rows: bool) {
        self.file = Some(File {
            name: name.into(),
            first_row: has_rows.then_some(0),
            first: self.next,
        });
    }

    /// Ends with the solids of a file.
    pub fn end_file(&mut self) {
        self.end_run();
    }

    /// Records what the solids with consecutive numbers come from, and returns the file as it
    /// continues with others.
    fn end_run(&mut self) -> Option<File> {
        let file = self.file.take()?;
        let (first, end) = (file.first, self.next);
        if first < end {
            let name = Arc::clone(&file.name);
            self.origins.add(name, file.first_row, first, end);
        }
        let first_row = file.first_row.map(|row| row + (end - first));
        Some(File { first_row, ..file })
    }

    /// Skips a row; it keeps its primitive number.
    pub fn skip(&mut self) -> Result<(), Refusal> {
        self.skipped += 1;
        self.leave_free()
    }

    /// Leaves the next primitive number unused.
    pub fn leave_free(&mut self) -> Result<(), Refusal> {
        self.free = Some(self.number()?);
        Ok(())
    }
}

/// Whether a row with this error is degenerate. Negative radii and numbers out of
/// range are not degenerate: they are always errors.
pub(super) fn is_degenerate(error: &CylinderError) -> bool {
    match error {
        CylinderError::Endpoint { .. } => false,
        CylinderError::Radius { radius } => (0.0..Cylinder::LEAST).contains(radius),
        CylinderError::Length { .. } => true,
    }
}

/// [`is_degenerate`] for a cone or a rounded cone. One radius may be zero.
pub(super) fn is_degenerate_cone(error: &ConeError) -> bool {
    match error {
        ConeError::Endpoint { .. } => false,
        ConeError::Radius { radius, .. } => (0.0..Cylinder::LEAST).contains(radius),
        ConeError::NoRadius | ConeError::Length { .. } => true,
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn primitive_numbers_that_run_out_are_an_error() {
        let mut solids = SolidCollector {
            next: u32::MAX - 1,
            ..SolidCollector::default()
        };
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::X, 1.0, Caps::Both).expect("valid");
        assert_eq!(solids.push(cylinder, MaterialIndex(0)), Ok(()));
        assert_eq!(solids.solids.cylinders.primitive(0), u32::MAX - 1);
        let refusal = solids.skip().expect_err("no number is left");
        assert_eq!(refusal, Refusal::Numbers);
        let (message, _) = refusal.message();
        assert!(
            message.contains("at most 4294967295 primitives"),
            "{message}"
        );
    }

    #[test]
    fn only_rows_without_extent_are_degenerate() {
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
