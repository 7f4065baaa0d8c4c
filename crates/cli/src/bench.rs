//! `cyltrace bench`.

mod image;
mod scale;
mod traversal;

use std::path::Path;

use cyltrace::tracer::Options;
use cyltrace_bench::formulations;
use cyltrace_bench::{
    Accuracy, Contender, Environment, JudgedCases, Rounds, Row, SUMMARY_HEADINGS, USUAL_ROUNDS,
    USUAL_TIMED, WallClock, contenders, draw, figure, page, records, summaries,
};
use cyltrace_oracle::cases::Family;
use cyltrace_output::{Table, csv, write_text};
use serde_json::{Value, json};

use super::arguments::{AccuracyArguments, Bench, BenchArguments, Common};
use super::output_sink::make_directory;
use super::print::print;
use super::{GOOD, interrupt, json, progress, scene};

/// Runs a benchmark and returns its exit code.
pub fn run(arguments: &BenchArguments) -> anyhow::Result<u8> {
    match &arguments.bench {
        Bench::Accuracy(arguments) => accuracy(arguments).map(|()| GOOD),
        Bench::Traversal(arguments) => traversal::run(arguments),
        Bench::Scale(arguments) => scale::run(arguments).map(|()| GOOD),
        Bench::Image(arguments) => image::run(arguments).map(|()| GOOD),
    }
}

/// Measures time and error of everything that intersects rays with cylinders.
fn accuracy(arguments: &AccuracyArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    let workers = scene::workers(common)?;

    let rounds = Rounds {
        rounds: arguments.rounds.get(),
        ..USUAL_ROUNDS
    };
    let contenders = contenders_of(arguments)?;
    let steps = Accuracy::steps(Family::ALL.len(), contenders.len(), rounds);
    let bar = progress::bar(common, (Family::ALL.len() + steps) as u64, "steps");
    // The truth and the errors are computed on all threads; times are taken later, when
    // nothing else runs.
    let found = workers.install(|| {
        let cases: Vec<JudgedCases> = Family::ALL
            .into_iter()
            .map(|family| {
                bar.inc(1);
                JudgedCases::of(family, arguments.seed, arguments.cases.get())
            })
            .collect();
        let timed = draw(Family::Nominal, arguments.seed, USUAL_TIMED);
        Accuracy::measure(
            &cases,
            &timed,
            &contenders,
            rounds,
            &mut WallClock,
            &mut || {
                bar.inc(1);
            },
        )
    });
    bar.finish_and_clear();

    let environment = Environment::here(
        common.max_isa,
        arguments.cases.get(),
        arguments.seed,
        arguments.rounds.get(),
    );
    interrupt::end_in_order();
    if let Some(directory) = &arguments.report {
        write_text(&directory.join("accuracy.svg"), &figure(&found))?;
        write_text(&directory.join("accuracy.csv"), &csv(&records(&found)))?;
        write_text(&directory.join("index.html"), &page(&found, &environment))?;
    }
    json::write(common, &figures(&found, &environment))?;
    let text = summary_text(&found, &environment);
    print_summary(common, text, arguments.report.as_deref())
}

/// The contenders: all, or those that are named.
fn contenders_of(arguments: &AccuracyArguments) -> anyhow::Result<Vec<Contender>> {
    let wanted = &arguments.formulation;
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name);
    let options = Options {
        threads: arguments.common.threads,
        max_isa: arguments.common.max_isa,
        ..Options::default()
    };
    Ok(contenders(formulations::all(), &options, is_wanted)?)
}

/// The table for people.
fn summary_text(found: &Accuracy, environment: &Environment) -> String {
    let mut table = Table::new(&SUMMARY_HEADINGS, 2);
    for row in summaries(found) {
        table.push(row);
    }
    format!("{}\n{table}", environment.sentence())
}

/// All figures. A percentile is null if it is not finite, or if nothing is hit.
fn figures(found: &Accuracy, environment: &Environment) -> Value {
    let sample = |row: &Row| {
        json!({
            "name": row.name,
            "precision": row.precision.name(),
            "times": row.times.name(),
            "ratio_median": row.ratio.map(|ratio| ratio.median),
            "ratio_spread": row.ratio.map(|ratio| ratio.deviation),
            "cases": row.errors.first().map(|errors| errors.cases),
            "ns_by_round": row.ns_by_round,
        })
    };
    let figures = json!({
        "formulations": records(found),
        "samples": found.rows.iter().map(sample).collect::<Vec<_>>(),
        "spread": "median absolute deviation",
    });
    with_environment(figures, environment, "cases")
}

/// The figures, followed by the environment that they depend on; `count` is the key of
/// [`Environment::cases`].
fn with_environment(mut figures: Value, environment: &Environment, count: &str) -> Value {
    figures["machine"] = json!(environment.machine);
    figures["isa"] = json!(environment.isa);
    figures["target_features"] = json!(environment.target_features);
    figures["commit"] = json!(environment.commit);
    figures[count] = json!(environment.cases);
    figures["seed"] = json!(environment.seed);
    figures["rounds"] = json!(environment.rounds);
    figures
}

/// The environment of rays through whole scenes, as a sentence.
fn rays_sentence(environment: &Environment) -> String {
    format!(
        "{} rays of each kind, seed {}, {} rounds. {}",
        environment.cases,
        environment.seed,
        environment.rounds,
        environment.place()
    )
}

/// Prints the summary and the path of the report.
fn print_summary(common: &Common, mut text: String, report: Option<&Path>) -> anyhow::Result<()> {
    if !common.prints() {
        return Ok(());
    }
    if let Some(directory) = report {
        text += &format!("report: {}\n", directory.join("index.html").display());
    }
    print(&text)
}
