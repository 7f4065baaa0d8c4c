//! Single solids in scene files, one file for each kind: the keys of its table, the solid
//! given by them, and the solid moved by a pose.

mod cone;
mod cuboid;
mod cylinder;
mod disk;
mod rounded_cone;
mod sphere;

use std::fmt::Display;
use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;

use super::error::SceneError;
use super::rigid_motion::RigidMotion;
use super::save::Entry;
use super::solid_keys::{CAPS, SolidTable};
use super::source::Source;
use crate::solid::{AnySolid, Caps, ConvexSolid};

/// A kind of solid in scene files.
pub(super) trait SceneSolid: ConvexSolid + Into<AnySolid> {
    /// The keys of its table.
    type Keys: SolidKeys + DeserializeOwned;

    /// Why numbers are not a valid solid of this kind.
    type Error: Display;

    /// The solid moved by a rigid motion.
    fn moved(&self, motion: &RigidMotion) -> Result<Self, Self::Error>;

    /// States the solid without a pose.
    fn state(&self, entry: &mut Entry);
}

/// The table of one kind of solid.
pub(super) trait SolidKeys: SolidTable {
    /// The place of errors about the solid as a whole.
    fn place(&self) -> Range<usize>;

    /// The place of the key for the closed ends.
    fn caps_place(&self) -> Option<Range<usize>> {
        None
    }

    /// The solid before its pose is applied.
    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError>;
}

/// The closed ends of a solid.
pub(super) fn caps(source: &Source, word: Option<&Spanned<String>>) -> Result<Caps, SceneError> {
    word.map_or(Ok(Caps::default()), |word| {
        source.choose("caps", word, &CAPS)
    })
}

/// A solid of its kind, or the error at its place.
fn with_span<S: SceneSolid>(
    source: &Source,
    solid: Result<S, S::Error>,
    place: impl FnOnce(&S::Error) -> Range<usize>,
) -> Result<AnySolid, SceneError> {
    solid
        .map(Into::into)
        .map_err(|error| source.error(place(&error), error.to_string()))
}
