//! What a scene states besides solids and placements: camera, lights, materials and drawings, by
//! the keys of a scene file.
//!
//! The loader validates every statement: it reads a small scene file with the statement and all
//! that it has to agree with, which are the single tables and the materials.

use std::io;
use std::path::Path;
use std::sync::Arc;

use cyltrace::scene::{
    Color, Environment, Integrator, Material, MaterialIndex, MaterialKind, Prototype,
    RenderSettings, Scene, SceneError, SceneFile,
};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use toml::{Table, Value};

use crate::arrays::value_error;
use crate::scene::PyScene;

/// The keys of arrays of tables.
const LISTS: [&str; 5] = [
    "material",
    "clip",
    "point_light",
    "sphere_light",
    "rectangle_light",
];

/// The tables that keep keys which a statement does not have.
const KEPT: [&str; 2] = ["film", "render"];

impl PyScene {
    /// Adds an entry to an array of tables, or replaces what a single key states. Nothing
    /// changes if it is wrong.
    ///
    /// # Errors
    /// What is wrong, and what would be right.
    pub fn apply(&mut self, key: &str, value: Value) -> PyResult<()> {
        let mut stated = self.stated()?;
        let is_entry = LISTS.contains(&key) || key == "environment";
        match (stated.get_mut(key), value.as_table()) {
            _ if is_entry => {}
            (Some(Value::Table(known)), Some(keys)) if KEPT.contains(&key) => {
                known.extend(keys.clone());
            }
            _ => {
                stated.insert(key.to_owned(), value.clone());
            }
        }
        if key == "environment" {
            stated.remove("sky");
        }
        let loaded = self.load_stated(&stated, is_entry.then_some((key, &value)))?;
        let scene = Arc::make_mut(&mut self.scene);
        match key {
            "environment" => scene.environment.clone_from(&loaded.environment),
            "sky" => scene.environment = None,
            "clip" => {
                let clips = loaded.clips.iter().cloned();
                scene.clips.extend(clips.map(|mut clip| {
                    let of_loaded = clip
                        .material
                        .map(|index| &loaded.materials[usize::from(index.0)]);
                    clip.material = of_loaded.map(|material| index_of(&scene.materials, material));
                    clip
                }));
            }
            "material" => {
                let material = loaded
                    .materials
                    .last()
                    .expect("the material that was added");
                if scene.materials.len() > usize::from(u16::MAX) {
                    return Err(value_error(format!(
                        "a scene has at most {} materials",
                        u16::MAX
                    )));
                }
                let index = scene.materials.len() as u16;
                let range = value.get("color").and_then(|color| color.get("range"));
                if material.color.column().is_some()
                    && range.is_none_or(|range| range.as_str() == Some("auto"))
                {
                    self.shown.automatic.insert(index);
                }
                scene.materials.push(material.clone());
            }
            _ => scene.lights.extend(loaded.lights.iter().copied()),
        }
        self.take(stated, loaded);
        self.update_ranges();
        Ok(())
    }

    /// Makes pixels the light from all directions.
    ///
    /// # Errors
    /// When what is stated is wrong without the sky.
    pub fn surround(&mut self, environment: Environment) -> PyResult<()> {
        let mut stated = self.stated()?;
        stated.remove("sky");
        let loaded = self.load_stated(&stated, None)?;
        Arc::make_mut(&mut self.scene).environment = Some(environment);
        self.take(stated, loaded);
        Ok(())
    }

    /// Takes over the single tables.
    fn take(&mut self, stated: Table, loaded: Scene) {
        let render = stated.get("render");
        let is_stated = render.is_some_and(|keys| keys.get("integrator").is_some());
        let scene = Arc::make_mut(&mut self.scene);
        let is_diffuse = |material: &Material| material.kind == MaterialKind::Diffuse;
        let needs_paths = !scene.lights.is_empty()
            || scene.environment.is_some()
            || !scene.materials.iter().all(is_diffuse);
        scene.render = RenderSettings {
            integrator: match needs_paths && !is_stated {
                true => Integrator::Path,
                false => loaded.render.integrator,
            },
            ..loaded.render
        };
        scene.legend = loaded.legend.map(|mut legend| {
            let material = &loaded.materials[usize::from(legend.material.0)];
            legend.material = index_of(&scene.materials, material);
            legend
        });
        scene.camera = loaded.camera;
        scene.film = loaded.film;
        scene.sun = loaded.sun;
        scene.sky = loaded.sky;
        scene.clear_sky = loaded.clear_sky;
        scene.illustration = loaded.illustration;
        scene.background = loaded.background;
        self.stated = Some(stated);
    }

    /// The single tables that the scene states; those of a file are what it would be saved as.
    fn stated(&self) -> PyResult<Table> {
        if let Some(stated) = &self.stated {
            return Ok(stated.clone());
        }
        let mut scene = Scene::new(vec![Prototype::default()]);
        let of = &self.scene;
        scene.materials.clone_from(&of.materials);
        for material in &mut scene.materials {
            if let Color::Image(_) = material.color {
                material.color = Color::Constant(material.color.average());
            }
        }
        scene.camera.clone_from(&of.camera);
        (scene.film, scene.render) = (of.film, of.render);
        (scene.sun, scene.sky, scene.clear_sky) = (of.sun, of.sky, of.clear_sky);
        scene.background = of.background;
        scene.legend.clone_from(&of.legend);
        scene.illustration.clone_from(&of.illustration);
        let mut text = Vec::new();
        let saved = cyltrace::scene::save(
            &scene,
            "scene",
            |_| Ok(Vec::new()),
            |file| {
                text = file;
                Ok::<_, io::Error>(())
            },
        );
        saved.map_err(|error| value_error(error.to_string()))?;
        let text = String::from_utf8(text).expect("a scene file is UTF-8");
        let mut stated: Table = toml::from_str(&text).expect("a scene file is TOML");
        for key in LISTS {
            stated.remove(key);
        }
        if let Some(Value::Table(render)) = stated.get_mut("render")
            && !self.states_integrator
        {
            render.remove("integrator");
        }
        Ok(stated)
    }

    /// Loads the single tables with the materials, and an entry.
    fn load_stated(&self, stated: &Table, entry: Option<(&str, &Value)>) -> PyResult<Scene> {
        let mut document = stated.clone();
        let is_material = entry.is_some_and(|(key, _)| key == "material");
        // The name of a new material is checked where the names are known.
        let is_needed = |material: &&Material| !is_material || material.color.column().is_some();
        let materials = self.scene.materials[1..].iter().filter(is_needed);
        let mut materials: Vec<Value> = materials.map(keys_of_material).collect();
        match entry {
            Some(("material", value)) => materials.push(value.clone()),
            Some(("environment", value)) => {
                document.insert("environment".to_owned(), value.clone());
            }
            Some((key, value)) => {
                document.insert(key.to_owned(), Value::Array(vec![value.clone()]));
            }
            None => {}
        }
        // The loader demands a solid, and a value in every column.
        let sphere = || {
            Table::from_iter([
                ("center".to_owned(), Value::from(vec![0.0; 3])),
                ("radius".to_owned(), Value::from(1.0)),
            ])
        };
        let shown = materials.iter().filter_map(|material| {
            let column = material.get("color")?.get("column")?.as_str()?;
            let mut keys = sphere();
            keys.insert("material".to_owned(), material.get("name")?.clone());
            keys.insert("values".to_owned(), table(column, 0.0));
            Some(Value::Table(keys))
        });
        let spheres: Vec<Value> = [sphere().into()].into_iter().chain(shown).collect();
        document.insert("sphere".to_owned(), spheres.into());
        document.insert("material".to_owned(), materials.into());
        let text = toml::to_string(&document).map_err(|error| value_error(error.to_string()))?;
        // Names of files are relative to the working directory.
        let file = SceneFile::parse(Path::new("scene"), text.clone());
        let loaded = file.and_then(SceneFile::load);
        loaded.map_err(|error| fault(error, &text))
    }
}

/// The position of a material of the same name.
fn index_of(materials: &[Material], material: &Material) -> MaterialIndex {
    let position = materials.iter().position(|one| one.name == material.name);
    MaterialIndex(position.unwrap_or_default() as u16)
}

fn table(key: &str, value: impl Into<Value>) -> Value {
    Table::from_iter([(key.to_owned(), value.into())]).into()
}

/// A material as far as statements depend on it: whether its color is the same everywhere,
/// and the column that it shows.
fn keys_of_material(material: &Material) -> Value {
    let color = match &material.color {
        Color::Constant(color) => Value::from(color.to_array().to_vec()),
        Color::Data(data) => {
            let mut keys = Table::from_iter([
                ("column".to_owned(), data.column.as_str().into()),
                ("map".to_owned(), data.map.name().into()),
            ]);
            if !data.labels.is_empty() {
                keys.insert("labels".to_owned(), data.labels.clone().into());
            }
            keys.into()
        }
        Color::Checker(_) | Color::Stripes(_) | Color::Image(_) => {
            table("stripes", vec![vec![0.0; 3]])
        }
    };
    Table::from_iter([
        ("name".to_owned(), material.name.as_str().into()),
        ("color".to_owned(), color),
    ])
    .into()
}

/// What is wrong, without the place in a file that the user has not written.
fn fault(error: SceneError, text: &str) -> PyErr {
    let SceneError::Statement(statement) = error else {
        return value_error(error.to_string());
    };
    let mut message = statement.message;
    // Of a wrong type, the message does not have the key.
    if message.starts_with("invalid ") {
        let line = text.lines().nth(statement.line - 1).unwrap_or_default();
        message = format!("{line}: {message}");
    }
    value_error(match statement.help {
        Some(help) => format!("{message}; {help}"),
        None => message,
    })
}

/// The value of a key: a dict of keys, a list, a text or a number.
///
/// # Errors
/// When it is something else.
pub fn value(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(keys) = object.cast::<PyDict>() {
        let keys = keys
            .iter()
            .map(|(key, one)| Ok((key.extract()?, value(&one)?)));
        return Ok(Value::Table(keys.collect::<PyResult<Table>>()?));
    }
    if object.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(object.extract()?));
    }
    if object.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(object.extract()?));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(object.extract()?));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Value::String(object.extract()?));
    }
    let items = object.try_iter()?.map(|item| value(&item?));
    Ok(Value::Array(items.collect::<PyResult<_>>()?))
}
