//! The outcome as JSON values, the same for the command line and for C.

use serde_json::{Value, json};

use super::report::percent;
use crate::{ClassRow, Convergence, Violation};

/// A row of the table.
#[must_use]
pub fn class_figures(row: &ClassRow) -> Value {
    json!({
        "name": row.class.name(),
        "witness": row.witness.name(),
        "segments": row.segments,
        "rays": row.rays,
        "violations": row.violations,
        "band_percent": percent(row.band, row.rays),
        "max_dt_over_chord": row.max_dt_over_chord,
        "hits": row.hits,
        "witnessed_percent": percent(row.witnessed, row.rays),
        "unwitnessed_percent": percent(row.unwitnessed, row.rays),
        "triangle_errors": row.triangle_errors,
        "wrong_normals": row.wrong_normals,
    })
}

/// How near the prisms are for a number of sides.
#[must_use]
pub fn convergence_figures(row: &Convergence) -> Value {
    json!({
        "segments": row.segments,
        "band_percent": row.band_percent,
        "p99_dt_r": row.p99_dt_r,
    })
}

/// A wrong answer with all that replays it; what is infinite is null.
#[must_use]
pub fn violation_figures(violation: &Violation) -> Value {
    let ray = &violation.ray;
    json!({
        "class": violation.class.name(),
        "witness": violation.witness.name(),
        "segments": violation.segments,
        "index": violation.index,
        "t": violation.answer.as_ref().map(|answer| answer.t),
        "what": violation.what,
        "replay": violation.replay().to_string(),
        "exact_t": null,
        "line": null,
        "origin": ray.origin.to_array(),
        "direction": ray.direction.to_array(),
        "t_min": ray.t_min,
        "t_max": ray.t_max,
        "allowed": [violation.allowed.0, violation.allowed.1],
    })
}
