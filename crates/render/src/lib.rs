//! From a scene to a picture: camera, samples, light and image files.
//!
//! [`render()`] makes a [`Film`] of linear colors, [`cyltrace_output::Output`] writes it. The
//! same scene, settings and seed give the same bytes for any number of
//! threads. [`render_tiles()`] renders a part of a picture, so that several processes can share
//! it: [`Tiles`] numbers its tiles.

mod bsdf;
mod channels;
mod clear_sky;
mod clips;
mod colors;
mod compare;
mod depth_cue;
mod disk;
mod environment;
mod frame;
mod inset;
mod insets;
mod integrator;
mod kept;
mod legend;
mod lights;
mod outlines;
mod place;
mod rendering;
mod sampler;
mod spread;
mod tiles;
mod until_error;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use cyltrace_output::{Band, Bands, Film};
use rayon::ThreadPool;

pub use channels::{ChannelGroup, Channels, NO_ID};
pub use clear_sky::ClearSkyModel;
pub use compare::tile_errors;
pub use cyltrace::scene::GREATEST_PIXELS;
pub use environment::EnvironmentMap;
pub use insets::insets;
pub use integrator::RayCounts;
pub use kept::{KeptTiles, Reached, Taken};
pub use lights::{Lights, SunLight};
pub use tiles::Tiles;
pub use until_error::Target;

use cyltrace::scene::{
    self, AimedCamera, Background, Integrator, RenderSettings, Sampler, Scene, ViewVolume,
};
use cyltrace::tracer::Tracer;
use integrator::View;
use place::Pixels;
use rendering::Work;
use until_error::LEAST_SAMPLES;

/// What to render, where the scene leaves a choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Size of the picture; at least 1 x 1.
    pub film: scene::Film,
    /// Samples a pixel, at least 1. The first `n` are the same for any number
    /// of samples; powers of two are spread most evenly. With a target, the most that a pixel
    /// gets, at least 2.
    pub spp: u32,
    /// What a pixel shows.
    pub integrator: Integrator,
    /// How samples are spread.
    pub sampler: Sampler,
    /// Chooses the random numbers.
    pub seed: u64,
    /// The channels beside the colors.
    pub channels: Channels,
    /// When a pixel has enough samples; `None` gives every pixel the same number.
    pub target: Option<Target>,
    /// The camera is turned by this, see [`AimedCamera::turned`].
    pub turn_degrees: f64,
}

impl Settings {
    /// The settings of the scene, with seed 0.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self::new((scene.film, scene.render), scene.background)
    }

    /// These settings of a scene, with seed 0.
    #[must_use]
    pub fn new((film, render): (scene::Film, RenderSettings), background: Background) -> Self {
        Self {
            film,
            spp: render.spp,
            integrator: render.integrator,
            sampler: render.sampler,
            seed: 0,
            channels: Channels::new([], background.is_transparent()),
            target: None,
            turn_degrees: 0.0,
        }
    }

    /// The camera of a picture.
    #[must_use]
    pub fn camera(&self, tracer: &Tracer) -> AimedCamera {
        let camera = &tracer.scene().camera;
        AimedCamera::new(camera, &tracer.bounds(), self.film).turned(self.turn_degrees)
    }

    /// The part of space that all rays of the picture will be in, where that is
    /// known before the scene is built: rays of the camera stay in its view,
    /// and with normals there are no others.
    #[must_use]
    pub fn view(&self, scene: &Scene) -> Option<ViewVolume> {
        let camera = match self.integrator {
            Integrator::Normal => AimedCamera::stated(&scene.camera, self.film)?,
            Integrator::Ao | Integrator::Sun | Integrator::Path => return None,
        };
        // Rays for outlines are also beside the picture.
        let is_inside = scene.illustration.outlines.is_none();
        let camera = is_inside.then(|| camera.turned(self.turn_degrees))?;
        camera.view_volume()
    }

    /// The bytes of the rendered pixels of some tiles, which are all in memory.
    #[must_use]
    pub fn pixels_bytes(&self, tiles: Range<u64>) -> u64 {
        let words = self.channels.list().len() * size_of::<u32>();
        let each = size_of::<[f32; 3]>() + words;
        let pixels = Tiles::of(self.film).pixels(tiles);
        pixels.saturating_mul(each as u64)
    }

    /// The bytes that the samples take while the picture is rendered: with a limit of time those of
    /// all tiles, otherwise little.
    #[must_use]
    pub fn samples_bytes(&self) -> u64 {
        match self.target {
            Some(Target { time: Some(_), .. }) => until_error::samples_bytes(self),
            _ => 0,
        }
    }

    /// Says whether a picture can be made with these settings.
    ///
    /// # Errors
    /// When there is no pixel, no sample, there are too many pixels, or the target is wrong.
    pub fn check(&self) -> Result<(), RenderError> {
        let scene::Film { width, height } = self.film;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > GREATEST_PIXELS {
            return Err(RenderError::Size { width, height });
        }
        if self.spp == 0 {
            return Err(RenderError::NoSamples);
        }
        match self.target {
            Some(target) if !(0.0..f64::INFINITY).contains(&target.error) => {
                Err(RenderError::Error(target.error))
            }
            Some(_) if self.spp < LEAST_SAMPLES => Err(RenderError::FewSamples(self.spp)),
            _ => Ok(()),
        }
    }
}

/// A picture and what it took.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The colours.
    pub film: Film,
    /// The words of the channels of each pixel, in the order of [`Channels::list`].
    pub words: Vec<u32>,
    /// What was reached, if the settings have a target.
    pub reached: Option<Reached>,
    /// The rays traced.
    pub rays: RayCounts,
    /// Work that the scene did not need.
    pub skipped: Vec<String>,
}

/// An error of a rendering.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The size is zero or too large.
    #[error(
        "invalid picture size {width}x{height}: it must be at least 1x1 and at most {GREATEST_PIXELS} pixels in all"
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The number of samples is zero.
    #[error("invalid number of samples per pixel 0: it must be at least 1")]
    NoSamples,
    /// The number of samples is too small to estimate an error.
    #[error(
        "at most {0} samples per pixel are too few to estimate an error: allow at least {LEAST_SAMPLES}"
    )]
    FewSamples(u32),
    /// The error that is to be reached is wrong.
    #[error("invalid error {0}: it must be a finite number from 0")]
    Error(f64),
    /// The caller cancelled the rendering.
    #[error("the rendering was cancelled")]
    Cancelled,
}

/// What a rendering reports to while it runs, and what it takes from an earlier one.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Gets the number of pixels that are done since the last call, from any of the threads.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// The rendering ends within some hundred samples of every thread when this becomes true.
    pub cancelled: &'a AtomicBool,
    /// Tiles of an earlier rendering with the same settings, and the place of new ones. A
    /// rendering with a limit of time takes and keeps none.
    pub kept: Option<&'a dyn KeptTiles>,
}

/// Some tiles of a picture and what they took.
#[derive(Clone, Debug)]
pub struct RenderedTiles {
    /// The colours of the tiles in their order, those of a tile row by row.
    pub pixels: Vec<[f32; 3]>,
    /// The words of the channels of each pixel, in the order of the pixels.
    pub words: Vec<u32>,
    /// The number of words of a pixel.
    pub words_each: usize,
    /// What was reached, if the settings have a target.
    pub reached: Option<Reached>,
    /// The rays traced.
    pub rays: RayCounts,
    /// Work that the scene did not need.
    pub skipped: Vec<String>,
}

impl RenderedTiles {
    /// The rows of a picture of this size whose tiles these are, a row of tiles at a
    /// time: the source of [`cyltrace_output::Output::write_bands`].
    ///
    /// # Panics
    /// If they are not.
    pub fn bands(&self, size: scene::Film) -> impl Bands {
        let (tiles, each) = (Tiles::of(size), self.words_each);
        let (mut row, mut rest, mut words) = (0, &self.pixels[..], &self.words[..]);
        move |band: &mut Band| {
            let pixels = tiles.pixels(tiles.row(row)) as usize;
            let (colors, later) = rest.split_at(pixels);
            tiles.arrange(row, 1, colors, &mut band.colors);
            let (own, later_words) = words.split_at(pixels * each);
            tiles.arrange(row, each, own, &mut band.words);
            (rest, words) = (later, later_words);
            row += 1;
            Ok(())
        }
    }
}

/// Renders the scene of `tracer` on the threads of `workers` (see
/// [`cyltrace::tracer::workers`]).
///
/// `progress` gets the number of pixels done since the last call, from any
/// of the threads. The rendering ends within some hundred samples of every
/// thread when `cancelled` becomes true.
///
/// # Errors
/// When the settings are unusable (see [`Settings::check`]), or the rendering
/// was cancelled.
pub fn render(
    tracer: &Tracer,
    settings: &Settings,
    workers: &ThreadPool,
    progress: &(dyn Fn(u64) + Sync),
    cancelled: &AtomicBool,
) -> Result<Picture, RenderError> {
    settings.check()?;
    let tiles = Tiles::of(settings.film);
    let all = tiles.all();
    let watch = Watch {
        progress,
        cancelled,
        kept: None,
    };
    let rendered = render_tiles(tracer, settings, all, workers, &watch)?;
    let (mut pixels, mut words) = (Vec::new(), Vec::new());
    tiles.arrange(0, 1, &rendered.pixels, &mut pixels);
    tiles.arrange(0, rendered.words_each, &rendered.words, &mut words);
    let scene::Film { width, height } = settings.film;
    Ok(Picture {
        film: Film::new(width, height, pixels),
        words,
        reached: rendered.reached,
        rays: rendered.rays,
        skipped: rendered.skipped,
    })
}

/// As [`render()`], only the tiles with the numbers `tiles` of [`Tiles`]. They are the same
/// pixels as in the whole picture.
///
/// # Errors
/// Those of [`render()`].
///
/// # Panics
/// If there are not as many tiles.
pub fn render_tiles(
    tracer: &Tracer,
    settings: &Settings,
    tiles: Range<u64>,
    workers: &ThreadPool,
    watch: &Watch,
) -> Result<RenderedTiles, RenderError> {
    settings.check()?;
    let count = Tiles::of(settings.film).count();
    assert!(tiles.end <= count, "tiles {tiles:?} of {count}");
    let view = View::new(tracer, settings.camera(tracer), settings.integrator);
    let work = Work {
        view: &view,
        settings,
        watch,
    };
    let all = Tiles::of(settings.film);
    let words_each = settings.channels.list().len();
    let mut pixels = Pixels::new(all.pixels(tiles.clone()), words_each);
    let places = pixels.places(all, tiles, words_each);
    let taken = workers.install(|| match settings.target {
        None => rendering::render(&work, places),
        Some(target) => until_error::render(&work, places, target),
    })?;
    Ok(RenderedTiles {
        pixels: pixels.colors,
        words: pixels.words,
        words_each,
        reached: settings.target.map(|_| taken.reached),
        rays: taken.rays,
        skipped: skipped(settings.integrator, &view.lights),
    })
}

/// The kinds of rays that the integrator or the lights have no need of.
fn skipped(integrator: Integrator, lights: &Lights) -> Vec<String> {
    let no_shadow = "no sun: no shadow rays";
    let reasons: &[(bool, &str)] = match integrator {
        Integrator::Normal => &[(true, "normals only: no shadow rays and no sky rays")],
        Integrator::Ao => &[(true, "ambient occlusion only: no shadow rays")],
        Integrator::Sun => &[
            (lights.sun().is_none(), no_shadow),
            (!lights.has_sky(), "no sky: no sky rays"),
        ],
        Integrator::Path => &[
            (
                !lights.is_sampled(),
                "no light to choose a direction to: no shadow rays",
            ),
            (
                lights.has_too_many_emitters(),
                "too many solids emit light to choose one: no shadow rays to them",
            ),
        ],
    };
    let holding = reasons.iter().filter(|(holds, _)| *holds);
    holding.map(|(_, reason)| (*reason).to_owned()).collect()
}
