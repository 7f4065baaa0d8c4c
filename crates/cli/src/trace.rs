//! `cyltrace trace`.
//!
//! Rays or points are read, traced and written in batches of a few blocks per thread, so
//! that a table of any length needs little memory and rows stay in order.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use anyhow::anyhow;
use cyltrace::math::Ray;
use cyltrace::scene::{NumberRow, NumberTable, SceneError};
use cyltrace::tracer::{DEFAULT_BATCH, Options, PartialHit, Tracer};
use glam::DVec3;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::arguments::{FormatArguments, TraceArguments};
use super::interrupt::Interrupted;
use super::limit::{MemoryLimit, Need};
use super::output_sink::{OutputSink, is_standard_stream};
use super::outputs::Files;
use super::print::{self, print};
use super::{hit_table, interrupt, json, progress, scene, text};

/// Blocks per thread in each batch: enough to even out slow ones.
const BLOCKS_PER_THREAD: usize = 4;

/// Counts of rows and results.
#[derive(Clone, Copy, Default)]
struct Totals {
    /// Rays, or points.
    rows: u64,
    /// Rays with a hit, or points inside a solid.
    hit_rows: u64,
    /// Hits, or solids that contain a point; a row may have many.
    hits: u64,
}

/// A table and the query of its rows.
struct Task<'a, R> {
    path: &'a Path,
    /// The table's role in messages.
    what: &'static str,
    header: &'static str,
    /// The name of the rows in messages.
    items: &'static str,
    /// Writes the results of a row with its number, and returns how many they are.
    answer: Answer<'a, R>,
}

/// See [`Task::answer`].
type Answer<'a, R> = &'a (dyn Fn(&Tracer, &mut String, u64, &R) -> u64 + Sync);

/// The outcome of a command.
struct Traced {
    tracer: Tracer,
    items: &'static str,
    totals: Totals,
    check: f64,
    load: f64,
    build: f64,
    trace: f64,
    threads: usize,
    /// The columns that are not read, as a note.
    note: Option<String>,
}

/// Traces the rays, or locates the points.
pub fn run(arguments: &TraceArguments) -> anyhow::Result<()> {
    match (&arguments.table.rays, &arguments.table.points) {
        (Some(rays), _) => trace_rays(arguments, rays),
        (None, Some(points)) => locate_points(arguments, points),
        (None, None) => unreachable!("the arguments name a table"),
    }
}

/// Traces the rays of a table.
fn trace_rays(arguments: &TraceArguments, path: &Path) -> anyhow::Result<()> {
    let all = arguments.all;
    let traced = Task::<Ray> {
        path,
        what: "the table of rays",
        header: hit_table::HEADER,
        items: "rays",
        answer: &|tracer, rows, number, ray| {
            let mut hits = 0;
            let mut push = |hit: &PartialHit| {
                hit_table::push_row(rows, number, Some(hit), tracer.scene());
                hits += 1;
            };
            if all {
                tracer
                    .all_hits(ray, DEFAULT_BATCH)
                    .with(hit_table::FIELDS)
                    .for_each(|hit| push(&hit));
            } else if let Some(hit) = tracer.closest_with(ray, hit_table::FIELDS) {
                push(&hit);
            }
            if hits == 0 {
                hit_table::push_row(rows, number, None, tracer.scene());
            }
            hits
        },
    }
    .run(arguments)?;
    let Totals {
        rows,
        hit_rows,
        hits,
    } = traced.totals;
    let figures = json!({
        "rays_file": path,
        "rays": rows,
        "hit_rays": hit_rows,
        "hits": hits,
        "rays_per_s": traced.rate(),
    });
    let more = if all {
        format!(", {hits} hits")
    } else {
        String::new()
    };
    traced.report(
        arguments,
        figures,
        &format!("{hit_rows} of {rows} rays hit{more}"),
    )
}

/// Finds the solids that contain the points of a table.
fn locate_points(arguments: &TraceArguments, path: &Path) -> anyhow::Result<()> {
    let traced = Task::<DVec3> {
        path,
        what: "the table of points",
        header: hit_table::POINTS_HEADER,
        items: "points",
        answer: &|tracer, rows, number, point| {
            let found = tracer.contains(*point);
            for containing in &found {
                hit_table::push_point_row(rows, number, Some(containing), tracer.scene());
            }
            if found.is_empty() {
                hit_table::push_point_row(rows, number, None, tracer.scene());
            }
            found.len() as u64
        },
    }
    .run(arguments)?;
    let Totals {
        rows,
        hit_rows,
        hits,
    } = traced.totals;
    let figures = json!({
        "points_file": path,
        "points": rows,
        "inside_points": hit_rows,
        "containing_solids": hits,
        "points_per_s": traced.rate(),
    });
    traced.report(
        arguments,
        figures,
        &format!("{hit_rows} of {rows} points inside, of {hits} solids"),
    )
}

impl<R: NumberRow + Sync> Task<'_, R> {
    /// Reads the table, traces its rows and writes the results.
    fn run(&self, arguments: &TraceArguments) -> anyhow::Result<Traced> {
        let common = &arguments.common;
        let files = Files::new(&arguments.scene, common.json.as_deref())
            .input(self.what, self.path)
            .output("-o", &arguments.output);
        files.check()?;
        OutputSink::check(&arguments.output)?;
        json::check(common)?;
        let workers = scene::workers(common)?;
        let threads = workers.current_num_threads();

        let start = Instant::now();
        let limit = MemoryLimit::of(&arguments.memory);
        let file = scene::read(&arguments.scene, limit)?;
        files.check_with(&file)?;
        let read = start.elapsed();

        // Invalid rows are reported before anything is traced or written. A pipe can be
        // read only once; its rows are validated on the way.
        let start = Instant::now();
        let rereadable =
            !is_standard_stream(self.path) && self.path.metadata().is_ok_and(|file| file.is_file());
        let rows = if rereadable {
            Some(workers.install(|| self.count_rows(&arguments.format))?)
        } else {
            None
        };
        let check = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let scene = Arc::new(scene::load(common, file, Need::Build, limit)?);
        let load = (read + start.elapsed()).as_secs_f64();
        let start = Instant::now();
        let tracer = scene::build(
            common,
            &scene,
            Options {
                layout: arguments.memory.layout.into(),
                exact: arguments.decisions.exact,
                ..Options::default()
            },
        )?;
        let build = start.elapsed().as_secs_f64();

        interrupt::end_in_order();
        let mut target = OutputSink::create(&arguments.output)?;
        let bar = progress::bar(common, rows.unwrap_or(0), self.items);
        let start = Instant::now();
        // Written after the first block is read: an empty table would look like a result.
        let mut header = Some(self.header);
        let mut totals = Totals::default();
        let traced = workers.install(|| {
            for_each_batch(self.path, &arguments.format, |blocks| {
                let before = totals.rows;
                if let Some(header) = header.take() {
                    target.write_all(header.as_bytes())?;
                }
                self.batch(&tracer, &blocks, &mut totals, &mut target)?;
                bar.inc(totals.rows - before);
                Ok(())
            })
        });
        let note = traced.map_err(|error| match error.downcast_ref::<Interrupted>() {
            Some(_) if target.shows_parts() => Interrupted::PartWritten.into(),
            _ => error,
        })?;
        if let Some(header) = header {
            target.write_all(header.as_bytes())?;
        }
        target.finish()?;
        let trace = start.elapsed().as_secs_f64();
        bar.finish_and_clear();
        if let Some(note) = &note {
            print::note(common.quiet, note);
        }
        Ok(Traced {
            tracer,
            items: self.items,
            totals,
            check,
            load,
            build,
            trace,
            threads,
            note,
        })
    }

    /// Validates all rows of the table and counts them.
    fn count_rows(&self, format: &FormatArguments) -> anyhow::Result<u64> {
        let mut count = 0;
        for_each_batch(self.path, format, |blocks: Vec<Vec<R>>| {
            count += blocks.iter().map(|rows| rows.len() as u64).sum::<u64>();
            Ok(())
        })?;
        Ok(count)
    }

    /// Traces the rows of some blocks and writes the results.
    fn batch(
        &self,
        tracer: &Tracer,
        blocks: &[Vec<R>],
        totals: &mut Totals,
        target: &mut OutputSink,
    ) -> anyhow::Result<()> {
        let numbered: Vec<_> = blocks
            .iter()
            .map(|rows| {
                let first = totals.rows;
                totals.rows += rows.len() as u64;
                (first, rows)
            })
            .collect();
        let answered: Vec<(String, Totals)> = numbered
            .par_iter()
            .map(|(first, rows)| self.block(tracer, *first, rows))
            .collect();
        for (text, block) in answered {
            target.write_all(text.as_bytes())?;
            totals.hit_rows += block.hit_rows;
            totals.hits += block.hits;
        }
        Ok(())
    }

    /// The results of a block whose rows are numbered from `first`, and their counts.
    fn block(&self, tracer: &Tracer, first: u64, rows: &[R]) -> (String, Totals) {
        let mut text = String::new();
        let mut totals = Totals::default();
        for (number, row) in (first..).zip(rows) {
            let found = (self.answer)(tracer, &mut text, number, row);
            totals.hit_rows += u64::from(found > 0);
            totals.hits += found;
        }
        (text, totals)
    }
}

impl Traced {
    /// Rows per second.
    fn rate(&self) -> f64 {
        self.totals.rows as f64 / self.trace
    }

    /// Writes the JSON with the task's own keys, and prints a summary.
    fn report(&self, arguments: &TraceArguments, own: Value, summary: &str) -> anyhow::Result<()> {
        let common = &arguments.common;
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let skipped_rows = scene.skipped_rows;
        let notes: Vec<&String> = scene.notes.iter().chain(&self.note).collect();
        let solids = json::Solids::of(statistics);
        let mut figures = json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "check_s": self.check,
            "load_s": self.load,
            "build_s": self.build,
            "trace_s": self.trace,
            "solids": solids.by_kind(),
            "cylinders": solids.cylinders(),
            "other_solids": solids.others(),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": statistics.skipped,
            "skipped_rows": skipped_rows,
            "notes": notes,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": self.threads,
        });
        if let (Value::Object(all), Value::Object(own)) = (&mut figures, own) {
            all.extend(own);
        }
        json::write(common, &figures)?;
        if !common.prints() || is_standard_stream(&arguments.output) {
            return Ok(());
        }
        let mut text = format!("{}: {summary}\n", arguments.output.display());
        text += &text::skipped_rows(skipped_rows);
        text += &text::notes(notes);
        text += &format!(
            "time: check {:.2} s, load {:.2} s, build {:.2} s, trace {:.2} s on {} threads ({:.2} million {} per second, tables included)\n",
            self.check,
            self.load,
            self.build,
            self.trace,
            self.threads,
            self.rate() / 1e6,
            self.items
        );
        print(&text)
    }
}

/// Reads a table in the current rayon pool and calls `action` with the rows of some blocks
/// at a time, in order. Returns a note if there are columns that are not read.
pub fn for_each_batch<R: NumberRow>(
    path: &Path,
    format: &FormatArguments,
    mut action: impl FnMut(Vec<Vec<R>>) -> anyhow::Result<()>,
) -> anyhow::Result<Option<String>> {
    // The error's text is the whole message; its source would repeat a part.
    let message = |error: SceneError| anyhow!("{error}");
    let table = NumberTable::<R>::open(path, format.format(), &format.columns);
    let mut table = table.map_err(message)?;
    let columns = table.columns();
    loop {
        interrupt::check()?;
        let mut blocks = Vec::new();
        while blocks.len() < BLOCKS_PER_THREAD * rayon::current_num_threads() {
            let Some(block) = table.next_block().map_err(message)? else {
                break;
            };
            blocks.push(block);
        }
        if blocks.is_empty() {
            return Ok(columns.unread());
        }
        // Collected first, then searched for an error, so that the first invalid row is
        // reported.
        let parsed: Vec<_> = blocks.par_iter().map(|block| columns.rows(block)).collect();
        let parsed: Result<_, _> = parsed.into_iter().collect();
        action(parsed.map_err(message)?)?;
    }
}
