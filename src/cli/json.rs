//! The figures of a run as JSON.

use std::io::Write;
use std::path::{self, Path};

use anyhow::bail;
use cyltrace::tracer::Statistics;
use serde_json::{Value, json};

use super::arguments::Common;
use super::memory::peak_resident_bytes;
use super::target::Target;

/// Says before any work whether the figures can be written, and to another place
/// than `output`.
pub fn check(common: &Common, output: Option<&Path>) -> anyhow::Result<()> {
    let Some(path) = &common.json else {
        return Ok(());
    };
    if output.is_some_and(|output| is_same_place(path, output)) {
        bail!("--json and --output both name {path:?}: one would replace the other");
    }
    Ok(Target::check(path)?)
}

/// Whether two paths name the same file or both standard output. Devices and
/// pipes, such as /dev/null, take more than one.
fn is_same_place(one: &Path, other: &Path) -> bool {
    if one.metadata().is_ok_and(|existing| !existing.is_file()) {
        return false;
    }
    let whole = |path: &Path| path::absolute(path).unwrap_or_else(|_| path.into());
    let found = |path: &Path| path.canonicalize().unwrap_or_else(|_| whole(path));
    found(one) == found(other)
}

/// Writes the figures where `--json` says, if it was given.
pub fn write(common: &Common, figures: &Value) -> anyhow::Result<()> {
    let Some(path) = &common.json else {
        return Ok(());
    };
    let mut target = Target::create(path)?;
    serde_json::to_writer_pretty(&mut target, figures)?;
    writeln!(target)?;
    target.finish()
}

/// A count; one beyond u64, which JSON readers round anyway, is given as a
/// float.
pub fn count(count: u128) -> Value {
    u64::try_from(count).map_or_else(|_| json!(count as f64), |count| json!(count))
}

/// The memory a traced scene took.
pub fn memory(statistics: &Statistics) -> Value {
    json!({
        "embree_bytes": statistics.embree_bytes,
        "records_bytes": statistics.records_bytes,
        "peak_rss_bytes": peak_resident_bytes(),
    })
}

/// The cylinders of a traced scene.
pub fn cylinders(statistics: &Statistics) -> Value {
    json!({
        "unique": statistics.cylinders_unique,
        "instanced": count(statistics.cylinders_instanced),
    })
}
