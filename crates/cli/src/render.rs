//! `cyltrace render`.

use std::sync::Arc;
use std::time::Instant;

use cyltrace::tracer::{Options, Tracer};
use cyltrace_output::Output;
use cyltrace_render::{Picture, RenderError, Settings};
use serde_json::json;

use super::arguments::{RenderArguments, integrator_name};
use super::limit::{MemoryLimit, Need};
use super::outputs::Files;
use super::{interrupt, json, memory, print, progress, scene, text};

/// The times of the command's parts, in seconds.
struct Times {
    load: f64,
    build: f64,
    render: f64,
}

/// Renders the scene into the picture.
pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    let files =
        Files::new(&arguments.scene, common.json.as_deref()).output("-o", &arguments.output);
    files.check()?;
    Output::check(&arguments.output)?;
    json::check(common)?;

    let start = Instant::now();
    let limit = MemoryLimit::of(&arguments.memory);
    let file = scene::read(&arguments.scene, limit)?;
    files.check_with(&file)?;
    let scene = Arc::new(scene::load(common, file, Need::Build, limit)?);
    let mut settings = Settings::of(&scene);
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

    let cancelled = interrupt::end_in_order();
    let output = Output::create(&arguments.output)?;
    let workers = scene::workers(common)?;
    let threads = workers.current_num_threads();
    let film = settings.film;
    let bar = progress::bar(
        common,
        u64::from(film.width) * u64::from(film.height),
        "pixels",
    );
    let start = Instant::now();
    let rendered = cyltrace_render::render(
        &tracer,
        &settings,
        &workers,
        &|pixels| bar.inc(pixels),
        cancelled,
    );
    let render = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let picture = match rendered {
        Err(RenderError::Cancelled) => return Err(interrupt::Interrupted::NothingWritten.into()),
        other => other?,
    };
    interrupt::check()?;
    output.write(&picture.film)?;

    let times = Times {
        load,
        build,
        render,
    };
    report(arguments, &settings, &tracer, &picture, &times, threads)
}

/// Writes the JSON of `--json`, and prints the figures.
fn report(
    arguments: &RenderArguments,
    settings: &Settings,
    tracer: &Tracer,
    picture: &Picture,
    times: &Times,
    threads: usize,
) -> anyhow::Result<()> {
    let statistics = &tracer.statistics();
    let skipped_rows = tracer.scene().skipped_rows;
    let rays = picture.rays;
    let rays_per_s = rays.total() as f64 / times.render;
    let skipped: Vec<_> = picture.skipped.iter().chain(&statistics.skipped).collect();
    json::write(
        &arguments.common,
        &json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "size": [settings.film.width, settings.film.height],
            "spp": settings.spp,
            "integrator": integrator_name(settings.integrator),
            "seed": settings.seed,
            "load_s": times.load,
            "build_s": times.build,
            "render_s": times.render,
            "rays": { "camera": rays.camera, "shadow": rays.shadow, "ao": rays.ao },
            "rays_per_s": rays_per_s,
            "solids": json::Solids::of(statistics).by_kind(),
            "cylinders": json::Solids::of(statistics).cylinders(),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": skipped,
            "skipped_rows": skipped_rows,
            "notes": tracer.scene().notes,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": threads,
            "records": json::records(tracer.scene()),
        }),
    )?;
    if !arguments.common.prints() {
        return Ok(());
    }
    let mut text = format!(
        "{}: {}x{}, {} samples per pixel, {}\n{}",
        arguments.output.display(),
        settings.film.width,
        settings.film.height,
        settings.spp,
        integrator_name(settings.integrator),
        text::solids(statistics),
    );
    text += &format!(
        "memory: {} of records, {} in Embree {} ({})\n",
        memory::readable(statistics.records_bytes as u64),
        memory::readable(statistics.embree_bytes as u64),
        statistics.embree_version,
        statistics.isa
    );
    text += &text::records(tracer.scene());
    text += &format!(
        "time: load {:.2} s, build {:.2} s, render {:.2} s on {threads} threads\n",
        times.load, times.build, times.render
    );
    text += &format!(
        "rays: {}, {:.2} million per second\n",
        rays.total(),
        rays_per_s / 1e6
    );
    for reason in &skipped {
        text += &format!("skipped: {reason}\n");
    }
    text += &text::notes(&tracer.scene().notes);
    print(&text)
}
