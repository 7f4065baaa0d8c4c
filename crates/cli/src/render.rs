//! `cyltrace render`.

mod report;

use std::fs::File;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, anyhow, bail};
use cyltrace::scene::{Integrator, Scene, SceneFile};
use cyltrace::tracer::Options;
use cyltrace_output::{Contents, Display, Format, Legend, Output, with_overlay};
use cyltrace_parts::{Header, PartNumber, PartWriter};
use cyltrace_render::{Channels, KeptTiles, RenderError, Settings, Tiles, Watch};
use serde_json::json;

use super::arguments::RenderArguments;
use super::interrupt::Interrupted;
use super::limit::{MemoryLimit, Need};
use super::outputs::Files;
use super::parts::checkpoint::KeptInFile;
use super::parts::{self, Work};
use super::print::{note, print};
use super::{interrupt, json, progress, scene};
pub use report::samples_text;
use report::{Run, Times};

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
    let settings = settings(arguments, &file)?;
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
    let whole = whole.map(|whole| work(arguments, &settings, &file).header(whole));
    let whole = whole.transpose()?;
    let limit = limit.with_samples(settings.samples_bytes());
    let scene = Arc::new(scene::load(common, file, Need::Build, limit)?);
    let load = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let options = Options {
        view: settings.view(&scene),
        layout: arguments.memory.layout.into(),
        exact: arguments.decisions.exact,
        ..Options::default()
    };
    let tracer = scene::build(common, &scene, options)?;
    let build = start.elapsed().as_secs_f64();

    let legend = legend(arguments, &settings, &scene)?;
    let cancelled = interrupt::end_in_order();
    let target = match &header {
        Some(header) => Target::Part(parts::create(&arguments.output, header)?),
        None => Target::Picture(Output::create(
            &arguments.output,
            contents(arguments, &settings),
        )?),
    };
    // A scene that is wrong leaves no checkpoint.
    let kept = match (&arguments.checkpoint, &whole) {
        (Some(path), Some(header)) => Some(checkpoint(arguments, path, header)?),
        _ => None,
    };
    let workers = scene::workers(common)?;
    let all = Tiles::of(settings.film);
    let tiles = header
        .as_ref()
        .map_or(0..all.count(), |header| header.range.clone());
    let bar = progress::bar(common, all.pixels(tiles.clone()), "pixels");
    let start = Instant::now();
    let watch = Watch {
        progress: &|pixels| bar.inc(pixels),
        cancelled,
        kept: kept.as_ref().map(|kept| kept as &dyn KeptTiles),
    };
    let rendered = cyltrace_render::render_tiles(&tracer, &settings, tiles, &workers, &watch);
    let times = Times {
        load,
        build,
        render: start.elapsed().as_secs_f64(),
    };
    bar.finish_and_clear();
    if let Some(failure) = kept.as_ref().and_then(KeptInFile::flush) {
        note(common.quiet, &failure);
    }
    let rendered = match (rendered, &kept) {
        (Err(RenderError::Cancelled), Some(_)) => return Err(Interrupted::TilesKept.into()),
        (Err(RenderError::Cancelled), None) => return Err(Interrupted::NothingWritten.into()),
        (other, _) => other?,
    };
    interrupt::check()?;
    let run = Run {
        arguments,
        settings: &settings,
        tracer: &tracer,
        rays: rendered.rays,
        reached: rendered.reached,
        skipped: &rendered.skipped,
        times,
        threads: workers.current_num_threads(),
        header: header.as_ref(),
        earlier: kept.as_ref().map(KeptInFile::earlier),
    };
    let figures = run.figures();
    match target {
        Target::Picture(mut output) => {
            if let Some(reached) = rendered.reached {
                output.state_error(reached.error);
            }
            let film = settings.film;
            let size = (film.width, film.height);
            let overlay = legend.map(|legend| legend.overlay(size));
            let bands = with_overlay(
                overlay,
                film.width,
                settings.channels.has_opacity(),
                rendered.bands(film),
            );
            output.write_bands(size, bands)?;
            if let Some(kept) = kept {
                sync(&arguments.output)?;
                kept.remove()?;
            }
        }
        Target::Part(mut part) => {
            parts::render::write(&mut part, &rendered)?;
            let seconds = run.times.all();
            // Drawn when the parts are put together.
            part.finish(&json!({ "figures": figures, "seconds": seconds, "legend": legend }))?;
        }
    }
    json::write(common, &figures)?;
    match common.prints() {
        true => print(&run.text()),
        false => Ok(()),
    }
}

/// Opens the checkpoint of the picture with this header.
fn checkpoint(
    arguments: &RenderArguments,
    path: &Path,
    header: &Header,
) -> anyhow::Result<KeptInFile> {
    let kept = KeptInFile::open(path, header)?;
    if let Some(text) = kept.opened_text() {
        note(arguments.common.quiet, &text);
    }
    Ok(kept)
}

/// Waits until the picture is on the disk, where it is a file: only then the checkpoint is of no
/// more use.
fn sync(output: &Path) -> anyhow::Result<()> {
    let file = File::open(output).and_then(|file| match file.metadata()?.is_file() {
        true => file.sync_all(),
        false => Ok(()),
    });
    file.with_context(|| format!("cannot sync {output:?}; the checkpoint is kept"))
}

/// The legend that is drawn over the picture, where that shows the color that it explains.
fn legend(
    arguments: &RenderArguments,
    settings: &Settings,
    scene: &Scene,
) -> anyhow::Result<Option<Legend>> {
    let shows_colors = matches!(settings.integrator, Integrator::Sun | Integrator::Path);
    let legend = cyltrace_render::legend(scene).filter(|_| shows_colors);
    if legend.is_some() && contents(arguments, settings).display != Display::default() {
        bail!(
            "{:?} has a [legend], whose colors --exposure and --tonemap would change: leave them out, or remove the legend",
            arguments.scene
        );
    }
    Ok(legend)
}

/// What a run writes to.
enum Target {
    Picture(Output),
    Part(PartWriter),
}

/// The files that are read and written.
pub fn output_files(arguments: &RenderArguments) -> Files<'_> {
    let files = Files::new(&arguments.scene, arguments.common.json.as_deref());
    let files = files.output("-o", &arguments.output);
    match &arguments.checkpoint {
        Some(path) => files.output("--checkpoint", path),
        None => files,
    }
}

/// Samples of a pixel unless the command line says otherwise, with `--error` or `--time`.
const MOST_SAMPLES: u32 = 16_384;

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
        settings.spp = MOST_SAMPLES;
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
