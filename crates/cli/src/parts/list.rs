//! `cyltrace parts`.

use anyhow::Context;
use cyltrace_parts::{PartFile, Survey, Whole};
use serde_json::{Value, json};

use crate::arguments::PartsArguments;
use crate::outputs::Files;
use crate::print::print;
use crate::{CHECK_FAILED, GOOD, json};

/// Missing parts that are named, of each result.
const MOST_NAMED: usize = 10;

/// Lists the parts. The exit code is 0 if there are results and all are complete.
pub fn run(arguments: &PartsArguments) -> anyhow::Result<u8> {
    let (common, folder) = (&arguments.common, &arguments.folder);
    json::check(common)?;
    let survey =
        Survey::of(folder).with_context(|| format!("cannot read the folder {folder:?}"))?;
    let parts = survey.wholes.iter().flat_map(|whole| &whole.parts);
    let files = Files::without_scene(common.json.as_deref());
    parts
        .fold(files, |files, part| files.input("a part,", part.path()))
        .check()?;
    let wholes: Vec<Value> = survey.wholes.iter().map(figures).collect();
    let damaged = survey.damaged.iter();
    let damaged: Vec<Value> = damaged
        .map(|one| json!({ "file": one.path, "reason": one.reason }))
        .collect();
    json::write(
        common,
        &json!({ "folder": folder, "results": wholes, "damaged": damaged }),
    )?;
    if common.prints() {
        let mut text: String = survey.wholes.iter().map(whole_text).collect();
        for damaged in &survey.damaged {
            text += &format!("{}\n", damaged.reason);
        }
        if text.is_empty() {
            text = format!("{}: no parts\n", folder.display());
        }
        print(&text)?;
    }
    let is_complete = !survey.wholes.is_empty()
        && survey.damaged.is_empty()
        && survey.wholes.iter().all(|whole| whole.check().is_ok());
    Ok(if is_complete { GOOD } else { CHECK_FAILED })
}

/// The seconds that a part took.
fn seconds(part: &PartFile) -> Option<f64> {
    part.summary()["seconds"].as_f64()
}

fn figures(whole: &Whole) -> Value {
    let header = whole.parts[0].header();
    let parts = whole.parts.iter().map(|part| {
        json!({
            "file": part.path(),
            "part": part.header().number.number(),
            "of": part.header().number.of(),
            "seconds": seconds(part),
        })
    });
    json!({
        "command": header.command,
        "fingerprint": header.fingerprint,
        "settings": header.settings,
        "parts": parts.collect::<Vec<_>>(),
        "missing": whole.missing(),
    })
}

/// A result as a line, and a line with the missing parts.
fn whole_text(whole: &Whole) -> String {
    let header = whole.parts[0].header();
    let (there, of) = (whole.parts.len(), header.number.of());
    let mut text = format!(
        "{} {}: {there} of {of} parts",
        header.command,
        header.fingerprint.get(..12).unwrap_or("?")
    );
    let seconds: Vec<f64> = whole.parts.iter().filter_map(seconds).collect();
    if let Some(longest) = seconds.iter().copied().reduce(f64::max) {
        let mean = seconds.iter().sum::<f64>() / seconds.len() as f64;
        text += &format!(", {mean:.2} s each on average, {longest:.2} s at most");
    }
    text += "\n";
    match whole.missing() {
        Some(missing) if !missing.is_empty() => {
            let named = missing.iter().take(MOST_NAMED).map(u64::to_string);
            let named = named.collect::<Vec<_>>().join(", ");
            let more = match missing.len().saturating_sub(MOST_NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            text += &format!("  missing: {named}{more}\n");
        }
        // Doubled parts, or parts of several numbers of parts.
        _ => {
            if let Err(error) = whole.check() {
                text += &format!("  {error}\n");
            }
        }
    }
    text
}
