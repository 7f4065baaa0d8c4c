//! `cyltrace check`.

mod external_input;
mod figures;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::bail;
use cyltrace::embree::DeviceOptions;
use cyltrace::scene::Film;
use cyltrace::tracer::{Options, Tracer};
use cyltrace_check::{
    self, Agreement, Class, Outcome, PageContent, Replay, Settings, TABLE_HEADINGS, TABLE_NAMES,
};
use cyltrace_output::NewFile;
use cyltrace_output::{Table, figure};

use super::arguments::{CheckArguments, Rays};
use super::limit::{MemoryLimit, Need};
use super::memory::readable;
use super::output_sink::{make_directory, write_text};
use super::outputs::Files;
use super::print::print;
use super::{CHECK_FAILED, GOOD, interrupt, json, progress, scene};
use external_input::ExternalInput;
use figures::figures;

/// Wrong answers that are listed, of each kind.
const MOST_LISTED: usize = 20;

/// Pixels across the pictures of the page; they have the shape of the scene's.
const PICTURE_WIDTH: u32 = 320;

/// Sides of the prisms in the pictures: few enough to see the difference.
const PICTURE_SEGMENTS: u32 = 16;

/// Everything that was found.
struct Found {
    outcome: Outcome,
    agreements: Vec<Agreement>,
}

impl Found {
    /// Whether nothing is wrong and the witnesses say enough.
    fn holds(&self) -> bool {
        let told_hold = self.agreements.iter().all(Agreement::holds);
        self.outcome.holds() && told_hold
    }
}

/// Runs the check; the exit code says whether it holds.
pub fn run(arguments: &CheckArguments) -> anyhow::Result<u8> {
    let common = &arguments.common;
    let page_path = arguments.report.as_ref().map(|dir| dir.join("index.html"));
    let files = files(arguments, page_path.as_ref());
    files.check()?;
    if let (Some(_), Rays::Count(_)) = (&arguments.hits, &arguments.rays) {
        bail!("--hits needs the rays that they are of: --rays FILE");
    }
    if let (Rays::Table(path), None, None) = (&arguments.rays, &arguments.hits, &arguments.mesh) {
        bail!(
            "--rays {}: a table of rays needs --hits or --mesh to be compared with",
            path.display()
        );
    }
    json::check(common)?;
    if let Some(directory) = &arguments.report
        && directory.is_file()
    {
        bail!(
            "--report {}: it is a file, not a directory",
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
    let told = workers.install(|| ExternalInput::read(arguments))?;
    let loaded = Arc::new(scene::load(
        common,
        file,
        Need::Build,
        MemoryLimit::available(),
    )?);
    let options = Options {
        exact: arguments.decisions.exact,
        ..Options::default()
    };
    let tracer = scene::build(common, &loaded, options)?;
    let settings = settings(arguments);
    if let Some(which) = &arguments.replay {
        return workers.install(|| replay(&tracer, which, &settings));
    }

    if told.is_none() && common.prints() {
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
    let report_progress = |done: u64, total: u64, _: &str| {
        bar.set_length(total);
        bar.set_position(done);
        if stop.load(std::sync::atomic::Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let start = Instant::now();
    let found = workers.install(|| match &told {
        Some(told) => told.compare(&tracer, arguments, &report_progress),
        None => {
            let outcome =
                cyltrace_check::compare_with(&loaded, &tracer, &settings, &report_progress);
            interrupt::check()?;
            Ok(Found {
                outcome: outcome?,
                agreements: Vec::new(),
            })
        }
    });
    bar.finish_and_clear();
    let found = found?;
    let elapsed = start.elapsed().as_secs_f64();

    if let Some(page) = &page_path {
        // Hits from elsewhere have nothing to do with these prisms.
        let pictures = if told.is_some() {
            None
        } else {
            workers.install(|| {
                cyltrace_check::pictures(
                    &tracer,
                    PICTURE_SEGMENTS,
                    picture_film(loaded.film),
                    arguments.max_memory,
                )
            })?
        };
        interrupt::check()?;
        let text = cyltrace_check::page(&PageContent {
            scene: &arguments.scene.display().to_string(),
            sentence: &sentence(arguments, &tracer, &found),
            outcome: &found.outcome,
            agreements: &found.agreements,
            source: &|index| source(told.as_ref(), index),
            pictures: pictures.as_ref(),
        });
        write_text(page, &text)?;
    }
    json::write(
        common,
        &figures(arguments, &tracer, &found, told.as_ref(), elapsed),
    )?;
    if common.prints() {
        let mut text = summary(&found, told.as_ref());
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
            cyltrace_check::verdict(&found.outcome, &found.agreements)
        );
        print(&text)?;
    }
    Ok(if found.holds() { GOOD } else { CHECK_FAILED })
}

/// Prints one ray and what everyone says of it.
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

/// What is read and written.
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
    files
}

fn settings(arguments: &CheckArguments) -> Settings {
    let mut segments = arguments.segments.clone();
    segments.sort_unstable();
    segments.dedup();
    let is_wanted = |class: &Class| arguments.class.is_empty() || arguments.class.contains(class);
    let mut settings = Settings {
        segments,
        // Each once, in the order of the table.
        classes: Class::ALL.into_iter().filter(is_wanted).collect(),
        seed: arguments.seed,
        max_memory: arguments.max_memory,
        most_listed: MOST_LISTED,
        device: device_options(arguments),
        ..Settings::default()
    };
    if let Rays::Count(count) = arguments.rays {
        settings.rays = count;
    }
    settings
}

fn device_options(arguments: &CheckArguments) -> DeviceOptions {
    DeviceOptions {
        threads: arguments.common.threads,
        max_isa: arguments.common.max_isa,
    }
}

/// A small picture of the same shape, but for extreme ones.
fn picture_film(film: Film) -> Film {
    let height = u64::from(PICTURE_WIDTH) * u64::from(film.height) / u64::from(film.width);
    Film {
        width: PICTURE_WIDTH,
        height: height.clamp(1, 2 * u64::from(PICTURE_WIDTH)) as u32,
    }
}

/// What the page is about, without anything that differs from run to run.
fn sentence(arguments: &CheckArguments, tracer: &Tracer, found: &Found) -> String {
    let compared = arguments.hits.as_ref().or(arguments.mesh.as_ref());
    let compared = compared.map_or_else(String::new, |path| format!("{}: ", path.display()));
    let told: u64 = found.agreements.iter().map(|one| one.rays).sum();
    let rays = match &arguments.rays {
        Rays::Table(path) => format!("{compared}{told} rays of {}", path.display()),
        Rays::Count(count) if compared.is_empty() => {
            format!("{count} rays of each class, seed {}", arguments.seed)
        }
        Rays::Count(_) => format!(
            "{compared}{told} rays around the scene, seed {}",
            arguments.seed
        ),
    };
    let statistics = tracer.statistics();
    format!(
        "{rays}; {}; Embree {} with {}.",
        statistics.instanced, statistics.embree_version, statistics.isa
    )
}

/// The lines for people.
fn summary(found: &Found, told: Option<&ExternalInput>) -> String {
    let Found {
        outcome,
        agreements,
    } = found;
    let mut text = String::new();
    for window in &outcome.windows {
        text += &format!("{window}\n");
    }
    let mut table = Table::new(&TABLE_HEADINGS, TABLE_NAMES);
    for row in cyltrace_check::table_rows(outcome, agreements) {
        table.push(row);
    }
    text += &table.to_string();
    for row in agreements {
        text += &cyltrace_check::tolerance_text(row);
    }
    for row in &outcome.convergence {
        text += &format!(
            "{} sides: {} % of rays in the silhouette band, 99 % of hits within {} r of the prism\n",
            row.segments,
            figure(row.band_percent),
            figure(row.p99_dt_r)
        );
    }
    for violation in &outcome.violations {
        text += &cyltrace_check::violation_text(violation);
    }
    for disagreement in agreements.iter().flat_map(|one| &one.listed) {
        let source = source(told, disagreement.index);
        text += &cyltrace_check::disagreement_text(disagreement, &source);
    }
    text
}

/// Where the answer for a ray stands, when it is not the tracer's.
fn source(told: Option<&ExternalInput>, index: u64) -> String {
    told.map_or_else(String::new, |told| told.source(index))
}
