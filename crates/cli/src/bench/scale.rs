//! `cyltrace bench scale`.

use cyltrace::tracer::Options;
use cyltrace_bench::scale::{
    Plan, Resident, SUMMARY_HEADINGS, Scale, Series, figures, growths, page, records, summary,
};
use cyltrace_bench::traversal::Workers;
use cyltrace_bench::{Environment, WallClock};
use cyltrace_output::{Table, csv, write_text};
use serde_json::{Value, json};

use super::{print_summary, rays_sentence, with_environment};
use crate::arguments::ScaleArguments;
use crate::memory::{forget_peak, peak_resident_bytes};
use crate::output_sink::make_directory;
use crate::{interrupt, json, progress, scene};

/// Measures build time, memory and rays per second against the size of scenes.
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
        let rows = Series::ALL.map(|series| records(&found, series));
        let rows: Vec<_> = rows.into_iter().flatten().collect();
        write_text(&directory.join("scale.csv"), &csv(&rows))?;
        write_text(&directory.join("index.html"), &page(&found, &sentence))?;
    }
    json::write(common, &all_figures(&found, &environment))?;
    let text = summary_text(&found, &sentence);
    print_summary(common, text, arguments.report.as_deref())
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

/// All figures; null for missing ones.
fn all_figures(found: &Scale, environment: &Environment) -> Value {
    let fits = |series| {
        let fits = found.fits(series);
        json!({
            "build_s": fits.build_s,
            "bytes": fits.bytes,
            "rays_per_s": fits.rays_per_s,
            "incoherent_rays_per_s": fits.incoherent_rays_per_s,
        })
    };
    let figures = json!({
        "cylinders": records(found, Series::Cylinders),
        "placements": records(found, Series::Placements),
        "fits": {
            "cylinders": fits(Series::Cylinders),
            "placements": fits(Series::Placements),
        },
        "threads": found.threads,
    });
    with_environment(figures, environment, "rays")
}
