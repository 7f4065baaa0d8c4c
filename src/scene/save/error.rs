//! Why a scene cannot be saved.

use std::io;

use crate::scene::limits::GREATEST_SCENE_BYTES;
use crate::scene::names::quoted;

/// Why a scene cannot be saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The stem of the files' names is empty or contains a separator of folders.
    #[error(
        "{} cannot begin the names of files: it must not be empty or contain /, \\ or NUL",
        quoted(stem)
    )]
    Stem {
        /// The stem as given.
        stem: String,
    },
    /// An output cannot be created or written.
    #[error("cannot write {name}: {source}")]
    Output {
        /// The name of the output.
        name: String,
        /// The error of the caller's function, or of the output.
        source: io::Error,
    },
    /// The scene file would be too large.
    #[error(
        "the scene file would be larger than {GREATEST_SCENE_BYTES} bytes, the most that are read: solids other than cylinders have no tables"
    )]
    TooLarge,
    /// The scene has no prototypes, so that it has no root.
    #[error("the scene has no prototypes: the first is the scene itself")]
    NoRoot,
    /// A material or prototype has no name, or that of another.
    #[error(
        "the {what} {index} has the name {}: names must differ and not be empty",
        quoted(name)
    )]
    Name {
        /// `"material"` or `"prototype"`.
        what: &'static str,
        /// Its position in the scene.
        index: usize,
        /// Its name.
        name: String,
    },
    /// The first material is not the default one.
    #[error("the first material must be the default one: without a name, and of color 0.5")]
    DefaultMaterial,
    /// A solid has a material, or a placement a prototype, that the scene does not have; the
    /// root cannot be placed either.
    #[error("there is no {what} {index} to refer to")]
    Reference {
        /// `"material"` or `"prototype"`.
        what: &'static str,
        /// The position in the scene that is referred to.
        index: u32,
    },
    /// A number is not finite.
    #[error("{place} is {number}: the numbers of a scene file are finite")]
    NotFinite {
        /// What it is.
        place: String,
        /// The number.
        number: f64,
    },
    /// The direction of the sun or the normal of a clip plane is not a unit vector.
    #[error("{what} has the length {length}: it must be 1 to within roundings")]
    NotUnit {
        /// `"the sun's direction"` or `"the normal of a clip plane"`.
        what: &'static str,
        /// Its length.
        length: f64,
    },
    /// Cut faces have the default material.
    #[error("a clip plane has the default material, which has no name to refer to")]
    DefaultMaterialOfClip,
    /// Some prototypes store cylinders in f64 and others in f32.
    #[error("cylinders are stored in f64 and in f32: a scene file has one precision for all")]
    MixedRecords,
    /// A set operation is not one that scene files state.
    #[error("the set operation {primitive} {reason}")]
    Operation {
        /// Its primitive number.
        primitive: u32,
        /// What is wrong with it.
        reason: &'static str,
    },
}
