//! Turns a scene file into a validated description.

use std::collections::HashMap;
use std::ops::Range;

use rayon::prelude::*;
use toml::Spanned;

use super::background::background;
use super::camera::camera;
use super::clip_keys::clips;
use super::colors::{DataColumns, Found};
use super::description::{Prototype, PrototypeIndex, Scene};
use super::document::{Body, CameraKeys, Document, PrototypeKeys};
use super::environment_file;
use super::error::SceneError;
use super::formats::Context;
use super::graph::{self, Node};
use super::illustration_keys::{IllustrationKeys, illustration};
use super::materials::{Materials, check_names};
use super::named_table::{PipeMemory, Tables};
use super::names::{quoted, suggestion};
use super::origins::Origins;
use super::placed_lights::placed_lights;
use super::placing::{Edge, Placements};
use super::pose;
use super::record::{MaterialIndex, Records};
use super::scatter::Scatter;
use super::set_operations::{CompositionKeys, Operation};
use super::settings::{film, lights, render};
use super::solid_collector::{Refusal, SolidCollector};
use super::solid_keys::SolidTable;
use super::solids::SolidKeys;
use super::source::Source;
use super::values::{Keys, Whole};
use crate::for_each_solid;

/// Turns the keys of a scene file into the scene.
pub(super) fn lower(
    source: &Source,
    document: Document,
    memory: Option<u64>,
    reads_environment: bool,
) -> Result<Scene, SceneError> {
    let memory = PipeMemory::new(memory);
    let mut materials = Materials::new(source, &document.material)?;
    let colors = document
        .material
        .iter()
        .map(|Keys(keys)| keys.color.as_ref());
    let columns = DataColumns::new(source, &materials.list, colors)?;
    let index = prototype_index(source, &document.prototype)?;
    let loader = Loader {
        source,
        memory: &memory,
        records: records(source, document.records.as_ref())?,
        materials: &materials,
        columns: &columns,
        prototypes: &index,
    };
    // Prototypes are loaded side by side; the first error in their order is the one reported.
    let bodies: Vec<Body> = document.bodies().collect();
    let bodies = bodies.par_iter().with_max_len(1);
    let bodies: Vec<_> = bodies.map(|body| loader.body(body)).collect();
    let mut bodies = bodies.into_iter().collect::<Result<Vec<_>, _>>()?;
    let nodes: Vec<Node> = bodies.iter().map(Lowered::node).collect();
    graph::check(source, &nodes)?;
    let mut found = Found::default();
    for body in &mut bodies {
        found.extend(std::mem::take(&mut body.found));
    }
    columns.complete(source, &mut materials.list, &found)?;
    let legend = document.legend.as_ref();
    let legend = legend.map(|Keys(keys)| keys.legend(source, &materials));
    let legend = legend.transpose()?;
    let default_camera = CameraKeys::default();
    let camera_keys = document.camera.as_ref();
    let camera_keys = camera_keys.map_or(&default_camera, |Keys(keys)| keys);
    let camera = camera(source, camera_keys)?;
    let legend_keys = document.legend.as_ref().map(|Keys(keys)| keys);
    let tables = IllustrationKeys {
        scale_bar: document.scale_bar.as_ref(),
        axes: document.axes.as_ref(),
        outlines: document.outlines.as_ref(),
        depth_cue: document.depth_cue.as_ref(),
    };
    let illustration = illustration(source, tables, &camera, legend_keys.zip(legend.as_ref()))?;

    let clips = clips(source, &materials, &document.clip)?;
    let placed_lights = placed_lights(
        source,
        &document.point_light,
        &document.sphere_light,
        &document.rectangle_light,
    )?;
    let integrator = document.default_integrator();
    if let (Some(Keys(keys)), Some(_)) = (&document.environment, &document.sky) {
        return Err(source.error(
            keys.file.span(),
            "[environment] excludes [sky], as both are light from all directions: use one",
        ));
    }
    let environment = match &document.environment {
        Some(Keys(keys)) => environment_file::environment(source, keys, reads_environment)?,
        None => None,
    };
    let sun = document.sun.map(|Keys(keys)| keys);
    let sky = document.sky.map(|Keys(keys)| keys);
    let lights = lights(source, sun.as_ref(), sky.as_ref())?;
    let notes = bodies.iter().flat_map(|body| body.notes.clone());
    let table_notes = bodies.iter().flat_map(|body| body.table_notes.clone());
    let notes = notes.chain(table_notes).collect();
    Ok(Scene {
        camera,
        film: film(source, &keys(document.film))?,
        render: render(source, &keys(document.render), integrator)?,
        sun: lights.sun,
        sky: lights.sky,
        clear_sky: lights.clear_sky,
        environment,
        lights: placed_lights,
        background: background(source, document.background.as_ref())?,
        clips,
        legend,
        illustration,
        skipped_rows: bodies.iter().map(|body| body.skipped).sum(),
        notes,
        prototypes: bodies.into_iter().map(|body| body.prototype).collect(),
        materials: materials.list,
    })
}

/// The keys of a table, or default keys if the file does not contain it.
fn keys<T: Default>(table: Option<Keys<T>>) -> T {
    table.map_or_else(T::default, |Keys(keys)| keys)
}

/// The precision of cylinders.
pub(super) fn records(
    source: &Source,
    word: Option<&Spanned<String>>,
) -> Result<Records, SceneError> {
    let choices = [Records::F64, Records::F32].map(|records| (records.name(), records));
    word.map_or(Ok(Records::default()), |word| {
        source.choose("records", word, &choices)
    })
}

/// The indices of the prototypes by name, without the root.
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

/// The data that the entries of a prototype refer to.
struct Loader<'a> {
    source: &'a Source,
    memory: &'a PipeMemory,
    records: Records,
    materials: &'a Materials,
    columns: &'a DataColumns,
    prototypes: &'a HashMap<String, PrototypeIndex>,
}

/// A prototype, and the data that the check of all prototypes needs.
struct Lowered {
    prototype: Prototype,
    edges: Vec<Edge>,
    reach: f64,
    skipped: u64,
    notes: Vec<String>,
    table_notes: Vec<String>,
    found: Found,
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

/// Adds the solids of each kind. The numbers of solids from files follow those of the first
/// kind, the cylinders.
macro_rules! add_in_order {
    (
        $loader:ident $solids:ident $body:ident $tables:ident;
        { $first_type:ident $first:ident $($first_rest:tt)* }
        $({ $type:ident $name:ident $($rest:tt)* })*
    ) => {
        $loader.add_solids(&mut $solids, $body.$first)?;
        $loader.add_files(&mut $solids, $body, &$tables)?;
        $($loader.add_solids(&mut $solids, $body.$name)?;)*
    };
}

impl Loader<'_> {
    /// Collects the solids and placements of a prototype, in the order of their numbers.
    fn body(&self, body: &Body) -> Result<Lowered, SceneError> {
        let source = self.source;
        let tables = Tables::new(source, self.memory);
        let mut solids = SolidCollector::new(self.records);
        for_each_solid!(add_in_order self solids body tables;);
        for (operation, tables) in body.operations() {
            self.add_compositions(&mut solids, operation, tables)?;
        }
        self.sort(&mut solids)?;

        let mut placements = Placements::new(self.columns);
        let mut placement_origins = Origins::default();
        for Keys(keys) in body.instance {
            placements.add_instance(source, keys, self.placed(&keys.of)?)?;
        }
        for Keys(keys) in body.instance_table {
            let first = placements.list.len() as u32;
            placements.add_table(&tables, keys, self.placed(&keys.of)?)?;
            let end = placements.list.len() as u32;
            placement_origins.add(keys.file.get_ref().as_str().into(), Some(0), first, end);
        }
        let scatters = body.scatter.iter().map(|Keys(keys)| {
            let of = self.placed(&keys.of)?;
            Ok((&keys.of, of, Scatter::new(source, keys)?))
        });
        placements.add_scatters(source, &scatters.collect::<Result<Vec<_>, _>>()?)?;

        solids.solids.trim();
        solids.solids.cylinders.arrange();
        placements.list.shrink_to_fit();
        solids.values.finish();
        let mut found = solids.found;
        let placement_values = placements.values(&mut found);
        Ok(Lowered {
            prototype: Prototype {
                name: body.name.to_owned(),
                solids: solids.solids,
                placements: placements.list,
                solid_values: solids.values,
                placement_values,
                solid_origins: solids.origins,
                placement_origins,
            },
            edges: placements.edges,
            reach: solids.reach,
            skipped: solids.skipped,
            notes: solids.notes,
            table_notes: tables.into_notes(),
            found,
        })
    }

    /// Adds the solids from files.
    fn add_files(
        &self,
        solids: &mut SolidCollector,
        body: &Body,
        tables: &Tables,
    ) -> Result<(), SceneError> {
        let context = Context {
            source: self.source,
            tables,
            materials: self.materials,
            columns: self.columns,
        };
        for file in body.files() {
            solids.begin_file(file.file().get_ref(), file.has_rows());
            file.add(&context, solids)?;
            solids.end_file();
        }
        Ok(())
    }

    /// Adds solids of one kind.
    fn add_solids<K: SolidKeys>(
        &self,
        solids: &mut SolidCollector,
        tables: &[Keys<K>],
    ) -> Result<(), SceneError> {
        for Keys(keys) in tables {
            let solid = pose::solid(self.source, keys)?;
            let material = self.materials.find(self.source, keys.material())?;
            self.number(solids, keys.primitive())?;
            let pushed = solids.push_any(&solid, material);
            pushed.map_err(|refusal| self.refused(keys.place(), &refusal))?;
            self.value(solids, material, keys)?;
        }
        Ok(())
    }

    /// Adds solids composed by one set operation.
    fn add_compositions(
        &self,
        solids: &mut SolidCollector,
        operation: Operation,
        tables: &[Keys<CompositionKeys>],
    ) -> Result<(), SceneError> {
        for Keys(keys) in tables {
            let solid = operation.of(self.source, keys)?;
            let material = self.materials.find(self.source, keys.material())?;
            self.number(solids, keys.primitive())?;
            let pushed = solids.push_composition(solid, material);
            pushed.map_err(|refusal| self.refused(keys.of().span(), &refusal))?;
            self.value(solids, material, keys)?;
        }
        Ok(())
    }

    /// Sets the value of the solid that was added last, if its table states one that is shown.
    fn value(
        &self,
        solids: &mut SolidCollector,
        material: MaterialIndex,
        keys: &impl SolidTable,
    ) -> Result<(), SceneError> {
        let Some(column) = self.columns.of(material) else {
            return Ok(());
        };
        match column.stated(self.source, keys.values())? {
            Some(value) => solids.value(material, value),
            None => {
                let values = keys
                    .values()
                    .into_iter()
                    .flat_map(|keys| keys.get_ref().keys());
                solids.found.others(values);
            }
        }
        Ok(())
    }

    /// Continues the primitive numbers from the one that a solid's table states.
    fn number(
        &self,
        solids: &mut SolidCollector,
        key: Option<&Spanned<Whole>>,
    ) -> Result<(), SceneError> {
        key.map_or(Ok(()), |key| {
            let numbered = solids.number_from(key.get_ref().0, key.span());
            numbered.map_err(|refusal| self.refused(key.span(), &refusal))
        })
    }

    /// Puts solids with stated numbers in order.
    fn sort(&self, solids: &mut SolidCollector) -> Result<(), SceneError> {
        let Some(place) = solids.numbered_at.take() else {
            return Ok(());
        };
        solids.solids.sort().map_err(|number| {
            self.source.error_with_help(
                place,
                format!("two solids have the primitive number {number}: numbers must differ"),
                "a solid without the key has the number after that of the solid before it",
            )
        })
    }

    /// The error that the solid at a place cannot be added.
    fn refused(&self, place: Range<usize>, refusal: &Refusal) -> SceneError {
        let (message, help) = refusal.message();
        match help {
            Some(help) => self.source.error_with_help(place, message, help),
            None => self.source.error(place, message),
        }
    }

    fn placed(&self, of: &Spanned<String>) -> Result<PrototypeIndex, SceneError> {
        self.prototypes.get(of.get_ref()).copied().ok_or_else(|| {
            let mut names: Vec<&str> = self.prototypes.keys().map(String::as_str).collect();
            names.sort_unstable();
            self.source.error_with_help(
                of.span(),
                format!("unknown prototype {}", quoted(of.get_ref())),
                suggestion(of.get_ref(), names, "prototypes"),
            )
        })
    }
}
