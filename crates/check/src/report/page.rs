//! The outcome of a check as a page.

use super::pictures::{Pictures, PicturesError, pictures};
use super::text::{DASH, HEADINGS, cells, tolerance_text, verdict, violation_text};
use crate::outcome::{Outcome, Witness};
use cyltrace::scene::Film;
use cyltrace::tracer::Tracer;
use cyltrace_output::{Figure, Mark, Page, Series, Symbol, figure};

/// The width of the pictures; they have the aspect ratio of the scene's.
const PICTURE_WIDTH: u32 = 320;

/// Sides of the meshes in the pictures: few enough to see the difference.
const PICTURE_SEGMENTS: u32 = 16;

/// A check, as its page describes it.
pub struct Checked<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// Which rays were checked, such as `1000 rays of each class, seed 0`.
    pub rays: &'a str,
    /// The outcome.
    pub outcome: &'a Outcome,
    /// The scene, and Embree's version.
    pub tracer: &'a Tracer,
    /// Bytes that the meshes in the pictures may take.
    pub max_memory: u64,
}

/// The page of a check, with pictures unless the hits are external: those show the meshes, which
/// a check of external hits does not have. It is a single file that fetches nothing, and does
/// not differ from run to run.
///
/// # Errors
/// If a picture cannot be encoded.
pub fn page(checked: &Checked) -> Result<String, PicturesError> {
    let Checked {
        scene,
        outcome,
        tracer,
        ..
    } = checked;
    let is_external = outcome.rows.iter().any(|row| row.tolerance.is_some());
    let pictures = if is_external {
        None
    } else {
        let film = picture_film(tracer.scene().film);
        pictures(tracer, PICTURE_SEGMENTS, film, checked.max_memory)?
    };
    let statistics = tracer.statistics();
    let sentence = format!(
        "{}; {}; Embree {} with {}.",
        checked.rays, statistics.instanced, statistics.embree_version, statistics.isa
    );
    Ok(written(scene, &sentence, outcome, pictures.as_ref()))
}

/// A small picture of the same aspect ratio, unless that is extreme.
fn picture_film(film: Film) -> Film {
    let height = u64::from(PICTURE_WIDTH) * u64::from(film.height) / u64::from(film.width);
    Film {
        width: PICTURE_WIDTH,
        height: height.clamp(1, 2 * u64::from(PICTURE_WIDTH)) as u32,
    }
}

fn written(scene: &str, sentence: &str, outcome: &Outcome, pictures: Option<&Pictures>) -> String {
    let external = outcome.rows.iter().find(|row| row.tolerance.is_some());
    let subject = match external.map(|row| row.witness) {
        Some(Witness::UserHits) => "Hits of another program against exact ones",
        Some(_) => "Hits of a mesh against exact ones",
        None => "Analytic hits against meshes",
    };
    let mut page = Page::new(&format!("{subject}: {scene}"));
    page.note(sentence);
    page.paragraph(&verdict(outcome));
    page.heading("Agreement");
    agreement_table(&mut page, outcome);
    for text in outcome.rows.iter().filter_map(tolerance_text) {
        page.note(&text);
    }
    page.note(external.map_or(READING, |_| READING_EXTERNAL));
    if let Some(pictures) = pictures {
        show(&mut page, pictures);
    }
    if !outcome.convergence.is_empty() {
        page.heading("Convergence");
        page.figure(&convergence_figure(outcome));
        page.note(
            "The share of rays in the silhouette band, and the 99th percentile of the distance between mesh and solid along a ray, in radii. For capped solids both fall as 1/N², the course of the diamonds; open ends keep a share in the band for any N.",
        );
    }
    page.heading("Worst rays");
    for violation in &outcome.violations {
        page.entry(&violation_text(violation));
    }
    if outcome.violations.is_empty() {
        page.paragraph("No answer is wrong.");
    }
    for window in &outcome.windows {
        page.note(window);
    }
    page.finish()
}

/// The table without empty columns.
fn agreement_table(page: &mut Page, outcome: &Outcome) {
    let rows: Vec<Vec<String>> = outcome.rows.iter().map(cells).collect();
    let is_shown = |column: &usize| rows.iter().any(|row| row[*column] != DASH);
    let shown: Vec<usize> = (0..HEADINGS.len()).filter(is_shown).collect();
    let headings: Vec<&str> = shown.iter().map(|&column| HEADINGS[column]).collect();
    let cells = |row: &Vec<String>| shown.iter().map(|&column| row[column].clone()).collect();
    page.table(&headings, &rows.iter().map(cells).collect::<Vec<_>>());
}

/// How to read the table.
const READING: &str = "Witnessed: the meshes bound the answer on both sides. Band: the ray enters a circumscribed mesh before any certain hit, so both a hit and a miss are allowed. Unwitnessed: no bound at all. Embree's errors: Embree's triangle test contradicted the answer, and exact arithmetic on the same triangles confirmed it. dt / chord: the greatest distance from the answer to the inscribed mesh in units of the chord error; far above 4 for a solid so far away or so tiny that f32 moves the corners of its mesh by more than that.";

/// How to read the table of external hits.
const READING_EXTERNAL: &str = "Violations: answers that no displacement by the allowed distance explains. Witnessed: answers that agree or are wrong. Band: the rest, near a silhouette or an edge or at a low angle, where answers may differ. Unwitnessed: answers about a solid that is thinner than the tolerance.";

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
            "The inscribed meshes, traced as triangles",
        ),
        (
            &pictures.distance,
            "Difference in t in units of the chord error: full red is one unit behind the solid, full blue one before it; orange where the ray misses the mesh",
        ),
        (
            &pictures.normal,
            "Angle between the normals: full color is π/N or more",
        ),
    ]);
    page.note(&format!(
        "{} solids as meshes; both are hit in {both} pixels, the solid alone in {solid}, the mesh alone in {mesh}.",
        pictures.solids
    ));
    if pictures.composed > 0 {
        page.note(&format!(
            "Unions, intersections and differences have no mesh of their own; they are hit first in {} pixels.",
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
        x_title: String::from("sides of the meshes"),
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
    use crate::report::text::tests::sample;

    #[test]
    fn page_has_table_figure_and_worst_rays_and_fetches_nothing() {
        let outcome = sample();
        let text = written("a & b", "1000 rays", &outcome, None);
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
}
