//! The outcome of `bench scale` as figures, as records and as a page.

use serde::Serialize;

use super::measure::{Figures, Row, Scale, Series};
use crate::traversal::Shown;
use cyltrace_output::{Figure, Mark, Page, Symbol, figure as short, readable};

/// A curve of a figure: its name, its series and what it shows of a scene.
type Curve = (&'static str, Series, fn(&Figures) -> f64);

/// Time to build, memory and rays a second against the number.
#[must_use]
pub fn figures(found: &Scale) -> Vec<Shown> {
    use Series::{Cylinders, Placements};
    let both = |of: fn(&Figures) -> f64| -> Vec<Curve> {
        vec![
            (Cylinders.name(), Cylinders, of),
            (Placements.name(), Placements, of),
        ]
    };
    let incoherent: fn(&Figures) -> f64 = |one| one.incoherent_rays_per_s;
    let mut rays = both(|one| one.rays_per_s);
    rays.push(("cylinders, incoherent rays", Cylinders, incoherent));
    rays.push(("placements, incoherent rays", Placements, incoherent));
    [
        ("build", "seconds to build", both(|one| one.build_s)),
        (
            "bytes",
            "bytes, records and Embree",
            both(|one| one.bytes as f64),
        ),
        ("rays", "rays a second", rays),
    ]
    .into_iter()
    .map(|(name, caption, curves)| Shown {
        name: name.to_owned(),
        caption: caption.to_owned(),
        svg: figure(found, caption, &curves),
    })
    .collect()
}

fn figure(found: &Scale, y_title: &str, curves: &[Curve]) -> String {
    let series = curves
        .iter()
        .map(|&(name, series, of)| cyltrace_output::Series {
            name: name.to_owned(),
            symbol: match series {
                Series::Cylinders => Symbol::Circle,
                Series::Placements => Symbol::Square,
            },
            is_curve: true,
            marks: found
                .of(series)
                .iter()
                .filter_map(|row| {
                    let figures = row.found.as_ref().ok()?;
                    Some(Mark {
                        label: String::new(),
                        details: format!("{name}: {}", summary(series, row)[1..].join(", ")),
                        x: row.n as f64,
                        y: of(figures),
                        second_y: None,
                    })
                })
                .collect(),
        });
    Figure {
        x_title: String::from("cylinders, or placements of a prototype of 1000 cylinders"),
        y_title: y_title.to_owned(),
        second_title: String::new(),
        series: series.collect(),
    }
    .svg()
}

/// A row of `scale.csv` and of the JSON.
#[derive(Serialize)]
pub struct Record<'a> {
    series: &'static str,
    n: usize,
    build_s: Option<f64>,
    bytes: Option<usize>,
    bytes_per: Option<f64>,
    resident_bytes: Option<u64>,
    rays_per_s: Option<f64>,
    incoherent_rays_per_s: Option<f64>,
    reason: Option<&'a str>,
}

/// The rows of a series with all digits of their figures.
#[must_use]
pub fn records(found: &Scale, series: Series) -> Vec<Record<'_>> {
    found
        .of(series)
        .iter()
        .map(|row| record(series, row))
        .collect()
}

fn record(series: Series, row: &Row) -> Record<'_> {
    let figures = row.found.as_ref().ok();
    Record {
        series: series.name(),
        n: row.n,
        build_s: figures.map(|one| one.build_s),
        bytes: figures.map(|one| one.bytes),
        bytes_per: figures.map(|one| one.bytes as f64 / row.n as f64),
        resident_bytes: figures.and_then(|one| one.resident_bytes),
        rays_per_s: figures.map(|one| one.rays_per_s),
        incoherent_rays_per_s: figures.map(|one| one.incoherent_rays_per_s),
        reason: row.found.as_ref().err().map(String::as_str),
    }
}

/// The columns of [`summary`].
pub const SUMMARY_HEADINGS: [&str; 8] = [
    "series",
    "n",
    "build s",
    "memory",
    "bytes each",
    "peak resident",
    "rays/s",
    "incoherent",
];

/// The figures of a scene, rounded for people; dashes if there are none.
#[must_use]
pub fn summary(series: Series, row: &Row) -> Vec<String> {
    let dash = || String::from("–");
    let mut cells = vec![series.name().to_owned(), row.n.to_string()];
    match &row.found {
        Err(_) => cells.resize_with(SUMMARY_HEADINGS.len(), dash),
        Ok(found) => cells.extend([
            short(found.build_s),
            readable(found.bytes as u64),
            format!("{:.0}", found.bytes as f64 / row.n as f64),
            found.resident_bytes.map_or_else(dash, readable),
            short(found.rays_per_s),
            short(found.incoherent_rays_per_s),
        ]),
    }
    cells
}

/// How a series grows, as a sentence.
fn growth(found: &Scale, series: Series) -> String {
    let fits = found.fits(series);
    let exponent = |fit: Option<f64>| fit.map_or_else(|| String::from("–"), |x| format!("{x:.2}"));
    format!(
        "{}: time to build grows as n^{}, memory as n^{}, camera rays a second as n^{}, incoherent ones as n^{}.",
        series.name(),
        exponent(fits.build_s),
        exponent(fits.bytes),
        exponent(fits.rays_per_s),
        exponent(fits.incoherent_rays_per_s),
    )
}

/// Both sentences about growth.
#[must_use]
pub fn growths(found: &Scale) -> [String; 2] {
    Series::ALL.map(|series| growth(found, series))
}

/// The page: figures, growth and the table. `environment` describes the machine and the
/// settings.
#[must_use]
pub fn page(found: &Scale, environment: &str) -> String {
    let mut page = Page::new("Larger and larger scenes: time, memory and rays");
    page.note(&format!("On {} threads. {environment}", found.threads));
    for sentence in growths(found) {
        page.paragraph(&sentence);
    }
    page.paragraph(READING);
    for shown in figures(found) {
        page.heading(&shown.caption);
        page.figure(&shown.svg);
    }
    page.heading("All figures");
    let mut rows = Vec::new();
    for series in Series::ALL {
        rows.extend(found.of(series).iter().map(|row| summary(series, row)));
    }
    page.table(&SUMMARY_HEADINGS, &rows);
    for series in Series::ALL {
        for row in found.of(series) {
            if let Err(reason) = &row.found {
                page.note(&format!("{} {}: {reason}", row.n, series.name()));
            }
        }
    }
    page.finish()
}

/// How to read the page.
const READING: &str = "Cylinders are random sticks in a cube, shorter and thinner the more there are, so that a ray hits the same number of them. Placements are of one prototype of 1000 sticks, turned at random, one to a cell of a cube. Exponents are slopes of the line of least squares through the logarithms, over all sizes. Rays are those of a camera that sees the whole scene, and random ones from within its box. Memory is the records' and Embree's; the peak is the whole program's, the description included, while the scene was made, built and traced.";

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Scale {
        let row = |n: usize, build_s: f64| Row {
            n,
            found: Ok(Figures {
                build_s,
                bytes: 150 * n,
                resident_bytes: None,
                rays_per_s: 1e6,
                incoherent_rays_per_s: 5e5,
            }),
        };
        let absent = Row {
            n: 1000,
            found: Err(String::from("too large")),
        };
        Scale {
            threads: 2,
            rows: [
                vec![row(1000, 0.001), row(10_000, 0.01)],
                vec![row(100, 0.1), absent],
            ],
        }
    }

    #[test]
    fn growth_is_stated_where_there_are_two_sizes() {
        let [cylinders, placements] = growths(&sample());
        assert!(cylinders.contains("build grows as n^1.00, memory as n^1.00"));
        assert!(placements.contains("n^–"), "{placements}");
    }

    #[test]
    fn table_and_page_have_every_size() {
        let found = sample();
        let rows = Series::ALL.map(|series| records(&found, series));
        let text = cyltrace_output::csv(&rows.into_iter().flatten().collect::<Vec<_>>());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[1],
            "cylinders,1000,0.001,150000,150.0,,1000000.0,500000.0,"
        );
        assert_eq!(lines[4], "placements,1000,,,,,,,too large");
        let page = page(&found, "here");
        assert_eq!(page.matches("<polyline").count(), 2 + 2 + 4);
        assert!(page.contains("1000 placements: too large"));
    }
}
