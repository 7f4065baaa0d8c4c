//! `cyltrace check`.

mod external_input;

use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::bail;
use cyltrace::embree::{Device, DeviceOptions, MaxIsa};
use cyltrace::scene::SceneFile;
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{self, Checked, Outcome, Replay, Settings};
use cyltrace_output::{NewFile, write_text};
use cyltrace_parts::Header;
use serde_json::{Value, json};

use super::arguments::{CheckArguments, Rays};
use super::limit::{MemoryLimit, Need};
use super::memory::readable;
use super::output_sink::make_directory;
use super::outputs::Files;
use super::parts::{self, Work};
use super::print::print;
use super::{CHECK_FAILED, GOOD, interrupt, json, progress, scene};
use external_input::ExternalInput;

/// The fields of the rows that depend on Embree's f32 arithmetic, whose last bits depend
/// on the instruction set.
const ISA_DEPENDENT: [&str; 6] = [
    "band_percent",
    "witnessed_percent",
    "unwitnessed_percent",
    "triangle_errors",
    "max_dt_over_chord",
    "p99_dt_r",
];

/// Wrong answers that are listed, of each kind.
const MOST_LISTED: usize = 20;

/// Runs the check. The exit code is 0 if it passes.
pub fn run(arguments: &CheckArguments) -> anyhow::Result<u8> {
    let common = &arguments.common;
    let page_path = arguments.report.as_ref().map(|dir| dir.join("index.html"));
    let files = files(arguments, page_path.as_ref());
    files.check()?;
    if let (Some(_), Rays::Count(_)) = (&arguments.hits, &arguments.rays) {
        bail!("--hits requires --rays FILE");
    }
    if let (Rays::Table(path), None, None) = (&arguments.rays, &arguments.hits, &arguments.mesh) {
        bail!(
            "--rays {}: a table of rays needs --hits or --mesh to be compared with",
            path.display()
        );
    }
    json::check(common)?;
    if let Some(output) = &arguments.output {
        parts::check(&arguments.part, output)?;
    }
    if let Some(directory) = &arguments.report
        && directory.is_file()
    {
        bail!(
            "--report {}: this is a file, not a directory",
            directory.display()
        );
    }
    if let (Some(directory), Some(page)) = (&arguments.report, &page_path) {
        make_directory(directory)?;
        NewFile::check(page)?;
    }
    let workers = scene::workers(common)?;
    let file = scene::read(&arguments.scene, MemoryLimit::available())?;
    files.check_with(&file)?;
    let settings = settings(arguments);
    let header = part_header(arguments, &settings, &file)?;
    if let (Some(header), Some(output)) = (&header, &arguments.output)
        && parts::is_done(&arguments.part, common, output, header)?
    {
        return Ok(GOOD);
    }
    let external = workers.install(|| ExternalInput::read(arguments))?;
    let loaded = Arc::new(scene::load(
        common,
        file.without_environment(),
        Need::Build,
        MemoryLimit::available(),
    )?);
    let options = Options {
        exact: arguments.decisions.exact,
        ..Options::default()
    };
    let tracer = scene::build(common, &loaded, options)?;
    if let Some(which) = &arguments.replay {
        return workers.install(|| replay(&tracer, which, &settings));
    }

    if external.is_none() && common.prints() {
        let plan = workers.install(|| cyltrace_check::plan(&loaded, &settings))?;
        print(&format!(
            "meshes: about {} for {} solids, {}\n",
            readable(plan.bytes),
            plan.solids,
            match plan.windows {
                1 => "the whole scene".to_owned(),
                parts => format!("the largest of {parts} parts of the scene"),
            }
        ))?;
    }
    let stop = interrupt::end_in_order();
    let bar = progress::bar(common, 0, "rays");
    let report_progress = |done: u64, total: u64| {
        bar.set_length(total);
        bar.set_position(done);
        if stop.load(std::sync::atomic::Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let start = Instant::now();
    let rays = header
        .as_ref()
        .map_or(0..settings.rays, |header| header.range.clone());
    let mut drawn = None;
    let outcome = workers.install(|| match &external {
        Some(external) => external.compare(&tracer, arguments, &report_progress),
        None => {
            let outcome =
                cyltrace_check::compare_rays(&loaded, &tracer, &settings, rays, &report_progress);
            interrupt::check()?;
            let outcome = outcome?;
            drawn = header.is_some().then(|| outcome.to_bytes());
            Ok(Outcome::of_parts(&settings, [outcome]))
        }
    });
    bar.finish_and_clear();
    let outcome = outcome?;
    let elapsed = start.elapsed().as_secs_f64();
    let mut figures = figures(arguments, &tracer, &outcome, elapsed);
    if let (Some(header), Some(output), Some(tallies)) = (&header, &arguments.output, drawn) {
        let mut part = parts::create(output, header)?;
        part.write_all(&tallies)?;
        part.finish(&json!({ "figures": figures, "seconds": elapsed }))?;
        figures["part"] = json!(header.number.to_string());
    }

    if let Some(page) = &page_path {
        let checked = Checked {
            scene: &arguments.scene.display().to_string(),
            rays: &rays_text(arguments, &settings, &outcome),
            outcome: &outcome,
            tracer: &tracer,
            max_memory: arguments.max_memory,
        };
        let text = workers.install(|| cyltrace_check::page(&checked))?;
        interrupt::check()?;
        write_text(page, &text)?;
    }
    json::write(common, &figures)?;
    if common.prints() {
        let mut text = match &header {
            Some(header) => parts::range_text(header) + "\n",
            None => String::new(),
        };
        text += &cyltrace_check::summary(&outcome);
        text += &format!(
            "time: {elapsed:.2} s on {} threads\n",
            workers.current_num_threads()
        );
        if let Some(page) = &page_path {
            text += &format!("report: {}\n", page.display());
        }
        text += &format!(
            "{} {}\n",
            arguments.scene.display(),
            cyltrace_check::verdict(&outcome)
        );
        print(&text)?;
    }
    // A part that is written is a success: the verdict is that of the whole.
    Ok(match header.is_some() || outcome.holds() {
        true => GOOD,
        false => CHECK_FAILED,
    })
}

/// The header of the part that is checked, if not all is.
fn part_header(
    arguments: &CheckArguments,
    settings: &Settings,
    scene: &SceneFile,
) -> anyhow::Result<Option<Header>> {
    let Some(number) = arguments.part.part else {
        return Ok(None);
    };
    let embree = Device::new(&settings.device)?.version().to_string();
    let isa = MaxIsa::name_in_use(settings.device.max_isa);
    let work = Work {
        command: "check",
        unit: "rays",
        whole: settings.rays,
        settings: parts::check::settings(settings, arguments.decisions.exact, &embree, isa),
        scene,
        long_table: None,
    };
    work.header(number).map(Some)
}

/// Prints one ray with all that is known about it.
fn replay(tracer: &Tracer, which: &Replay, settings: &Settings) -> anyhow::Result<u8> {
    let replayed = cyltrace_check::replay(tracer.scene(), tracer, settings, which)?;
    let mut text: String = replayed
        .lines
        .iter()
        .map(|line| line.clone() + "\n")
        .collect();
    for violation in &replayed.violations {
        text += &cyltrace_check::violation_text(violation);
    }
    print(&text)?;
    Ok(if replayed.violations.is_empty() {
        GOOD
    } else {
        CHECK_FAILED
    })
}

/// The files that are read and written.
fn files<'a>(arguments: &'a CheckArguments, page: Option<&'a PathBuf>) -> Files<'a> {
    let mut files = Files::new(&arguments.scene, arguments.common.json.as_deref());
    if let Rays::Table(path) = &arguments.rays {
        files = files.input("the table of rays", path);
    }
    if let Some(path) = &arguments.hits {
        files = files.input("the table of hits", path);
    }
    if let Some(path) = &arguments.mesh {
        files = files.input("the mesh", path);
    }
    if let Some(path) = page {
        files = files.output("the page of --report", path);
    }
    if let Some(path) = &arguments.output {
        files = files.output("-o", path);
    }
    files
}

fn settings(arguments: &CheckArguments) -> Settings {
    let mut settings = Settings {
        segments: arguments.segments.clone(),
        seed: arguments.seed,
        max_memory: arguments.max_memory,
        most_listed: MOST_LISTED,
        device: device_options(arguments),
        ..Settings::default()
    };
    if !arguments.class.is_empty() {
        settings.classes.clone_from(&arguments.class);
    }
    if let Rays::Count(count) = arguments.rays {
        settings.rays = count;
    }
    settings.in_order()
}

fn device_options(arguments: &CheckArguments) -> DeviceOptions {
    DeviceOptions {
        threads: arguments.common.threads,
        max_isa: arguments.common.max_isa,
    }
}

/// Which rays were checked, without anything that differs from run to run.
fn rays_text(arguments: &CheckArguments, settings: &Settings, outcome: &Outcome) -> String {
    let compared = arguments.hits.as_ref().or(arguments.mesh.as_ref());
    let Some(compared) = compared.map(|path| path.display()) else {
        return settings.rays_text();
    };
    let rays = outcome.rays();
    match &arguments.rays {
        Rays::Table(path) => format!("{compared}: {rays} rays of {}", path.display()),
        Rays::Count(_) => format!(
            "{compared}: {rays} rays around the scene, seed {}",
            arguments.seed
        ),
    }
}

/// The figures as JSON: those of the outcome, and of this run.
fn figures(arguments: &CheckArguments, tracer: &Tracer, outcome: &Outcome, elapsed: f64) -> Value {
    let statistics = tracer.statistics();
    let is_external = outcome.rows.iter().any(|row| row.tolerance.is_some());
    let mut figures = json!({ "scene": arguments.scene });
    let all = json!(outcome);
    let solids = json::Solids::of(&statistics);
    let of_run = json!({
        "seed": arguments.seed,
        "solids": solids.by_kind(),
        "cylinders": solids.cylinders(),
        "embree": statistics.embree_version,
        "isa": statistics.isa,
        // External hits are compared in f64.
        "isa_dependent": if is_external { &[][..] } else { &ISA_DEPENDENT },
        "check_s": elapsed,
    });
    for part in [all, of_run] {
        if let (Value::Object(figures), Value::Object(part)) = (&mut figures, part) {
            figures.extend(part);
        }
    }
    figures
}
