//! `cyltrace stress`.

mod composed;
mod map;
mod replay;
mod tables;

use std::time::Instant;

use cyltrace_bench::stress::{self, Cell, Contender, Promise, Settings, StressFamily};
use cyltrace_oracle::cases::Inputs;
use cyltrace_output::write_text;
use serde_json::{Value, json};

use super::arguments::StressArguments;
use super::output_sink::make_directory;
use super::print::print;
use super::{CHECK_FAILED, GOOD, interrupt, json, progress, scene};

/// Runs the command; the exit code is 1 if a promise is broken.
pub fn run(arguments: &StressArguments) -> anyhow::Result<u8> {
    let common = &arguments.common;
    if arguments.promises {
        print(&tables::promises())?;
        return Ok(GOOD);
    }
    let contenders = chosen(&arguments.formulation);
    if let Some(word) = &arguments.replay {
        replay::run(word, &contenders)?;
        return Ok(GOOD);
    }
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    let workers = scene::workers(common)?;
    if let Some(family) = arguments.map {
        workers.install(|| map::run(arguments, family, &contenders))?;
        return Ok(GOOD);
    }

    let settings = Settings {
        families: match arguments.family.as_slice() {
            [] => StressFamily::all(),
            some => some.to_vec(),
        },
        inputs: arguments
            .inputs
            .map_or(Inputs::ALL.to_vec(), |one| vec![one]),
        contenders,
        cases: arguments.cases,
        seed: arguments.seed,
    };
    let bar = progress::bar(common, settings.all_cases(), "cases");
    let stop = interrupt::end_in_order();
    let start = Instant::now();
    let cells = workers.install(|| stress::run(&settings, &|cases| bar.inc(cases), stop));
    let elapsed = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let cells = match cells {
        Some(cells) => cells,
        None => return Err(interrupt::Interrupted::NothingWritten.into()),
    };

    let broken: Vec<(&Cell, &Promise)> = cells
        .iter()
        .flat_map(|cell| Promise::about(cell).map(move |promise| (cell, promise)))
        .filter(|(cell, promise)| !promise.is_kept(cell))
        .collect();
    let text = tables::all(&settings, &cells, &broken, elapsed);
    let figures = json!({
        "cases": settings.cases,
        "seed": settings.seed,
        "threads": workers.current_num_threads(),
        "stress_s": elapsed,
        "promises_broken": broken.len(),
        "families": cells.iter().map(row).collect::<Vec<_>>(),
    });
    if let Some(directory) = &arguments.report {
        write_text(&directory.join("stress.txt"), &text)?;
        write_text(&directory.join("stress.json"), &format!("{figures:#}\n"))?;
    }
    json::write(common, &figures)?;
    if common.prints() {
        print(&text)?;
    }
    Ok(if broken.is_empty() {
        GOOD
    } else {
        CHECK_FAILED
    })
}

/// The contenders of these names in both precisions, or all.
fn chosen(names: &[String]) -> Vec<Contender> {
    let mut contenders = Contender::all();
    contenders.retain(|one| names.is_empty() || names.iter().any(|name| name == one.name()));
    contenders
}

/// A cell as a row of the JSON.
fn row(cell: &Cell) -> Value {
    let figures = &cell.figures;
    let promised: Vec<_> = Promise::about(cell).collect();
    let t = cell.t_ulps();
    json!({
        "name": cell.family.name(),
        "inputs": cell.inputs.name(),
        "formulation": cell.formulation,
        "precision": cell.precision.name(),
        "cases": figures.cases,
        "hits": figures.hits,
        "wrong_hit": figures.wrong_hit,
        "wrong_hit_outside_band": figures.wrong_hit_outside,
        "wrong_part": figures.wrong_part,
        "wrong_part_outside_band": figures.wrong_part_outside,
        "wrong_crossing": figures.wrong_crossing,
        "wrong_point": figures.wrong_point,
        "non_finite": figures.non_finite,
        "t_ulp_of": cell.ulp_of().name(),
        "median_t_ulp": t.at(0.5),
        "p99_t_ulp": t.at(0.99),
        "p999_t_ulp": t.at(0.999),
        "max_t_ulp": t.greatest(),
        "p999_t_f64_ulp": figures.t_f64_ulps.at(0.999),
        "max_t_f64_ulp": figures.t_f64_ulps.greatest(),
        "t_bound_used": figures.t_bound_used,
        "p99_position_r": figures.position.at(0.99),
        "p99_normal_rad": figures.normal.at(0.99),
        "spawned": figures.spawned,
        "self_hits": figures.self_hits,
        "promised": !promised.is_empty(),
        "kept": promised.iter().all(|promise| promise.is_kept(cell)),
        "worst": tables::worst_bits(cell),
    })
}
