//! The comparison of `bench accuracy` as a figure, as records and as a page.

use serde::Serialize;

use super::accuracy::{Accuracy, Row, Times};
use super::groups::Group;
use super::machine::Environment;
use crate::formulations::Precision;
use cyltrace_output::{Figure, Mark, Page, Symbol, figure as short};

const GROUPS: [Group<Row>; 5] = [
    Group {
        name: "formulation in f32",
        symbol: Symbol::Circle,
        is_curve: false,
        contains: |row| row.times == Times::Solver && row.precision == Precision::F32,
    },
    Group {
        name: "formulation in f64",
        symbol: Symbol::Circle,
        is_curve: false,
        contains: |row| row.times == Times::Solver && row.precision == Precision::F64,
    },
    Group {
        name: "Embree's cone curve, end to end",
        symbol: Symbol::Diamond,
        is_curve: false,
        contains: |row| is_native(row) && !is_mesh(row),
    },
    Group {
        name: "Embree's mesh of N sides, end to end",
        symbol: Symbol::Square,
        is_curve: true,
        contains: |row| is_native(row) && is_mesh(row),
    },
    Group {
        name: "this library's tracer, end to end",
        symbol: Symbol::Diamond,
        is_curve: false,
        contains: |row| row.times == Times::EndToEnd && row.precision == Precision::F64,
    },
];

/// The prefix of a mesh's name, before the number of its sides.
const MESH: &str = "mesh-";

fn is_native(row: &Row) -> bool {
    row.times == Times::EndToEnd && row.precision == Precision::F32
}

fn is_mesh(row: &Row) -> bool {
    row.name.starts_with(MESH)
}

/// The figure as SVG: time against error, with a second mark for the worst family. A
/// contender that never hits has no mark.
#[must_use]
pub fn figure(accuracy: &Accuracy) -> String {
    let mark = |row: &Row| mark(accuracy, row);
    let series = GROUPS.map(|group| group.series(accuracy.rows.iter(), mark));
    Figure {
        x_title: String::from("nanoseconds per ray, nominal family"),
        y_title: String::from("position error in radii, 99th percentile"),
        second_title: String::from("hollow: its worst family"),
        series: series.into(),
    }
    .svg()
}

fn mark(accuracy: &Accuracy, row: &Row) -> Option<Mark> {
    let y = row.p99_error_r()?;
    let worst = row.worst();
    let worst_family = worst.map_or("none", |(family, _)| accuracy.families[family]);
    Some(Mark {
        label: row.name.strip_prefix(MESH).unwrap_or(row.name).to_owned(),
        details: format!(
            "{} {}, {}: {} ns ± {}; 99 % within {} r, in {worst_family} {} r; {} % wrong hits",
            row.name,
            row.precision.name(),
            row.times.name(),
            three_digits(row.ns.median),
            three_digits(row.ns.deviation),
            error(Some(y)),
            error(worst.map(|(_, error)| error)),
            short(row.wrong_percent_mean()),
        ),
        x: row.ns.median,
        y,
        second_y: worst.map(|(_, error)| error),
    })
}

/// A row of `accuracy.csv` and of the JSON's `formulations`.
#[derive(Serialize)]
pub struct Record {
    name: &'static str,
    precision: &'static str,
    times: &'static str,
    ns_median: f64,
    ns_spread: f64,
    ratio_median: Option<f64>,
    ratio_spread: Option<f64>,
    p99_error_r: Option<f64>,
    worst_family: Option<&'static str>,
    worst_p99_error_r: Option<f64>,
    wrong_percent_mean: f64,
    bytes: usize,
}

/// The rows with all digits of their figures.
#[must_use]
pub fn records(accuracy: &Accuracy) -> Vec<Record> {
    let record = |row: &Row| {
        let worst = row.worst();
        Record {
            name: row.name,
            precision: row.precision.name(),
            times: row.times.name(),
            ns_median: row.ns.median,
            ns_spread: row.ns.deviation,
            ratio_median: row.ratio.map(|ratio| ratio.median),
            ratio_spread: row.ratio.map(|ratio| ratio.deviation),
            p99_error_r: row.p99_error_r(),
            worst_family: worst.map(|(family, _)| accuracy.families[family]),
            worst_p99_error_r: worst.map(|(_, error)| error),
            wrong_percent_mean: row.wrong_percent_mean(),
            bytes: row.bytes,
        }
    };
    accuracy.rows.iter().map(record).collect()
}

/// The page: the figure, how to read it, and the tables.
#[must_use]
pub fn page(accuracy: &Accuracy, environment: &Environment) -> String {
    let mut page = Page::new("Run time against error: rays and cylinders");
    page.note(&environment.sentence());
    page.figure(&figure(accuracy));
    for paragraph in READING {
        page.paragraph(paragraph);
    }
    page.heading("Time and error");
    page.table(&SUMMARY_HEADINGS, &summaries(accuracy));
    page.note(
        "Spreads are median absolute deviations over the rounds. Ratios are to triple-product in f64, round by round; of an end-to-end time, the ratio says little.",
    );
    page.heading("Wrong hits and misses, % of all cases");
    families(&mut page, accuracy, |errors| short(errors.wrong_percent()));
    page.heading("Position error in radii, 99th percentile");
    families(&mut page, accuracy, |errors| error(errors.p99_r));
    page.note(
        "Over the cases in which contender and oracle both hit; a dash where there are none.",
    );
    page.finish()
}

/// How to read the page.
const READING: [&str; 2] = [
    "Every contender answers the same cases; an exact oracle says what is right. The filled mark is the ordinary (nominal) family, the hollow one at the same time the family in which the contender does worst. A mark on the lower edge has no error that f64 can show.",
    "A formulation's time is that of the solver alone: a ray and its one cylinder, ready in memory, hit or miss, t and part. End-to-end times are of a scene of cylinders through Embree's tree, each with rays of the nominal family; compare them with one another only: the tracer also works out point, normal and error bound, Embree a normal.",
];

fn families(page: &mut Page, accuracy: &Accuracy, cell: impl Fn(&super::truth::Errors) -> String) {
    let headings: Vec<&str> = ["contender"]
        .iter()
        .chain(&accuracy.families)
        .copied()
        .collect();
    let rows: Vec<Vec<String>> = accuracy
        .rows
        .iter()
        .map(|row| {
            let mut cells = vec![full_name(row)];
            cells.extend(row.errors.iter().map(&cell));
            cells
        })
        .collect();
    page.table(&headings, &rows);
}

/// The columns of [`summaries`].
pub const SUMMARY_HEADINGS: [&str; 9] = [
    "contender",
    "times",
    "ns per ray",
    "± ns",
    "ratio",
    "p99 error / r",
    "worst family",
    "wrong %",
    "bytes",
];

/// The rows with rounded figures, for people.
#[must_use]
pub fn summaries(accuracy: &Accuracy) -> Vec<Vec<String>> {
    let rows = accuracy.rows.iter();
    rows.map(|row| summary(accuracy, row)).collect()
}

fn summary(accuracy: &Accuracy, row: &Row) -> Vec<String> {
    let ratio = row.ratio.map_or_else(
        || String::from("–"),
        |ratio| format!("{:.2} ± {:.2}", ratio.median, ratio.deviation),
    );
    let worst = row.worst().map_or_else(
        || String::from("–"),
        |(family, found)| format!("{} {}", accuracy.families[family], error(Some(found))),
    );
    vec![
        full_name(row),
        row.times.name().to_owned(),
        three_digits(row.ns.median),
        three_digits(row.ns.deviation),
        ratio,
        error(row.p99_error_r()),
        worst,
        short(row.wrong_percent_mean()),
        row.bytes.to_string(),
    ]
}

/// The name with the precision.
fn full_name(row: &Row) -> String {
    format!("{} {}", row.name, row.precision.name())
}

fn three_digits(x: f64) -> String {
    let decimals = if x < 10.0 { 2 } else { usize::from(x < 100.0) };
    format!("{x:.decimals$}")
}

fn error(x: Option<f64>) -> String {
    x.map_or_else(|| String::from("–"), short)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Spread;
    use crate::truth::Errors;

    fn row(name: &'static str, precision: Precision, times: Times, p99: [Option<f64>; 2]) -> Row {
        Row {
            name,
            precision,
            times,
            ns: Spread {
                median: 12.5,
                deviation: 0.25,
            },
            ratio: None,
            ns_by_round: vec![12.5],
            errors: p99
                .map(|p99_r| Errors {
                    cases: 200,
                    wrong: 3,
                    p99_r,
                })
                .into(),
            bytes: 56,
        }
    }

    fn sample() -> Accuracy {
        use Precision::{F32, F64};
        use Times::{EndToEnd, Solver};
        Accuracy {
            families: vec!["nominal", "far"],
            rows: vec![
                row("literal", F32, Solver, [Some(1e-2), Some(f64::INFINITY)]),
                row("careful", F64, Solver, [Some(0.0), Some(1e-15)]),
                row("cone-curve", F32, EndToEnd, [Some(1e-3), Some(5.0)]),
                row("mesh-6", F32, EndToEnd, [Some(0.1), Some(0.5)]),
                row("mesh-64", F32, EndToEnd, [Some(0.001), None]),
                row("tracer", F64, EndToEnd, [Some(1e-15), Some(1e-14)]),
                row("blind", F32, Solver, [None, None]),
            ],
        }
    }

    #[test]
    fn figure_has_each_contender_that_hits_once() {
        let svg = figure(&sample());
        for label in [
            ">literal<",
            ">careful<",
            ">cone-curve<",
            ">6<",
            ">64<",
            ">tracer<",
        ] {
            assert_eq!(svg.matches(label).count(), 1, "{label} in\n{svg}");
        }
        assert!(!svg.contains("blind"), "{svg}");
        assert_eq!(svg.matches("<polyline").count(), 1, "{svg}");
        assert!(svg.contains("in far inf r; 1.5 % wrong hits"), "{svg}");
    }

    #[test]
    fn table_empty_cells_where_there_is_no_number() {
        let text = cyltrace_output::csv(&records(&sample()));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 8);
        assert_eq!(
            lines[0],
            "name,precision,times,ns_median,ns_spread,ratio_median,ratio_spread,p99_error_r,worst_family,worst_p99_error_r,wrong_percent_mean,bytes"
        );
        assert_eq!(
            lines[2],
            "careful,f64,solver,12.5,0.25,,,0.0,far,1e-15,1.5,56"
        );
        assert_eq!(lines[7], "blind,f32,solver,12.5,0.25,,,,,,1.5,56");
    }

    #[test]
    fn page_shows_every_contender_in_every_table() {
        let text = page(&sample(), &Environment::here(None, 200, 7, 31));
        for row in &sample().rows {
            let cell = format!("<td>{}</td>", full_name(row));
            assert_eq!(text.matches(&cell).count(), 3, "{cell}");
        }
        assert!(
            text.contains("seed 7") && text.contains("31 rounds"),
            "{text}"
        );
    }

    #[test]
    fn numbers_are_short() {
        let written = [0.123_45, 1.234, 12.34, 1234.5].map(three_digits);
        assert_eq!(written, ["0.12", "1.23", "12.3", "1234"]);
    }
}
