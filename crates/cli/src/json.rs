//! The figures of a run as JSON.

use std::io::Write;

use cyltrace::scene::Scene;
use cyltrace::tracer::Statistics;
use serde_json::{Value, json};

use super::arguments::Common;
use super::memory::peak_resident_bytes;
use super::output_sink::OutputSink;

/// Checks before any work that the figures can be written.
pub fn check(common: &Common) -> anyhow::Result<()> {
    match &common.json {
        Some(path) => Ok(OutputSink::check(path)?),
        None => Ok(()),
    }
}

/// Writes the figures to the file of `--json`, if it was given.
pub fn write(common: &Common, figures: &Value) -> anyhow::Result<()> {
    let Some(path) = &common.json else {
        return Ok(());
    };
    let mut target = OutputSink::create(path)?;
    serde_json::to_writer_pretty(&mut target, figures)?;
    writeln!(target)?;
    target.finish()
}

/// A count: beyond u64 a float, since JSON readers round it anyway, and beyond u128 null.
pub fn count(count: u128) -> Value {
    match u64::try_from(count) {
        Ok(count) => json!(count),
        Err(_) if count == u128::MAX => Value::Null,
        Err(_) => json!(count as f64),
    }
}

/// The memory a traced scene took.
pub fn memory(statistics: &Statistics) -> Value {
    json!({
        "embree_bytes": statistics.embree_bytes,
        "records_bytes": statistics.records_bytes,
        "peak_rss_bytes": peak_resident_bytes(),
    })
}

/// The form of a scene's records.
pub fn records(scene: &Scene) -> Value {
    json!({ "numbers": scene.records().name(), "rounding": scene.rounding() })
}

/// The cylinders of a traced scene.
pub fn cylinders(statistics: &Statistics) -> Value {
    json!({
        "unique": statistics.cylinders_unique,
        "instanced": count(statistics.cylinders_instanced),
    })
}

/// The solids of other kinds of a traced scene.
pub fn other_solids(statistics: &Statistics) -> Value {
    json!({
        "unique": statistics.other_solids_unique,
        "instanced": count(statistics.other_solids_instanced),
    })
}
