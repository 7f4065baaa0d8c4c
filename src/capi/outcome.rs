//! The outcome of a check as C gets it: counts and two texts.

use std::ffi::{CString, c_char};
use std::fmt::Write;
use std::ptr;

use serde_json::{Value, json};

use super::status::c_text;
use super::types::CyltraceCheckOutcome;
use crate::check::{ClassRow, Outcome, Violation};

/// The outcome, with texts that [`free`] gives back.
pub(super) fn of(outcome: &Outcome) -> CyltraceCheckOutcome {
    let unwitnessed = outcome.rows.iter().filter(|row| row.is_unwitnessed());
    CyltraceCheckOutcome {
        rays: outcome.rays(),
        violations: outcome.violation_count(),
        unwitnessed_rows: unwitnessed.count() as u64,
        text: c_text(text(outcome)).into_raw(),
        json: c_text(json(outcome).to_string()).into_raw(),
    }
}

/// Frees the texts.
///
/// # Safety
/// They are null or of [`of`], and were not freed.
pub(super) unsafe fn free(outcome: &mut CyltraceCheckOutcome) {
    for text in [&mut outcome.text, &mut outcome.json] {
        let text: *mut c_char = std::mem::replace(text, ptr::null_mut());
        if !text.is_null() {
            // SAFETY: invariant 2: it came from `CString::into_raw`.
            drop(unsafe { CString::from_raw(text) });
        }
    }
}

/// A line a row, and a line a listed violation.
fn text(outcome: &Outcome) -> String {
    let mut text = String::new();
    for row in &outcome.rows {
        let sides = row
            .segments
            .map_or_else(String::new, |n| format!(" of {n} sides"));
        let fails = if row.is_unwitnessed() {
            ": too few witnessed"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "{} against {}{sides}: {} rays, {} hits, {} witnessed, {} violations{fails}",
            row.class,
            row.witness.name(),
            row.rays,
            row.hits,
            row.witnessed,
            row.violations
        );
    }
    for violation in &outcome.violations {
        let Violation {
            class,
            index,
            ray,
            allowed: (low, high),
            what,
            ..
        } = violation;
        let answer = violation.answer.as_ref().map_or_else(
            || "a miss".to_owned(),
            |answer| format!("t = {:?}", answer.t),
        );
        let _ = writeln!(
            text,
            "{class} ray {index}, from {:?} along {:?}: {what}; answered {answer}, allowed {low:?} to {high:?}",
            ray.origin.to_array(),
            ray.direction.to_array()
        );
    }
    text
}

/// What the text says and more, in the keys of `cyltrace check --json`.
fn json(outcome: &Outcome) -> Value {
    let percent = |part: u64, row: &ClassRow| 100.0 * part as f64 / row.rays.max(1) as f64;
    let classes = outcome.rows.iter().map(|row| {
        json!({
            "name": row.class.name(),
            "witness": row.witness.name(),
            "segments": row.segments,
            "rays": row.rays,
            "violations": row.violations,
            "band_percent": percent(row.band, row),
            "max_dt_over_chord": row.max_dt_over_chord,
            "hits": row.hits,
            "witnessed_percent": percent(row.witnessed, row),
            "unwitnessed_percent": percent(row.unwitnessed, row),
            "triangle_errors": row.triangle_errors,
            "wrong_normals": row.wrong_normals,
        })
    });
    let convergence = outcome.convergence.iter().map(|of| {
        json!({
            "segments": of.segments,
            "band_percent": of.band_percent,
            "p99_dt_r": of.p99_dt_r,
        })
    });
    let listed = outcome.violations.iter().map(|violation| {
        let ray = &violation.ray;
        json!({
            "class": violation.class.name(),
            "witness": violation.witness.name(),
            "segments": violation.segments,
            "index": violation.index,
            "origin": ray.origin.to_array(),
            "direction": ray.direction.to_array(),
            "t_min": ray.t_min,
            "t_max": ray.t_max,
            "t": violation.answer.as_ref().map(|answer| answer.t),
            "allowed": [violation.allowed.0, violation.allowed.1],
            "what": violation.what,
        })
    });
    json!({
        "holds": outcome.holds(),
        "rays": outcome.rays(),
        "violations": outcome.violation_count(),
        "classes": classes.collect::<Vec<_>>(),
        "convergence": convergence.collect::<Vec<_>>(),
        "listed": listed.collect::<Vec<_>>(),
    })
}
