//! `cyltrace render --workers N`: a picture by several processes.
//!
//! Every part is rendered by a process of its own, so that one that dies takes nothing with
//! it but its part, which is rendered again. The processes share nothing.

use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow, bail};
use cyltrace_parts::{PartNumber, PartSet};
use cyltrace_render::RayCounts;
use indicatif::ProgressBar;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};

use super::folder::Folder;
use super::parent::PARENT;
use super::passed_on::passed_on;
use super::render::merge;
use crate::arguments::RenderArguments;
use crate::interrupt;
use crate::limit::MemoryLimit;
use crate::print::{note, print};
use crate::render::{check_output, output_files, samples_text, settings, work};
use crate::{COULD_NOT_RUN, json, progress, reached, scene};

/// Parts for each worker, unless `--parts` gives their number: at the end a worker is idle
/// for half a part's time on average, and every part costs a start.
const PARTS_PER_WORKER: u64 = 8;

/// How often a part is tried whose process ends by a signal or a panic.
const MOST_TRIES: u32 = 3;

/// How often a process is looked at.
const PAUSE: Duration = Duration::from_millis(10);

/// Renders the picture.
pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let (common, output) = (&arguments.common, &arguments.output);
    let Some(workers) = arguments.workers.workers else {
        bail!("--workers is missing");
    };
    let files = output_files(arguments);
    files.check()?;
    check_output(arguments)?;
    json::check(common)?;
    let start = Instant::now();
    let file = scene::read(&arguments.scene, MemoryLimit::of(&arguments.memory))?;
    files.check_with(&file)?;
    let settings = settings(arguments, &file)?;
    let work = work(arguments, &settings, &file);
    let count = work.whole;
    let whole = PartNumber::new(1, 1).map(|number| work.header(number));
    let fingerprint = whole.transpose()?.map(|header| header.fingerprint);

    let folder = Folder::open(output, arguments.part.resume)?;
    let stated = arguments.workers.parts.map(u64::from);
    let parts = stated
        .or_else(|| folder.earlier_parts(fingerprint.as_deref()))
        .unwrap_or(PARTS_PER_WORKER * workers.get() as u64)
        // More parts than tiles would be empty.
        .min(count);
    let workers = workers.get().min(parts as usize);
    interrupt::end_in_order();
    let bar = progress::bar(common, parts, "parts");
    let crew = Crew {
        program: std::env::current_exe().context("cannot find the program itself")?,
        arguments: passed_on(arguments, workers)?,
        folder: &folder.path,
        parts,
        bar: &bar,
        next: Mutex::new(1),
        failed: AtomicBool::new(false),
        notes: &|text| note(common.quiet, text),
    };
    let outcome = crew.work_together(workers);
    bar.finish_and_clear();
    let paths: Vec<PathBuf> = (1..=parts).map(|number| crew.path(number)).collect();
    if let Err(error) = outcome {
        return Err(match folder.remove_if_empty() {
            true => error,
            false => error.context(format!(
                "the parts that are complete are in {:?}: --resume uses them",
                folder.path
            )),
        });
    }
    let set = PartSet::read(&paths)?;
    merge(&set, output)?;
    let figures = figures(arguments, &set, workers, start.elapsed().as_secs_f64());
    folder.remove(&paths)?;

    for text in figures["notes"].as_array().into_iter().flatten() {
        note(common.quiet, text.as_str().unwrap_or_default());
    }
    json::write(common, &figures)?;
    if !common.prints() {
        return Ok(());
    }
    let film = settings.film;
    let reached = reached::of_parts(&set);
    let reached = reached.map_or_else(String::new, |one| reached::text(&one, &settings));
    print(&format!(
        "{}: {}x{}, {}, {}\n{reached}time: {:.2} s for {parts} parts by {workers} workers\n",
        output.display(),
        film.width,
        film.height,
        samples_text(&settings),
        settings.integrator.name(),
        start.elapsed().as_secs_f64(),
    ))
}

/// The workers and the parts that none has begun.
struct Crew<'a> {
    program: PathBuf,
    arguments: Vec<OsString>,
    folder: &'a Path,
    parts: u64,
    bar: &'a ProgressBar,
    /// The next part.
    next: Mutex<u64>,
    /// Whether a part cannot be rendered, so that the others need not be.
    failed: AtomicBool,
    notes: &'a (dyn Fn(&str) + Sync),
}

impl Crew<'_> {
    fn path(&self, number: u64) -> PathBuf {
        let digits = self.parts.to_string().len();
        self.folder.join(format!("{number:0digits$}.cylpart"))
    }

    /// Renders all parts.
    fn work_together(&self, workers: usize) -> anyhow::Result<()> {
        thread::scope(|scope| {
            let workers: Vec<_> = (0..workers).map(|_| scope.spawn(|| self.work())).collect();
            let ended: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
            let panicked = || anyhow!("a thread of --workers panicked");
            ended
                .into_iter()
                .try_for_each(|ended| ended.unwrap_or_else(|_| Err(panicked())))
        })
    }

    /// Renders parts until there are no more.
    fn work(&self) -> anyhow::Result<()> {
        while let Some(part) = self.next_part() {
            let rendered = self.render(part);
            if rendered.is_err() {
                self.failed.store(true, Ordering::Relaxed);
            }
            rendered?;
            self.bar.inc(1);
        }
        Ok(())
    }

    fn next_part(&self) -> Option<PartNumber> {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        let part = PartNumber::new(*next, self.parts);
        *next += 1;
        part.filter(|_| !self.failed.load(Ordering::Relaxed))
    }

    /// Renders a part, again if its process dies.
    fn render(&self, part: PartNumber) -> anyhow::Result<()> {
        for tried in 1.. {
            let Some((status, message)) = self.start(part)? else {
                return Ok(());
            };
            if status.success() {
                return Ok(());
            }
            // Wrong input would be wrong again, and a full disk full.
            if status.code() == Some(i32::from(COULD_NOT_RUN)) {
                let reason = message.strip_prefix("error: ").unwrap_or(&message);
                bail!("part {part}: {}", reason.trim_end());
            }
            if tried == MOST_TRIES {
                bail!(
                    "the process of part {part} ended {tried} times, the last time by {status}: {message}"
                );
            }
            (self.notes)(&format!(
                "the process of part {part} ended by {status}; the part is rendered again"
            ));
        }
        unreachable!("a part is tried {MOST_TRIES} times")
    }

    /// Runs the process of a part, and returns how it ended and what it printed to standard
    /// error. `None` if it was ended because another part failed.
    fn start(&self, part: PartNumber) -> anyhow::Result<Option<(ExitStatus, String)>> {
        let mut command = Command::new(&self.program);
        let path = self.path(part.number());
        command.arg(&self.arguments[0]);
        let mut output = OsString::from("--output=");
        output.push(path);
        command.arg(format!("--part={part}")).arg(output);
        command.args(&self.arguments[1..]).stderr(Stdio::piped());
        command.env(PARENT, std::process::id().to_string());
        let child = command.spawn();
        let child = child.with_context(|| format!("cannot start {:?}", self.program))?;
        self.wait(child)
    }

    /// Waits for a process, and ends it if the command is interrupted or another part failed.
    fn wait(&self, mut child: Child) -> anyhow::Result<Option<(ExitStatus, String)>> {
        loop {
            if let Some(status) = child.try_wait().context("cannot wait for a process")? {
                // A quiet process prints at most a message, which a pipe can keep.
                let mut message = String::new();
                if let Some(mut pipe) = child.stderr.take() {
                    let _ = pipe.read_to_string(&mut message);
                }
                return Ok(Some((status, message)));
            }
            let interrupted = interrupt::check();
            if interrupted.is_err() || self.failed.load(Ordering::Relaxed) {
                // It removes its unfinished file. A process that has just ended cannot be
                // signalled, and need not be.
                let _ = kill_process(Pid::from_child(&child), Signal::TERM);
                let _ = child.wait();
                interrupted?;
                return Ok(None);
            }
            thread::sleep(PAUSE);
        }
    }
}

/// The figures of the run: those of a part, with what the parts sum up to.
fn figures(arguments: &RenderArguments, set: &PartSet, workers: usize, seconds: f64) -> Value {
    let all = set.parts().iter().map(|part| &part.summary()["figures"]);
    let all: Vec<&Value> = all.collect();
    let mut figures = all[0].clone();
    if let Value::Object(keys) = &mut figures {
        keys.remove("part");
    }
    let sum = |key: &str| all.iter().filter_map(|one| one[key].as_f64()).sum::<f64>();
    for key in ["load_s", "build_s", "render_s"] {
        figures[key] = json!(sum(key));
    }
    let mut total = 0;
    for kind in RayCounts::PURPOSES {
        let counts = all.iter().filter_map(|one| one["rays"][kind].as_u64());
        let count: u64 = counts.sum();
        figures["rays"][kind] = json!(count);
        total += count;
    }
    // The workers trace side by side.
    figures["rays_per_s"] = json!(total as f64 / sum("render_s") * workers as f64);
    let peak = all
        .iter()
        .map(|one| one["memory"]["peak_rss_bytes"].as_u64());
    figures["memory"]["peak_rss_bytes"] = json!(peak.max().flatten());
    if let Some(reached) = reached::of_parts(set) {
        figures[reached::KEY] = reached::figures(&reached);
    }
    figures["output"] = json!(arguments.output);
    figures["workers"] = json!(workers);
    figures["parts"] = json!(set.parts().len());
    figures["run_s"] = json!(seconds);
    figures
}
