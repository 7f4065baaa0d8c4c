//! A comparison as a figure, as a table for programs and as a page.

use super::accuracy::{Accuracy, Row, Times};
use super::machine::Environment;
use crate::formulations::Precision;
use cyltrace_output::{Figure, Mark, Page, Series, Symbol, csv};

/// The kinds of contenders in the figure: legend, symbol, whether they are
/// the points of a curve, and which rows are of the kind.
type Kind = (&'static str, Symbol, bool, fn(&Row) -> bool);

const KINDS: [Kind; 5] = [
    ("formulation in f32", Symbol::Circle, false, |row| {
        row.times == Times::Solver && row.precision == Precision::F32
    }),
    ("formulation in f64", Symbol::Circle, false, |row| {
        row.times == Times::Solver && row.precision == Precision::F64
    }),
    (
        "Embree's cone curve, end to end",
        Symbol::Diamond,
        false,
        |row| is_native(row) && !is_mesh(row),
    ),
    (
        "Embree's mesh of N sides, end to end",
        Symbol::Square,
        true,
        |row| is_native(row) && is_mesh(row),
    ),
    (
        "this library's tracer, end to end",
        Symbol::Diamond,
        false,
        |row| row.times == Times::EndToEnd && row.precision == Precision::F64,
    ),
];

/// What begins the name of a mesh; its sides follow.
const MESH: &str = "mesh-";

fn is_native(row: &Row) -> bool {
    row.times == Times::EndToEnd && row.precision == Precision::F32
}

fn is_mesh(row: &Row) -> bool {
    row.name.starts_with(MESH)
}

/// The figure as SVG: time against error, with a second mark for the worst
/// family. A contender that never hits has no place in it.
#[must_use]
pub fn figure(accuracy: &Accuracy) -> String {
    let series = KINDS.map(|(name, symbol, is_curve, is_of_kind)| Series {
        name: name.to_owned(),
        symbol,
        is_curve,
        marks: accuracy
            .rows
            .iter()
            .filter(|row| is_of_kind(row))
            .filter_map(|row| mark(accuracy, row))
            .collect(),
    });
    Figure {
        x_title: String::from("nanoseconds a ray, nominal family"),
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
            cyltrace_output::figure(row.wrong_percent_mean()),
        ),
        x: row.ns.median,
        y,
        second_y: worst.map(|(_, error)| error),
    })
}

const CSV_HEADINGS: [&str; 12] = [
    "name",
    "precision",
    "times",
    "ns_median",
    "ns_spread",
    "ratio_median",
    "ratio_spread",
    "p99_error_r",
    "worst_family",
    "worst_p99_error_r",
    "wrong_percent_mean",
    "bytes",
];

/// The table as CSV, numbers in full; a cell is empty where there is none.
#[must_use]
pub fn table(accuracy: &Accuracy) -> String {
    let rows: Vec<Vec<String>> = accuracy
        .rows
        .iter()
        .map(|row| {
            let number = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
            let worst = row.worst();
            vec![
                row.name.to_owned(),
                row.precision.name().to_owned(),
                row.times.name().to_owned(),
                row.ns.median.to_string(),
                row.ns.deviation.to_string(),
                number(row.ratio.map(|ratio| ratio.median)),
                number(row.ratio.map(|ratio| ratio.deviation)),
                number(row.p99_error_r()),
                worst.map_or_else(String::new, |(family, _)| {
                    accuracy.families[family].to_owned()
                }),
                number(worst.map(|(_, error)| error)),
                row.wrong_percent_mean().to_string(),
                row.bytes.to_string(),
            ]
        })
        .collect();
    csv(&CSV_HEADINGS, &rows)
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
    let rows: Vec<Vec<String>> = accuracy
        .rows
        .iter()
        .map(|row| summary(accuracy, row))
        .collect();
    page.table(&SUMMARY_HEADINGS, &rows);
    page.note(
        "Spreads are median absolute deviations over the rounds. Ratios are to triple-product in f64, round by round; of an end-to-end time, the ratio says little.",
    );
    page.heading("Wrong hits and misses, % of all cases");
    families(&mut page, accuracy, |errors| {
        cyltrace_output::figure(errors.wrong_percent())
    });
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

/// The columns of [`summary`].
pub const SUMMARY_HEADINGS: [&str; 9] = [
    "contender",
    "times",
    "ns a ray",
    "± ns",
    "ratio",
    "p99 error / r",
    "worst family",
    "wrong %",
    "bytes",
];

/// The figures of a row as people read them.
#[must_use]
pub fn summary(accuracy: &Accuracy, row: &Row) -> Vec<String> {
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
        cyltrace_output::figure(row.wrong_percent_mean()),
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
    x.map_or_else(|| String::from("–"), cyltrace_output::figure)
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
        let text = table(&sample());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 8);
        assert_eq!(lines[0], CSV_HEADINGS.join(","));
        assert_eq!(
            lines[2],
            "careful,f64,solver,12.5,0.25,,,0,far,0.000000000000001,1.5,56"
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
