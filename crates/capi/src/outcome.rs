//! The outcome of a check as C gets it: counts and two texts.

use std::ffi::{CString, c_char};
use std::ptr;

use super::status::c_text;
use super::types::CyltraceCheckOutcome;
use cyltrace_check::{Outcome, summary, verdict};

/// The outcome, with texts that [`free`] releases: those of `cyltrace check` and of its
/// `--json`.
pub(super) fn of(outcome: &Outcome) -> CyltraceCheckOutcome {
    let rows = outcome.rows.iter();
    let text = format!("{}{}\n", summary(outcome), verdict(outcome));
    CyltraceCheckOutcome {
        rays: outcome.rays(),
        violations: outcome.violation_count(),
        unwitnessed_rows: rows.filter(|row| row.shortfall().is_some()).count() as u64,
        text: c_text(text).into_raw(),
        json: c_text(serde_json::json!(outcome).to_string()).into_raw(),
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
