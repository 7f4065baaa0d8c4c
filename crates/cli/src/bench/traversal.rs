//! `cyltrace bench traversal`.

use cyltrace::tracer::Options;
use cyltrace_bench::traversal::{
    BEST_HEADINGS, BEST_NAMES, Best, Figures, Kind, Plan, RIVALS, Ratio, Representation, Row,
    SUMMARY_HEADINGS, SceneName, Traversal, Workers, figures, page, summary, table,
};
use cyltrace_bench::{Environment, ThreadClock, Timer, WallClock};
use cyltrace_output::Table;
use serde_json::{Map, Value, json};

use super::{rays_sentence, tell, with_circumstances};
use crate::arguments::TraversalArguments;
use crate::output_sink::{make_directory, write_text};
use crate::{CHECK_FAILED, GOOD, interrupt, json, progress, scene};

/// Time, error and memory of everything that traces solids. The check is that this
/// library has no wrong answer.
pub fn run(arguments: &TraversalArguments) -> anyhow::Result<u8> {
    let common = &arguments.common;
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    // What is not timed runs on all of these.
    let workers = scene::workers(common)?;
    let plan = plan(arguments, workers.current_num_threads())?;
    let bar = progress::bar(common, Traversal::steps(&plan) as u64, "steps");
    // One thread's processor time leaves out what other programs do meanwhile.
    let is_one_thread = plan.worker_sets.iter().all(|workers| workers.threads == 1);
    let timer: &mut (dyn Timer + Send) = match is_one_thread {
        true => &mut ThreadClock,
        false => &mut WallClock,
    };
    let found = workers.install(|| Traversal::measure(&plan, timer, &mut || bar.inc(1)));
    bar.finish_and_clear();

    let environment = Environment::here(
        common.max_isa,
        arguments.rays.get() as u64,
        arguments.seed,
        arguments.rounds.get(),
    );
    let sentence = rays_sentence(&environment);
    interrupt::end_in_order();
    if let Some(directory) = &arguments.report {
        for shown in figures(&found) {
            write_text(&directory.join(shown.name + ".svg"), &shown.svg)?;
        }
        write_text(
            &directory.join("traversal.csv"),
            &table(&found, &environment),
        )?;
        write_text(&directory.join("index.html"), &page(&found, &sentence))?;
    }
    let mut all = all_figures(&found, &environment);
    all["processor"] = json!(environment.processor);
    all["embree"] = json!(environment.embree);
    all["clock"] = json!(if is_one_thread { "thread" } else { "wall" });
    json::write(common, &all)?;
    let text = summary_text(&found, &sentence);
    tell(common, text, arguments.report.as_deref())?;
    let is_good = found.wrong().next().is_none();
    Ok(if is_good { GOOD } else { CHECK_FAILED })
}

/// One thread and all, or as many as `--threads` says.
fn plan(arguments: &TraversalArguments, all_threads: usize) -> anyhow::Result<Plan> {
    let common = &arguments.common;
    let threads = match common.threads {
        None if all_threads > 1 => vec![1, all_threads],
        _ => vec![all_threads],
    };
    let worker_sets: Result<Vec<Workers>, _> = threads.into_iter().map(Workers::new).collect();
    let scenes = match arguments.scene.as_slice() {
        [] => SceneName::ALL.to_vec(),
        some => some.to_vec(),
    };
    Ok(Plan {
        scenes,
        directory: arguments.scenes.clone(),
        rays: arguments.rays.get(),
        rounds: arguments.rounds.get(),
        seed: arguments.seed,
        rivals: match arguments.rival.as_slice() {
            [] => Representation::ALL.to_vec(),
            some => some.iter().flat_map(|chosen| chosen.0.clone()).collect(),
        },
        worker_sets: worker_sets?,
        max_memory: arguments.max_memory,
        options: Options {
            threads: common.threads,
            max_isa: common.max_isa,
            exact: arguments.decisions.exact,
            ..Options::default()
        },
    })
}

/// The tables for people: all that was measured, each side at its best, and this
/// library's wrong answers.
fn summary_text(found: &Traversal, sentence: &str) -> String {
    let mut table = Table::new(&SUMMARY_HEADINGS, 3);
    let measured = found.rows.iter().filter(|row| row.found.is_ok());
    for row in measured {
        table.push(summary(row));
    }
    let mut text = format!("{sentence}\n{table}");
    for &scene in &found.scenes {
        for rays in Kind::ALL {
            let ratios = RIVALS.iter().filter_map(|(key, rivals)| {
                let ratio = found.ratio(scene, rays, rivals).ok()?;
                Some(format!("{key} {:.2}", ratio.spread.median))
            });
            let ratios: Vec<String> = ratios.collect();
            let (scene, rays) = (scene.name(), rays.name());
            text += &format!("times as fast: {scene}, {rays}: {}\n", ratios.join(", "));
        }
    }
    let mut best = Table::new(&BEST_HEADINGS, BEST_NAMES);
    for one in found.best() {
        best.push(one.cells());
    }
    text += &format!("{sentence}\n{best}");
    text + &wrong_text(found)
}

/// Which rows of this library have wrong answers.
fn wrong_text(found: &Traversal) -> String {
    let ours = found.rows.iter().filter(|row| row.representation.is_ours());
    let measured = ours.filter(|row| row.found.is_ok()).count();
    let wrong = found.wrong().map(|row| {
        let (scene, rays) = (row.scene.name(), row.rays.name());
        let percent = row.found.as_ref().map_or(0.0, |one| one.wrong_percent);
        let name = row.representation.name();
        format!("wrong: {name}, {scene}, {rays}: {percent:.3} % of the rays judged\n")
    });
    let wrong: String = wrong.collect();
    match wrong.is_empty() {
        true => format!("0 wrong in all {measured} rows of this library\n"),
        false => wrong,
    }
}

/// All figures; null where there is none.
fn all_figures(found: &Traversal, environment: &Environment) -> Value {
    let numbers = |of: fn(Ratio) -> Value| by_scene(found, |ratio| ratio.map_or(Value::Null, of));
    let figures = json!({
        "rows": found.rows.iter().map(row_figures).collect::<Vec<_>>(),
        "ratios": numbers(|ratio| json!(ratio.spread.median)),
        "ratio_spreads": numbers(|ratio| json!(ratio.spread.deviation)),
        "ratio_of": numbers(|ratio| json!([ratio.rival.name(), ratio.ours.name()])),
        "reasons": by_scene(found, |ratio| {
            ratio.err().map_or(Value::Null, |reason| json!(reason))
        }),
        "best": found.best().iter().map(best_figures).collect::<Vec<_>>(),
        "ratio_threads": found.threads.first(),
        "spread": "median absolute deviation",
    });
    with_circumstances(figures, environment, "rays")
}

fn row_figures(row: &Row) -> Value {
    let figures = row.found.as_ref().ok();
    let number = |of: fn(&Figures) -> Option<f64>| figures.and_then(of);
    json!({
        "scene": row.scene.name(),
        "rays": row.rays.name(),
        "representation": row.representation.name(),
        "threads": row.threads,
        "ns_per_ray": number(|one| Some(one.ns.median)),
        "spread": number(|one| Some(one.ns.deviation)),
        "wrong_percent": number(|one| Some(one.wrong_percent)),
        "p99_error_r": number(|one| one.p99_error_r),
        "bytes_per_cylinder": number(|one| Some(one.bytes_per_cylinder)),
        "build_s": number(|one| Some(one.build_s)),
        "mrays_per_s": number(|one| Some(one.mrays_per_s())),
        "callbacks_per_ray": number(|one| one.callbacks_per_ray),
        "solves_per_ray": number(|one| one.solves_per_ray),
        "ratio": number(|one| one.ratio.map(|(spread, _)| spread.median)),
        "ratio_spread": number(|one| one.ratio.map(|(spread, _)| spread.deviation)),
        "ratio_to": figures.and_then(|one| one.ratio.map(|(_, ours)| ours.name())),
        "reason": row.found.as_ref().err(),
        "order": figures.map(|one| one.order.name()),
    })
}

fn best_figures(best: &Best) -> Value {
    let ratio = best.ratio.as_ref().ok();
    let number = |side: usize, of: fn(&Figures) -> f64| best.figures.map(|both| of(both[side]));
    json!({
        "scene": best.scene.name(),
        "rays": best.rays.name(),
        "ours": ratio.map(|ratio| ratio.ours.name()),
        "rival": ratio.map(|ratio| ratio.rival.name()),
        "order": ratio.map(|ratio| ratio.order.name()),
        "ratio": ratio.map(|ratio| ratio.spread.median),
        "ratio_spread": ratio.map(|ratio| ratio.spread.deviation),
        "ns_per_ray": number(0, |one| one.ns.median),
        "rival_ns_per_ray": number(1, |one| one.ns.median),
        "wrong_percent": number(0, |one| one.wrong_percent),
        "rival_wrong_percent": number(1, |one| one.wrong_percent),
        "bytes_per_cylinder": number(0, |one| one.bytes_per_cylinder),
        "rival_bytes_per_cylinder": number(1, |one| one.bytes_per_cylinder),
        "reason": best.ratio.as_ref().err(),
    })
}

/// `{scene: {rays: {rival: value}}}`.
fn by_scene(found: &Traversal, value: impl Fn(Result<Ratio, String>) -> Value) -> Value {
    let scenes = found.scenes.iter().map(|&scene| {
        let kinds = Kind::ALL.map(|rays| {
            let rivals = RIVALS
                .map(|(key, rivals)| (key.to_owned(), value(found.ratio(scene, rays, rivals))));
            (
                rays.name().to_owned(),
                Value::Object(Map::from_iter(rivals)),
            )
        });
        (
            scene.name().to_owned(),
            Value::Object(Map::from_iter(kinds)),
        )
    });
    Value::Object(scenes.collect())
}
