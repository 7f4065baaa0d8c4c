//! Pictures.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use cyltrace::scene::Film;
use cyltrace_output::{
    Band, Bands, Channel, Contents, Display, Format, Insets, Numbers, Output, OutputError, ToneMap,
    picture_png_bytes, with_overlays,
};
use cyltrace_render::{ChannelGroup, Channels, RenderError, Settings, Target};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::value_error;
use crate::choice::one_of;
use crate::tracer::PyTracer;
use crate::work::{self, Work};

/// What is drawn over a picture.
#[pyclass(frozen, name = "Insets", module = "cyltrace._core")]
pub struct PyInsets(Arc<Insets>);

/// How to render: `None` is as the scene has it.
#[derive(FromPyObject)]
pub struct Request {
    size: Option<(u32, u32)>,
    spp: Option<u32>,
    integrator: Option<String>,
    seed: u64,
    channels: Vec<String>,
    /// The relative error to reach.
    error: Option<f64>,
    /// The seconds after which the rendering ends.
    time: Option<f64>,
}

impl Request {
    /// # Errors
    /// When a name or a number is wrong.
    fn settings(&self, of_scene: Settings) -> PyResult<Settings> {
        let groups = self.channels.iter().map(|name| group(name));
        let groups: Vec<ChannelGroup> = groups.collect::<PyResult<_>>()?;
        let time = self.time.map(|seconds| {
            let time = Duration::try_from_secs_f64(seconds).ok();
            time.filter(|time| !time.is_zero()).ok_or_else(|| {
                value_error(format!(
                    "time is {seconds}: it must be a positive number of seconds"
                ))
            })
        });
        let is_limited = self.error.is_some() || self.time.is_some();
        let target = Target {
            error: self.error.unwrap_or_default(),
            time: time.transpose()?,
        };
        if let Some(error) = self.error
            && !(error > 0.0 && error.is_finite())
        {
            return Err(value_error(format!(
                "error is {error}: it must be a number above 0, such as 0.02"
            )));
        }
        let spp = match is_limited {
            true => Target::MOST_SAMPLES,
            false => of_scene.spp,
        };
        let integrator = self.integrator.as_ref();
        let integrator = integrator.map(|name| {
            one_of(
                "integrator",
                name,
                cyltrace::scene::Integrator::ALL,
                |one| one.name(),
            )
        });
        let film = self.size.map(|(width, height)| Film { width, height });
        let settings = Settings {
            film: film.unwrap_or(of_scene.film),
            spp: self.spp.unwrap_or(spp),
            integrator: integrator.unwrap_or(Ok(of_scene.integrator))?,
            seed: self.seed,
            channels: Channels::new(groups, of_scene.channels.has_opacity()),
            target: is_limited.then_some(target),
            ..of_scene
        };
        let checked = settings.check();
        checked.map_err(|error| value_error(error.to_string()))?;
        Ok(settings)
    }
}

fn group(name: &str) -> PyResult<ChannelGroup> {
    one_of("channel", name, ChannelGroup::ALL, ChannelGroup::name)
}

/// A rendered picture: linear RGB and the words of channels, row by row from the top.
#[pyclass(frozen, get_all, name = "Rendered", module = "cyltrace._core")]
pub struct Rendered {
    width: u32,
    height: u32,
    colors: Py<PyArray1<f32>>,
    has_opacity: bool,
    /// One word for opacity, if there is, then those of the channels.
    words: Py<PyArray1<u32>>,
    /// The error that was reached, and the number of tiles whose error is greater than that
    /// which was to be reached.
    reached: Option<(f32, u64)>,
    insets: Py<PyInsets>,
}

/// Renders a picture.
#[pyfunction]
#[pyo3(signature = (tracer, request, progress=None))]
pub fn render<'py>(
    py: Python<'py>,
    tracer: &PyTracer,
    request: Request,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Rendered> {
    let tracing = &tracer.0;
    let settings = request.settings(Settings::of(tracing.tracer.scene()))?;
    let film = settings.film;
    let insets = cyltrace_render::insets(&tracing.tracer, &settings);
    let insets = insets.map_err(|error| value_error(error.to_string()))?;
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
    let colors = picture.film.pixels().as_flattened().to_vec();
    let reached = picture.reached;
    Ok(Rendered {
        width: film.width,
        height: film.height,
        colors: PyArray1::from_vec(py, colors).unbind(),
        has_opacity: settings.channels.has_opacity(),
        words: PyArray1::from_vec(py, picture.words).unbind(),
        reached: reached.map(|reached| (reached.error, reached.tiles_above)),
        insets: Py::new(py, PyInsets(Arc::new(insets)))?,
    })
}

/// The channels by name: how many words a pixel has, and whether they are floats.
pub fn channels() -> Vec<(&'static str, usize, bool)> {
    let groups = ChannelGroup::ALL.into_iter();
    let widths = groups.map(|group| {
        let channels = group.channels();
        let are_floats = channels[0].numbers == Numbers::F32;
        (group.name(), channels.len(), are_floats)
    });
    widths.collect()
}

/// What is written of a picture.
#[derive(FromPyObject)]
pub struct Pixels<'py> {
    width: u32,
    height: u32,
    colors: PyReadonlyArray1<'py, f32>,
    has_opacity: bool,
    channels: Vec<String>,
    words: PyReadonlyArray1<'py, u32>,
    error: Option<f32>,
    insets: Option<Py<PyInsets>>,
}

impl Pixels<'_> {
    fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn contents(&self, display: Display) -> PyResult<Contents> {
        let groups = self.channels.iter().map(|name| group(name));
        let groups: Vec<ChannelGroup> = groups.collect::<PyResult<_>>()?;
        let channels: Vec<Channel> = Channels::new(groups, self.has_opacity).list();
        Ok(Contents {
            channels,
            display,
            error: self.error,
        })
    }

    fn has_legend(&self) -> bool {
        let insets = self.insets.as_ref();
        insets.is_some_and(|insets| insets.get().0.legend.is_some())
    }

    /// All rows at once.
    fn bands(&self) -> PyResult<impl Bands> {
        let (colors, _) = self.colors.as_slice()?.as_chunks::<3>();
        let words = self.words.as_slice()?;
        let rows = move |band: &mut Band| {
            band.colors.extend_from_slice(colors);
            band.words.extend_from_slice(words);
            Ok(())
        };
        let insets = self.insets.as_ref();
        let overlays = insets.map(|insets| insets.get().0.overlays(self.size()));
        let overlays = overlays.unwrap_or_default();
        Ok(with_overlays(overlays, self.width, self.has_opacity, rows))
    }
}

/// A picture as the bytes of a PNG, as the program writes it.
#[pyfunction]
pub fn png<'py>(py: Python<'py>, pixels: Pixels<'py>) -> PyResult<Bound<'py, PyBytes>> {
    let contents = pixels.contents(Display::default())?;
    let bytes = picture_png_bytes(pixels.size(), &contents, pixels.bands()?);
    let bytes = bytes.map_err(|error| value_error(error.to_string()))?;
    Ok(PyBytes::new(py, &bytes))
}

/// Writes a picture to a file, in the format of its ending: `.png` or `.exr`.
#[pyfunction]
pub fn write_picture(
    path: PathBuf,
    pixels: Pixels<'_>,
    exposure: f64,
    tonemap: &str,
) -> PyResult<()> {
    if !(-64.0..=64.0).contains(&exposure) {
        return Err(value_error(format!(
            "exposure is {exposure}: it must be a number from -64 to 64"
        )));
    }
    let tone_map = one_of("tonemap", tonemap, ToneMap::ALL, ToneMap::name)?;
    let display = Display { exposure, tone_map };
    let format = Format::of(&path).map_err(output_error)?;
    if !display.is_plain() && format == Format::Exr {
        return Err(value_error(
            "exposure and tonemap are of a .png: an .exr has the colors as they are",
        ));
    }
    if !display.is_plain() && pixels.has_legend() {
        return Err(value_error(
            "the picture has a legend, whose colors exposure and tonemap would change: leave them out, or render without the legend",
        ));
    }
    let output = Output::create(&path, pixels.contents(display)?).map_err(output_error)?;
    let written = output.write_bands(pixels.size(), pixels.bands()?);
    written.map_err(output_error)
}

fn output_error(error: OutputError) -> PyErr {
    match error {
        OutputError::File(_) => PyOSError::new_err(error.to_string()),
        error => value_error(error.to_string()),
    }
}
