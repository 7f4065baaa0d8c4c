//! A scene file that has been read, before the files that it names are read.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use toml::Spanned;

use super::background::{Background, background};
use super::colors::{ValueList, header_bytes};
use super::contents::{ExpectedCounts, ExpectedSolids, mark_used, placed_counts};
use super::description::{Film, PrototypeIndex, RenderSettings, Scene};
use super::document::{Body, Document, EnvironmentKeys};
use super::environment_file::{pixels, reading_bytes};
use super::error::SceneError;
use super::formats::{self, SolidFile};
use super::load::{lower, records};
use super::named_table::table_rows;
use super::record::Records;
use super::set_operations::operand_count;
use super::settings::{film, render};
use super::source::Source;
use super::toml_message::toml_error;
use super::values::Keys;

/// Reads a scene file and the files that it names, and validates them.
///
/// `docs/scene-file.md` describes the file. Paths in it are relative to its
/// folder.
///
/// # Errors
/// If a file cannot be read, or differs from that description. The message names
/// the file, the line and the value, and states what would be right.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    SceneFile::read(path)?.load()
}

/// A scene file that has been read; the files that it names have not.
pub struct SceneFile {
    source: Source,
    document: Document,
    reads_environment: bool,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// If the file cannot be read, is not TOML, or has keys or types other than those in
    /// `docs/scene-file.md`.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_toml(path).map_err(|error| match error {
            SceneError::Unreadable { .. } => error,
            other => other_kind(path).unwrap_or(other),
        })
    }

    fn read_toml(path: &Path) -> Result<Self, SceneError> {
        Self::of(Source::read(path)?)
    }

    /// The scene file of this text, as if `path` had been read: files that it names are relative
    /// to the folder of `path`.
    ///
    /// # Errors
    /// If the text is not TOML, or has keys or types other than those in `docs/scene-file.md`.
    pub fn parse(path: &Path, text: String) -> Result<Self, SceneError> {
        Self::of(Source::new(path, text))
    }

    fn of(source: Source) -> Result<Self, SceneError> {
        let document =
            toml::from_str(source.text()).map_err(|error| toml_error(&source, &error))?;
        Ok(Self {
            source,
            document,
            reads_environment: true,
        })
    }

    /// The path of the scene file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.source.path()
    }

    /// The files that the scene names, whether they exist or not.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut names = Vec::new();
        for body in self.document.bodies() {
            names.extend(body.files().map(SolidFile::file));
            names.extend(body.instance_table.iter().map(|Keys(keys)| &keys.file));
        }
        names.extend(self.images());
        let environment = self.document.environment.iter();
        names.extend(environment.map(|Keys(keys)| &keys.file));
        let paths = names.iter().map(|name| self.source.resolve(name.get_ref()));
        paths.collect()
    }

    /// The image files of materials.
    fn images(&self) -> impl Iterator<Item = &Spanned<String>> {
        let colors = self.document.material.iter();
        colors.filter_map(|Keys(keys)| keys.color.as_ref()?.get_ref().image())
    }

    /// The names of the materials that show a column, and the number of different columns.
    fn shown(&self) -> (HashSet<&str>, u64) {
        let materials = self.document.material.iter();
        let shown = materials.filter_map(|Keys(keys)| {
            let column = keys.color.as_ref()?.get_ref().column()?;
            Some((keys.name.get_ref().as_str(), column.get_ref().as_str()))
        });
        let (materials, columns): (HashSet<_>, HashSet<_>) = shown.unzip();
        (materials, columns.len() as u64)
    }

    /// The size of the picture, and how it is rendered.
    ///
    /// # Errors
    /// If a value is wrong, as when the scene is loaded.
    pub fn picture(&self) -> Result<(Film, RenderSettings), SceneError> {
        let (film_keys, render_keys) = (&self.document.film, &self.document.render);
        let film_keys = film_keys.as_ref().map(|Keys(keys)| keys);
        let render_keys = render_keys.as_ref().map(|Keys(keys)| keys);
        Ok((
            film(&self.source, film_keys.unwrap_or(&Default::default()))?,
            render(
                &self.source,
                render_keys.unwrap_or(&Default::default()),
                self.document.default_integrator(),
            )?,
        ))
    }

    /// Whether the file states an integrator; otherwise it follows from materials and lights.
    #[must_use]
    pub fn states_integrator(&self) -> bool {
        let keys = self.document.render.as_ref();
        keys.is_some_and(|Keys(keys)| keys.integrator.is_some())
    }

    /// What is behind the scene.
    ///
    /// # Errors
    /// If the value is wrong, as when the scene is loaded.
    pub fn background(&self) -> Result<Background, SceneError> {
        background(&self.source, self.document.background.as_ref())
    }

    /// Upper bounds of the contents of the prototypes, in their order. Tables are counted by
    /// their lines, lattices by their beams; a file that cannot be read counts as empty. No
    /// record is made, so a scene that is too large can be rejected in advance.
    #[must_use]
    pub fn contents(&self) -> Vec<ExpectedCounts> {
        let records = records(&self.source, self.document.records.as_ref()).unwrap_or_default();
        let index: HashMap<&str, PrototypeIndex> = (0..)
            .zip(self.document.bodies())
            .map(|(number, body)| (body.name, PrototypeIndex(number)))
            .collect();
        let (shown, columns) = self.shown();
        let value = ValueList::VALUE_BYTES + ValueList::RUN_BYTES;
        let of = |name: &Spanned<String>| index.get(name.get_ref().as_str()).copied();
        let count = |body: Body| {
            let mut values_bytes = columns * value * body.instance.len() as u64;
            let single = body.instance.iter();
            let single = single.map(|Keys(keys)| (of(&keys.of), 1));
            let mut placed_rows = 0_u64;
            let tables = body.instance_table.iter();
            let tables = tables.map(|Keys(keys)| {
                let Keys(columns) = keys.columns.get_ref();
                let rows = table_rows(&self.source, &keys.file, columns.all().first());
                placed_rows = placed_rows.saturating_add(rows);
                (of(&keys.of), rows)
            });
            let mut placed: Vec<_> = single.chain(tables).collect();
            let placed_values = placed_rows.saturating_mul(columns * ValueList::VALUE_BYTES);
            values_bytes = values_bytes.saturating_add(placed_values);
            if body.name.is_empty() {
                let images = self.images();
                let images = images.map(|name| header_bytes(&self.source.resolve(name.get_ref())));
                values_bytes = values_bytes.saturating_add(images.sum());
            }
            // Loading rejects larger numbers before it makes anything.
            let mut total: u64 = placed.iter().map(|(_, count)| count).sum();
            for Keys(keys) in body.scatter {
                let count = keys.count.get_ref().0;
                total = total.saturating_add(count);
                if total <= u64::from(u32::MAX) {
                    placed.push((of(&keys.of), count));
                }
            }
            let placed = placed
                .into_iter()
                .filter_map(|(of, count)| Some((of?, count)));
            let (solids, solid_values) = self.solids(&body, records, &shown);
            ExpectedCounts {
                name: body.name.to_owned(),
                solids,
                placed: placed_counts(placed),
                values_bytes: values_bytes.saturating_add(solid_values),
                is_used: false,
            }
        };
        let mut contents: Vec<_> = self.document.bodies().map(count).collect();
        mark_used(&mut contents);
        contents
    }

    /// The most bytes that files take while they are read on some threads, besides their
    /// records: a thread reads the files of a prototype one after the other. The pixels of
    /// pictures are included.
    #[must_use]
    pub fn reading_bytes(&self, threads: usize) -> u64 {
        let of_body = |body: Body| {
            let files = body.files();
            let bytes = files.map(|file| file.reading_bytes(&self.source));
            bytes.max().unwrap_or(0)
        };
        let mut bytes: Vec<u64> = self.document.bodies().map(of_body).collect();
        bytes.sort_unstable_by(|one, other| other.cmp(one));
        let environment = self.read_environment().into_iter();
        let environment = environment.map(|keys| reading_bytes(&self.source, keys));
        bytes.into_iter().take(threads).chain(environment).sum()
    }

    /// The numbers of solids that a prototype itself contains, and the bytes of their values.
    fn solids(
        &self,
        body: &Body,
        records: Records,
        shown: &HashSet<&str>,
    ) -> (ExpectedSolids, u64) {
        let mut solids = ExpectedSolids::default();
        let mut values_bytes = 0_u64;
        for file in body.files() {
            let before = solids.counts.total();
            file.count(&self.source, records, &mut solids);
            let material = file.material().map(|name| name.get_ref().as_str());
            if material.is_some_and(|name| shown.contains(name)) {
                let more = u64::try_from(solids.counts.total() - before).unwrap_or(u64::MAX);
                let bytes = more.saturating_mul(file.value_bytes());
                values_bytes = values_bytes.saturating_add(bytes + ValueList::RUN_BYTES);
            }
        }
        if !shown.is_empty() {
            let stated: usize = body.solids().map(|(_, stated)| stated).sum();
            let operations = body.operations().map(|(_, tables)| tables.len());
            let stated = stated + operations.iter().sum::<usize>();
            let value = ValueList::VALUE_BYTES + ValueList::RUN_BYTES;
            values_bytes = values_bytes.saturating_add(value * stated as u64);
        }
        for (kind, stated) in body.solids() {
            solids.add(kind, stated as u64, records);
        }
        for (operation, tables) in body.operations() {
            for Keys(keys) in tables {
                solids.add(operation.kind(), 1, records);
                solids.add_operands(operand_count(keys));
            }
        }
        (solids, values_bytes)
    }

    /// The scene without its environment, which only pictures show. Its keys are validated, but its
    /// file is not read.
    #[must_use]
    pub fn without_environment(self) -> Self {
        Self {
            reads_environment: false,
            ..self
        }
    }

    /// The environment whose file is read.
    fn read_environment(&self) -> Option<&EnvironmentKeys> {
        let environment = self.document.environment.as_ref();
        let Keys(keys) = environment.filter(|_| self.reads_environment)?;
        Some(keys)
    }

    /// The number of pixels of the environment; 0 if there is none, or if its file is not or
    /// cannot be read.
    #[must_use]
    pub fn environment_pixels(&self) -> u64 {
        self.read_environment()
            .map_or(0, |keys| pixels(&self.source, keys))
    }

    /// Reads the files that the scene names, and validates the scene.
    ///
    /// # Errors
    /// See [`load`](super::load()).
    pub fn load(self) -> Result<Scene, SceneError> {
        self.load_within(None)
    }

    /// As [`SceneFile::load`], with at most `memory` bytes for the records of pipes, whose rows
    /// [`SceneFile::contents`] cannot count; `None` sets no limit.
    ///
    /// # Errors
    /// See [`load`](super::load()); also if the rows of pipes exceed the memory.
    pub fn load_within(self, memory: Option<u64>) -> Result<Scene, SceneError> {
        lower(&self.source, self.document, memory, self.reads_environment)
    }
}

/// The error that a file is data or a picture instead of a scene, judged by its extension.
fn other_kind(path: &Path) -> Option<SceneError> {
    const PICTURES: &[&str] = &["png", "exr", "jpg", "jpeg"];
    let name = path.file_name()?.to_str()?;
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let named = |name: &str| toml::Value::from(name).to_string();
    let (what, purpose, example) = match formats::example(&extension, &named(name)) {
        Some((what, example)) => (what, " that names it", example),
        None if PICTURES.contains(&extension.as_str()) => {
            let (_, example) = formats::example("csv", &named("tree.csv"))?;
            ("a picture", "", example)
        }
        None => return None,
    };
    Some(SceneError::NotAScene {
        path: path.to_owned(),
        what,
        purpose,
        example,
    })
}
