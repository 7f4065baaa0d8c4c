//! `cyltrace render --workers N`: a picture by several processes.
//!
//! Every part is rendered by a process of its own, so that one that dies takes nothing with
//! it but its part, which is rendered again. The processes share nothing.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow, bail};
use clap::ValueEnum;
use cyltrace_output::Output;
use cyltrace_parts::{PartNumber, PartSet};
use indicatif::ProgressBar;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};

use super::render::merge;
use crate::arguments::RenderArguments;
use crate::interrupt;
use crate::limit::MemoryLimit;
use crate::print::{note, print};
use crate::render::{output_files, settings, work};
use crate::{COULD_NOT_RUN, json, progress, scene};

/// Parts for each worker, unless `--parts` gives their number: at the end a worker is idle
/// for half a part's time on average, and every part costs a start.
const PARTS_PER_WORKER: u64 = 8;

/// How often a part is tried whose process dies.
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
    Output::check(output)?;
    json::check(common)?;
    let start = Instant::now();
    let file = scene::read(&arguments.scene, MemoryLimit::of(&arguments.memory))?;
    files.check_with(&file)?;
    let settings = settings(arguments, &file)?;
    let count = work(arguments, &settings, &file).whole;
    let stated = arguments.workers.parts.map(u64::from);
    let parts = stated.unwrap_or(PARTS_PER_WORKER * workers.get() as u64);
    // More parts than tiles would be empty.
    let parts = parts.min(count);

    let folder = folder_of(output);
    if folder.exists() && !arguments.part.resume {
        bail!(
            "{folder:?} is there already, with parts of an earlier run: add --resume to use them, or remove it"
        );
    }
    fs::create_dir_all(&folder).with_context(|| format!("cannot create the folder {folder:?}"))?;

    interrupt::end_in_order();
    let bar = progress::bar(common, parts, "parts");
    let crew = Crew {
        program: std::env::current_exe().context("cannot find the program itself")?,
        arguments: passed_on(arguments, workers.get())?,
        folder: &folder,
        parts,
        bar: &bar,
        next: Mutex::new(1),
        failed: AtomicBool::new(false),
        notes: &|text| note(common.quiet, text),
    };
    let outcomes: Vec<anyhow::Result<()>> = thread::scope(|scope| {
        let workers: Vec<_> = (0..workers.get())
            .map(|_| scope.spawn(|| crew.work()))
            .collect();
        let ended = workers.into_iter().map(|worker| worker.join());
        ended
            .map(|ended| ended.unwrap_or_else(|_| Err(anyhow!("a thread of --workers panicked"))))
            .collect()
    });
    bar.finish_and_clear();
    let outcome: anyhow::Result<()> = outcomes.into_iter().collect();
    outcome.with_context(|| {
        format!("the parts that are complete are in {folder:?}: --resume uses them")
    })?;

    let paths: Vec<PathBuf> = (1..=parts).map(|number| crew.path(number)).collect();
    let set = PartSet::read(&paths)?;
    merge(&set, output)?;
    fs::remove_dir_all(&folder).with_context(|| format!("cannot remove the folder {folder:?}"))?;

    let figures = figures(
        arguments,
        &set,
        workers.get(),
        start.elapsed().as_secs_f64(),
    );
    json::write(common, &figures)?;
    if !common.prints() {
        return Ok(());
    }
    let film = settings.film;
    print(&format!(
        "{}: {}x{}, {} samples per pixel, {}\ntime: {:.2} s for {parts} parts by {workers} workers\n",
        output.display(),
        film.width,
        film.height,
        settings.spp,
        crate::arguments::integrator_name(settings.integrator),
        start.elapsed().as_secs_f64(),
    ))
}

/// The folder of the parts of a picture.
fn folder_of(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".parts");
    name.into()
}

/// The arguments of a worker, without its part and its output.
fn passed_on(arguments: &RenderArguments, workers: usize) -> anyhow::Result<Vec<OsString>> {
    let common = &arguments.common;
    let mut words: Vec<OsString> = vec!["render".into(), "--quiet".into(), "--resume".into()];
    let mut option = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            words.push(format!("--{name}={value}").into());
        }
    };
    let size = arguments
        .size
        .map(|size| format!("{}x{}", size.width, size.height));
    option("size", size);
    option("spp", arguments.spp.map(|spp| spp.to_string()));
    option(
        "integrator",
        arguments.integrator.as_ref().and_then(name_of),
    );
    option("seed", Some(arguments.seed.to_string()));
    option(
        "max-memory",
        arguments.memory.max_memory.map(|bytes| format!("{bytes}B")),
    );
    option("layout", name_of(&arguments.memory.layout));
    option("max-isa", common.max_isa.map(|isa| isa.name().to_owned()));
    let all = match common.threads {
        Some(threads) => threads,
        None => thread::available_parallelism().context("cannot count the processors")?,
    };
    option("threads", Some((all.get() / workers).max(1).to_string()));
    if arguments.decisions.exact {
        words.push("--exact".into());
    }
    words.push("--".into());
    words.push(arguments.scene.clone().into());
    Ok(words)
}

fn name_of(value: &impl ValueEnum) -> Option<String> {
    Some(value.to_possible_value()?.get_name().to_owned())
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
            let Some(status) = self.start(part)? else {
                return Ok(());
            };
            if status.success() {
                return Ok(());
            }
            // The process has printed the reason, which would be the same again.
            if status.code() == Some(i32::from(COULD_NOT_RUN)) {
                bail!("part {part} cannot be rendered");
            }
            if tried == MOST_TRIES {
                bail!("the process of part {part} died {tried} times, the last time by {status}");
            }
            (self.notes)(&format!(
                "the process of part {part} died by {status}; the part is rendered again"
            ));
        }
        unreachable!("a part is tried {MOST_TRIES} times")
    }

    /// Runs the process of a part. `None` if it was ended because another part failed.
    fn start(&self, part: PartNumber) -> anyhow::Result<Option<ExitStatus>> {
        let mut command = Command::new(&self.program);
        let path = self.path(part.number());
        command.arg(&self.arguments[0]);
        command.arg(format!("--part={part}")).arg("-o").arg(path);
        command.args(&self.arguments[1..]);
        let child = command.spawn();
        let child = child.with_context(|| format!("cannot start {:?}", self.program))?;
        self.wait(child)
    }

    /// Waits for a process, and ends it if the command is interrupted or another part failed.
    fn wait(&self, mut child: Child) -> anyhow::Result<Option<ExitStatus>> {
        loop {
            if let Some(status) = child.try_wait().context("cannot wait for a process")? {
                return Ok(Some(status));
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
    let of = |part: &cyltrace_parts::PartFile| part.summary()["figures"].clone();
    let all: Vec<Value> = set.parts().iter().map(of).collect();
    let mut figures = all[0].clone();
    if let Value::Object(keys) = &mut figures {
        keys.remove("part");
    }
    let sum = |key: &str| all.iter().filter_map(|one| one[key].as_f64()).sum::<f64>();
    for key in ["load_s", "build_s", "render_s"] {
        figures[key] = json!(sum(key));
    }
    let mut total = 0;
    for kind in ["camera", "shadow", "ao"] {
        let counts = all.iter().filter_map(|one| one["rays"][kind].as_u64());
        let count: u64 = counts.sum();
        figures["rays"][kind] = json!(count);
        total += count;
    }
    figures["rays_per_s"] = json!(total as f64 / seconds);
    figures["output"] = json!(arguments.output);
    figures["workers"] = json!(workers);
    figures["parts"] = json!(set.parts().len());
    figures["run_s"] = json!(seconds);
    figures
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::*;
    use crate::arguments::{Arguments, Command};

    /// Options that a worker does not have, or that have its own values.
    const OWN: [&str; 7] = [
        "output", "json", "quiet", "part", "resume", "workers", "parts",
    ];

    fn render(words: &[OsString]) -> RenderArguments {
        let program = [OsString::from("cyltrace")];
        let words = program.iter().chain(words);
        match Arguments::try_parse_from(words).expect("valid").command {
            Command::Render(arguments) => arguments,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn every_option_of_render_reaches_the_workers() {
        let line = "render -o p.png --size 3x2 --spp 5 --integrator ao --seed 7 --max-memory 1GB \
                    --layout block --exact --threads 6 --max-isa avx2 --workers 2 -- -s.toml";
        let words: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
        let arguments = render(&words);
        let mut passed = passed_on(&arguments, 2).expect("processors");
        let command = Arguments::command();
        let command = command.find_subcommand("render").expect("a command");
        let options = command.get_arguments().filter_map(|arg| arg.get_long());
        for option in options.filter(|option| !OWN.contains(option)) {
            let begins = |word: &OsString| {
                let word = word.to_str().expect("UTF-8");
                word.strip_prefix("--")
                    .is_some_and(|word| word.starts_with(option))
            };
            assert!(passed.iter().any(begins), "--{option} is not passed on");
        }
        passed.splice(1..1, ["-o", "part"].map(OsString::from));
        let worker = render(&passed);
        let stated = |arguments: &RenderArguments| {
            let memory = format!("{:?}", arguments.memory);
            let integrator = format!("{:?}", arguments.integrator);
            let scene = arguments.scene.clone();
            let numbers = (arguments.size, arguments.spp, arguments.seed);
            let max_isa = arguments.common.max_isa;
            (
                scene,
                numbers,
                integrator,
                memory,
                arguments.decisions.exact,
                max_isa,
            )
        };
        assert_eq!(stated(&worker), stated(&arguments));
        assert_eq!(worker.common.threads.map(usize::from), Some(3));
    }
}
