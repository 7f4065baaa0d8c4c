//! `cyltrace bench traversal`.

use cyltrace::tracer::Options;
use cyltrace_bench::traversal::{
    BEST_HEADINGS, BEST_NAMES, Best, Figures, Kind, Plan, RIVALS, Ratio, Representation,
    SUMMARY_HEADINGS, SceneName, Traversal, Workers, figures, page, ratio_key, records, summary,
};
use cyltrace_bench::{Environment, ThreadClock, Timer, WallClock};
use cyltrace_output::{Table, csv, write_text};
use serde_json::{Map, Value, json};

use super::{print_summary, rays_sentence, with_environment};
use crate::arguments::TraversalArguments;
use crate::output_sink::make_directory;
use crate::{CHECK_FAILED, GOOD, interrupt, json, progress, scene};

/// Measures time, error and memory of everything that traces solids. The check fails if
/// this library has a wrong answer.
pub fn run(arguments: &TraversalArguments) -> anyhow::Result<u8> {
    let common = &arguments.common;
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    // Everything that is not timed runs on all of these.
    let workers = scene::workers(common)?;
    let plan = plan(arguments, workers.current_num_threads())?;
    let bar = progress::bar(common, Traversal::steps(&plan) as u64, "steps");
    // One thread's processor time excludes other programs.
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
            &csv(&records(&found, &environment)),
        )?;
        write_text(&directory.join("index.html"), &page(&found, &sentence))?;
    }
    let mut all = all_figures(&found, &environment);
    all["processor"] = json!(environment.processor);
    all["embree"] = json!(environment.embree);
    all["clock"] = json!(if is_one_thread { "thread" } else { "wall" });
    json::write(common, &all)?;
    let text = summary_text(&found, &sentence);
    print_summary(common, text, arguments.report.as_deref())?;
    let is_good = found.wrong().next().is_none();
    Ok(if is_good { GOOD } else { CHECK_FAILED })
}

/// The settings: one thread and all threads, or the number that `--threads` states.
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

/// The tables for people: all rows, each side at its best, and this library's wrong
/// answers.
fn summary_text(found: &Traversal, sentence: &str) -> String {
    let mut table = Table::new(&SUMMARY_HEADINGS, 3);
    let measured = found.rows.iter().filter(|row| row.found.is_ok());
    for row in measured {
        table.push(summary(row));
    }
    let mut text = format!("{sentence}\n{table}");
    for &scene in &found.scenes {
        for rays in Kind::ALL {
            let ratios = RIVALS.iter().filter_map(|&rival| {
                let ratio = found.ratio_to(scene, rays, rival).ok()?;
                Some(format!("{} {:.2}", ratio_key(rival), ratio.spread.median))
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

/// The rows of this library with wrong answers.
fn wrong_text(found: &Traversal) -> String {
    let ours = found.rows.iter().filter(|row| row.representation.is_ours());
    let measured = ours.filter(|row| row.found.is_ok()).count();
    let wrong = found.wrong().map(|row| {
        let (scene, rays) = (row.scene.name(), row.rays.name());
        let percent = row.found.as_ref().map_or(0.0, |one| one.wrong_percent);
        let name = row.representation;
        format!("wrong: {name}, {scene}, {rays}: {percent:.3} % of the rays judged\n")
    });
    let wrong: String = wrong.collect();
    match wrong.is_empty() {
        true => format!("0 wrong in all {measured} rows of this library\n"),
        false => wrong,
    }
}

/// All figures; null for missing ones.
fn all_figures(found: &Traversal, environment: &Environment) -> Value {
    let numbers = |of: fn(Ratio) -> Value| by_scene(found, |ratio| ratio.map_or(Value::Null, of));
    let figures = json!({
        "rows": records(found, environment),
        "ratios": numbers(|ratio| json!(ratio.spread.median)),
        "ratio_spreads": numbers(|ratio| json!(ratio.spread.deviation)),
        "ratio_of": numbers(|ratio| json!([ratio.rival.to_string(), ratio.ours.to_string()])),
        "reasons": by_scene(found, |ratio| {
            ratio.err().map_or(Value::Null, |reason| json!(reason))
        }),
        "best": found.best().iter().map(best_figures).collect::<Vec<_>>(),
        "ratio_threads": found.threads.first(),
        "spread": "median absolute deviation",
    });
    with_environment(figures, environment, "rays")
}

fn best_figures(best: &Best) -> Value {
    let ratio = best.ratio.as_ref().ok();
    let number = |side: usize, of: fn(&Figures) -> f64| best.figures.map(|both| of(both[side]));
    json!({
        "scene": best.scene.name(),
        "rays": best.rays.name(),
        "ours": ratio.map(|ratio| ratio.ours.to_string()),
        "rival": ratio.map(|ratio| ratio.rival.to_string()),
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
            let rivals = RIVALS.map(|rival| {
                let ratio = found.ratio_to(scene, rays, rival);
                (ratio_key(rival), value(ratio))
            });
            let rivals = Value::Object(Map::from_iter(rivals));
            (rays.name().to_owned(), rivals)
        });
        (
            scene.name().to_owned(),
            Value::Object(Map::from_iter(kinds)),
        )
    });
    Value::Object(scenes.collect())
}
