//! Writes a scene as a scene file with tables beside it: the counterpart of
//! [`load`](super::load()).
//!
//! `text` writes keys, and `tables` the rows of tables; the parts of a scene are written one a
//! file: `picture` (camera, film, lights, materials), `drawings` (legend, scale bar, axes, outlines,
//! depth cue, clip planes), `environment`, `solids`, `cylinders`, `operations` and `placements`. The
//! keys of each kind of solid are written where they are read, in [`solids`](super::solids).
//!
//! A number is written as the shortest decimal that reads back as the same f64. Primitive
//! numbers follow from the order of a scene file; where they do not, the key or column
//! `primitive` states them.

mod cylinders;
mod drawings;
mod environment;
mod error;
mod operations;
mod picture;
mod placements;
mod solids;
mod tables;
mod text;

use std::collections::HashSet;
use std::io::{self, Write};

pub use error::SaveError;
pub(super) use text::Entry;

use glam::DVec3;

use self::tables::Tables;
use self::text::Text;
use super::description::{Prototype, PrototypeIndex, Scene};
use super::record::{MaterialIndex, Records};
use crate::math::is_unit;

/// What is being written.
struct Saver<'a, W> {
    scene: &'a Scene,
    /// The scene file so far.
    text: Text,
    tables: Tables<'a, W>,
}

/// Writes a scene as the scene file `STEM.toml` and the tables that it names, in the same
/// folder.
///
/// `create` makes an output of a name, and `complete` gets it back with everything written and
/// flushed: first the images and tables `STEM_image_1.png`, `STEM_cylinders_2.csv`,
/// `STEM_instances_3.csv` and so on, one after the other, and last the scene file. So the caller decides how and when files come into
/// place. Rows are made on the rayon pool that this is called in, and are never all in memory.
///
/// **What is promised.** [`load`](super::load()) reads the same scene from the files, to the
/// last bit of every number: prototypes, solids with their primitive numbers and materials,
/// placements with their instance numbers, the values that materials show, camera, film,
/// render settings, lights, environment, clip planes, legend, illustration and background. If the
/// scene breaks a rule of `docs/scene-file.md`, which only scenes made in code do, this function or
/// `load` fails; `load` never reads another scene.
///
/// Some of a [`Scene`] is about the files that it was read from, and is not written:
/// [`Scene::notes`], [`Scene::skipped_rows`] (the numbers of skipped rows stay unused),
/// the origins of solids and placements, and [`Scene::rounding`]: cylinders in f32 are
/// written as they are, so that reading them rounds nothing. The order of the cylinders in
/// memory may change, and so may that of lights of different shapes; the name of the root is
/// not written.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = cyltrace::scene::load(std::path::Path::new("scenes/minimal.toml"))?;
/// let folder = tempfile::tempdir()?;
/// let create = |name: &str| std::fs::File::create(folder.path().join(name));
/// cyltrace::scene::save(&scene, "copy", create, |file| file.sync_all())?;
/// let copy = cyltrace::scene::load(&folder.path().join("copy.toml"))?;
/// assert_eq!(copy.camera, scene.camera);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// When an output cannot be created, written or completed, when the scene states what a scene file
/// cannot, or when the scene file would be larger than
/// [`GREATEST_SCENE_BYTES`](super::GREATEST_SCENE_BYTES): cylinders and placements are in
/// tables, but every other solid takes some hundred bytes of it.
pub fn save<W: Write>(
    scene: &Scene,
    stem: &str,
    mut create: impl FnMut(&str) -> io::Result<W>,
    mut complete: impl FnMut(W) -> io::Result<()>,
) -> Result<(), SaveError> {
    if stem.is_empty() || stem.contains(['/', '\\', '\0']) {
        return Err(SaveError::Stem { stem: stem.into() });
    }
    let [_, named @ ..] = scene.prototypes.as_slice() else {
        return Err(SaveError::NoRoot);
    };
    check_names("prototype", named.iter().map(|one| one.name.as_str()))?;
    let mut saver = Saver {
        scene,
        text: Text::default(),
        tables: Tables::new(stem, &mut create, &mut complete),
    };
    if records(scene)? == Records::F32 {
        saver.text.top().text("records", Records::F32.name());
    }
    picture::state(&mut saver.text, &mut saver.tables, scene)?;
    saver.environment()?;
    for (index, prototype) in scene.prototypes.iter().enumerate() {
        let prefix = match index {
            0 => "",
            _ => {
                let mut entry = saver.text.table("[[prototype]]");
                entry.text("name", &prototype.name);
                "prototype."
            }
        };
        saver.prototype(prefix, prototype)?;
    }
    let Saver { text, tables, .. } = saver;
    tables.finish(&text.complete()?)
}

impl<'a, W: Write> Saver<'a, W> {
    /// The solids and placements of a prototype.
    fn prototype(&mut self, prefix: &str, prototype: &Prototype) -> Result<(), SaveError> {
        self.solids(prefix, prototype)?;
        self.placements(prefix, prototype)
    }

    /// The name of a material, which the default one has not.
    fn material(&self, index: MaterialIndex) -> Result<Option<&'a str>, SaveError> {
        let material = self.scene.materials.get(usize::from(index.0));
        let material = material.ok_or(SaveError::Reference {
            what: "material",
            index: index.0.into(),
        })?;
        Ok(Some(material.name.as_str()).filter(|_| index != MaterialIndex::default()))
    }

    /// The column that a material shows, if it shows one.
    fn column(&self, index: MaterialIndex) -> Option<&'a str> {
        self.scene
            .materials
            .get(usize::from(index.0))?
            .color
            .column()
    }

    /// All columns that materials show. No other column of a table may have the name of one.
    fn columns(&self) -> Vec<&'a str> {
        let materials = self.scene.materials.iter();
        materials
            .filter_map(|material| material.color.column())
            .collect()
    }

    /// The name of a prototype that is placed.
    fn placed(&self, index: PrototypeIndex) -> Result<&'a str, SaveError> {
        let prototype = self.scene.prototypes.get(index.0 as usize);
        let prototype = prototype.filter(|_| index != PrototypeIndex::ROOT);
        let prototype = prototype.ok_or(SaveError::Reference {
            what: "prototype",
            index: index.0,
        })?;
        Ok(&prototype.name)
    }
}

/// How all cylinders are stored: a scene file states that once.
fn records(scene: &Scene) -> Result<Records, SaveError> {
    let lists = scene.prototypes.iter().map(|one| &one.solids.cylinders);
    let mut stored = lists
        .filter(|list| !list.is_empty())
        .map(|list| list.records());
    let first = stored.next().unwrap_or_else(|| scene.records());
    match stored.all(|records| records == first) {
        true => Ok(first),
        false => Err(SaveError::MixedRecords),
    }
}

/// Rejects a vector whose length is not 1 to within roundings.
fn check_unit(what: &'static str, vector: DVec3) -> Result<(), SaveError> {
    match is_unit(vector) {
        true => Ok(()),
        false => Err(SaveError::NotUnit {
            what,
            length: vector.length(),
        }),
    }
}

/// That no name is empty and no two are the same.
fn check_names<'n>(
    what: &'static str,
    names: impl Iterator<Item = &'n str>,
) -> Result<(), SaveError> {
    let mut known = HashSet::new();
    // The first of either has no name: the root, and the default material.
    for (index, name) in (1..).zip(names) {
        if name.is_empty() || !known.insert(name) {
            let name = name.to_owned();
            return Err(SaveError::Name { what, index, name });
        }
    }
    Ok(())
}
