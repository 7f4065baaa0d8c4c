//! `cyltrace bench scale`.

use cyltrace::tracer::Options;
use cyltrace_bench::scale::{
    Fits, Plan, Resident, Row, SUMMARY_HEADINGS, Scale, Series, figures, growths, page, summary,
    table,
};
use cyltrace_bench::traversal::Workers;
use cyltrace_bench::{Environment, WallClock};
use cyltrace_output::Table;
use serde_json::{Value, json};

use super::{rays_sentence, tell, with_circumstances};
use crate::arguments::ScaleArguments;
use crate::memory::{forget_peak, peak_resident_bytes};
use crate::output_sink::{make_directory, write_text};
use crate::{interrupt, json, progress, scene};

/// Time to build, memory and rays a second against the size of scenes.
pub fn run(arguments: &ScaleArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    let threads = scene::workers(common)?.current_num_threads();
    let plan = Plan {
        most: arguments.most.get(),
        rays: arguments.rays.get(),
        rounds: arguments.rounds.get(),
        seed: arguments.seed,
        workers: Workers::new(threads)?,
        max_memory: arguments.max_memory,
        options: Options {
            threads: common.threads,
            max_isa: common.max_isa,
            build: cyltrace::tracer::BuildTime::AtOnce,
            ..Options::default()
        },
    };
    let bar = progress::bar(common, Scale::steps(&plan) as u64, "scenes");
    let resident = Resident {
        forget: &forget_peak,
        peak: &peak_resident_bytes,
    };
    let found = Scale::measure(&plan, &resident, &mut WallClock, &mut || bar.inc(1));
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
            write_text(&directory.join(format!("{}.svg", shown.name)), &shown.svg)?;
        }
        write_text(&directory.join("scale.csv"), &table(&found))?;
        write_text(&directory.join("index.html"), &page(&found, &sentence))?;
    }
    json::write(common, &all_figures(&found, &environment))?;
    let text = summary_text(&found, &sentence);
    tell(common, text, arguments.report.as_deref())
}

fn summary_text(found: &Scale, sentence: &str) -> String {
    let mut table = Table::new(&SUMMARY_HEADINGS, 1);
    let mut missing = String::new();
    for series in Series::ALL {
        for row in found.of(series) {
            table.push(summary(series, row));
            if let Err(reason) = &row.found {
                missing += &format!("{} {}: {reason}\n", row.n, series.name());
            }
        }
    }
    let [cylinders, placements] = growths(found);
    format!("{sentence}\n{table}{missing}{cylinders}\n{placements}\n")
}

/// All figures; null where there is none.
fn all_figures(found: &Scale, environment: &Environment) -> Value {
    let rows = |series| -> Vec<Value> { found.of(series).iter().map(row_figures).collect() };
    let fits = |series| {
        let Fits {
            build_s,
            bytes,
            rays_per_s,
            incoherent_rays_per_s,
        } = found.fits(series);
        json!({
            "build_s": build_s,
            "bytes": bytes,
            "rays_per_s": rays_per_s,
            "incoherent_rays_per_s": incoherent_rays_per_s,
        })
    };
    let figures = json!({
        "cylinders": rows(Series::Cylinders),
        "placements": rows(Series::Placements),
        "fits": {
            "cylinders": fits(Series::Cylinders),
            "placements": fits(Series::Placements),
        },
        "threads": found.threads,
    });
    with_circumstances(figures, environment, "rays")
}

fn row_figures(row: &Row) -> Value {
    let found = row.found.as_ref().ok();
    json!({
        "n": row.n,
        "build_s": found.map(|one| one.build_s),
        "bytes": found.map(|one| one.bytes),
        "bytes_per": found.map(|one| one.bytes as f64 / row.n as f64),
        "resident_bytes": found.and_then(|one| one.resident_bytes),
        "rays_per_s": found.map(|one| one.rays_per_s),
        "incoherent_rays_per_s": found.map(|one| one.incoherent_rays_per_s),
        "reason": row.found.as_ref().err(),
    })
}
