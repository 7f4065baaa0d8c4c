//! Pictures.

use std::path::PathBuf;

use cyltrace::scene::Film;
use cyltrace_output::{Contents, Output, OutputError, film_png_bytes};
use cyltrace_render::{Channels, RenderError, Settings};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::value_error;
use crate::look::integrator_of;
use crate::tracer::PyTracer;
use crate::work::{self, Work};

/// Renders a picture: linear RGB, row by row from the top.
#[pyfunction]
#[pyo3(signature = (tracer, width, height, spp, integrator, seed, progress=None))]
#[expect(clippy::too_many_arguments, reason = "as the flags of the program")]
pub fn render<'py>(
    py: Python<'py>,
    tracer: &PyTracer,
    width: Option<u32>,
    height: Option<u32>,
    spp: Option<u32>,
    integrator: Option<&str>,
    seed: u64,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(u32, u32, Bound<'py, PyArray1<f32>>)> {
    let tracing = &tracer.0;
    let of_scene = Settings::of(tracing.tracer.scene());
    let film = Film {
        width: width.unwrap_or(of_scene.film.width),
        height: height.unwrap_or(of_scene.film.height),
    };
    let settings = Settings {
        film,
        spp: spp.unwrap_or(of_scene.spp),
        integrator: integrator.map_or(Ok(of_scene.integrator), integrator_of)?,
        seed,
        // A picture is an array of three colors; there is no opacity in it.
        channels: Channels::default(),
        ..of_scene
    };
    settings
        .check()
        .map_err(|error| value_error(error.to_string()))?;
    let pixels = u64::from(film.width) * u64::from(film.height);
    let picture = work::run(py, progress, pixels, |work: &Work| {
        cyltrace_render::render(
            &tracing.tracer,
            &settings,
            &tracing.workers,
            &|pixels| work.add(pixels),
            work.cancelled(),
        )
    })?;
    let picture = picture.map_err(|error| match error {
        RenderError::Cancelled => PyKeyboardInterrupt::new_err(error.to_string()),
        error => value_error(error.to_string()),
    })?;
    let pixels = picture.film.pixels().as_flattened().to_vec();
    Ok((film.width, film.height, PyArray1::from_vec(py, pixels)))
}

/// A picture as the bytes of a PNG, as the program writes it.
#[pyfunction]
pub fn png<'py>(
    py: Python<'py>,
    width: u32,
    height: u32,
    pixels: PyReadonlyArray1<'_, f32>,
) -> PyResult<Bound<'py, PyBytes>> {
    let film = film(width, height, &pixels)?;
    let bytes = film_png_bytes(&film).map_err(|error| value_error(error.to_string()))?;
    Ok(PyBytes::new(py, &bytes))
}

/// Writes a picture to a file, in the format of its ending: `.png` or `.exr`.
#[pyfunction]
pub fn write_picture(
    path: PathBuf,
    width: u32,
    height: u32,
    pixels: PyReadonlyArray1<'_, f32>,
) -> PyResult<()> {
    let film = film(width, height, &pixels)?;
    let output = Output::create(&path, Contents::default()).map_err(output_error)?;
    output.write(&film).map_err(output_error)
}

fn output_error(error: OutputError) -> PyErr {
    match error {
        OutputError::File(_) => PyOSError::new_err(error.to_string()),
        error => value_error(error.to_string()),
    }
}

fn film(
    width: u32,
    height: u32,
    pixels: &PyReadonlyArray1<'_, f32>,
) -> PyResult<cyltrace_output::Film> {
    let (pixels, _) = pixels.as_slice()?.as_chunks::<3>();
    Ok(cyltrace_output::Film::new(width, height, pixels.to_vec()))
}
