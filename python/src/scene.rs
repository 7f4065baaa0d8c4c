//! Scenes made of arrays, or loaded from files.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use cyltrace::scene::{
    CylinderList, Environment, MaterialIndex, Prototype, Records, SaveError, Scene, SceneError,
    SceneFile, SolidRecord,
};
use cyltrace::solid::{AnySolid, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use cyltrace_output::NewFile;
use glam::DVec3;
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use toml::Table;

use crate::arrays::{Numbers, Quaternions, Vectors, value_error};
use crate::rows::{Rows, caps_of, has_no_size, is_degenerate, next_primitive, text};
use crate::shown::Shown;
use crate::solid::{PySolid, orientation};
use crate::statement;

/// A scene. Tracers share it until it is changed.
#[pyclass(name = "Scene", module = "cyltrace._core")]
pub struct PyScene {
    pub scene: Arc<Scene>,
    pub(crate) records: Records,
    /// For each prototype, the number of the next solid. Rows that were left out keep theirs.
    pub(crate) next: Vec<u32>,
    /// The single tables that it states; `None` if it is as it was loaded.
    pub(crate) stated: Option<Table>,
    /// Whether the file that it was loaded from states an integrator.
    pub(crate) states_integrator: bool,
    pub(crate) shown: Shown,
}

impl PyScene {
    pub(crate) fn prototype(&mut self, index: u32) -> PyResult<&mut Prototype> {
        let prototypes = &mut Arc::make_mut(&mut self.scene).prototypes;
        let prototype = prototypes.get_mut(index as usize);
        prototype.ok_or_else(|| value_error(format!("the scene has no prototype {index}")))
    }
}

#[pymethods]
impl PyScene {
    #[new]
    fn new(records: &str) -> PyResult<Self> {
        let records = match records {
            "f64" => Records::F64,
            "f32" => Records::F32,
            other => {
                return Err(value_error(format!(
                    "records is \"{other}\": it must be \"f64\" or \"f32\""
                )));
            }
        };
        let mut scene = Self {
            scene: Arc::new(Scene::new(Vec::new())),
            records,
            next: Vec::new(),
            stated: Some(Table::new()),
            states_integrator: false,
            shown: Shown::default(),
        };
        scene.add_prototype(String::new());
        Ok(scene)
    }

    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        // A file that cannot be opened is an OSError, as everywhere in Python.
        std::fs::File::open(&path).map_err(|error| {
            PyErr::from(std::io::Error::new(
                error.kind(),
                format!("{}: {error}", path.display()),
            ))
        })?;
        let loaded = py.detach(|| {
            let file = SceneFile::read(&path)?;
            Ok::<_, SceneError>((file.states_integrator(), file.load()?))
        });
        let (states_integrator, scene) = loaded.map_err(|error| value_error(error.to_string()))?;
        let records = scene.records();
        Ok(Self {
            next: scene.prototypes.iter().map(next_primitive).collect(),
            stated: None,
            states_integrator,
            shown: Shown::of_file(&scene),
            scene: Arc::new(scene),
            records,
        })
    }

    /// Writes `STEM.toml` and its tables to a folder: all files, or none.
    fn save(&self, py: Python<'_>, folder: PathBuf, stem: &str) -> PyResult<()> {
        self.check_columns()?;
        let mut files = Vec::new();
        let create = |name: &str| NewFile::create(&folder.join(name)).map_err(io::Error::other);
        let complete = |file| {
            files.push(file);
            Ok(())
        };
        let saved = py.detach(|| cyltrace::scene::save(&self.scene, stem, create, complete));
        saved.map_err(|error| match error {
            SaveError::Output { .. } => PyOSError::new_err(error.to_string()),
            error => value_error(error.to_string()),
        })?;
        // The scene file comes last, so that it never names tables that are not there.
        for file in files {
            let finished: Result<(), _> = file.finish();
            finished.map_err(|error| PyOSError::new_err(error.to_string()))?;
        }
        Ok(())
    }

    fn add_prototype(&mut self, name: String) -> u32 {
        let records = self.records;
        let prototypes = &mut Arc::make_mut(&mut self.scene).prototypes;
        let mut prototype = Prototype {
            name,
            ..Prototype::default()
        };
        prototype.solids.cylinders = CylinderList::new(records);
        prototypes.push(prototype);
        self.next.push(0);
        self.next.len() as u32 - 1
    }

    /// States a key of a scene file; those of arrays of tables get one more entry.
    fn state(&mut self, key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        self.apply(key, statement::value(value)?)
    }

    /// Makes a picture, linear RGB row by row from the top, the light from all directions.
    fn set_environment(
        &mut self,
        width: u32,
        height: u32,
        pixels: PyReadonlyArray1<'_, f32>,
        strength: f64,
        rotate_degrees: f64,
    ) -> PyResult<()> {
        let (pixels, _) = pixels.as_slice()?.as_chunks::<3>();
        let environment = Environment::new(width, height, pixels.into());
        let mut environment = environment.map_err(|error| value_error(error.to_string()))?;
        environment.strength = strength;
        environment.rotate_degrees = rotate_degrees;
        self.surround(environment)
    }

    /// The column that a material shows.
    fn column(&self, material: u16) -> Option<String> {
        self.column_of(material)
    }

    /// The texts that stand for the values 0, 1, 2 and so on in a column.
    fn labels(&self, column: &str) -> Vec<String> {
        self.labels_of(column)
    }

    /// Checks the values of a column.
    fn check_values(&self, column: &str, values: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        self.check_column(column, values.as_slice()?)
    }

    /// Adds the values that the material of solids shows; their numbers count up from `first`.
    fn set_solid_values(
        &mut self,
        prototype: u32,
        material: u16,
        first: u32,
        values: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        self.show_solids(prototype, material, first, values.as_slice()?)
    }

    /// Adds the values of placements in a column; their numbers count up from `first`.
    fn set_placement_values(
        &mut self,
        prototype: u32,
        column: &str,
        first: u32,
        values: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<()> {
        self.show_placements(prototype, column, first, values.as_slice()?)
    }

    /// Checks that each column that a material shows has values.
    fn check_shown(&self) -> PyResult<()> {
        self.check_columns()
    }

    fn add_cylinders(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        p0: PyReadonlyArray2<'_, f64>,
        p1: PyReadonlyArray2<'_, f64>,
        radius: PyReadonlyArray1<'_, f64>,
        caps: PyReadonlyArray1<'_, u8>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (p0, p1) = (Vectors::of(&p0)?, Vectors::of(&p1)?);
        let (radius, caps) = (Numbers::of(&radius)?, Numbers::of(&caps)?);
        let is_degenerate = |row| is_degenerate(p0.row(row), p1.row(row), &[radius.row(row)]);
        self.add_rows(py, &rows, is_degenerate, |row| {
            let caps = caps_of(caps.row(row));
            let cylinder = Cylinder::new(p0.row(row), p1.row(row), radius.row(row), caps);
            cylinder.map(AnySolid::from).map_err(text)
        })
    }

    #[expect(clippy::too_many_arguments, reason = "columns")]
    fn add_cones(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        p0: PyReadonlyArray2<'_, f64>,
        p1: PyReadonlyArray2<'_, f64>,
        radius0: PyReadonlyArray1<'_, f64>,
        radius1: PyReadonlyArray1<'_, f64>,
        caps: PyReadonlyArray1<'_, u8>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (p0, p1) = (Vectors::of(&p0)?, Vectors::of(&p1)?);
        let (radius0, radius1) = (Numbers::of(&radius0)?, Numbers::of(&radius1)?);
        let caps = Numbers::of(&caps)?;
        let is_degenerate = |row| {
            let radii = [radius0.row(row), radius1.row(row)];
            is_degenerate(p0.row(row), p1.row(row), &radii)
        };
        self.add_rows(py, &rows, is_degenerate, |row| {
            let (radius0, radius1) = (radius0.row(row), radius1.row(row));
            let caps = caps_of(caps.row(row));
            let cone = Cone::new(p0.row(row), p1.row(row), radius0, radius1, caps);
            cone.map(AnySolid::from).map_err(text)
        })
    }

    fn add_rounded_cones(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        p0: PyReadonlyArray2<'_, f64>,
        p1: PyReadonlyArray2<'_, f64>,
        radius0: PyReadonlyArray1<'_, f64>,
        radius1: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (p0, p1) = (Vectors::of(&p0)?, Vectors::of(&p1)?);
        let (radius0, radius1) = (Numbers::of(&radius0)?, Numbers::of(&radius1)?);
        // Without length it is a ball.
        let is_degenerate = |row| has_no_size(&[radius0.row(row), radius1.row(row)]);
        self.add_rows(py, &rows, is_degenerate, |row| {
            let (radius0, radius1) = (radius0.row(row), radius1.row(row));
            let solid = RoundedCone::new(p0.row(row), p1.row(row), radius0, radius1);
            solid.map(AnySolid::from).map_err(text)
        })
    }

    fn add_spheres(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        center: PyReadonlyArray2<'_, f64>,
        radius: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (center, radius) = (Vectors::of(&center)?, Numbers::of(&radius)?);
        let is_degenerate = |row| has_no_size(&[radius.row(row)]);
        self.add_rows(py, &rows, is_degenerate, |row| {
            let sphere = Sphere::new(center.row(row), radius.row(row));
            sphere.map(AnySolid::from).map_err(text)
        })
    }

    fn add_cuboids(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        center: PyReadonlyArray2<'_, f64>,
        half_widths: PyReadonlyArray2<'_, f64>,
        quaternion: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (center, half_widths) = (Vectors::of(&center)?, Vectors::of(&half_widths)?);
        let quaternion = Quaternions::of(&quaternion)?;
        self.add_rows(
            py,
            &rows,
            |_| false,
            |row| {
                let orientation = orientation(quaternion.row(row))?;
                let cuboid = Cuboid::new(center.row(row), half_widths.row(row), orientation);
                cuboid.map(AnySolid::from).map_err(text)
            },
        )
    }

    fn add_disks(
        &mut self,
        py: Python<'_>,
        rows: Rows,
        center: PyReadonlyArray2<'_, f64>,
        normal: PyReadonlyArray2<'_, f64>,
        radius: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(u32, Vec<i64>)> {
        let (center, normal) = (Vectors::of(&center)?, Vectors::of(&normal)?);
        let radius = Numbers::of(&radius)?;
        let is_degenerate = |row| has_no_size(&[radius.row(row)]);
        self.add_rows(py, &rows, is_degenerate, |row| {
            let disk = Disk::new(center.row(row), normal.row(row), radius.row(row));
            disk.map(AnySolid::from).map_err(text)
        })
    }

    fn add_composition(&mut self, prototype: u32, solid: PySolid, material: u16) -> PyResult<u32> {
        let number = self.next[prototype as usize];
        let record = SolidRecord::new(solid.0, number, MaterialIndex(material));
        self.prototype(prototype)?.solids.compositions.push(record);
        self.next[prototype as usize] = number + 1;
        Ok(number)
    }

    /// Places a prototype in another; the matrices are rows of 16 numbers.
    fn add_placements(
        &mut self,
        prototype: u32,
        of: u32,
        matrices: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<u32> {
        self.place(prototype, of, matrices.as_slice()?)
    }

    /// The names of prototypes; the root's is empty.
    fn prototype_names(&self) -> Vec<String> {
        let prototypes = self.scene.prototypes.iter();
        prototypes.map(|prototype| prototype.name.clone()).collect()
    }

    /// The names of materials; the default one's is empty.
    fn material_names(&self) -> Vec<String> {
        let materials = self.scene.materials.iter();
        materials.map(|material| material.name.clone()).collect()
    }

    /// How many solids and placements a prototype has.
    fn counts(&self, prototype: u32) -> (usize, usize) {
        let prototype = &self.scene.prototypes[prototype as usize];
        (prototype.solids.len(), prototype.placements.len())
    }

    /// The number that the next solid of a prototype gets.
    fn next_primitive(&self, prototype: u32) -> u32 {
        self.next[prototype as usize]
    }

    /// `p0`, `p1`, `radius` and number of every cylinder of a prototype.
    #[expect(clippy::type_complexity, reason = "columns")]
    fn cylinders<'py>(
        &self,
        py: Python<'py>,
        prototype: u32,
    ) -> (
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<i64>>,
    ) {
        let cylinders = &self.scene.prototypes[prototype as usize].solids.cylinders;
        let column = |get: &dyn Fn(&Cylinder) -> DVec3| {
            let rows: Vec<[f64; 3]> = cylinders
                .iter()
                .map(|record| get(&record.cylinder()).to_array())
                .collect();
            PyArray1::from_vec(py, rows.into_flattened())
        };
        let radius = cylinders.iter().map(|record| record.cylinder().radius());
        let numbers = cylinders.iter().map(|record| record.primitive().into());
        (
            column(&Cylinder::p0),
            column(&Cylinder::p1),
            PyArray1::from_vec(py, radius.collect()),
            PyArray1::from_vec(py, numbers.collect()),
        )
    }

    /// What the files had to say, such as columns that are not read.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.scene.notes.clone()
    }

    #[getter]
    fn skipped_rows(&self) -> u64 {
        self.scene.skipped_rows
    }
}
