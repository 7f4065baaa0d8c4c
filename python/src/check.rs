//! Checks of the tracer, of a Python callable and of arrays of hits.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::slice;
use std::sync::Arc;

use cyltrace::embree::DeviceOptions;
use cyltrace::math::Ray;
use cyltrace::tracer::workers;
use cyltrace_check::{
    CheckError, Checked, Class, F32_TOLERANCE, Intersector, Outcome, Place, ReportedHit, Settings,
    compare_hits, compare_with, page, summary, verdict,
};
use cyltrace_output::write_text;
use glam::DVec3;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use rayon::ThreadPool;

use crate::arrays::value_error;
use crate::found::PARTS;
use crate::tracer::{Progress, PyTracer, Tracing, rays};
use crate::work::{self, Work};

/// Rays of a call of a Python intersector: enough for NumPy to be worth the call.
const BATCH: u64 = 4096;

/// What a check found.
#[pyclass(frozen, name = "Check", module = "cyltrace._core")]
pub struct PyCheck {
    tracing: Arc<Tracing>,
    /// Which rays were checked, in words.
    rays: String,
    max_memory: u64,
    outcome: Outcome,
}

#[pymethods]
impl PyCheck {
    /// The outcome as the program writes it to its JSON file.
    fn json(&self) -> PyResult<String> {
        let text = serde_json::to_string(&self.outcome);
        text.map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    /// The outcome as the program prints it.
    fn text(&self) -> String {
        summary(&self.outcome) + &verdict(&self.outcome)
    }

    /// The last line of that.
    fn verdict(&self) -> String {
        verdict(&self.outcome)
    }

    /// Writes the page.
    fn write_page(&self, py: Python<'_>, path: PathBuf, scene: &str) -> PyResult<()> {
        let checked = Checked {
            scene,
            rays: &self.rays,
            outcome: &self.outcome,
            tracer: &self.tracing.tracer,
            max_memory: self.max_memory,
        };
        let text = py.detach(|| self.tracing.workers.install(|| page(&checked)));
        let text = text.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        write_text(&path, &text).map_err(|error| PyOSError::new_err(error.to_string()))
    }
}

/// Checks the tracer itself, or a Python callable with its name.
#[pyfunction]
#[pyo3(signature = (tracer, intersector, rays, classes, segments, seed, max_memory, progress=None))]
#[expect(clippy::too_many_arguments, reason = "as the flags of the program")]
pub fn check(
    py: Python<'_>,
    tracer: &PyTracer,
    intersector: Option<(String, Py<PyAny>)>,
    rays: u64,
    classes: Option<Vec<String>>,
    segments: Vec<u32>,
    seed: u64,
    max_memory: u64,
    progress: Progress,
) -> PyResult<PyCheck> {
    let tracing = Arc::clone(&tracer.0);
    let classes = classes.map_or(Ok(Class::ALL.to_vec()), |names| {
        let classes = names.iter().map(|name| name.parse());
        classes.collect::<Result<_, String>>().map_err(value_error)
    })?;
    let settings = Settings {
        segments,
        rays,
        classes,
        seed,
        max_memory,
        device: DeviceOptions {
            threads: tracing.threads,
            ..DeviceOptions::default()
        },
        ..Settings::default()
    }
    .in_order();
    let (name, caller) = intersector.unzip();
    let caller = caller.map(Arc::new);
    let total = settings.segments.len() as u64 * settings.classes.len() as u64 * rays;
    let pool = own_pool(&tracing)?;
    let outcome = work::run(py, progress, total, |work| {
        let progress = |done, _| watched(work, done);
        let (scene, tracer) = (tracing.tracer.scene(), &tracing.tracer);
        pool.install(|| match caller {
            None => compare_with(scene, tracer, &settings, &progress),
            Some(closest) => {
                let caller = Caller { closest, work };
                compare_with(scene, &caller, &settings, &progress)
            }
        })
    })?;
    let outcome = outcome.map_err(|error| match error {
        CheckError::Interrupted => PyKeyboardInterrupt::new_err(error.to_string()),
        CheckError::Embree(error) => PyMemoryError::new_err(error.to_string()),
        error => value_error(error.to_string()),
    })?;
    let of = name.map_or_else(String::new, |name| format!("{name}: "));
    Ok(PyCheck {
        tracing,
        rays: of + &settings.rays_text(),
        max_memory,
        outcome,
    })
}

/// Compares the hits of another program with the exact ones. A `t` that is not finite is a miss.
#[pyfunction]
#[pyo3(signature = (tracer, origins, directions, t_min, t_max, t, tolerance, progress=None))]
#[expect(clippy::too_many_arguments, reason = "columns")]
pub fn check_hits(
    py: Python<'_>,
    tracer: &PyTracer,
    origins: PyReadonlyArray2<'_, f64>,
    directions: PyReadonlyArray2<'_, f64>,
    t_min: PyReadonlyArray1<'_, f64>,
    t_max: PyReadonlyArray1<'_, f64>,
    t: PyReadonlyArray1<'_, f64>,
    tolerance: Option<f64>,
    progress: Progress,
) -> PyResult<PyCheck> {
    let tracing = Arc::clone(&tracer.0);
    let most_listed = Settings::default().most_listed;
    let rays = rays(&origins, &directions, &t_min, &t_max)?;
    let t = t.as_slice()?;
    let rays = rays.rows(0..t.len()).map_err(value_error)?;
    let reported = t.iter().map(|t| t.is_finite().then_some(*t));
    let reported: Vec<Option<f64>> = reported.collect();
    let tolerance = tolerance.unwrap_or(F32_TOLERANCE);
    let outcome = work::run(py, progress, rays.len() as u64, |work| {
        let progress = |done, _| watched(work, done);
        tracing.workers.install(|| {
            compare_hits(
                &tracing.tracer,
                &rays,
                &reported,
                tolerance,
                most_listed,
                &progress,
            )
        })
    })?;
    let outcome = outcome.ok_or_else(|| PyKeyboardInterrupt::new_err("interrupted"))?;
    Ok(PyCheck {
        tracing,
        rays: format!("arrays: {} rays", rays.len()),
        max_memory: 0,
        outcome,
    })
}

/// Reports the rays that are done, and ends a check that is cancelled.
fn watched(work: &Work, done: u64) -> ControlFlow<()> {
    work.reach(done);
    match work.is_cancelled() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

/// The threads of a check. The intersector may trace in the tracer's own pool, which must not
/// wait for it.
fn own_pool(tracing: &Tracing) -> PyResult<ThreadPool> {
    workers(tracing.threads).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// A Python callable as an intersector.
struct Caller<'a> {
    /// Takes flat columns of rays, and returns those of [`Answer`].
    closest: Arc<Py<PyAny>>,
    work: &'a Work,
}

impl Intersector for Caller<'_> {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        self.closest_of_each(slice::from_ref(ray)).pop()?
    }

    fn closest_of_each(&self, rays: &[Ray]) -> Vec<Option<ReportedHit>> {
        let closest = Arc::clone(&self.closest);
        let vectors = |of: fn(&Ray) -> DVec3| -> Vec<f64> {
            rays.iter().flat_map(|ray| of(ray).to_array()).collect()
        };
        let numbers = |of: fn(&Ray) -> f64| -> Vec<f64> { rays.iter().map(of).collect() };
        let origins = vectors(|ray| ray.origin);
        let directions = vectors(|ray| ray.direction);
        let (t_min, t_max) = (numbers(|ray| ray.t_min), numbers(|ray| ray.t_max));
        let count = rays.len();
        let hits = self.work.in_python(move |py| {
            let columns = [origins, directions, t_min, t_max];
            let [origins, directions, t_min, t_max] =
                columns.map(|column| PyArray1::from_vec(py, column));
            let answer = closest.call1(
                py,
                (
                    origins.reshape([count, 3])?,
                    directions.reshape([count, 3])?,
                    t_min,
                    t_max,
                ),
            )?;
            let answer: Answer = answer.extract(py)?;
            (0..count)
                .map(|row| answer.hit(row))
                .collect::<PyResult<_>>()
        });
        // Cancelled work drops what it found.
        hits.unwrap_or_else(|| vec![None; count])
    }

    fn batch(&self) -> u64 {
        BATCH
    }
}

/// The columns of an answer: `t`; the normals if they are known; and the places if they are.
#[derive(FromPyObject)]
struct Answer<'py>(
    PyReadonlyArray1<'py, f64>,
    Option<PyReadonlyArray1<'py, f64>>,
    Option<Places<'py>>,
);

/// The parts, the solids, and the paths of placements to them as values and offsets.
#[derive(FromPyObject)]
struct Places<'py>(
    PyReadonlyArray1<'py, i8>,
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i64>,
);

impl Answer<'_> {
    /// The hit of a row; `None` if its `t` is not finite.
    fn hit(&self, row: usize) -> PyResult<Option<ReportedHit>> {
        let Self(t, normals, places) = self;
        let t = t.as_slice()?[row];
        if !t.is_finite() {
            return Ok(None);
        }
        let normal = |normals: &PyReadonlyArray1<'_, f64>| {
            PyResult::Ok(DVec3::from_slice(&normals.as_slice()?[3 * row..]))
        };
        Ok(Some(ReportedHit {
            t,
            normal: normals.as_ref().map(normal).transpose()?,
            place: places.as_ref().map(|places| places.row(row)).transpose()?,
        }))
    }
}

impl Places<'_> {
    /// The place of the hit of a row.
    fn row(&self, row: usize) -> PyResult<Place> {
        let Self(parts, primitives, path_values, offsets) = self;
        let offsets = offsets.as_slice()?;
        let path = &path_values.as_slice()?[offsets[row] as usize..offsets[row + 1] as usize];
        Ok(Place {
            instance: path.iter().map(|&number| number as u32).collect(),
            primitive: primitives.as_slice()?[row] as u32,
            part: PARTS[parts.as_slice()?[row] as usize],
        })
    }
}

/// The bytes of a size such as `4GiB`.
#[pyfunction]
pub fn parse_size(text: &str) -> PyResult<u64> {
    let bytes = cyltrace_output::parse_size(text);
    bytes.map_err(|fault| value_error(format!("max_memory is \"{text}\": {fault}")))
}
