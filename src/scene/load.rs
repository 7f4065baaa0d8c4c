//! From a scene file to a checked description.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use toml::Spanned;

use super::camera::camera;
use super::description::{Prototype, PrototypeIndex, Scene};
use super::document::{
    Body, CylinderTableKeys, Document, InstanceTableKeys, PrototypeKeys, ScatterKeys, SwcKeys,
};
use super::error::SceneError;
use super::graph::{self, Node};
use super::names::{quoted, suggestion};
use super::placing::{Edge, Placements};
use super::scatter::{Pattern, Scatter};
use super::settings::{Materials, check_names, film, lights, render};
use super::solids::{Degenerate, Look, Solids};
use super::source::Source;
use super::swc::add_swc;
use super::transform::GREATEST_ENTRY;
use super::values::{Keys, NumberOrList};
use crate::solid::Caps;

/// A scene file that has been read; the files that it names have not.
pub struct SceneFile {
    source: Source,
    document: Document,
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// When the file cannot be read, is no TOML, or has keys or types other
    /// than those of `docs/scene-file.md`.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_toml(path).map_err(|error| match error {
            SceneError::Unreadable { .. } => error,
            other => other_kind(path).unwrap_or(other),
        })
    }

    fn read_toml(path: &Path) -> Result<Self, SceneError> {
        let source = Source::read(path)?;
        let document = toml::from_str(source.text()).map_err(|error| source.toml_error(&error))?;
        Ok(Self { source, document })
    }

    /// The files that the scene names, whether they exist or not.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let document = &self.document;
        let mut names = Vec::new();
        let mut add = |tables: &[Keys<CylinderTableKeys>],
                       neurons: &[Keys<SwcKeys>],
                       placements: &[Keys<InstanceTableKeys>]| {
            names.extend(tables.iter().map(|Keys(keys)| keys.file.get_ref().clone()));
            names.extend(neurons.iter().map(|Keys(keys)| keys.file.get_ref().clone()));
            names.extend(
                placements
                    .iter()
                    .map(|Keys(keys)| keys.file.get_ref().clone()),
            );
        };
        add(
            &document.cylinder_table,
            &document.swc,
            &document.instance_table,
        );
        for Keys(keys) in &document.prototype {
            add(&keys.cylinder_table, &keys.swc, &keys.instance_table);
        }
        let paths = names.iter().map(|name| self.source.resolve(name));
        paths.collect()
    }

    /// Reads the files that the scene names, and checks everything.
    ///
    /// # Errors
    /// Those of [`load`].
    pub fn load(self) -> Result<Scene, SceneError> {
        lower(&self.source, self.document)
    }
}

/// That a file which is no scene is data or a picture, as its name says.
fn other_kind(path: &Path) -> Option<SceneError> {
    const TO_READ: &str = " that names it";
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let file = |fallback: &str| {
        let name = path.file_name().and_then(|name| name.to_str());
        toml::Value::from(name.unwrap_or(fallback)).to_string()
    };
    let columns = r#"columns = { p0 = ["startX", "startY", "startZ"], p1 = ["endX", "endY", "endZ"], radius = "radius" }"#;
    let (what, purpose, example) = match extension.as_str() {
        "csv" | "tsv" => (
            "a table",
            TO_READ,
            format!("[[cylinder_table]]\nfile = {}\n{columns}", file("tree.csv")),
        ),
        "swc" => (
            "a neuron in SWC",
            TO_READ,
            format!("[[swc]]\nfile = {}", file("neuron.swc")),
        ),
        "png" | "exr" | "jpg" | "jpeg" => (
            "a picture",
            "",
            format!("[[cylinder_table]]\nfile = \"tree.csv\"\n{columns}"),
        ),
        _ => return None,
    };
    Some(SceneError::NotAScene {
        path: path.to_owned(),
        what,
        purpose,
        example,
    })
}

/// Reads a scene file and the tables it names, and checks everything.
///
/// `docs/scene-file.md` describes the file. Paths in it are relative to its
/// folder.
///
/// # Errors
/// When a file cannot be read, or anything in one is not as described there.
/// The error's text names the file, the line and the value, and says what
/// would be right.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    SceneFile::read(path)?.load()
}

fn lower(source: &Source, document: Document) -> Result<Scene, SceneError> {
    let materials = Materials::new(source, &document.material)?;
    let index = prototype_index(source, &document.prototype)?;
    let loader = Loader {
        source,
        materials: &materials,
        prototypes: &index,
    };
    let root = Body {
        cylinder: document.cylinder,
        cylinder_table: document.cylinder_table,
        swc: document.swc,
        instance: document.instance,
        instance_table: document.instance_table,
        scatter: document.scatter,
    };
    let mut bodies = vec![loader.body("", root)?];
    for Keys(keys) in document.prototype {
        bodies.push(loader.prototype(keys)?);
    }
    let nodes: Vec<Node> = bodies.iter().map(Lowered::node).collect();
    graph::check(source, &nodes)?;

    let sun = document.sun.map(|Keys(keys)| keys);
    let sky = document.sky.map(|Keys(keys)| keys);
    let lights = lights(
        source,
        sun.as_ref(),
        sky.as_ref(),
        document.background.as_ref(),
    )?;
    Ok(Scene {
        camera: camera(source, &keys(document.camera))?,
        film: film(source, &keys(document.film))?,
        render: render(source, &keys(document.render))?,
        sun: lights.sun,
        sky: lights.sky,
        background: lights.background,
        skipped_rows: bodies.iter().map(|body| body.skipped).sum(),
        prototypes: bodies.into_iter().map(|body| body.prototype).collect(),
        materials: materials.list,
    })
}

/// The keys of a table, all of them at their defaults where it is not stated.
fn keys<T: Default>(table: Option<Keys<T>>) -> T {
    table.map_or_else(T::default, |Keys(keys)| keys)
}

/// The numbers of the prototypes; the root has none of their names.
fn prototype_index(
    source: &Source,
    prototypes: &[Keys<PrototypeKeys>],
) -> Result<HashMap<String, PrototypeIndex>, SceneError> {
    check_names(
        source,
        "prototype",
        prototypes.iter().map(|Keys(keys)| &keys.name),
    )?;
    Ok((PrototypeIndex::ROOT.0 + 1..)
        .zip(prototypes)
        .map(|(index, Keys(keys))| (keys.name.get_ref().clone(), PrototypeIndex(index)))
        .collect())
}

/// What every entry of a prototype may refer to.
struct Loader<'a> {
    source: &'a Source,
    materials: &'a Materials,
    prototypes: &'a HashMap<String, PrototypeIndex>,
}

/// A prototype, and what the check of all prototypes needs of it.
struct Lowered {
    prototype: Prototype,
    edges: Vec<Edge>,
    reach: f64,
    skipped: u64,
}

impl Lowered {
    fn node(&self) -> Node<'_> {
        Node {
            prototype: &self.prototype,
            edges: &self.edges,
            reach: self.reach,
            skipped: self.skipped,
        }
    }
}

impl Loader<'_> {
    fn prototype(&self, keys: PrototypeKeys) -> Result<Lowered, SceneError> {
        let body = Body {
            cylinder: keys.cylinder,
            cylinder_table: keys.cylinder_table,
            swc: keys.swc,
            instance: keys.instance,
            instance_table: keys.instance_table,
            scatter: keys.scatter,
        };
        self.body(keys.name.get_ref(), body)
    }

    /// The solids and placements, in the order of their numbers.
    fn body(&self, name: &str, body: Body) -> Result<Lowered, SceneError> {
        let source = self.source;
        let mut solids = Solids::default();
        for Keys(keys) in &body.cylinder {
            let look = self.look(keys.caps.as_ref(), keys.material.as_ref())?;
            solids.add_cylinder(source, keys, look)?;
        }
        for Keys(keys) in &body.cylinder_table {
            let look = self.look(keys.caps.as_ref(), keys.material.as_ref())?;
            let degenerate = self.degenerate(keys.degenerate.as_ref())?;
            solids.add_table(source, keys, look, degenerate)?;
        }
        for Keys(keys) in &body.swc {
            let look = self.look(keys.caps.as_ref(), keys.material.as_ref())?;
            let degenerate = self.degenerate(keys.degenerate.as_ref())?;
            add_swc(&mut solids, source, keys, look, degenerate)?;
        }

        let mut placements = Placements::default();
        for Keys(keys) in &body.instance {
            placements.add_instance(source, keys, self.placed(&keys.of)?)?;
        }
        for Keys(keys) in &body.instance_table {
            placements.add_table(source, keys, self.placed(&keys.of)?)?;
        }
        for Keys(keys) in &body.scatter {
            let of = self.placed(&keys.of)?;
            let scatter = self.scatter(keys)?;
            placements.add_scatter(source, &keys.of, of, &scatter)?;
        }

        solids.records.shrink_to_fit();
        placements.list.shrink_to_fit();
        Ok(Lowered {
            prototype: Prototype {
                name: name.to_owned(),
                cylinders: solids.records,
                placements: placements.list,
            },
            edges: placements.edges,
            reach: solids.reach,
            skipped: solids.skipped,
        })
    }

    fn look(
        &self,
        caps: Option<&Spanned<String>>,
        material: Option<&Spanned<String>>,
    ) -> Result<Look, SceneError> {
        const CAPS: [(&str, Caps); 4] = [
            ("none", Caps::None),
            ("p0", Caps::P0),
            ("p1", Caps::P1),
            ("both", Caps::Both),
        ];
        Ok(Look {
            caps: match caps {
                Some(word) => self.source.choose("caps", word, &CAPS)?,
                None => Caps::default(),
            },
            material: self.materials.find(self.source, material)?,
        })
    }

    fn degenerate(&self, word: Option<&Spanned<String>>) -> Result<Degenerate, SceneError> {
        const POLICIES: [(&str, Degenerate); 2] =
            [("error", Degenerate::Error), ("skip", Degenerate::Skip)];
        word.map_or(Ok(Degenerate::Error), |word| {
            self.source.choose("degenerate", word, &POLICIES)
        })
    }

    fn placed(&self, of: &Spanned<String>) -> Result<PrototypeIndex, SceneError> {
        self.prototypes.get(of.get_ref()).copied().ok_or_else(|| {
            let mut names: Vec<&str> = self.prototypes.keys().map(String::as_str).collect();
            names.sort_unstable();
            self.source.error_with_help(
                of.span(),
                format!("there is no prototype {}", quoted(of.get_ref())),
                suggestion(of.get_ref(), names, "prototypes"),
            )
        })
    }

    fn scatter(&self, keys: &ScatterKeys) -> Result<Scatter, SceneError> {
        const PATTERNS: [(&str, Pattern); 2] = [("grid", Pattern::Grid), ("disc", Pattern::Disc)];
        const YAWS: [(&str, bool); 2] = [("none", false), ("random", true)];
        let wrong = |place, message: String| Err(self.source.error(place, message));

        let count = keys.count.get_ref().0;
        let Some(count) = u32::try_from(count).ok().filter(|&count| count > 0) else {
            return wrong(
                keys.count.span(),
                format!("count is {count}: it must be between 1 and {}", u32::MAX),
            );
        };
        let spacing = keys.spacing.get_ref().0;
        if spacing <= 0.0 {
            return wrong(
                keys.spacing.span(),
                format!("spacing is {spacing}: it must be a positive length"),
            );
        }
        let scale = keys
            .scale
            .as_ref()
            .map_or([1.0; 2], |scale| match scale.get_ref() {
                NumberOrList::One(scale) => [*scale; 2],
                NumberOrList::Many(range) => *range,
            });
        let accepted = 1.0 / GREATEST_ENTRY..=GREATEST_ENTRY;
        if let Some(key) = &keys.scale
            && !(accepted.contains(&scale[0])
                && accepted.contains(&scale[1])
                && scale[0] <= scale[1])
        {
            return wrong(
                key.span(),
                format!(
                    "scale is [{}, {}]: it must be a positive number, or the least and the greatest, in that order, between 2^-100 and 2^100",
                    scale[0], scale[1]
                ),
            );
        }
        let scatter = Scatter {
            pattern: self.source.choose("pattern", &keys.pattern, &PATTERNS)?,
            count,
            spacing,
            random_yaw: match &keys.yaw {
                Some(word) => self.source.choose("yaw", word, &YAWS)?,
                None => false,
            },
            scale,
            seed: keys.seed.map_or(0, |seed| seed.0),
        };
        if scatter.reach().translation > GREATEST_ENTRY {
            return wrong(
                keys.spacing.span(),
                format!("spacing is {spacing}: with {count} items it reaches beyond 2^100"),
            );
        }
        Ok(scatter)
    }
}
