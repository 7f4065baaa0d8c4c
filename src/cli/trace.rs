//! `cyltrace trace`.
//!
//! Rays are read, traced and written in batches of a few blocks a thread, so
//! that a table of any length needs little memory and rows stay in order.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use cyltrace::math::Ray;
use cyltrace::tracer::{DEFAULT_BATCH, Hit, Options, Tracer};
use rayon::prelude::*;
use serde_json::json;

use super::arguments::TraceArguments;
use super::interrupt::Interrupted;
use super::limit::{Limit, Need};
use super::outputs::Files;
use super::ray_table::{Block, RayTable};
use super::target::{Target, is_standard_stream};
use super::{hit_table, interrupt, json, print, progress, ray_table, scene, text};

/// Blocks that a thread gets of each batch: enough to even out slow ones.
const BLOCKS_PER_THREAD: usize = 4;

/// What rays came to.
#[derive(Clone, Copy, Default)]
struct Totals {
    rays: u64,
    /// Rays that hit anything.
    hit_rays: u64,
    /// Hits; more than one a ray only if all are asked for.
    hits: u64,
}

/// Traces the rays of a table.
pub fn run(arguments: &TraceArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    let files = Files::new(&arguments.scene, common.json.as_deref())
        .input("the table of rays", &arguments.rays)
        .output("-o", &arguments.output);
    files.check()?;
    Target::check(&arguments.output)?;
    json::check(common)?;
    interrupt::install()?;
    let workers = scene::workers(common)?;
    let threads = workers.current_num_threads();

    let start = Instant::now();
    let file = scene::read(&arguments.scene)?;
    files.check_with(&file)?;
    let read = start.elapsed();

    // A bad row is to be found before anything is traced or written. A pipe
    // can be read once only; its rows are checked on the way.
    let start = Instant::now();
    let rereadable = !is_standard_stream(&arguments.rays)
        && arguments.rays.metadata().is_ok_and(|file| file.is_file());
    let rays = if rereadable {
        Some(workers.install(|| count_rays(&arguments.rays))?)
    } else {
        None
    };
    let check = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let scene = Arc::new(scene::load(
        common,
        file,
        Need::Build,
        Limit::of(&arguments.memory),
    )?);
    let load = (read + start.elapsed()).as_secs_f64();
    let start = Instant::now();
    let tracer = scene::build_with(
        common,
        &scene,
        Options {
            layout: arguments.memory.layout.into(),
            ..Options::default()
        },
    )?;
    let build = start.elapsed().as_secs_f64();

    interrupt::end_in_order();
    let mut target = Target::create(&arguments.output)?;
    let bar = progress::bar(common, rays.unwrap_or(0), "rays");
    let start = Instant::now();
    target.write_all(hit_table::HEADER.as_bytes())?;
    let mut totals = Totals::default();
    let traced = workers.install(|| {
        for_each_batch(&arguments.rays, |blocks| {
            let before = totals.rays;
            trace_batch(&tracer, arguments.all, &blocks, &mut totals, &mut target)?;
            bar.inc(totals.rays - before);
            Ok(())
        })
    });
    traced.map_err(|error| match error.downcast_ref::<Interrupted>() {
        Some(_) if target.shows_parts() => Interrupted::PartWritten.into(),
        _ => error,
    })?;
    target.finish()?;
    let trace = start.elapsed().as_secs_f64();
    bar.finish_and_clear();

    let statistics = &tracer.statistics();
    let skipped_rows = tracer.scene().skipped_rows;
    let Totals {
        rays,
        hit_rays,
        hits,
    } = totals;
    let rays_per_s = rays as f64 / trace;
    json::write(
        common,
        &json!({
            "scene": arguments.scene,
            "rays_file": arguments.rays,
            "output": arguments.output,
            "rays": rays,
            "hit_rays": hit_rays,
            "hits": hits,
            "check_s": check,
            "load_s": load,
            "build_s": build,
            "trace_s": trace,
            "rays_per_s": rays_per_s,
            "cylinders": json::cylinders(statistics),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": statistics.skipped,
            "skipped_rows": skipped_rows,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": threads,
        }),
    )?;
    if !common.prints() || is_standard_stream(&arguments.output) {
        return Ok(());
    }
    let more = if arguments.all {
        format!(", {hits} hits")
    } else {
        String::new()
    };
    let mut text = format!(
        "{}: {hit_rays} of {rays} rays hit{more}\n",
        arguments.output.display()
    );
    text += &text::skipped_rows(skipped_rows);
    text += &format!(
        "time: check {check:.2} s, load {load:.2} s, build {build:.2} s, trace {trace:.2} s on {threads} threads ({:.2} million rays a second, tables included)\n",
        rays_per_s / 1e6
    );
    print(&text)
}

/// The number of rays in a table, all of them good.
fn count_rays(path: &Path) -> anyhow::Result<u64> {
    let mut count = 0;
    for_each_batch(path, |blocks| {
        count += blocks.iter().map(|rays| rays.len() as u64).sum::<u64>();
        Ok(())
    })?;
    Ok(count)
}

/// Reads a table in the rayon pool that this is called in, and hands on the
/// rays of some blocks at a time, in order.
pub fn for_each_batch(
    path: &Path,
    mut action: impl FnMut(Vec<Vec<Ray>>) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let mut table = RayTable::open(path)?;
    let columns = table.columns();
    loop {
        interrupt::check()?;
        let mut blocks = Vec::new();
        while blocks.len() < BLOCKS_PER_THREAD * rayon::current_num_threads() {
            let Some(block) = table.next_block()? else {
                break;
            };
            blocks.push(block);
        }
        if blocks.is_empty() {
            return Ok(());
        }
        let name = ray_table::name(path);
        let parse = |block: &Block| RayTable::rays(&name, &columns, block);
        // Collected first, then searched for an error, so that the first bad
        // row is the one that is reported.
        let parsed: Vec<_> = blocks.par_iter().map(parse).collect();
        action(parsed.into_iter().collect::<anyhow::Result<_>>()?)?;
    }
}

/// Traces the rays of some blocks and writes their rows.
fn trace_batch(
    tracer: &Tracer,
    all: bool,
    blocks: &[Vec<Ray>],
    totals: &mut Totals,
    target: &mut Target,
) -> anyhow::Result<()> {
    let numbered: Vec<_> = blocks
        .iter()
        .map(|rays| {
            let first = totals.rays;
            totals.rays += rays.len() as u64;
            (first, rays)
        })
        .collect();
    let traced: Vec<(String, Totals)> = numbered
        .par_iter()
        .map(|(first, rays)| trace_block(tracer, all, *first, rays))
        .collect();
    for (rows, block) in traced {
        target.write_all(rows.as_bytes())?;
        totals.hit_rays += block.hit_rays;
        totals.hits += block.hits;
    }
    Ok(())
}

/// The rows of a block whose rays count from `first`, and what they come to.
fn trace_block(tracer: &Tracer, all: bool, first: u64, rays: &[Ray]) -> (String, Totals) {
    let mut rows = String::new();
    let mut totals = Totals::default();
    for (number, ray) in (first..).zip(rays) {
        let mut push = |hit: Option<&Hit>| {
            hit_table::push_row(&mut rows, number, hit, tracer.scene());
        };
        let mut hits = 0;
        if all {
            for hit in tracer.all_hits(ray, DEFAULT_BATCH) {
                push(Some(&hit));
                hits += 1;
            }
        } else if let Some(hit) = tracer.closest(ray) {
            push(Some(&hit));
            hits += 1;
        }
        if hits == 0 {
            push(None);
        }
        totals.rays += 1;
        totals.hit_rays += u64::from(hits > 0);
        totals.hits += hits;
    }
    (rows, totals)
}
