//! The figures of a run as JSON.

use std::io::Write;

use cyltrace::scene::Scene;
use cyltrace::solid::{SolidCounts, SolidKind};
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
    write_to(&mut target, figures)?;
    target.finish()
}

/// Writes figures as every file of `--json` has them.
pub fn write_to(target: &mut impl Write, figures: &Value) -> anyhow::Result<()> {
    serde_json::to_writer_pretty(&mut *target, figures)?;
    Ok(writeln!(target)?)
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

/// How many solids of each kind a scene stores and, with every placement counted, has.
#[derive(Clone, Copy)]
pub struct Solids<'a> {
    pub unique: &'a SolidCounts,
    pub instanced: &'a SolidCounts,
}

impl<'a> Solids<'a> {
    /// Those of a traced scene.
    pub fn of(statistics: &'a Statistics) -> Self {
        Self {
            unique: &statistics.unique,
            instanced: &statistics.instanced,
        }
    }

    /// The counts of each kind that the scene has.
    pub fn by_kind(&self) -> Value {
        let kinds = self.unique.iter().map(|(kind, _)| kind);
        let counts = kinds.map(|kind| (kind.name().to_owned(), self.counts(|counts| counts[kind])));
        Value::Object(counts.collect())
    }

    /// The counts of cylinders, which have a key of their own.
    pub fn cylinders(&self) -> Value {
        self.counts(|counts| counts[SolidKind::Cylinder])
    }

    /// The counts of all other kinds together, likewise.
    pub fn others(&self) -> Value {
        self.counts(|counts| {
            let others = counts.iter();
            let others = others.filter(|(kind, _)| *kind != SolidKind::Cylinder);
            others.fold(0, |sum, (_, count)| u128::saturating_add(sum, count))
        })
    }

    fn counts(&self, of: impl Fn(&SolidCounts) -> u128) -> Value {
        json!({ "unique": count(of(self.unique)), "instanced": count(of(self.instanced)) })
    }
}
