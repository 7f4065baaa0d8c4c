//! `cyltrace render`.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{anyhow, bail};
use cyltrace::scene::{Integrator, Scene, SceneFile};
use cyltrace::tracer::{Options, Tracer};
use cyltrace_output::{Contents, Display, Format, Legend, Output, with_overlay};
use cyltrace_parts::{Header, PartWriter};
use cyltrace_render::{Channels, RayCounts, Reached, RenderError, Settings, Tiles};
use serde_json::{Value, json};

use super::arguments::RenderArguments;
use super::limit::{MemoryLimit, Need};
use super::outputs::Files;
use super::parts::{self, Work};
use super::{interrupt, json, memory, print, progress, reached, scene, text};

/// The times of the command's parts, in seconds.
struct Times {
    load: f64,
    build: f64,
    render: f64,
}

impl Times {
    fn all(&self) -> f64 {
        self.load + self.build + self.render
    }
}

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
    let workers = scene::workers(common)?;
    let all = Tiles::of(settings.film);
    let tiles = header
        .as_ref()
        .map_or(0..all.count(), |header| header.range.clone());
    let bar = progress::bar(common, all.pixels(tiles.clone()), "pixels");
    let start = Instant::now();
    let rendered = cyltrace_render::render_tiles(
        &tracer,
        &settings,
        tiles,
        &workers,
        &|pixels| bar.inc(pixels),
        cancelled,
    );
    let times = Times {
        load,
        build,
        render: start.elapsed().as_secs_f64(),
    };
    bar.finish_and_clear();
    let rendered = match rendered {
        Err(RenderError::Cancelled) => return Err(interrupt::Interrupted::NothingWritten.into()),
        other => other?,
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

/// How many samples a pixel gets.
pub fn samples_text(settings: &Settings) -> String {
    let at_most = if settings.target.is_some() {
        "at most "
    } else {
        ""
    };
    format!("{at_most}{} samples per pixel", settings.spp)
}

/// What a run writes to.
enum Target {
    Picture(Output),
    Part(PartWriter),
}

/// The files that are read and written.
pub fn output_files(arguments: &RenderArguments) -> Files<'_> {
    Files::new(&arguments.scene, arguments.common.json.as_deref()).output("-o", &arguments.output)
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

/// A rendering that is complete.
struct Run<'a> {
    arguments: &'a RenderArguments,
    settings: &'a Settings,
    tracer: &'a Tracer,
    rays: RayCounts,
    reached: Option<Reached>,
    skipped: &'a [String],
    times: Times,
    threads: usize,
    /// The part that it is.
    header: Option<&'a Header>,
}

impl Run<'_> {
    /// The rays per second.
    fn rate(&self) -> f64 {
        self.rays.total() as f64 / self.times.render
    }

    /// Work that the scene did not need.
    fn skipped(&self) -> Vec<String> {
        let of_tracer = self.tracer.statistics().skipped;
        self.skipped.iter().cloned().chain(of_tracer).collect()
    }

    /// The JSON of `--json`.
    fn figures(&self) -> Value {
        let (arguments, settings, times) = (self.arguments, self.settings, &self.times);
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let purposes = RayCounts::PURPOSES.into_iter().zip(self.rays.by_purpose());
        let counts: BTreeMap<_, _> = purposes.collect();
        let channels = settings.channels.list();
        let names: Vec<_> = channels.iter().map(|channel| channel.name).collect();
        let mut figures = json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "size": [settings.film.width, settings.film.height],
            "spp": settings.spp,
            "integrator": settings.integrator.name(),
            "seed": settings.seed,
            "load_s": times.load,
            "build_s": times.build,
            "render_s": times.render,
            "rays": counts,
            "channels": names,
            "rays_per_s": self.rate(),
            "solids": json::Solids::of(statistics).by_kind(),
            "cylinders": json::Solids::of(statistics).cylinders(),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": self.skipped(),
            "skipped_rows": scene.skipped_rows,
            "notes": scene.notes,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": self.threads,
            "records": json::records(scene),
        });
        if let Some(reached) = &self.reached {
            figures[reached::KEY] = reached::figures(reached);
        }
        if let Some(header) = self.header {
            figures["part"] = json!(header.number.to_string());
        }
        figures
    }

    /// The figures for people.
    fn text(&self) -> String {
        let (arguments, settings, times) = (self.arguments, self.settings, &self.times);
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let of_whole = match self.header {
            Some(header) => parts::range_text(header) + ", ",
            None => String::new(),
        };
        let mut text = format!(
            "{}: {of_whole}{}x{}, {}, {}\n{}",
            arguments.output.display(),
            settings.film.width,
            settings.film.height,
            samples_text(settings),
            settings.integrator.name(),
            text::solids(statistics),
        );
        if let Some(reached) = &self.reached {
            text += &reached::text(reached, settings);
        }
        text += &format!(
            "memory: {} of records, {} in Embree {} ({})\n",
            memory::readable(statistics.records_bytes as u64),
            memory::readable(statistics.embree_bytes as u64),
            statistics.embree_version,
            statistics.isa
        );
        text += &text::records(scene);
        text += &format!(
            "time: load {:.2} s, build {:.2} s, render {:.2} s on {} threads\n",
            times.load, times.build, times.render, self.threads
        );
        text += &format!(
            "rays: {}, {:.2} million per second\n",
            self.rays.total(),
            self.rate() / 1e6
        );
        for reason in self.skipped() {
            text += &format!("skipped: {reason}\n");
        }
        text += &text::notes(&scene.notes);
        text
    }
}
