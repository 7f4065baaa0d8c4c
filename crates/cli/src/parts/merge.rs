//! `cyltrace merge`.

use std::path::PathBuf;

use anyhow::{Context, bail};
use cyltrace_parts::{PartSet, Survey};
use cyltrace_render::RayCounts;
use serde_json::{Value, json};

use super::{check, render, trace};
use crate::arguments::MergeArguments;
use crate::output_sink::{OutputSink, is_standard_stream};
use crate::outputs::Files;
use crate::print::print;
use crate::{CHECK_FAILED, GOOD, interrupt, json, reached};

/// Puts the parts together. The exit code is that of the command that made them.
pub fn run(arguments: &MergeArguments) -> anyhow::Result<u8> {
    let (common, output) = (&arguments.common, &arguments.output);
    OutputSink::check(output)?;
    json::check(common)?;
    let paths = paths(&arguments.parts)?;
    let files = Files::without_scene(common.json.as_deref()).output("-o", output);
    let files = paths
        .iter()
        .fold(files, |files, path| files.input("a part,", path));
    files.check()?;
    if paths.is_empty() {
        let named = arguments.parts.iter().map(|path| format!("{path:?}"));
        bail!(
            "there are no parts in {}",
            named.collect::<Vec<_>>().join(", ")
        );
    }
    let set = PartSet::read(&paths)?;
    let command = set.header().command.as_str();
    if command == "render" {
        render::check(&set, output)?;
    }
    interrupt::end_in_order();
    let (code, figures, text) = match command {
        "render" => {
            render::merge(&set, output)?;
            let mut figures = sums(&set, "rays", &RayCounts::PURPOSES);
            if let Some(reached) = reached::of_parts(&set) {
                figures[reached::KEY] = reached::figures(&reached);
            }
            let rays = figures["rays"].as_object().into_iter().flatten();
            let rays: u64 = rays.filter_map(|(_, count)| count.as_u64()).sum();
            (GOOD, figures, format!("{rays} rays\n"))
        }
        "trace" => {
            let totals = trace::merge(&set, output)?;
            let text = format!("{} of {} rows hit\n", totals.hit_rows, totals.rows);
            (GOOD, json!({ "totals": totals }), text)
        }
        "check" => {
            let outcome = check::merge(&set, output)?;
            let code = if outcome.holds() { GOOD } else { CHECK_FAILED };
            let mut text = cyltrace_check::summary(&outcome);
            text += &format!("{}\n", cyltrace_check::verdict(&outcome));
            (code, json!(outcome), text)
        }
        other => bail!(
            "{:?} is a part of the command `{other}`, which this version does not know",
            set.parts()[0].path()
        ),
    };
    let mut all = json!({
        "output": output,
        "command": command,
        "parts": set.parts().len(),
        "settings": set.header().settings,
    });
    if let (Value::Object(all), Value::Object(figures)) = (&mut all, figures) {
        all.extend(figures);
    }
    json::write(common, &all)?;
    if common.prints() && !is_standard_stream(output) {
        let count = match set.parts().len() {
            1 => String::from("1 part"),
            count => format!("{count} parts"),
        };
        print(&format!(
            "{}: merged from {count}, {text}",
            output.display()
        ))?;
    }
    Ok(code)
}

/// The files that are named, and the parts in the folders that are named.
fn paths(named: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for path in named {
        if !path.is_dir() {
            paths.push(path.clone());
            continue;
        }
        let survey =
            Survey::of(path).with_context(|| format!("cannot read the folder {path:?}"))?;
        if let Some(damaged) = survey.damaged.first() {
            bail!("{}", damaged.reason);
        }
        let parts = survey.wholes.iter().flat_map(|whole| &whole.parts);
        paths.extend(parts.map(|part| part.path().to_owned()));
    }
    Ok(paths)
}

/// The sums of counts over all parts, `{ key: { count: sum } }`.
fn sums(set: &PartSet, key: &str, counts: &[&str]) -> Value {
    let sum = |name: &&str| {
        let parts = set.parts().iter();
        let counts = parts.filter_map(|part| part.summary()["figures"][key][name].as_u64());
        ((*name).to_owned(), json!(counts.sum::<u64>()))
    };
    json!({ key: Value::Object(counts.iter().map(sum).collect()) })
}
