//! `cyltrace trace`.
//!
//! Rays or points are read, traced and written in batches of a few blocks per thread, so
//! that a table of any length needs little memory and rows stay in order.

mod report;

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use cyltrace::math::Ray;
use cyltrace::scene::{NumberRow, SceneFile};
use cyltrace::tracer::{DEFAULT_BATCH, Options, PartialHit, Tracer};
use cyltrace_parts::{Header, PartWriter};
use glam::DVec3;
use rayon::prelude::*;
use serde_json::json;

use super::arguments::TraceArguments;
use super::interrupt::Interrupted;
use super::limit::{MemoryLimit, Need};
use super::number_rows::NumberRows;
use super::output_sink::{OutputSink, is_standard_stream};
use super::outputs::Files;
use super::parts::trace::Totals;
use super::parts::{self, Work};
use super::print;
use super::{hit_table, interrupt, json, progress, scene};
use report::Traced;

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
    let task = Task::<Ray> {
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
    };
    let Some(traced) = task.run(arguments)? else {
        return Ok(());
    };
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
    let task = Task::<DVec3> {
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
    };
    let Some(traced) = task.run(arguments)? else {
        return Ok(());
    };
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

/// Where results go.
enum Target {
    Whole(OutputSink),
    Part(Box<PartWriter>),
}

impl Target {
    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Self::Whole(sink) => sink,
            Self::Part(part) => part,
        }
    }

    /// Whether readers see the output before its end.
    fn shows_parts(&self) -> bool {
        matches!(self, Self::Whole(sink) if sink.shows_parts())
    }
}

impl<R: NumberRow + Sync> Task<'_, R> {
    /// Reads the table, traces its rows and writes the results. `None` if the part is already
    /// there.
    fn run(&self, arguments: &TraceArguments) -> anyhow::Result<Option<Traced>> {
        let common = &arguments.common;
        let files = Files::new(&arguments.scene, common.json.as_deref())
            .input(self.what, self.path)
            .output("-o", &arguments.output);
        files.check()?;
        OutputSink::check(&arguments.output)?;
        parts::check(&arguments.part, &arguments.output)?;
        json::check(common)?;
        let workers = scene::workers(common)?;
        let threads = workers.current_num_threads();

        let start = Instant::now();
        let limit = MemoryLimit::of(&arguments.memory);
        let file = scene::read(&arguments.scene, limit)?;
        files.check_with(&file)?;
        let header = self.header(arguments, &file)?;
        if let Some(header) = &header
            && parts::is_done(&arguments.part, common, &arguments.output, header)?
        {
            return Ok(None);
        }
        let read = start.elapsed();

        // Invalid rows are reported before anything is traced or written. A pipe can be
        // read only once; its rows are validated on the way.
        let start = Instant::now();
        let rereadable =
            !is_standard_stream(self.path) && self.path.metadata().is_ok_and(|file| file.is_file());
        let table = NumberRows {
            path: self.path,
            format: &arguments.format,
            range: header.as_ref().map(|header| header.range.clone()),
        };
        let rows = if rereadable {
            Some(workers.install(|| count_rows::<R>(&table))?)
        } else {
            None
        };
        let check = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let scene = Arc::new(scene::load(
            common,
            file.without_environment(),
            Need::Build,
            limit,
        )?);
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
        let mut target = match &header {
            Some(header) => Target::Part(Box::new(parts::create(&arguments.output, header)?)),
            None => Target::Whole(OutputSink::create(&arguments.output)?),
        };
        let bar = progress::bar(common, rows.unwrap_or(0), self.items);
        let start = Instant::now();
        // Written after the first block is read: an empty table would look like a result. A
        // part has no header.
        let mut first_line = Some(self.header).filter(|_| header.is_none());
        let mut totals = Totals::default();
        let traced = workers.install(|| {
            table.for_each_batch(|blocks| {
                let before = totals.rows;
                if let Some(line) = first_line.take() {
                    target.writer().write_all(line.as_bytes())?;
                }
                self.batch(&tracer, &blocks, &mut totals, target.writer())?;
                bar.inc(totals.rows - before);
                Ok(())
            })
        });
        let note = traced.map_err(|error| match error.downcast_ref::<Interrupted>() {
            Some(_) if target.shows_parts() => Interrupted::PartWritten.into(),
            _ => error,
        })?;
        if let Some(line) = first_line {
            target.writer().write_all(line.as_bytes())?;
        }
        let part = match target {
            Target::Whole(sink) => {
                sink.finish()?;
                None
            }
            Target::Part(part) => header.map(|header| (header, part)),
        };
        let trace = start.elapsed().as_secs_f64();
        bar.finish_and_clear();
        if let Some(note) = &note {
            print::note(common.quiet, note);
        }
        Ok(Some(Traced {
            tracer,
            items: self.items,
            totals,
            check,
            load,
            build,
            trace,
            threads,
            part,
            note,
        }))
    }

    /// The header of the part that is traced, if not all is.
    fn header(
        &self,
        arguments: &TraceArguments,
        scene: &SceneFile,
    ) -> anyhow::Result<Option<Header>> {
        let Some(number) = arguments.part.part else {
            return Ok(None);
        };
        let work = Work {
            command: "trace",
            unit: "bytes",
            whole: parts::trace::table_bytes(self.path)?,
            settings: parts::trace::settings(arguments),
            scene,
            long_table: Some(self.path),
        };
        work.header(number).map(Some)
    }

    /// Traces the rows of some blocks and writes the results.
    fn batch(
        &self,
        tracer: &Tracer,
        blocks: &[Vec<R>],
        totals: &mut Totals,
        target: &mut dyn Write,
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

/// Validates all rows of a table and counts them.
fn count_rows<R: NumberRow>(table: &NumberRows) -> anyhow::Result<u64> {
    let mut count = 0;
    table.for_each_batch(|blocks: Vec<Vec<R>>| {
        count += blocks.iter().map(|rows| rows.len() as u64).sum::<u64>();
        Ok(())
    })?;
    Ok(count)
}
