//! The outcome of a check as C gets it: counts and two texts.

use std::ffi::{CString, c_char};
use std::fmt::Write;
use std::ptr;

use serde_json::{Value, json};

use super::status::c_text;
use super::types::CyltraceCheckOutcome;
use cyltrace_check::{Outcome, Violation};

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
    let classes = outcome.rows.iter().map(cyltrace_check::class_figures);
    let convergence = outcome
        .convergence
        .iter()
        .map(cyltrace_check::convergence_figures);
    let listed = outcome
        .violations
        .iter()
        .map(cyltrace_check::violation_figures);
    json!({
        "holds": outcome.holds(),
        "rays": outcome.rays(),
        "violations": outcome.violation_count(),
        "classes": classes.collect::<Vec<_>>(),
        "convergence": convergence.collect::<Vec<_>>(),
        "listed": listed.collect::<Vec<_>>(),
    })
}
