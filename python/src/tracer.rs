//! Queries of many rays or points.

use std::num::NonZeroUsize;
use std::sync::Arc;

use cyltrace::tracer::{
    BuildTime, Containing, DEFAULT_BATCH, HitFields, Layout, Options, Tracer, workers,
};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;
use rayon::ThreadPool;
use rayon::prelude::*;

use crate::arrays::{Numbers, Rays, Vectors, value_error};
use crate::found::{BLOCK, Block, Found, kinds, ragged};
use crate::scene::PyScene;
use crate::work::{self, Work};

/// A scene that is built for Embree, and the threads that trace it.
pub struct Tracing {
    pub tracer: Tracer,
    pub workers: ThreadPool,
    /// How many of them were requested.
    pub threads: Option<NonZeroUsize>,
}

/// The same as Python knows it.
#[pyclass(frozen, name = "Tracer", module = "cyltrace._core")]
pub struct PyTracer(pub Arc<Tracing>);

/// As many rays are traced before a thread would have started to watch them.
const FEW: usize = 64;

/// The progress callback of a query.
pub type Progress<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

impl PyTracer {
    /// Answers `count` rays or points in blocks.
    fn answer<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        progress: Progress,
        block: impl Fn(std::ops::Range<usize>) -> Result<T, String> + Sync,
    ) -> PyResult<Vec<T>> {
        let trace = |work: &Work| {
            let blocks = (0..count.div_ceil(BLOCK)).into_par_iter().map(|number| {
                let rows = number * BLOCK..count.min((number + 1) * BLOCK);
                let rows_count = rows.len() as u64;
                let answers = (!work.is_cancelled()).then(|| block(rows));
                work.add(rows_count);
                answers
            });
            self.0
                .workers
                .install(|| blocks.collect::<Vec<Option<Result<T, String>>>>())
        };
        let answers = if count <= FEW {
            py.detach(|| trace(&Work::default()))
        } else {
            work::run(py, progress, count as u64, trace)?
        };
        // The first of the faults, whichever thread came first. Nothing is left out, for
        // cancelled work has raised its exception.
        let answers: Result<Vec<T>, String> = answers.into_iter().flatten().collect();
        answers.map_err(value_error)
    }
}

#[pymethods]
impl PyTracer {
    #[new]
    fn new(
        py: Python<'_>,
        scene: &PyScene,
        threads: Option<usize>,
        layout: &str,
        exact: bool,
    ) -> PyResult<Self> {
        let threads = threads
            .map(|threads| {
                NonZeroUsize::new(threads)
                    .ok_or_else(|| value_error("threads is 0: it must be at least 1"))
            })
            .transpose()?;
        let layout = match layout {
            "auto" => Layout::Auto,
            "single" => Layout::Single,
            "block" => Layout::Block,
            other => {
                return Err(value_error(format!(
                    "layout is \"{other}\": it must be \"auto\", \"single\" or \"block\""
                )));
            }
        };
        let options = Options {
            threads,
            layout,
            exact,
            // Embree's refusal is an exception here; a query could not raise it.
            build: BuildTime::AtOnce,
            ..Options::default()
        };
        let scene = Arc::clone(&scene.scene);
        let workers =
            workers(threads).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let tracer = py.detach(|| workers.install(|| Tracer::new(scene, &options)));
        let tracer = tracer.map_err(|error| match error {
            cyltrace::tracer::TracerError::Embree(error) => {
                PyMemoryError::new_err(error.to_string())
            }
            error => value_error(error.to_string()),
        })?;
        Ok(Self(Arc::new(Tracing {
            tracer,
            workers,
            threads,
        })))
    }

    #[pyo3(signature = (origins, directions, t_min, t_max, progress=None))]
    fn closest(
        &self,
        py: Python<'_>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        t_min: PyReadonlyArray1<'_, f64>,
        t_max: PyReadonlyArray1<'_, f64>,
        progress: Progress,
    ) -> PyResult<Found> {
        let rays = rays(&origins, &directions, &t_min, &t_max)?;
        let blocks = self.answer(py, rays.len(), progress, |rows| {
            let rays = rays.rows(rows)?;
            let mut hits = Vec::new();
            self.0.tracer.first_hits(&rays, &mut hits);
            Ok(Block::first(rays, hits))
        })?;
        Ok(Found::new(Arc::clone(&self.0), blocks))
    }

    #[pyo3(signature = (origins, directions, t_min, t_max, progress=None))]
    fn occluded<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        t_min: PyReadonlyArray1<'_, f64>,
        t_max: PyReadonlyArray1<'_, f64>,
        progress: Progress,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let rays = rays(&origins, &directions, &t_min, &t_max)?;
        let blocks = self.answer(py, rays.len(), progress, |rows| {
            let mut blocked = Vec::new();
            self.0
                .tracer
                .occluded_batch(&rays.rows(rows)?, &mut blocked);
            Ok(blocked)
        })?;
        Ok(PyArray1::from_vec(py, blocks.concat()))
    }

    /// All hits, ray by ray, and how many each ray has.
    #[pyo3(signature = (origins, directions, t_min, t_max, progress=None))]
    fn all_hits<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        t_min: PyReadonlyArray1<'_, f64>,
        t_max: PyReadonlyArray1<'_, f64>,
        progress: Progress,
    ) -> PyResult<(Found, Bound<'py, PyArray1<i64>>)> {
        let rays = rays(&origins, &directions, &t_min, &t_max)?;
        let answers = self.answer(py, rays.len(), progress, |rows| {
            let (mut hits, mut counts) = (Vec::new(), Vec::new());
            for ray in rays.rows(rows)? {
                let before = hits.len();
                let all = self.0.tracer.all_hits(&ray, DEFAULT_BATCH);
                hits.extend(all.with(HitFields::all()));
                counts.push((hits.len() - before) as i64);
            }
            Ok((Block::Whole(hits), counts))
        })?;
        let (blocks, counts): (Vec<Block>, Vec<Vec<i64>>) = answers.into_iter().unzip();
        let found = Found::new(Arc::clone(&self.0), blocks);
        Ok((found, PyArray1::from_vec(py, counts.concat())))
    }

    /// Whether any solid contains each point.
    #[pyo3(signature = (points, progress=None))]
    fn contains<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'_, f64>,
        progress: Progress,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let points = Vectors::of(&points)?;
        let blocks = self.answer(py, points.len(), progress, |rows| {
            let contains = |row| !self.0.tracer.contains(points.row(row)).is_empty();
            Ok(rows.map(contains).collect::<Vec<bool>>())
        })?;
        Ok(PyArray1::from_vec(py, blocks.concat()))
    }

    /// The solids that contain each point: prototype, kind, primitive, the instance path and
    /// how many there are of each point.
    #[pyo3(signature = (points, progress=None))]
    #[expect(clippy::type_complexity, reason = "columns")]
    fn locate<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'_, f64>,
        progress: Progress,
    ) -> PyResult<(
        Bound<'py, PyArray1<i64>>,
        Bound<'py, PyArray1<i8>>,
        Bound<'py, PyArray1<i64>>,
        Bound<'py, pyo3::types::PyTuple>,
        Bound<'py, PyArray1<i64>>,
    )> {
        let points = Vectors::of(&points)?;
        let answers = self.answer(py, points.len(), progress, |rows| {
            let located: Vec<Vec<Containing>> = rows
                .map(|row| self.0.tracer.contains(points.row(row)))
                .collect();
            Ok(located)
        })?;
        let answers = answers.concat();
        let counts = answers.iter().map(|solids| solids.len() as i64).collect();
        let all: Vec<Containing> = answers.into_iter().flatten().collect();
        let kind = |one: &Containing| {
            let position = kinds().position(|kind| kind == one.solid);
            position.map_or(-1, |position| position as i8)
        };
        let paths: Vec<Vec<u32>> = all.iter().map(|one| one.instance.clone()).collect();
        let prototypes = all.iter().map(|one| one.prototype.0.into()).collect();
        let primitives = all.iter().map(|one| one.primitive.into()).collect();
        Ok((
            PyArray1::from_vec(py, prototypes),
            PyArray1::from_vec(py, all.iter().map(kind).collect()),
            PyArray1::from_vec(py, primitives),
            ragged(py, &paths)?,
            PyArray1::from_vec(py, counts),
        ))
    }

    /// Least and greatest corner of a box around the scene.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let bounds = self.0.tracer.bounds();
        (bounds.lower.to_array(), bounds.upper.to_array())
    }

    /// Embree's version and the instruction set in use.
    #[getter]
    fn engine(&self) -> (String, String) {
        let statistics = self.0.tracer.statistics();
        (
            statistics.embree_version.to_string(),
            statistics.isa.to_string(),
        )
    }

    #[getter]
    fn threads(&self) -> usize {
        self.0.workers.current_num_threads()
    }
}

/// The rays of columns of the same length, or of single rows for all rays.
///
/// # Errors
/// When a column is not contiguous.
pub fn rays<'a>(
    origins: &'a PyReadonlyArray2<'_, f64>,
    directions: &'a PyReadonlyArray2<'_, f64>,
    t_min: &'a PyReadonlyArray1<'_, f64>,
    t_max: &'a PyReadonlyArray1<'_, f64>,
) -> PyResult<Rays<'a>> {
    Ok(Rays {
        origins: Vectors::of(origins)?,
        directions: Vectors::of(directions)?,
        t_min: Numbers::of(t_min)?,
        t_max: Numbers::of(t_max)?,
    })
}
