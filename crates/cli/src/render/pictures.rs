//! The pictures of a run, or the part of one, from the scene that is built.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use cyltrace::tracer::Tracer;
use cyltrace_output::{Bands, Insets, Output, with_overlays};
use cyltrace_parts::{Header, PartWriter};
use cyltrace_render::{
    KeptTiles, RayCounts, Reached, RenderError, RenderedTiles, Settings, Tiles, Watch,
};
use rayon::ThreadPool;

use super::denoise::Denoising;
use super::frames::{Frame, FrameFigures};
use super::report::Times;
use super::{contents, insets, tiles};
use crate::arguments::RenderArguments;
use crate::interrupt::Interrupted;
use crate::parts::checkpoint::KeptInFile;
use crate::print::note;
use crate::{interrupt, parts, progress};

/// What the pictures are rendered with.
pub struct Pictures<'a> {
    pub arguments: &'a RenderArguments,
    pub settings: &'a Settings,
    pub tracer: &'a Tracer,
    /// The part that is rendered.
    pub header: Option<&'a Header>,
    pub kept: Option<&'a KeptInFile>,
    pub denoising: Option<&'a Denoising>,
    pub workers: &'a ThreadPool,
    /// Set by a signal.
    pub cancelled: &'a AtomicBool,
}

/// Pictures that are written, or a part that is not finished yet.
#[derive(Default)]
pub struct Done {
    pub figures: Vec<FrameFigures>,
    pub skipped: Vec<String>,
    pub part: Option<(PartWriter, Insets)>,
}

/// What a run writes to.
enum Target {
    Picture(Output),
    Part(PartWriter),
}

impl Pictures<'_> {
    /// Renders and writes pictures, one after the other.
    pub fn render(&self, frames: &[Frame]) -> anyhow::Result<Done> {
        let tiles = tiles(self.settings, self.header);
        let pixels = Tiles::of(self.settings.film).pixels(tiles) * frames.len() as u64;
        let bar = progress::bar(&self.arguments.common, pixels, "pixels");
        let mut done = Done::default();
        for frame in frames {
            let turned = |settings: &Settings| Settings {
                turn_degrees: frame.degrees,
                ..settings.clone()
            };
            let settings = turned(self.settings);
            let target = match self.header {
                Some(header) => Target::Part(parts::create(&frame.output, header)?),
                None => {
                    let contents = contents(self.arguments, &settings);
                    Target::Picture(Output::create(&frame.output, contents)?)
                }
            };
            let start = Instant::now();
            let with_guides = self.denoising.map(|denoising| turned(denoising.settings()));
            let rendered = self.rendered(
                with_guides.as_ref().unwrap_or(&settings),
                done.figures.len(),
                &|pixels| bar.inc(pixels),
            )?;
            let mut figures = FrameFigures {
                output: frame.output.clone(),
                degrees: frame.degrees,
                seconds: start.elapsed().as_secs_f64(),
                denoise_seconds: None,
                rays: rendered.rays,
                reached: rendered.reached,
            };
            let insets = insets(self.arguments, &settings, self.tracer)?;
            match (target, self.denoising) {
                (Target::Picture(output), Some(denoising)) => {
                    let denoised = denoising.apply(&rendered)?;
                    figures.denoise_seconds = Some(denoised.seconds);
                    write(
                        output,
                        &settings,
                        rendered.reached,
                        &insets,
                        denoised.bands(),
                    )?;
                }
                (Target::Picture(output), None) => {
                    let bands = rendered.bands(settings.film);
                    write(output, &settings, rendered.reached, &insets, bands)?;
                }
                (Target::Part(mut writer), _) => {
                    parts::render::write(&mut writer, &rendered)?;
                    done.part = Some((writer, insets));
                }
            }
            done.figures.push(figures);
            done.skipped = rendered.skipped;
        }
        bar.finish_and_clear();
        Ok(done)
    }

    /// Renders a picture, after others are complete, or a part.
    fn rendered(
        &self,
        settings: &Settings,
        complete: usize,
        progress: &(dyn Fn(u64) + Sync),
    ) -> anyhow::Result<RenderedTiles> {
        let watch = Watch {
            progress,
            cancelled: self.cancelled,
            kept: self.kept.map(|kept| kept as &dyn KeptTiles),
        };
        let tiles = tiles(settings, self.header);
        let rendered =
            cyltrace_render::render_tiles(self.tracer, settings, tiles, self.workers, &watch);
        if let Some(failure) = self.kept.and_then(KeptInFile::flush) {
            note(self.arguments.common.quiet, &failure);
        }
        let interrupted = match self.kept {
            Some(_) => Interrupted::TilesKept,
            None => Interrupted::after_pictures(complete),
        };
        let rendered = match rendered {
            Err(RenderError::Cancelled) => return Err(interrupted.into()),
            other => other?,
        };
        interrupt::check().map_err(|_| interrupted)?;
        Ok(rendered)
    }
}

/// Writes a picture.
fn write(
    mut output: Output,
    settings: &Settings,
    reached: Option<Reached>,
    insets: &Insets,
    bands: impl Bands,
) -> anyhow::Result<()> {
    if let Some(reached) = reached {
        output.state_error(reached.error);
    }
    let film = settings.film;
    let size = (film.width, film.height);
    let has_opacity = settings.channels.has_opacity();
    let bands = with_overlays(insets.overlays(size), film.width, has_opacity, bands);
    Ok(output.write_bands(size, bands)?)
}

impl Done {
    /// The rays of all pictures.
    pub fn rays(&self) -> RayCounts {
        let rays = self.figures.iter().map(|figures| figures.rays);
        rays.fold(RayCounts::default(), |all, rays| all + rays)
    }

    /// What the picture with the greatest error has reached.
    pub fn reached(&self) -> Option<Reached> {
        let reached = self.figures.iter().filter_map(|figures| figures.reached);
        reached.max_by(|one, other| one.error.total_cmp(&other.error))
    }

    /// The times of all pictures, with those before.
    pub fn times(&self, load: f64, build: f64) -> Times {
        let figures = || self.figures.iter();
        let denoise: Option<Vec<_>> = figures().map(|one| one.denoise_seconds).collect();
        Times {
            load,
            build,
            render: figures().map(|one| one.seconds).sum(),
            denoise: denoise.map(|seconds| seconds.iter().sum()),
        }
    }
}
