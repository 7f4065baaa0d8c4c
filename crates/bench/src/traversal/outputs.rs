//! The comparison of `bench traversal` as figures, as records and as a page.

use std::collections::HashSet;

use serde::Serialize;

use super::best::{BEST_HEADINGS, Best, ratio_table};
use super::outcome::{Figures, Row, Traversal};
use super::rays::Kind;
use super::scenes::SceneName;
use crate::groups::Group;
use crate::machine::Environment;
use cyltrace_output::{Figure, Mark, Page, Symbol, figure as short};

const GROUPS: [Group<Row>; 3] = [
    Group {
        name: "this library",
        symbol: Symbol::Circle,
        is_curve: false,
        contains: |row| row.representation.is_ours(),
    },
    Group {
        name: "Embree's own solids",
        symbol: Symbol::Diamond,
        is_curve: false,
        contains: |row| !row.representation.is_ours() && !row.representation.is_mesh(),
    },
    Group {
        name: "mesh",
        symbol: Symbol::Square,
        is_curve: true,
        contains: |row| row.representation.is_mesh(),
    },
];

/// The prefix of a mesh's name, before the number of its sides or `faces`.
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
            let x_title = "nanoseconds per ray, one traversal, end to end";
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
        let name = row.representation.to_string();
        Some(Mark {
            label: name.strip_prefix(MESH).unwrap_or(&name).to_owned(),
            details: format!("{name}: {}", summary(row)[4..].join(", ")),
            x,
            y,
            second_y: None,
        })
    };
    let is_here = |row: &&Row| {
        row.scene == scene && row.rays == rays && found.threads.first() == Some(&row.threads)
    };
    let rows = || found.rows.iter().filter(is_here);
    let series = GROUPS.map(|group| group.series(rows(), mark));
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

/// A row of `traversal.csv` and of the JSON's `rows`.
#[derive(Serialize)]
pub struct Record<'a> {
    scene: &'static str,
    rays: &'static str,
    representation: String,
    threads: usize,
    ns_per_ray: Option<f64>,
    spread: Option<f64>,
    mrays_per_s: Option<f64>,
    wrong_percent: Option<f64>,
    p99_error_r: Option<f64>,
    bytes_per_cylinder: Option<f64>,
    build_s: Option<f64>,
    callbacks_per_ray: Option<f64>,
    solves_per_ray: Option<f64>,
    ratio: Option<f64>,
    ratio_spread: Option<f64>,
    reason: Option<&'a str>,
    order: Option<&'static str>,
    processor: &'a str,
    embree: &'a str,
    isa: &'static str,
    ratio_to: Option<String>,
}

/// The rows with all digits of their figures, and the environment in each row.
#[must_use]
pub fn records<'a>(found: &'a Traversal, here: &'a Environment) -> Vec<Record<'a>> {
    found.rows.iter().map(|row| record(row, here)).collect()
}

fn record<'a>(row: &'a Row, here: &'a Environment) -> Record<'a> {
    let figures = row.found.as_ref().ok();
    let number = |of: fn(&Figures) -> f64| figures.map(of);
    let ratio = figures.and_then(|one| one.ratio);
    Record {
        scene: row.scene.name(),
        rays: row.rays.name(),
        representation: row.representation.to_string(),
        threads: row.threads,
        ns_per_ray: number(|one| one.ns.median),
        spread: number(|one| one.ns.deviation),
        mrays_per_s: number(Figures::mrays_per_s),
        wrong_percent: number(|one| one.wrong_percent),
        p99_error_r: figures.and_then(|one| one.p99_error_r),
        bytes_per_cylinder: number(|one| one.bytes_per_cylinder),
        build_s: number(|one| one.build_s),
        callbacks_per_ray: figures.and_then(|one| one.callbacks_per_ray),
        solves_per_ray: figures.and_then(|one| one.solves_per_ray),
        ratio: ratio.map(|(spread, _)| spread.median),
        ratio_spread: ratio.map(|(spread, _)| spread.deviation),
        reason: row.found.as_ref().err().map(String::as_str),
        order: figures.map(|one| one.order.name()),
        processor: &here.processor,
        embree: &here.embree,
        isa: here.isa,
        ratio_to: ratio.map(|(_, ours)| ours.to_string()),
    }
}

/// The columns of [`summary`].
pub const SUMMARY_HEADINGS: [&str; 11] = [
    "scene",
    "rays",
    "representation",
    "threads",
    "ns per ray",
    "Mrays/s",
    "times ours",
    "wrong %",
    "p99 error / r",
    "bytes",
    "build s",
];

/// The figures of a row, rounded for people; dashes if there are none.
#[must_use]
pub fn summary(row: &Row) -> Vec<String> {
    let dash = || String::from("–");
    let mut cells = vec![
        row.scene.name().to_owned(),
        row.rays.name().to_owned(),
        row.representation.to_string(),
        row.threads.to_string(),
    ];
    match &row.found {
        Err(_) => cells.resize_with(SUMMARY_HEADINGS.len(), dash),
        Ok(found) => cells.extend([
            format!("{:.1} ± {:.1}", found.ns.median, found.ns.deviation),
            short(found.mrays_per_s()),
            found.ratio.map_or_else(dash, |(spread, _)| {
                format!("{:.2} ± {:.2}", spread.median, spread.deviation)
            }),
            short(found.wrong_percent),
            found.p99_error_r.map_or_else(dash, short),
            format!("{:.0}", found.bytes_per_cylinder),
            short(found.build_s),
        ]),
    }
    cells
}

/// The page: the ratios, the figures, how to read them, the table and the missing rows.
/// `environment` describes the machine and the settings.
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
        let (scene, name) = (row.scene.name(), row.representation);
        Some(format!("{name} of {scene}: {reason}"))
    });
    // The same reason occurs for several kinds of rays and numbers of threads.
    let mut noted = HashSet::new();
    for one in missing.filter(|one| noted.insert(one.clone())) {
        page.note(&one);
    }
    page.finish()
}

/// How to read the page.
const READING: [&str; 3] = [
    "Above 1 this library is faster, each side in its fastest mode. Rivals are timed one by one in turns with this library on the same rays, in the order in which the rays were drawn and in the order in which this library's batches trace them (sorting not counted), and the better order counts; a ratio is the median over neighboring measurements of some milliseconds, averaged by time over all rays; spreads are median absolute deviations, as if all pieces were off together. Rows with several threads share the rays out; figures are of the first number of threads.",
    "Coherent rays are the camera's, in tiles of 4 by 4 pixels; shadow rays go from their hits to the sun and stop at anything; incoherent ones start anywhere in the box, in any direction. All are f32 numbers, so that everybody has the same ray. An exact oracle says of a sample of them what is hit first, among candidates found by brute force.",
    "Wrong is a hit for a miss, a miss for a hit, or another solid than the first. The position error is along the ray, in radii of the solid that is hit (the greater one where it tapers, the least half width of a cuboid), over the rays with the right solid. Bytes are the records and all memory of Embree, per solid that is stored: those of a placed prototype count once, placements come on top.",
];

#[cfg(test)]
mod tests {
    use super::super::order::Order;
    use super::super::representation::{Mode, Representation};
    use super::*;
    use crate::rivals::Shape;
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
                    ratio: Some((spread(ns / 100.0), Representation::Ours(Mode::Single))),
                })
            },
        };
        let single = Representation::Ours(Mode::Single);
        let embree = Representation::single;
        Traversal {
            scenes: vec![SceneName::Lattice],
            threads: vec![1],
            rows: vec![
                row(single, Kind::Coherent, 100.0, Some(1e-15)),
                row(embree(Shape::Cone), Kind::Coherent, 150.0, Some(1e-4)),
                row(embree(Shape::Mesh(16)), Kind::Coherent, 400.0, Some(0.02)),
                row(embree(Shape::Mesh(32)), Kind::Coherent, 500.0, Some(0.005)),
                row(embree(Shape::Mesh(64)), Kind::Coherent, 0.0, None),
                row(embree(Shape::Mesh(64)), Kind::Shadow, 0.0, None),
                row(embree(Shape::Cone), Kind::Shadow, 90.0, None),
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
        let found = sample();
        let text = cyltrace_output::csv(&records(&found, &here));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[0],
            "scene,rays,representation,threads,ns_per_ray,spread,mrays_per_s,wrong_percent,p99_error_r,bytes_per_cylinder,build_s,callbacks_per_ray,solves_per_ray,ratio,ratio_spread,reason,order,processor,embree,isa,ratio_to"
        );
        assert_eq!(
            lines[2],
            "lattice,coherent,embree_cone,1,150.0,0.5,6.666666666666667,0.25,0.0001,160.0,0.5,,,1.5,0.5,,given,\"Fast, Inc.\",4.3.1,avx2,analytic_single"
        );
        assert_eq!(
            lines[5],
            "lattice,coherent,mesh_64,1,,,,,,,,,,,,too large,,\"Fast, Inc.\",4.3.1,avx2,"
        );
    }

    #[test]
    fn page_has_ratios_figures_and_reasons() {
        let text = page(&sample(), "here");
        // Once, although of two kinds of rays; and no column for what no scene has.
        assert_eq!(text.matches("mesh_64 of lattice").count(), 1);
        assert!(text.contains("vs_embree_cone") && !text.contains("vs_embree_disc"));
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
