//! The comparison as figures, as tables and as a page.

use std::collections::HashSet;

use super::best::{BEST_HEADINGS, Best, ratio_table};
use super::outcome::{Figures, Row, Traversal};
use super::rays::Kind;
use super::representation::Representation;
use super::scenes::SceneName;
use crate::machine::Environment;
use cyltrace_output::{Figure, Mark, Page, Series, Symbol, csv};

/// The kinds of representations in a figure: legend, symbol, whether they are
/// the points of a curve, and which are of the kind.
type Group = (&'static str, Symbol, bool, fn(Representation) -> bool);

const GROUPS: [Group; 3] = [
    ("this library", Symbol::Circle, false, |one| one.is_ours()),
    ("Embree's own solids", Symbol::Diamond, false, |one| {
        one.name().starts_with("embree_")
    }),
    ("mesh", Symbol::Square, true, |one| {
        one.name().starts_with(MESH)
    }),
];

/// What begins the name of a mesh; its sides follow, or that it is of faces.
const MESH: &str = "mesh_";

/// A figure with the end of its file's name and its caption.
pub struct Shown {
    /// Such as `sticks_1e4-coherent`.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The figure.
    pub svg: String,
}

/// The figures: for each scene and kind of rays time against error, and for each
/// scene memory against the error of its incoherent rays.
#[must_use]
pub fn figures(found: &Traversal) -> Vec<Shown> {
    let mut shown = Vec::new();
    for &scene in &found.scenes {
        for rays in Kind::ALL {
            let (y_title, error): (_, fn(&Figures) -> Option<f64>) = match rays {
                Kind::Shadow => ("wrong answers, %", |one| Some(one.wrong_percent)),
                Kind::Coherent | Kind::Incoherent => {
                    ("position error in radii, 99th percentile", |one| {
                        one.p99_error_r
                    })
                }
            };
            let x_title = "nanoseconds a ray, one traversal, end to end";
            let point = |one: &Figures| Some((one.ns.median, error(one)?));
            let svg = figure(found, scene, rays, [x_title, y_title], point);
            shown.extend(svg.map(|svg| Shown {
                name: format!("{}-{}", scene.name(), rays.name()),
                caption: format!("{}, {} rays: time and error", scene.name(), rays.name()),
                svg,
            }));
        }
        let titles = [
            "bytes for each solid that is stored",
            "position error in radii, 99th percentile",
        ];
        let point = |one: &Figures| Some((one.bytes_per_cylinder, one.p99_error_r?));
        let svg = figure(found, scene, Kind::Incoherent, titles, point);
        shown.extend(svg.map(|svg| Shown {
            name: format!("{}-bytes", scene.name()),
            caption: format!("{}: memory and error", scene.name()),
            svg,
        }));
    }
    shown
}

/// One figure of the first set of workers' rows; none if nothing was measured.
fn figure(
    found: &Traversal,
    scene: SceneName,
    rays: Kind,
    [x_title, y_title]: [&str; 2],
    point: impl Fn(&Figures) -> Option<(f64, f64)>,
) -> Option<String> {
    let mark = |row: &Row| {
        let figures = row.found.as_ref().ok()?;
        let (x, y) = point(figures)?;
        let name = row.representation.name();
        Some(Mark {
            label: name.strip_prefix(MESH).unwrap_or(name).to_owned(),
            details: format!("{name}: {}", summary(row)[4..].join(", ")),
            x,
            y,
            second_y: None,
        })
    };
    let is_here = |row: &&Row| {
        row.scene == scene && row.rays == rays && found.threads.first() == Some(&row.threads)
    };
    let series = GROUPS.map(|(name, symbol, is_curve, is_of_group)| Series {
        name: name.to_owned(),
        symbol,
        is_curve,
        marks: found
            .rows
            .iter()
            .filter(is_here)
            .filter(|row| is_of_group(row.representation))
            .filter_map(mark)
            .collect(),
    });
    let has_marks = series.iter().any(|series| !series.marks.is_empty());
    has_marks.then(|| {
        Figure {
            x_title: x_title.to_owned(),
            y_title: y_title.to_owned(),
            second_title: String::new(),
            series: series.into(),
        }
        .svg()
    })
}

const CSV_HEADINGS: [&str; 20] = [
    "scene",
    "rays",
    "representation",
    "threads",
    "ns_per_ray",
    "spread",
    "mrays_per_s",
    "wrong_percent",
    "p99_error_r",
    "bytes_per_cylinder",
    "build_s",
    "callbacks_per_ray",
    "solves_per_ray",
    "ratio",
    "ratio_spread",
    "reason",
    "order",
    "processor",
    "embree",
    "isa",
];

/// The table as CSV, numbers in full; a cell is empty where there is none.
#[must_use]
pub fn table(found: &Traversal, here: &Environment) -> String {
    let rows = found.rows.iter().map(|row| cells(row, here));
    csv(&CSV_HEADINGS, &rows.collect::<Vec<_>>())
}

fn cells(row: &Row, here: &Environment) -> Vec<String> {
    let figures = row.found.as_ref().ok();
    let number = |of: fn(&Figures) -> Option<f64>| {
        let number = figures.and_then(of);
        number.map_or_else(String::new, |x| x.to_string())
    };
    vec![
        row.scene.name().to_owned(),
        row.rays.name().to_owned(),
        row.representation.name().to_owned(),
        row.threads.to_string(),
        number(|one| Some(one.ns.median)),
        number(|one| Some(one.ns.deviation)),
        number(|one| Some(one.mrays_per_s())),
        number(|one| Some(one.wrong_percent)),
        number(|one| one.p99_error_r),
        number(|one| Some(one.bytes_per_cylinder)),
        number(|one| Some(one.build_s)),
        number(|one| one.callbacks_per_ray),
        number(|one| one.solves_per_ray),
        number(|one| one.ratio.map(|(spread, _)| spread.median)),
        number(|one| one.ratio.map(|(spread, _)| spread.deviation)),
        row.found.as_ref().err().cloned().unwrap_or_default(),
        figures.map_or("", |one| one.order.name()).to_owned(),
        here.processor.clone(),
        here.embree.clone(),
        here.isa.to_owned(),
    ]
}

/// The columns of [`summary`].
pub const SUMMARY_HEADINGS: [&str; 11] = [
    "scene",
    "rays",
    "representation",
    "threads",
    "ns a ray",
    "Mrays/s",
    "times ours",
    "wrong %",
    "p99 error / r",
    "bytes",
    "build s",
];

/// The figures of a row as people read them; dashes where there are none.
#[must_use]
pub fn summary(row: &Row) -> Vec<String> {
    let dash = || String::from("–");
    let mut cells = vec![
        row.scene.name().to_owned(),
        row.rays.name().to_owned(),
        row.representation.name().to_owned(),
        row.threads.to_string(),
    ];
    match &row.found {
        Err(_) => cells.resize_with(SUMMARY_HEADINGS.len(), dash),
        Ok(found) => cells.extend([
            format!("{:.1} ± {:.1}", found.ns.median, found.ns.deviation),
            cyltrace_output::figure(found.mrays_per_s()),
            found.ratio.map_or_else(dash, |(spread, _)| {
                format!("{:.2} ± {:.2}", spread.median, spread.deviation)
            }),
            cyltrace_output::figure(found.wrong_percent),
            found.p99_error_r.map_or_else(dash, cyltrace_output::figure),
            format!("{:.0}", found.bytes_per_cylinder),
            cyltrace_output::figure(found.build_s),
        ]),
    }
    cells
}

/// The page: how many times faster, the figures, how to read them, the table
/// and what is missing. `environment` says where and how it was measured.
#[must_use]
pub fn page(found: &Traversal, environment: &str) -> String {
    let mut page = Page::new("Rays through whole scenes: time, error and memory");
    page.note(environment);
    page.heading("Beside Embree's own geometry");
    let best = found.best();
    page.table(
        &BEST_HEADINGS,
        &best.iter().map(Best::cells).collect::<Vec<_>>(),
    );
    page.heading("Times as fast");
    let (headings, rows) = ratio_table(found);
    page.table(&headings, &rows);
    for paragraph in READING {
        page.paragraph(paragraph);
    }
    for shown in figures(found) {
        page.heading(&shown.caption);
        page.figure(&shown.svg);
    }
    page.heading("All figures");
    let measured = found.rows.iter().filter(|row| row.found.is_ok());
    page.table(
        &SUMMARY_HEADINGS,
        &measured.map(summary).collect::<Vec<_>>(),
    );
    page.heading("What is missing");
    let missing = found.rows.iter().filter_map(|row| {
        let reason = row.found.as_ref().err()?;
        let (scene, name) = (row.scene.name(), row.representation.name());
        Some(format!("{name} of {scene}: {reason}"))
    });
    // Each stands at several kinds of rays and numbers of threads.
    let mut told = HashSet::new();
    for one in missing.filter(|one| told.insert(one.clone())) {
        page.note(&one);
    }
    page.finish()
}

/// How to read the page.
const READING: [&str; 3] = [
    "Above 1 this library is faster, each side in its fastest mode. Rivals are timed one by one in turns with this library on the same rays, in the order in which the rays were drawn and in the order in which this library's batches trace them (sorting not counted), and the better order counts; a ratio is the median over neighbouring measurements of some milliseconds, averaged by time over all rays; spreads are median absolute deviations, as if all pieces were off together. Rows with several threads share the rays out; figures are of the first number of threads.",
    "Coherent rays are the camera's, in tiles of 4 by 4 pixels; shadow rays go from their hits to the sun and stop at anything; incoherent ones start anywhere in the box, in any direction. All are f32 numbers, so that everybody has the same ray. An exact oracle says of a sample of them what is hit first, among candidates found by brute force.",
    "Wrong is a hit for a miss, a miss for a hit, or another solid than the first. The position error is along the ray, in radii of the solid that is hit (the greater one where it tapers, the least half width of a cuboid), over the rays with the right solid. Bytes are records and all that Embree holds, for each solid that is stored: those of a placed prototype count once, placements come on top.",
];

#[cfg(test)]
mod tests {
    use super::super::order::Order;
    use super::*;
    use crate::statistics::Spread;

    fn sample() -> Traversal {
        let spread = |median| Spread {
            median,
            deviation: 0.5,
        };
        let row = |representation: Representation, rays, ns: f64, error| Row {
            scene: SceneName::Lattice,
            rays,
            representation,
            threads: 1,
            found: if ns == 0.0 {
                Err(String::from("too large"))
            } else {
                Ok(Figures {
                    ns: spread(ns),
                    wrong_percent: 0.25,
                    p99_error_r: error,
                    bytes_per_cylinder: 160.0,
                    build_s: 0.5,
                    callbacks_per_ray: None,
                    solves_per_ray: None,
                    order: Order::Given,
                    ratio: Some((spread(ns / 100.0), Representation::AnalyticSingle)),
                })
            },
        };
        use Representation::{AnalyticSingle, EmbreeCone, Mesh16, Mesh32, Mesh64};
        Traversal {
            scenes: vec![SceneName::Lattice],
            threads: vec![1],
            rows: vec![
                row(AnalyticSingle, Kind::Coherent, 100.0, Some(1e-15)),
                row(EmbreeCone, Kind::Coherent, 150.0, Some(1e-4)),
                row(Mesh16, Kind::Coherent, 400.0, Some(0.02)),
                row(Mesh32, Kind::Coherent, 500.0, Some(0.005)),
                row(Mesh64, Kind::Coherent, 0.0, None),
                row(Mesh64, Kind::Shadow, 0.0, None),
                row(EmbreeCone, Kind::Shadow, 90.0, None),
            ],
        }
    }

    #[test]
    fn figures_are_of_what_was_measured() {
        let shown = figures(&sample());
        let names: Vec<&str> = shown.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["lattice-coherent", "lattice-shadow"]);
        let svg = &shown[0].svg;
        for label in [">analytic_single<", ">embree_cone<", ">16<", ">32<"] {
            assert_eq!(svg.matches(label).count(), 1, "{label} in\n{svg}");
        }
        assert_eq!(svg.matches("<polyline").count(), 1, "{svg}");
        assert!(!svg.contains(">64<"), "{svg}");
    }

    #[test]
    fn table_null_rows_say_why() {
        let mut here = Environment::here(None, 1, 2, 3);
        (here.processor, here.embree, here.isa) = ("Fast, Inc.".into(), "4.3.1".into(), "avx2");
        let text = table(&sample(), &here);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], CSV_HEADINGS.join(","));
        assert_eq!(
            lines[2],
            "lattice,coherent,embree_cone,1,150,0.5,6.666666666666667,0.25,0.0001,160,0.5,,,1.5,0.5,,given,\"Fast, Inc.\",4.3.1,avx2"
        );
        assert_eq!(
            lines[5],
            "lattice,coherent,mesh_64,1,,,,,,,,,,,,too large,,\"Fast, Inc.\",4.3.1,avx2"
        );
    }

    #[test]
    fn page_has_ratios_figures_and_reasons() {
        let text = page(&sample(), "here");
        // Once, although of two kinds of rays; and no column for what no scene has.
        assert_eq!(text.matches("mesh_64 of lattice").count(), 1);
        assert!(text.contains("vs_embree_cone") && !text.contains("vs_embree_disk"));
        for part in [
            "<td>1.50 ± 0.50</td>",
            "<svg",
            "mesh_64 of lattice: too large",
            "here",
        ] {
            assert!(text.contains(part), "no {part}");
        }
    }
}
