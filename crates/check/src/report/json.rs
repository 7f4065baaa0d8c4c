//! The outcome as JSON, the same for the command line and for C.

use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::text::what_text;
use crate::outcome::{Expected, Outcome, Row, Violation, percent};
use crate::replay::Replay;

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let external = self.tolerance.as_ref();
        let of_meshes = |value: Value| match external {
            None => value,
            Some(_) => Value::Null,
        };
        let mut figures = json!({
            "name": self.class,
            "witness": self.witness.name(),
            "segments": self.segments,
            "rays": self.rays,
            "violations": self.violations,
            "band_percent": percent(self.band, self.rays),
            "max_dt_over_chord": of_meshes(json!(self.max_dt_over_chord)),
            "hits": self.hits,
            "witnessed_percent": percent(self.witnessed, self.rays),
            "unwitnessed_percent": percent(self.unwitnessed, self.rays),
            "triangle_errors": of_meshes(json!(self.triangle_errors)),
            "wrong_normals": of_meshes(json!(self.wrong_normals)),
        });
        if let Some(tolerance) = external {
            figures["judged"] = json!(self.witnessed);
            figures["tolerance"] = json!(tolerance.greatest);
            // JSON has no infinity: json! makes it null.
            figures["least_radius"] = json!(tolerance.least_radius);
            figures["tessellated"] = match tolerance.tessellated {
                None => Value::Null,
                Some((segments, fit)) => json!({ "segments": segments, "fit": fit.name() }),
            };
        }
        figures.serialize(serializer)
    }
}

impl Serialize for Violation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let ray = &self.ray;
        let (replay, exact_t, allowed) = match &self.expected {
            Expected::Between { low, high, .. } => {
                let word = Replay::Given(*ray).to_string();
                (Some(word), None, Some([*low, *high]))
            }
            Expected::Exact { t, .. } => (None, *t, None),
        };
        let figures = json!({
            "class": self.class,
            "witness": self.witness.name(),
            "segments": self.segments,
            "index": self.index,
            "t": self.t,
            "what": what_text(self),
            "replay": replay,
            "exact_t": exact_t,
            "line": self.source.as_ref().map(|(_, line)| line),
            "origin": ray.origin.to_array(),
            "direction": ray.direction.to_array(),
            "t_min": ray.t_min,
            "t_max": ray.t_max,
            "allowed": allowed,
        });
        figures.serialize(serializer)
    }
}

impl Serialize for Outcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let figures = json!({
            "violations": self.violation_count(),
            "rays": self.rays(),
            "classes": self.rows,
            "convergence": self.convergence,
            "listed": self.violations,
            "windows": self.windows,
            "holds": self.holds(),
        });
        figures.serialize(serializer)
    }
}
