//! The outcome of `bench image` as figures, as records, as tables and as a page.

use cyltrace::scene::Sampler;
use cyltrace_bench::PowerLaw;
use cyltrace_output::{Figure, Mark, Page, Series, Symbol, figure as short};
use serde::Serialize;

use super::measure::{Group, Mode, Row};

/// What the table and the figures show.
const READING: &str = "Errors are relative: the root mean square of differences from a reference over the mean. The reference has another seed and at least 16 times the samples. A tile has 16 x 16 pixels; the 95th percentile and the greatest are over the errors of tiles. Kept are the tiles whose error is at most the one of --error, which promises that for 95 % of them. Slopes are of the lines of least squares through the logarithms of errors and samples per pixel, with their standard errors.";

/// A row of `image.csv` and of the JSON.
#[derive(Serialize)]
pub struct Record<'a> {
    scene: &'a str,
    integrator: &'static str,
    sampler: &'static str,
    mode: &'static str,
    error: Option<f64>,
    samples_per_pixel: f64,
    rays: u64,
    seconds: f64,
    seconds_spread: f64,
    rmse: f64,
    p95_of_tiles: f64,
    greatest_of_tiles: f64,
    tiles_kept: Option<u64>,
    tiles: Option<u64>,
    tiles_above: Option<u64>,
}

/// All rows with all digits.
pub fn records(groups: &[Group]) -> Vec<Record<'_>> {
    groups
        .iter()
        .flat_map(|group| group.rows.iter().map(|row| record(group, row)))
        .collect()
}

fn record<'a>(group: &'a Group, row: &Row) -> Record<'a> {
    Record {
        scene: &group.scene,
        integrator: group.integrator.name(),
        sampler: row.sampler.name(),
        mode: mode_name(row.mode),
        error: match row.mode {
            Mode::Uniform(_) => None,
            Mode::Error(error) => Some(error),
        },
        samples_per_pixel: row.spp,
        rays: row.rays,
        seconds: row.seconds.median,
        seconds_spread: row.seconds.deviation,
        rmse: row.rmse,
        p95_of_tiles: row.p95,
        greatest_of_tiles: row.greatest,
        tiles_kept: row.kept.map(|(kept, _)| kept),
        tiles: row.kept.map(|(_, all)| all),
        tiles_above: row.above,
    }
}

fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Uniform(_) => "uniform",
        Mode::Error(_) => "error",
    }
}

/// The columns of [`summaries`].
pub const SUMMARY_HEADINGS: [&str; 12] = [
    "scene",
    "integrator",
    "sampler",
    "until",
    "samples",
    "rays",
    "seconds",
    "± s",
    "rmse",
    "p95 of tiles",
    "greatest",
    "kept",
];

/// The rows with rounded figures, for people.
pub fn summaries(group: &Group) -> impl Iterator<Item = Vec<String>> {
    group.rows.iter().map(|row| {
        let until = match row.mode {
            Mode::Uniform(spp) => format!("{spp} samples"),
            Mode::Error(error) => format!("error {error}"),
        };
        let kept = |(kept, all)| format!("{kept} of {all}");
        vec![
            group.scene.clone(),
            group.integrator.name().to_owned(),
            row.sampler.name().to_owned(),
            until,
            short(row.spp),
            row.rays.to_string(),
            short(row.seconds.median),
            short(row.seconds.deviation),
            short(row.rmse),
            short(row.p95),
            short(row.greatest),
            row.kept.map_or_else(|| String::from("–"), kept),
        ]
    })
}

/// The columns of [`slopes`].
pub const SLOPE_HEADINGS: [&str; 6] = [
    "scene",
    "integrator",
    "sampler",
    "mode",
    "slope of rmse",
    "slope of p95",
];

/// The slopes of each series.
pub fn slopes(group: &Group) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for sampler in Sampler::ALL {
        for is_uniform in [true, false] {
            if group.series(sampler, is_uniform).next().is_none() {
                continue;
            }
            let text = |of| slope_text(group.slope(sampler, is_uniform, of));
            all.push(vec![
                group.scene.clone(),
                group.integrator.name().to_owned(),
                sampler.name().to_owned(),
                series_name(is_uniform).to_owned(),
                text(|row| row.rmse),
                text(|row| row.p95),
            ]);
        }
    }
    all
}

fn slope_text(law: Option<PowerLaw>) -> String {
    match law {
        None => String::from("–"),
        Some(PowerLaw {
            exponent,
            standard_error: None,
        }) => format!("{exponent:.3}"),
        Some(PowerLaw {
            exponent,
            standard_error: Some(error),
        }) => format!("{exponent:.3} ± {error:.3}"),
    }
}

fn series_name(is_uniform: bool) -> &'static str {
    match is_uniform {
        true => "uniform",
        false => "--error",
    }
}

/// A figure and its name.
pub struct Shown {
    pub name: String,
    pub caption: String,
    pub svg: String,
}

/// The error against time, and with second marks that of tiles.
pub fn figures(groups: &[Group]) -> Vec<Shown> {
    let figure = |group: &Group| {
        let (scene, integrator) = (&group.scene, group.integrator.name());
        Shown {
            name: format!("{scene}-{integrator}"),
            caption: format!("{scene}, {integrator}"),
            svg: figure(group),
        }
    };
    groups.iter().map(figure).collect()
}

fn figure(group: &Group) -> String {
    let series = Sampler::ALL.into_iter().flat_map(|sampler| {
        [true, false].map(|is_uniform| Series {
            name: format!("{}, {}", sampler.name(), series_name(is_uniform)),
            symbol: match is_uniform {
                true => Symbol::Circle,
                false => Symbol::Diamond,
            },
            is_curve: true,
            marks: group.series(sampler, is_uniform).map(mark).collect(),
        })
    });
    let series = series.filter(|series| !series.marks.is_empty());
    Figure {
        x_title: String::from("seconds"),
        y_title: String::from("relative root mean square error"),
        second_title: String::from("95th percentile of tiles"),
        series: series.collect(),
    }
    .svg()
}

fn mark(row: &Row) -> Mark {
    let label = match row.mode {
        Mode::Uniform(spp) => spp.to_string(),
        Mode::Error(error) => error.to_string(),
    };
    Mark {
        label,
        details: format!(
            "{} samples per pixel, {} rays, {} s",
            short(row.spp),
            row.rays,
            short(row.seconds.median)
        ),
        x: row.seconds.median,
        y: row.rmse,
        second_y: Some(row.p95),
    }
}

/// The page with all figures and tables.
pub fn page(groups: &[Group], sentence: &str) -> String {
    let mut page = Page::new("Error of pictures against time");
    page.paragraph(sentence);
    page.note(READING);
    for shown in figures(groups) {
        page.heading(&shown.caption);
        page.figure(&shown.svg);
    }
    page.heading("All pictures");
    let rows: Vec<_> = groups.iter().flat_map(summaries).collect();
    page.table(&SUMMARY_HEADINGS, &rows);
    page.heading("Slopes");
    let rows: Vec<_> = groups.iter().flat_map(slopes).collect();
    page.table(&SLOPE_HEADINGS, &rows);
    page.finish()
}
