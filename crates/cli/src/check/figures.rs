//! The figures of a check, as JSON.

use cyltrace::tracer::Tracer;
use cyltrace_check::{Agreement, Deviation, percent};
use serde_json::{Value, json};

use super::Found;
use super::external_input::ExternalInput;
use crate::arguments::CheckArguments;
use crate::json;

/// The fields of the rows that follow from what Embree computes in f32, whose last bits depend
/// on the instruction set.
const ISA_DEPENDENT: [&str; 6] = [
    "band_percent",
    "witnessed_percent",
    "unwitnessed_percent",
    "triangle_errors",
    "max_dt_over_chord",
    "p99_dt_r",
];

/// All figures.
pub fn figures(
    arguments: &CheckArguments,
    tracer: &Tracer,
    found: &Found,
    told: Option<&ExternalInput>,
    elapsed: f64,
) -> Value {
    let Found {
        outcome,
        agreements,
    } = found;
    let disagreements: u64 = agreements.iter().map(|one| one.disagreements).sum();
    let told_rays: u64 = agreements.iter().map(|one| one.rays).sum();
    let classes = outcome.rows.iter().map(cyltrace_check::class_figures);
    let classes = classes.chain(agreements.iter().map(agreement_figures));
    let convergence = outcome
        .convergence
        .iter()
        .map(cyltrace_check::convergence_figures);
    let listed = outcome
        .violations
        .iter()
        .map(cyltrace_check::violation_figures);
    let told_listed = agreements.iter().flat_map(|one| {
        one.listed.iter().map(move |found| {
            json!({
                "class": one.class,
                "witness": one.witness.name(),
                "segments": null,
                "index": found.index,
                "t": found.told,
                "what": found.exact.map_or_else(|| "exactly a miss".to_owned(), |t| format!("exactly {t:?}")),
                "replay": null,
                "exact_t": found.exact,
                "line": told.and_then(|told| told.line(found.index)),
                "origin": found.ray.origin.to_array(),
                "direction": found.ray.direction.to_array(),
            })
        })
    });
    let statistics = tracer.statistics();
    let solids = json::Solids::of(&statistics);
    json!({
        "scene": arguments.scene,
        "violations": outcome.violation_count() + disagreements,
        "rays": outcome.rays() + told_rays,
        "classes": classes.collect::<Vec<_>>(),
        "convergence": convergence.collect::<Vec<_>>(),
        "listed": listed.chain(told_listed).collect::<Vec<_>>(),
        "windows": outcome.windows,
        "seed": arguments.seed,
        "solids": solids.by_kind(),
        "cylinders": solids.cylinders(),
        "embree": tracer.statistics().embree_version,
        "isa": tracer.statistics().isa,
        // Hits from elsewhere are compared in f64.
        "isa_dependent": if told.is_some() { &[][..] } else { &ISA_DEPENDENT },
        "check_s": elapsed,
        "holds": found.holds(),
    })
}

/// The row of hits from elsewhere: its band is that of silhouettes.
fn agreement_figures(row: &Agreement) -> Value {
    json!({
        "name": row.class,
        "witness": row.witness.name(),
        "segments": null,
        "rays": row.rays,
        "violations": row.disagreements,
        "band_percent": percent(row.silhouette, row.rays),
        "max_dt_over_chord": null,
        "hits": row.hits,
        "witnessed_percent": percent(row.judged(), row.rays),
        "unwitnessed_percent": percent(row.coarse, row.rays),
        "triangle_errors": null,
        "wrong_normals": null,
        "judged": row.judged(),
        "tolerance": row.max_allowance.max(row.fixed_allowance),
        "least_radius": finite(row.least_radius),
        "tessellated": match row.deviation() {
            Deviation::Everywhere(_) => Value::Null,
            Deviation::Tessellated { segments, fit } => {
                json!({ "segments": segments, "fit": fit.name() })
            }
        },
    })
}

/// A number; `null` for what is infinite.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}
