//! The formats of files that contain solids, one file or folder each.
//!
//! A scene file names such files in arrays of tables (`[[swc]]`). A new format is a module
//! with keys that implement [`SolidFormat`] and a row in
//! [`for_each_solid_format!`]; `docs/architecture.md` has the recipe. Formats of meshes are in
//! `meshes/formats`.

mod beam_lattice;
mod cylinder_table;
mod swc;

use serde::de::DeserializeOwned;
use toml::Spanned;

use super::colors::{DataColumn, DataColumns, ValueList};
use super::contents::ExpectedSolids;
use super::error::SceneError;
use super::materials::Materials;
use super::named_table::Tables;
use super::record::{MaterialIndex, Records};
use super::solid_collector::{Degenerate, Look, SolidCollector};
use super::solids::caps;
use super::source::Source;

pub(super) use beam_lattice::BeamLatticeKeys;
pub use beam_lattice::beams_of_model;
pub(super) use cylinder_table::CylinderTableKeys;
pub(super) use swc::SwcKeys;
pub use swc::check_swc;

/// A format of files that contain solids. The implementors are the keys of the arrays of
/// tables that name such files in a scene file.
pub(super) trait SolidFormat: SolidFile + DeserializeOwned {
    /// A noun for its files, with an article.
    const WHAT: &'static str;

    /// The extensions of its files, in lower case.
    const EXTENSIONS: &'static [&'static str];

    /// Example lines that a scene file needs in addition to the name of the file.
    const EXAMPLE: &'static str = "";
}

/// A file of one of the formats, as a scene file names it.
pub(super) trait SolidFile {
    /// The file.
    fn file(&self) -> &Spanned<String>;

    /// The material of its solids.
    fn material(&self) -> Option<&Spanned<String>>;

    /// An upper bound of the bytes of a solid's value, if its material shows a column.
    fn value_bytes(&self) -> u64 {
        ValueList::VALUE_BYTES
    }

    /// Whether a solid's number is that of its row in the file.
    fn has_rows(&self) -> bool {
        false
    }

    /// Adds upper bounds of the numbers of its solids, before the file is read.
    /// [`add`](Self::add) reports errors of the keys and the file.
    fn count(&self, source: &Source, records: Records, solids: &mut ExpectedSolids);

    /// An upper bound of the bytes that reading the file takes besides the records of its solids.
    fn reading_bytes(&self, _: &Source) -> u64 {
        0
    }

    /// Reads the file and adds its solids.
    ///
    /// # Errors
    /// If a key, the file or a solid in it is wrong.
    fn add(&self, context: &Context, solids: &mut SolidCollector) -> Result<(), SceneError>;
}

/// A format of files that contain solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolidFormatInfo {
    /// The key of scene files that names such files.
    pub key: &'static str,
    /// A noun for its files, with an article.
    pub what: &'static str,
    /// The extensions of its files, in lower case.
    pub extensions: &'static [&'static str],
}

/// Calls a macro with the list of the formats: `for_each_solid_format!(callback arguments)`
/// becomes `callback! { arguments rows }`, with a row `{ Keys name }` for each; `name` is the
/// key of the scene file. Solids are numbered in this order, so append new rows at the end.
macro_rules! for_each_solid_format {
    ($callback:ident $($arguments:tt)*) => {
        $callback! {
            $($arguments)*
            { CylinderTableKeys cylinder_table }
            { SwcKeys swc }
            { BeamLatticeKeys beam_lattice }
        }
    };
}

pub(super) use for_each_solid_format;

/// The data that the formats share while a scene is loaded.
pub(super) struct Context<'a> {
    pub source: &'a Source,
    pub tables: &'a Tables<'a>,
    pub materials: &'a Materials,
    pub columns: &'a DataColumns,
}

impl Context<'_> {
    fn material(&self, name: Option<&Spanned<String>>) -> Result<MaterialIndex, SceneError> {
        self.materials.find(self.source, name)
    }

    /// The column that a material shows, of a file with these columns.
    fn known_column<T: Copy>(
        &self,
        material: MaterialIndex,
        known: &[(&str, T)],
        solids: &mut SolidCollector,
    ) -> Option<(&DataColumn, T)> {
        let column = self.columns.of(material)?;
        let Some((_, meaning)) = known.iter().find(|(name, _)| *name == column.name) else {
            solids.found.others(known.iter().map(|(name, _)| *name));
            return None;
        };
        Some((column, *meaning))
    }

    fn look(
        &self,
        caps: Option<&Spanned<String>>,
        material: Option<&Spanned<String>>,
    ) -> Result<Look, SceneError> {
        Ok(Look {
            caps: self::caps(self.source, caps)?,
            material: self.material(material)?,
        })
    }

    fn degenerate(&self, word: Option<&Spanned<String>>) -> Result<Degenerate, SceneError> {
        const POLICIES: [(&str, Degenerate); 2] =
            [("error", Degenerate::Error), ("skip", Degenerate::Skip)];
        word.map_or(Ok(Degenerate::Error), |word| {
            self.source.choose("degenerate", word, &POLICIES)
        })
    }
}

macro_rules! names {
    ($({ $keys:ident $name:ident })*) => {
        /// The keys of scene files that name files of solids.
        pub(super) const KEYS: &[&str] = &[$(stringify!($name)),*];

        /// The noun for a file with this extension, and an example of a scene file that
        /// names it `file`; `None` if it is of no format.
        pub(super) fn example(extension: &str, file: &str) -> Option<(&'static str, String)> {
            $(
                if <$keys as SolidFormat>::EXTENSIONS.contains(&extension) {
                    let lines = [
                        concat!("[[", stringify!($name), "]]"),
                        &format!("file = {file}"),
                        <$keys as SolidFormat>::EXAMPLE,
                    ];
                    let text = lines.join("\n").trim_end().to_owned();
                    return Some((<$keys as SolidFormat>::WHAT, text));
                }
            )*
            None
        }

        /// The formats of files that contain solids.
        pub const SOLID_FORMATS: &[SolidFormatInfo] = &[$(
            SolidFormatInfo {
                key: stringify!($name),
                what: <$keys as SolidFormat>::WHAT,
                extensions: <$keys as SolidFormat>::EXTENSIONS,
            },
        )*];
    };
}

for_each_solid_format!(names);
