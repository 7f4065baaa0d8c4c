//! Parts of a check: the tallies of a range of the rays of each class.

use std::io::Read;
use std::path::Path;

use anyhow::Context;
use cyltrace_check::{Class, Outcome, PartialOutcome, Settings};
use cyltrace_parts::PartSet;
use serde_json::{Value, json};

use super::value;
use crate::output_sink::OutputSink;

/// The settings that determine the outcome, the instruction set included: Embree's own
/// arithmetic decides which rays the meshes bound.
pub fn settings(settings: &Settings, exact: bool, embree: &str, isa: &str) -> Value {
    let classes: Vec<_> = settings.classes.iter().map(|class| class.name()).collect();
    json!({
        "segments": settings.segments,
        "rays": settings.rays,
        "classes": classes,
        "seed": settings.seed,
        "max_memory": settings.max_memory,
        "listed": settings.most_listed,
        "exact": exact,
        "embree": embree,
        "isa": isa,
    })
}

/// Writes the JSON of a whole set, and returns the outcome.
pub fn merge(set: &PartSet, output: &Path) -> anyhow::Result<Outcome> {
    let first = &set.parts()[0];
    let stated = &set.header().settings;
    let classes: Vec<String> = value(first, &stated["classes"])?;
    let classes: Result<Vec<Class>, _> = classes.iter().map(|name| name.parse()).collect();
    let settings = Settings {
        segments: value(first, &stated["segments"])?,
        rays: value(first, &stated["rays"])?,
        classes: classes.map_err(anyhow::Error::msg)?,
        seed: value(first, &stated["seed"])?,
        max_memory: value(first, &stated["max_memory"])?,
        most_listed: value(first, &stated["listed"])?,
        ..Settings::default()
    };
    let mut outcomes = Vec::new();
    let mut seconds = 0.0;
    for part in set.parts() {
        let mut bytes = Vec::new();
        let read = part.payload()?.read_to_end(&mut bytes);
        read.with_context(|| format!("cannot read {:?}", part.path()))?;
        let outcome = PartialOutcome::from_bytes(&settings, &bytes);
        outcomes.push(outcome.with_context(|| format!("{:?}", part.path()))?);
        let own: f64 = value(part, &part.summary()["figures"]["check_s"])?;
        seconds += own;
    }
    let outcome = Outcome::of_parts(&settings, outcomes);

    // The figures of a part are those of a whole run, with the outcome of its own rays.
    let mut figures = first.summary()["figures"].clone();
    if let (Value::Object(figures), Value::Object(whole)) = (&mut figures, json!(outcome)) {
        figures.extend(whole);
    }
    figures["check_s"] = json!(seconds);
    let mut target = OutputSink::create(output)?;
    crate::json::write_to(&mut target, &figures)?;
    target.finish()?;
    Ok(outcome)
}
