//! What came of a check as tables and as a page.

use crate::external::agreement::Disagreement;
use crate::{Agreement, ClassRow, Deviation, Outcome, Pictures, Violation, Witness};
use cyltrace_output::{Figure, Mark, Page, Series, Symbol, figure};

/// The columns of [`table_rows`].
pub const TABLE_HEADINGS: [&str; 12] = [
    "rays",
    "witness",
    "sides",
    "count",
    "hits",
    "violations",
    "witnessed %",
    "band %",
    "unwitnessed %",
    "Embree's errors",
    "wrong normals",
    "dt / chord",
];

/// How many of the first columns are names.
pub const TABLE_NAMES: usize = 2;

/// The table of agreement as people read it: a row a class, witness and number
/// of sides.
#[must_use]
pub fn table_rows(outcome: &Outcome, agreements: &[Agreement]) -> Vec<Vec<String>> {
    let of_class = |row: &ClassRow| {
        let percent = |count| figure(percent(count, row.rays));
        // What a witness has no way to find is not called none.
        let is_known = |is_known: bool, text: String| if is_known { text } else { dash() };
        let is_prisms = row.witness == Witness::Prisms;
        vec![
            row.class.name().to_owned(),
            row.witness.name().to_owned(),
            row.segments.map_or_else(dash, |sides| sides.to_string()),
            row.rays.to_string(),
            row.hits.to_string(),
            row.violations.to_string(),
            percent(row.witnessed),
            percent(row.band),
            percent(row.unwitnessed),
            is_known(
                row.witness != Witness::Oracle,
                row.triangle_errors.to_string(),
            ),
            is_known(is_prisms, row.wrong_normals.to_string()),
            is_known(is_prisms, figure(row.max_dt_over_chord)),
        ]
    };
    let told = |row: &Agreement| {
        vec![
            row.class.to_owned(),
            row.witness.name().to_owned(),
            dash(),
            row.rays.to_string(),
            row.hits.to_string(),
            row.disagreements.to_string(),
            figure(percent(row.judged(), row.rays)),
            figure(percent(row.silhouette, row.rays)),
            figure(percent(row.coarse, row.rays)),
            dash(),
            dash(),
            dash(),
        ]
    };
    let classes = outcome.rows.iter().map(of_class);
    classes.chain(agreements.iter().map(told)).collect()
}

/// A part in percent; 0 of nothing.
#[must_use]
pub fn percent(part: u64, whole: u64) -> f64 {
    if whole == 0 {
        0.0
    } else {
        100.0 * part as f64 / whole as f64
    }
}

fn dash() -> String {
    String::from("–")
}

/// The tolerance of hits of another program or of a mesh, and how many were judged.
#[must_use]
pub fn tolerance_text(row: &Agreement) -> String {
    let of_each = match row.deviation() {
        Deviation::Everywhere(_) => String::new(),
        Deviation::Tessellated { segments, fit } => {
            let fit = fit.name();
            format!(" (derived for each solid: {segments} segments, {fit})")
        }
    };
    format!(
        "tolerance: at most {}{of_each}, the least radius is {}; {} of {} answers judged\n",
        figure(row.max_allowance.max(row.fixed_allowance)),
        figure(row.least_radius),
        row.judged(),
        row.rays
    )
}

/// A violation in two lines, the second with the word that replays it.
#[must_use]
pub fn violation_text(violation: &Violation) -> String {
    let Violation {
        class,
        witness,
        index,
        allowed: (low, high),
        ..
    } = violation;
    let sides = violation
        .segments
        .map_or_else(String::new, |sides| format!(", {sides} sides"));
    format!(
        "{class} ray {index} ({}{sides}): {}; answered {}, allowed {low:?} to {high:?}\n  --replay {}\n",
        witness.name(),
        violation.what,
        t_text(violation.answer.as_ref().map(|answer| answer.t)),
        violation.replay(),
    )
}

/// A disagreement in two lines, the second with the ray; `source` says where the
/// answer stands.
#[must_use]
pub fn disagreement_text(found: &Disagreement, source: &str) -> String {
    let exact = match (found.exact, found.oracle) {
        (Some(_), Some(t)) => format!("t {t:?}"),
        (Some(t), None) => format!("t {t:?}, where the oracle misses"),
        (None, _) => "a miss".to_owned(),
    };
    format!(
        "ray {}{source}: told {}, exactly {exact}; allowed a distance of {}\n  {}\n",
        found.index,
        t_text(found.told),
        figure(found.allowance),
        super::words::ray_text(&found.ray),
    )
}

fn t_text(t: Option<f64>) -> String {
    t.map_or_else(|| "a miss".to_owned(), |t| format!("t {t:?}"))
}

/// What a page is about.
pub struct PageContent<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// What was done, in a sentence.
    pub sentence: &'a str,
    /// What came of it.
    pub outcome: &'a Outcome,
    /// Comparisons with hits from elsewhere.
    pub agreements: &'a [Agreement],
    /// Where the answer for a ray from elsewhere stands, as an addition to its
    /// number.
    pub source: &'a dyn Fn(u64) -> String,
    /// Where they could be made; of the scene and its prisms, so they have no
    /// place beside hits from elsewhere.
    pub pictures: Option<&'a Pictures>,
}

/// The page: it needs nothing but itself.
#[must_use]
pub fn page(content: &PageContent) -> String {
    let PageContent {
        outcome,
        agreements,
        ..
    } = content;
    let subject = match agreements.first().map(|told| told.witness) {
        Some(Witness::UserHits) => "Hits of another program against exact ones",
        Some(_) => "Hits of a mesh against exact ones",
        None => "Analytic hits against meshes",
    };
    let mut page = Page::new(&format!("{subject}: {}", content.scene));
    page.note(content.sentence);
    page.paragraph(&verdict(outcome, agreements));
    page.heading("Agreement");
    agreement_table(&mut page, &table_rows(outcome, agreements));
    for told in *agreements {
        page.note(&tolerance_text(told));
    }
    page.note(if agreements.is_empty() {
        READING
    } else {
        READING_TOLD
    });
    if let Some(pictures) = content.pictures {
        show(&mut page, pictures);
    }
    if !outcome.convergence.is_empty() {
        page.heading("Convergence");
        page.figure(&convergence_figure(outcome));
        page.note(
            "The share of rays in the silhouette band, and the 99th percentile of the distance between prism and solid along a ray, in radii. For capped solids both fall as 1/N², the course of the diamonds; open ends keep a share in the band whatever N is.",
        );
    }
    page.heading("Worst rays");
    for violation in &outcome.violations {
        page.entry(&violation_text(violation));
    }
    for found in agreements.iter().flat_map(|told| &told.listed) {
        page.entry(&disagreement_text(found, &(content.source)(found.index)));
    }
    if outcome.violations.is_empty() && agreements.iter().all(|told| told.listed.is_empty()) {
        page.paragraph("No answer is wrong.");
    }
    for window in &outcome.windows {
        page.note(window);
    }
    page.finish()
}

/// The table without the columns of which no row has anything.
fn agreement_table(page: &mut Page, rows: &[Vec<String>]) {
    let is_shown = |column: &usize| rows.iter().any(|row| row[*column] != dash());
    let shown: Vec<usize> = (0..TABLE_HEADINGS.len()).filter(is_shown).collect();
    let headings: Vec<&str> = shown.iter().map(|&column| TABLE_HEADINGS[column]).collect();
    let cells = |row: &Vec<String>| shown.iter().map(|&column| row[column].clone()).collect();
    let rows: Vec<Vec<String>> = rows.iter().map(cells).collect();
    page.table(&headings, &rows);
}

/// How to read the table.
const READING: &str = "Witnessed: the meshes bound the answer on both sides. Band: the ray meets a circumscribed prism before any certain hit, so that a hit and a miss are both allowed. Unwitnessed: no bound at all. Embree's errors: Embree's triangle test contradicted the answer, and exact arithmetic on the same triangles cleared it. dt / chord: the greatest way from the answer to the inscribed prism in units of the chord error; far above 4 where a solid is so far or so tiny that f32 moves the prism's corners by more than that.";

/// How to read the table of hits from elsewhere.
const READING_TOLD: &str = "Violations: answers that no displacement by the allowed distance explains. Witnessed: answers that agree, or that are wrong. Band: the rest, near a silhouette or an edge or at a low angle, where answers may differ. Unwitnessed: answers about a solid that is thinner than the tolerance.";

/// The outcome in a sentence.
#[must_use]
pub fn verdict(outcome: &Outcome, agreements: &[Agreement]) -> String {
    let wrong = outcome.violation_count()
        + agreements
            .iter()
            .map(|agreement| agreement.disagreements)
            .sum::<u64>();
    let unwitnessed = outcome.rows.iter().filter(|row| row.is_unwitnessed());
    let shortfall = agreements.iter().find_map(Agreement::shortfall);
    match (wrong, unwitnessed.count()) {
        (0, 0) => shortfall.map_or_else(
            || String::from("holds: no answer is wrong"),
            |shortfall| format!("fails: {shortfall}"),
        ),
        (0, rows) => format!("fails: {rows} rows have no witness for more than half of their rays"),
        (1, _) => String::from("fails: 1 answer is wrong"),
        (wrong, _) => format!("fails: {wrong} answers are wrong"),
    }
}

fn show(page: &mut Page, pictures: &Pictures) {
    let [both, solid, mesh] = pictures.counts;
    page.heading(&format!(
        "Both representations, {} sides",
        pictures.segments
    ));
    page.pictures(&[
        (&pictures.analytic, "The solids, traced analytically"),
        (
            &pictures.mesh,
            "The inscribed prisms, traced as triangles",
        ),
        (
            &pictures.distance,
            "Difference in t in units of the chord error: full red is one unit behind the solid, full blue one before it; orange where the ray passes the prism and meets nothing",
        ),
        (
            &pictures.normal,
            "Angle between the normals: full colour is π/N or more",
        ),
    ]);
    page.note(&format!(
        "{} prisms; both are met in {both} pixels, the solid alone in {solid}, the mesh alone in {mesh}.",
        pictures.prisms
    ));
    if pictures.composed > 0 {
        page.note(&format!(
            "Unions, intersections and differences have no mesh of their own; they are met first in {} pixels.",
            pictures.composed
        ));
    }
}

fn convergence_figure(outcome: &Outcome) -> String {
    let rows = &outcome.convergence;
    let series = |name: &str, symbol, label: fn(u32) -> String, y: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        symbol,
        is_curve: true,
        marks: rows
            .iter()
            .enumerate()
            .map(|(index, row)| Mark {
                label: label(row.segments),
                details: format!("{} sides: {name} {}", row.segments, figure(y(index))),
                x: f64::from(row.segments),
                y: y(index),
                second_y: None,
            })
            .collect(),
    };
    let named = |sides: u32| sides.to_string();
    let unnamed = |_| String::new();
    let first = &rows[0];
    let course = |index: usize| {
        let ratio = f64::from(first.segments) / f64::from(rows[index].segments);
        first.p99_dt_r * ratio * ratio
    };
    Figure {
        x_title: String::from("sides of the prisms"),
        y_title: String::from("percent of rays, or radii"),
        second_title: String::new(),
        series: vec![
            series("silhouette band, %", Symbol::Circle, named, &|index| {
                rows[index].band_percent
            }),
            series("p99 of dt / r", Symbol::Square, unnamed, &|index| {
                rows[index].p99_dt_r
            }),
            series("1/N² through the first", Symbol::Diamond, unnamed, &course),
        ],
    }
    .svg()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Class, Convergence, Witness};
    use cyltrace::math::Ray;
    use glam::DVec3;

    fn sample() -> Outcome {
        let row = |segments, violations| ClassRow {
            class: Class::Sphere,
            witness: Witness::Prisms,
            segments: Some(segments),
            rays: 1000,
            hits: 400,
            witnessed: 900,
            band: 90,
            unwitnessed: 10,
            triangle_errors: 2,
            violations,
            wrong_normals: 0,
            max_dt_over_chord: 1.25,
        };
        let convergence = |segments: u32| Convergence {
            segments,
            band_percent: 100.0 / f64::from(segments * segments),
            p99_dt_r: 2.0 / f64::from(segments * segments),
        };
        Outcome {
            rows: vec![row(16, 0), row(64, 1)],
            convergence: vec![convergence(16), convergence(64)],
            violations: vec![Violation {
                class: Class::Sphere,
                witness: Witness::Prisms,
                segments: Some(64),
                index: 17,
                ray: Ray::new(DVec3::X, DVec3::NEG_X),
                answer: None,
                allowed: (0.5, 0.75),
                what: String::from("<missed>"),
            }],
            windows: vec![String::from("the whole scene")],
        }
    }

    #[test]
    fn page_has_table_figure_and_worst_rays_and_fetches_nothing() {
        let outcome = sample();
        let text = page(&PageContent {
            scene: "a & b",
            sentence: "1000 rays",
            outcome: &outcome,
            agreements: &[],
            source: &|_| String::new(),
            pictures: None,
        });
        for part in [
            "a &amp; b",
            "fails: 1 answer is wrong",
            "<td>1.25</td>",
            "1/N² through the first",
            "&lt;missed&gt;; answered a miss, allowed 0.5 to 0.75",
            "<code>--replay 3ff0000000000000:0000000000000000:0000000000000000:bff0000000000000",
            "the whole scene",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        for foreign in ["src=", "href=", "@import", "url(", "<script"] {
            assert!(!text.contains(foreign), "{foreign} in\n{text}");
        }
    }

    #[test]
    fn violation_is_told_with_all_that_replays_it() {
        let text = violation_text(&sample().violations[0]);
        assert!(text.starts_with("sphere ray 17 (prisms, 64 sides): <missed>; answered a miss, allowed 0.5 to 0.75\n  --replay 3ff"), "{text}");
    }

    #[test]
    fn rows_fill_the_headings() {
        for row in table_rows(&sample(), &[]) {
            assert_eq!(row.len(), TABLE_HEADINGS.len());
        }
        assert_eq!(percent(1, 0), 0.0);
    }
}
