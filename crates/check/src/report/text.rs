//! The outcome of a check as text.

use super::words::ray_text;
use crate::outcome::{Expected, Outcome, Row, Shortfall, Violation, Witness, percent};
use crate::replay::Replay;
use cyltrace_output::{Table, figure};

/// The columns of [`cells`].
pub(super) const HEADINGS: [&str; 12] = [
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

/// The number of leading columns that are names.
const NAMES: usize = 2;

/// A cell without a value.
pub(super) const DASH: &str = "–";

/// The row as cells of a table, with a dash for what its witness does not determine.
pub(super) fn cells(row: &Row) -> Vec<String> {
    let percent = |count| figure(percent(count, row.rays));
    let known = |is_known: bool, text: String| if is_known { text } else { DASH.to_owned() };
    let is_prisms = row.witness == Witness::Prisms;
    let sides = row.segments.map(|sides| sides.to_string());
    vec![
        row.class.to_owned(),
        row.witness.name().to_owned(),
        sides.unwrap_or_else(|| DASH.to_owned()),
        row.rays.to_string(),
        row.hits.to_string(),
        row.violations.to_string(),
        percent(row.witnessed),
        percent(row.band),
        percent(row.unwitnessed),
        known(is_prisms, row.triangle_errors.to_string()),
        known(is_prisms, row.wrong_normals.to_string()),
        known(is_prisms, figure(row.max_dt_over_chord)),
    ]
}

/// The outcome as lines: parts of the scene, the table, tolerances, convergence, wrong
/// answers. [`verdict`] is the last line that belongs below.
#[must_use]
pub fn summary(outcome: &Outcome) -> String {
    let mut text: String = outcome
        .windows
        .iter()
        .map(|window| window.clone() + "\n")
        .collect();
    let mut table = Table::new(&HEADINGS, NAMES);
    outcome.rows.iter().for_each(|row| table.push(cells(row)));
    text += &table.to_string();
    text.extend(outcome.rows.iter().filter_map(tolerance_text));
    for row in &outcome.convergence {
        text += &format!(
            "{} sides: {} % of rays in the silhouette band, 99 % of hits within {} r of the mesh\n",
            row.segments,
            figure(row.band_percent),
            figure(row.p99_dt_r)
        );
    }
    text.extend(outcome.violations.iter().map(violation_text));
    text
}

/// The tolerance of a row of external answers, and how many answers were judged.
pub(super) fn tolerance_text(row: &Row) -> Option<String> {
    let tolerance = row.tolerance.as_ref()?;
    let of_each = match tolerance.tessellated {
        None => String::new(),
        Some((segments, fit)) => {
            let fit = fit.name();
            format!(" (derived for each solid: {segments} segments, {fit})")
        }
    };
    Some(format!(
        "tolerance: at most {}{of_each}, the least radius is {}; {} of {} answers judged\n",
        figure(tolerance.greatest),
        figure(tolerance.least_radius),
        row.witnessed,
        row.rays
    ))
}

/// A wrong answer in two lines. The second is the word that replays it or, for an external
/// answer, the ray.
#[must_use]
pub fn violation_text(violation: &Violation) -> String {
    let Violation { class, index, .. } = violation;
    let answer = t_text(violation.t);
    match &violation.expected {
        Expected::Between { low, high, reason } => {
            let sides = violation.segments.map(|sides| format!(", {sides} sides"));
            format!(
                "{class} ray {index} ({}{}): {reason}; answered {answer}, allowed {low:?} to {high:?}\n  --replay {}\n",
                violation.witness.name(),
                sides.unwrap_or_default(),
                Replay::Given(violation.ray),
            )
        }
        Expected::Exact {
            t,
            oracle,
            allowance,
        } => {
            let source = violation.source.as_ref();
            let source = source.map(|(file, line)| format!(" ({file}:{line})"));
            let note = match (t, oracle) {
                (Some(_), None) => ", where the oracle misses",
                _ => "",
            };
            format!(
                "ray {index}{}: answered {answer}, {}{note}; allowed a distance of {}\n  {}\n",
                source.unwrap_or_default(),
                what_text(violation),
                figure(*allowance),
                ray_text(&violation.ray),
            )
        }
    }
}

/// What is wrong with an answer.
pub(super) fn what_text(violation: &Violation) -> String {
    match &violation.expected {
        Expected::Between { reason, .. } => reason.clone(),
        Expected::Exact { t, .. } => format!("exactly {}", t_text(*t)),
    }
}

fn t_text(t: Option<f64>) -> String {
    t.map_or_else(|| "a miss".to_owned(), |t| format!("t {t:?}"))
}

/// The verdict in a sentence.
#[must_use]
pub fn verdict(outcome: &Outcome) -> String {
    match outcome.violation_count() {
        0 => {}
        1 => return String::from("fails: 1 answer is wrong"),
        wrong => return format!("fails: {wrong} answers are wrong"),
    }
    let mut rows = outcome.rows.iter();
    let Some((row, shortfall)) = rows.find_map(|row| Some((row, row.shortfall()?))) else {
        return String::from("passes: no answer is wrong");
    };
    let Row {
        rays,
        witnessed,
        unwitnessed,
        ..
    } = row;
    let reason = match shortfall {
        Shortfall::NoRays => String::from("there is no ray to compare"),
        Shortfall::NoHits => String::from("no ray hits a solid, so the mesh was not checked"),
        Shortfall::Coarse => {
            let tolerance = row.tolerance.as_ref();
            let [greatest, radius] = tolerance
                .map_or([0.0; 2], |one| [one.greatest, one.least_radius])
                .map(figure);
            format!(
                "the tolerance reaches the radius of a solid, so no answer about it can be proven wrong: it is at most {greatest}, the least radius is {radius}, and {unwitnessed} of {rays} rays hit such a solid"
            )
        }
        Shortfall::Band => {
            format!("only {witnessed} of {rays} answers could be judged, which is less than half")
        }
        Shortfall::Unwitnessed => {
            let all = outcome.rows.iter();
            let rows = all.filter(|row| row.shortfall().is_some()).count();
            format!("{rows} rows have no witness for more than half of their rays")
        }
    };
    format!("fails: {reason}")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::outcome::Convergence;
    use cyltrace::math::Ray;
    use glam::DVec3;

    pub(in crate::report) fn sample() -> Outcome {
        let row = |segments, violations| Row {
            rays: 1000,
            hits: 400,
            witnessed: 900,
            band: 90,
            unwitnessed: 10,
            triangle_errors: 2,
            violations,
            max_dt_over_chord: 1.25,
            ..Row::new("sphere", Witness::Prisms, Some(segments))
        };
        let convergence = |segments: u32| Convergence {
            segments,
            band_percent: 100.0 / f64::from(segments * segments),
            p99_dt_r: 2.0 / f64::from(segments * segments),
        };
        Outcome {
            rows: vec![row(16, 0), row(64, 1)],
            convergence: vec![convergence(16), convergence(64)],
            violations: vec![Violation::new(
                &row(64, 1),
                17,
                Ray::new(DVec3::X, DVec3::NEG_X),
                None,
                Expected::Between {
                    low: 0.5,
                    high: 0.75,
                    reason: String::from("<missed>"),
                },
            )],
            windows: vec![String::from("the whole scene")],
        }
    }

    #[test]
    fn violation_has_all_that_replays_it() {
        let text = violation_text(&sample().violations[0]);
        assert!(text.starts_with("sphere ray 17 (prisms, 64 sides): <missed>; answered a miss, allowed 0.5 to 0.75\n  --replay 3ff"), "{text}");
    }

    #[test]
    fn rows_fill_the_headings_and_have_the_same_values_in_json() {
        for row in sample().rows {
            let cells = cells(&row);
            assert_eq!(cells.len(), HEADINGS.len());
            let figures = serde_json::to_value(&row).expect("JSON");
            assert_eq!(figures["name"], cells[0]);
            assert_eq!(figures["violations"].to_string(), cells[5]);
            assert_eq!(figures["witnessed_percent"], 90.0);
        }
        assert_eq!(percent(0, 0), 0.0);
    }
}
