//! What a command has traced: its figures as JSON and as text.

use cyltrace::tracer::Tracer;
use cyltrace_parts::{Header, PartWriter};
use serde_json::{Value, json};

use crate::arguments::TraceArguments;
use crate::output_sink::is_standard_stream;
use crate::parts::trace::Totals;
use crate::print::print;
use crate::{json, parts, text};

/// The outcome of a command.
pub struct Traced {
    pub tracer: Tracer,
    pub items: &'static str,
    pub totals: Totals,
    pub check: f64,
    pub load: f64,
    pub build: f64,
    pub trace: f64,
    pub threads: usize,
    /// The part that was traced; its file is not complete yet.
    pub part: Option<(Header, Box<PartWriter>)>,
    /// The columns that are not read, as a note.
    pub note: Option<String>,
}

impl Traced {
    /// Rows per second.
    pub fn rate(&self) -> f64 {
        self.totals.rows as f64 / self.trace
    }

    /// Completes a part, writes the JSON with the task's own keys, and prints a summary.
    pub fn report(
        mut self,
        arguments: &TraceArguments,
        own: Value,
        summary: &str,
    ) -> anyhow::Result<()> {
        let common = &arguments.common;
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let skipped_rows = scene.skipped_rows;
        let notes: Vec<&String> = scene.notes.iter().chain(&self.note).collect();
        let solids = json::Solids::of(statistics);
        let mut figures = json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "check_s": self.check,
            "load_s": self.load,
            "build_s": self.build,
            "trace_s": self.trace,
            "solids": solids.by_kind(),
            "cylinders": solids.cylinders(),
            "other_solids": solids.others(),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": statistics.skipped,
            "skipped_rows": skipped_rows,
            "notes": notes,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": self.threads,
        });
        if let (Value::Object(all), Value::Object(own)) = (&mut figures, own) {
            all.extend(own);
        }
        let mut of_whole = String::new();
        if let Some((header, part)) = self.part.take() {
            figures["part"] = json!(header.number.to_string());
            let seconds = self.check + self.load + self.build + self.trace;
            part.finish(&json!({ "totals": self.totals, "figures": figures, "seconds": seconds }))?;
            of_whole = parts::range_text(&header) + ": ";
        }
        json::write(common, &figures)?;
        if !common.prints() || is_standard_stream(&arguments.output) {
            return Ok(());
        }
        let mut text = format!("{}: {of_whole}{summary}\n", arguments.output.display());
        text += &text::skipped_rows(skipped_rows);
        text += &text::notes(notes);
        text += &format!(
            "time: check {:.2} s, load {:.2} s, build {:.2} s, trace {:.2} s on {} threads ({:.2} million {} per second, tables included)\n",
            self.check,
            self.load,
            self.build,
            self.trace,
            self.threads,
            self.rate() / 1e6,
            self.items
        );
        print(&text)
    }
}
