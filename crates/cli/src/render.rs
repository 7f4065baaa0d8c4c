//! `cyltrace render`.

mod denoise;
mod frames;
mod pictures;
mod report;

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, anyhow, bail};
use cyltrace::scene::{Integrator, SceneFile};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_output::{Contents, Display, Format, Insets, Output};
use cyltrace_parts::{Header, PartNumber};
use cyltrace_render::{Channels, EnvironmentMap, Settings, Target, Tiles};
use serde_json::json;

use super::arguments::RenderArguments;
use super::limit::{MemoryLimit, Need, PictureBytes};
use super::outputs::Files;
use super::parts::checkpoint::KeptInFile;
use super::parts::{self, Work};
use super::print::{note, print};
use super::{interrupt, json, scene};
use denoise::Denoising;
use frames::frames;
use pictures::Pictures;
use report::Run;
pub use report::samples_text;

/// Renders the scene into the picture, or a part of it into a file of its own.
pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    if arguments.workers.workers.is_some() {
        return parts::workers::run(arguments);
    }
    parts::parent::end_with_parent()?;
    let common = &arguments.common;
    let files = output_files(arguments);
    files.check()?;
    parts::check(&arguments.part, &arguments.output)?;
    if arguments.part.part.is_none() {
        check_output(arguments)?;
    }
    json::check(common)?;

    let start = Instant::now();
    let limit = MemoryLimit::of(&arguments.memory);
    let file = scene::read(&arguments.scene, limit)?;
    files.check_with(&file)?;
    let frames = frames(&arguments.frames, &arguments.output);
    if arguments.frames.frames.is_some() {
        for frame in &frames {
            let files = Files::new(&arguments.scene, common.json.as_deref());
            files.output("-o", &frame.output).check_with(&file)?;
        }
    }
    let settings = settings(arguments, &file)?;
    let denoising = denoising(arguments, &settings)?;
    let header = arguments.part.part.map(|number| {
        let work = work(arguments, &settings, &file);
        work.header(number)
    });
    let header = header.transpose()?;
    if let Some(header) = &header
        && parts::is_done(&arguments.part, common, &arguments.output, header)?
    {
        return Ok(());
    }
    let whole = PartNumber::new(1, 1).filter(|_| arguments.checkpoint.is_some());
    let whole = whole.map(|whole| {
        let settings = denoising.as_ref().map_or(&settings, Denoising::settings);
        work(arguments, settings, &file).header(whole)
    });
    let whole = whole.transpose()?;
    let file = match settings.integrator {
        Integrator::Sun | Integrator::Path => file,
        Integrator::Ao | Integrator::Normal => file.without_environment(),
    };
    let rendered = denoising.as_ref().map_or(&settings, Denoising::settings);
    let limit = limit.with_picture(PictureBytes {
        pixels: rendered.pixels_bytes(tiles(&settings, header.as_ref())),
        denoising: denoising.as_ref().map_or(0, Denoising::bytes),
        samples: settings.samples_bytes(),
        environment: EnvironmentMap::bytes(file.environment_pixels()),
    });
    let scene = Arc::new(scene::load(common, file, Need::Build, limit)?);
    let load = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let options = Options {
        // Pictures of a film have different views.
        view: settings.view(&scene).filter(|_| frames.len() == 1),
        layout: arguments.memory.layout.into(),
        exact: arguments.decisions.exact,
        ..Options::default()
    };
    let tracer = scene::build(common, &scene, options)?;
    let build = start.elapsed().as_secs_f64();

    insets(arguments, &settings, &tracer)?;
    let cancelled = interrupt::end_in_order();
    // A scene that is wrong leaves no checkpoint.
    let kept = checkpoint(arguments, whole.as_ref())?;
    let workers = scene::workers(common)?;
    let done = Pictures {
        arguments,
        settings: &settings,
        tracer: &tracer,
        header: header.as_ref(),
        kept: kept.as_ref(),
        denoising: denoising.as_ref(),
        workers: &workers,
        cancelled,
    }
    .render(&frames)?;
    let run = Run {
        arguments,
        settings: &settings,
        tracer: &tracer,
        rays: done.rays(),
        reached: done.reached(),
        skipped: &done.skipped,
        times: done.times(load, build),
        threads: workers.current_num_threads(),
        header: header.as_ref(),
        earlier: kept.as_ref().map(KeptInFile::earlier),
        frames: match arguments.frames.frames {
            Some(_) => &done.figures,
            None => &[],
        },
    };
    let figures = run.figures();
    if let Some((part, insets)) = done.part {
        let seconds = run.times.all();
        // Insets are drawn when the parts are put together.
        part.finish(&json!({ "figures": figures, "seconds": seconds, "insets": insets }))?;
    }
    if let Some(kept) = kept {
        kept.end(&arguments.output)?;
    }
    json::write(common, &figures)?;
    match common.prints() {
        true => print(&run.text()),
        false => Ok(()),
    }
}

/// The tiles of a run: those of its part, or all.
fn tiles(settings: &Settings, part: Option<&Header>) -> Range<u64> {
    match part {
        Some(header) => header.range.clone(),
        None => Tiles::of(settings.film).all(),
    }
}

/// What removes the noise, if that is requested.
fn denoising(
    arguments: &RenderArguments,
    settings: &Settings,
) -> anyhow::Result<Option<Denoising>> {
    let threads = scene::workers(&arguments.common)?.current_num_threads();
    let denoising = arguments.picture.denoise;
    denoising
        .then(|| Denoising::new(settings, threads))
        .transpose()
}

/// Opens the checkpoint of the picture with this header, if it has one.
fn checkpoint(
    arguments: &RenderArguments,
    whole: Option<&Header>,
) -> anyhow::Result<Option<KeptInFile>> {
    let (Some(path), Some(whole)) = (&arguments.checkpoint, whole) else {
        return Ok(None);
    };
    let kept = KeptInFile::open(path, whole)?;
    if let Some(text) = kept.opened_text() {
        note(arguments.common.quiet, &text);
    }
    Ok(Some(kept))
}

/// What is drawn over the picture.
fn insets(
    arguments: &RenderArguments,
    settings: &Settings,
    tracer: &Tracer,
) -> anyhow::Result<Insets> {
    let insets = cyltrace_render::insets(tracer, settings)
        .with_context(|| format!("{:?} has a [scale_bar] that does not fit", arguments.scene))?;
    if insets.legend.is_some() && contents(arguments, settings).display != Display::default() {
        bail!(
            "{:?} has a [legend], whose colors --exposure and --tonemap would change: leave them out, or remove the legend",
            arguments.scene
        );
    }
    Ok(insets)
}

/// The files that are read and written.
pub fn output_files(arguments: &RenderArguments) -> Files<'_> {
    let files = Files::new(&arguments.scene, arguments.common.json.as_deref());
    // Pictures of a film have names of their own.
    let files = match arguments.frames.frames {
        Some(_) => files,
        None => files.output("-o", &arguments.output),
    };
    match &arguments.checkpoint {
        Some(path) => files.output("--checkpoint", path),
        None => files,
    }
}

/// Checks that the picture can be written, as far as this is known before the scene is read.
pub fn check_output(arguments: &RenderArguments) -> anyhow::Result<()> {
    let picture = &arguments.picture;
    let contents = Contents {
        channels: Channels::new(picture.channels.iter().copied(), false).list(),
        ..Contents::default()
    };
    Output::check(&arguments.output, &contents)?;
    let is_shown = picture.exposure.is_some() || picture.tonemap.is_some();
    if is_shown && Format::of(&arguments.output)? == Format::Exr {
        bail!("--exposure and --tonemap are of a .png: an .exr has the colors as they are");
    }
    Ok(())
}

/// What the file of the picture has beside its colors.
fn contents(arguments: &RenderArguments, settings: &Settings) -> Contents {
    Contents {
        channels: settings.channels.list(),
        display: arguments.picture.display(),
        error: None,
    }
}

/// The settings of the command line, and of the scene where that leaves a choice.
pub fn settings(arguments: &RenderArguments, file: &SceneFile) -> anyhow::Result<Settings> {
    // The error's text is the whole message; its source would repeat a part.
    let stated = file.picture().map_err(|error| anyhow!("{error}"))?;
    let background = file.background().map_err(|error| anyhow!("{error}"))?;
    let mut settings = Settings::new(stated, background);
    let picture = &arguments.picture;
    let channels = picture.channels.iter().copied();
    settings.channels = Channels::new(channels, background.is_transparent());
    settings.target = picture.target();
    if settings.target.is_some() {
        settings.spp = Target::MOST_SAMPLES;
    }
    settings.seed = arguments.seed;
    if let Some(size) = arguments.size {
        settings.film = size;
    }
    if let Some(spp) = arguments.spp {
        settings.spp = spp.get();
    }
    if let Some(integrator) = arguments.integrator {
        settings.integrator = integrator.into();
    }
    settings.sampler = arguments.sampler.unwrap_or(settings.sampler);
    settings.check()?;
    Ok(settings)
}

/// What parts of the picture are parts of.
pub fn work<'a>(
    arguments: &RenderArguments,
    settings: &Settings,
    scene: &'a SceneFile,
) -> Work<'a> {
    Work {
        command: "render",
        unit: "tiles",
        whole: Tiles::of(settings.film).count(),
        settings: parts::render::settings(
            settings,
            arguments.picture.display(),
            arguments.decisions.exact,
        ),
        scene,
        long_table: None,
    }
}
