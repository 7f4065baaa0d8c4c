//! `cyltrace bench`.

use std::collections::BTreeSet;

use anyhow::bail;
use cyltrace::bench::{
    Accuracy, Circumstances, Contender, JudgedCases, Rounds, Row, SUMMARY_HEADINGS, USUAL_ROUNDS,
    USUAL_TIMED, WallClock, contenders, draw, figure, page, rival_names, summary, table,
};
use cyltrace::cases::Family;
use cyltrace::report::Table;
use cyltrace::solid::formulations;
use cyltrace::tracer::Options;
use serde_json::{Value, json};

use super::arguments::{AccuracyArguments, Bench, BenchArguments};
use super::print::print;
use super::target::{make_directory, write_text};
use super::{interrupt, json, progress, scene};

/// Runs the benchmark that is asked for.
pub fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    match &arguments.bench {
        Bench::Accuracy(arguments) => accuracy(arguments),
    }
}

/// Time against error of everything that intersects rays with cylinders.
fn accuracy(arguments: &AccuracyArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    json::check(common)?;
    check_names(&arguments.formulation)?;
    interrupt::install()?;
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
    // The truth and the errors are found on all threads; times are taken
    // later, when nothing else runs.
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

    let circumstances = Circumstances::here(
        common.max_isa,
        arguments.cases.get(),
        arguments.seed,
        arguments.rounds.get(),
    );
    interrupt::end_in_order();
    if let Some(directory) = &arguments.report {
        write_text(&directory.join("accuracy.svg"), &figure(&found))?;
        write_text(&directory.join("accuracy.csv"), &table(&found))?;
        write_text(&directory.join("index.html"), &page(&found, &circumstances))?;
    }
    json::write(common, &figures(&found, &circumstances))?;
    if common.prints() {
        let mut text = summary_text(&found, &circumstances);
        if let Some(directory) = &arguments.report {
            text += &format!("report: {}\n", directory.join("index.html").display());
        }
        print(&text)?;
    }
    Ok(())
}

/// Those that take part: all, or the ones that are named.
fn contenders_of(arguments: &AccuracyArguments) -> anyhow::Result<Vec<Contender>> {
    let wanted = &arguments.formulation;
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name);
    let options = Options {
        threads: arguments.common.threads,
        max_isa: arguments.common.max_isa,
    };
    Ok(contenders(formulations::all(), &options, is_wanted)?)
}

fn check_names(names: &[String]) -> anyhow::Result<()> {
    let formulations = formulations::all();
    let known: BTreeSet<&str> = formulations
        .iter()
        .map(|formulation| formulation.name())
        .chain(rival_names())
        .collect();
    for name in names {
        if !known.contains(name.as_str()) {
            let known = Vec::from_iter(known).join(", ");
            bail!("--formulation {name:?} is unknown: it must be one of {known}");
        }
    }
    Ok(())
}

/// The table for people.
fn summary_text(found: &Accuracy, circumstances: &Circumstances) -> String {
    let mut table = Table::new(&SUMMARY_HEADINGS, 2);
    for row in &found.rows {
        table.push(summary(found, row));
    }
    format!("{}\n{table}", circumstances.sentence())
}

/// All figures. A percentile that is not finite, or that no hit gives, is
/// null.
fn figures(found: &Accuracy, circumstances: &Circumstances) -> Value {
    let formulation = |row: &Row| {
        let worst = row.worst();
        json!({
            "name": row.name,
            "precision": row.precision.name(),
            "ns_median": row.ns.median,
            "ns_spread": row.ns.deviation,
            "p99_error_r": row.p99_error_r(),
            "worst_family": worst.map(|(family, _)| found.families[family]),
            "worst_p99_error_r": worst.map(|(_, error)| error),
            "wrong_percent_mean": row.wrong_percent_mean(),
            "bytes": row.bytes,
        })
    };
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
    json!({
        "formulations": found.rows.iter().map(formulation).collect::<Vec<_>>(),
        "samples": found.rows.iter().map(sample).collect::<Vec<_>>(),
        "spread": "median absolute deviation",
        "machine": circumstances.machine,
        "isa": circumstances.isa,
        "target_features": circumstances.target_features,
        "commit": circumstances.commit,
        "cases": circumstances.cases,
        "seed": circumstances.seed,
        "rounds": circumstances.rounds,
    })
}
