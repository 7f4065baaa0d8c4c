//! What a command has rendered: its figures as JSON and as text.

use std::collections::BTreeMap;

use cyltrace::tracer::Tracer;
use cyltrace_parts::Header;
use cyltrace_render::{RayCounts, Reached, Settings, Tiles};
use serde_json::{Value, json};

use super::frames::FrameFigures;
use crate::arguments::RenderArguments;
use crate::parts::checkpoint::Earlier;
use crate::{json, memory, parts, reached, text};

/// The times of the command's parts, in seconds.
pub struct Times {
    pub load: f64,
    pub build: f64,
    pub render: f64,
    /// If the noise was removed.
    pub denoise: Option<f64>,
}

impl Times {
    pub fn all(&self) -> f64 {
        self.load + self.build + self.render + self.denoise.unwrap_or_default()
    }
}

/// How many samples a pixel gets.
pub fn samples_text(settings: &Settings) -> String {
    let at_most = if settings.target.is_some() {
        "at most "
    } else {
        ""
    };
    format!("{at_most}{} samples per pixel", settings.spp)
}

/// A rendering that is complete.
pub struct Run<'a> {
    pub arguments: &'a RenderArguments,
    pub settings: &'a Settings,
    pub tracer: &'a Tracer,
    pub rays: RayCounts,
    /// What the picture has reached; of several, the one with the greatest error.
    pub reached: Option<Reached>,
    pub skipped: &'a [String],
    pub times: Times,
    pub threads: usize,
    /// The part that it is.
    pub header: Option<&'a Header>,
    /// The pictures of a film; empty without `--frames`.
    pub frames: &'a [FrameFigures],
    /// What an earlier run had rendered.
    pub earlier: Option<Earlier>,
}

impl Run<'_> {
    /// The rays per second of this run.
    fn rate(&self) -> f64 {
        let earlier = self.earlier.map_or(0, |earlier| earlier.rays);
        (self.rays.total() - earlier) as f64 / self.times.render
    }

    /// Work that the scene did not need.
    fn skipped(&self) -> Vec<String> {
        let of_tracer = self.tracer.statistics().skipped;
        self.skipped.iter().cloned().chain(of_tracer).collect()
    }

    /// The names of the pictures.
    fn written(&self) -> String {
        match self.frames {
            [] => self.arguments.output.display().to_string(),
            [only] => only.output.display().to_string(),
            [first, .., last] => {
                let [first, last] = [first, last].map(|frame| frame.output.display());
                format!("{first} to {last}: {} pictures", self.frames.len())
            }
        }
    }

    /// The JSON of `--json`.
    pub fn figures(&self) -> Value {
        let (arguments, settings, times) = (self.arguments, self.settings, &self.times);
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let purposes = RayCounts::PURPOSES.into_iter().zip(self.rays.by_purpose());
        let counts: BTreeMap<_, _> = purposes.collect();
        let channels = settings.channels.list();
        let names: Vec<_> = channels.iter().map(|channel| channel.name).collect();
        let mut figures = json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "size": [settings.film.width, settings.film.height],
            "spp": settings.spp,
            "integrator": settings.integrator.name(),
            "sampler": settings.sampler.name(),
            "seed": settings.seed,
            "load_s": times.load,
            "build_s": times.build,
            "render_s": times.render,
            "rays": counts,
            "channels": names,
            "rays_per_s": self.rate(),
            "solids": json::Solids::of(statistics).by_kind(),
            "cylinders": json::Solids::of(statistics).cylinders(),
            "instances": json::count(statistics.instances),
            "memory": json::memory(statistics),
            "skipped": self.skipped(),
            "skipped_rows": scene.skipped_rows,
            "notes": scene.notes,
            "embree": statistics.embree_version,
            "isa": statistics.isa,
            "threads": self.threads,
            "records": json::records(scene),
        });
        if let Some(reached) = &self.reached {
            figures[reached::KEY] = reached::figures(reached);
        }
        if let Some(seconds) = times.denoise {
            figures["denoise_s"] = json!(seconds);
        }
        if let Some(earlier) = &self.earlier {
            figures["resumed"] = json!({ "tiles": earlier.tiles, "rays": earlier.rays });
        }
        if !self.frames.is_empty() {
            figures["frames"] = self.frames.iter().map(FrameFigures::json).collect();
        }
        if let Some(header) = self.header {
            figures["part"] = json!(header.number.to_string());
        }
        figures
    }

    /// The figures for people.
    pub fn text(&self) -> String {
        let (settings, times) = (self.settings, &self.times);
        let statistics = &self.tracer.statistics();
        let scene = self.tracer.scene();
        let of_whole = match self.header {
            Some(header) => parts::range_text(header) + ", ",
            None => String::new(),
        };
        let mut text = format!(
            "{}: {of_whole}{}x{}, {}, {}\n{}",
            self.written(),
            settings.film.width,
            settings.film.height,
            samples_text(settings),
            settings.integrator.name(),
            text::solids(statistics),
        );
        if let Some(reached) = &self.reached {
            text += &reached::text(reached, settings);
        }
        text += &format!(
            "memory: {} of records, {} in Embree {} ({})\n",
            memory::readable(statistics.records_bytes as u64),
            memory::readable(statistics.embree_bytes as u64),
            statistics.embree_version,
            statistics.isa
        );
        text += &text::records(scene);
        let denoise = times.denoise;
        let denoise = denoise.map_or(String::new(), |time| format!(", denoise {time:.2} s"));
        text += &format!(
            "time: load {:.2} s, build {:.2} s, render {:.2} s on {} threads{denoise}\n",
            times.load, times.build, times.render, self.threads
        );
        text += &format!(
            "rays: {}, {:.2} million per second\n",
            self.rays.total(),
            self.rate() / 1e6
        );
        if let Some(earlier) = self.earlier.filter(|earlier| earlier.tiles > 0) {
            let all = Tiles::of(settings.film).count();
            text += &format!(
                "resumed: {} of {all} tiles and {} of the rays are of an earlier run\n",
                earlier.tiles, earlier.rays
            );
        }
        for reason in self.skipped() {
            text += &format!("skipped: {reason}\n");
        }
        text += &text::notes(&scene.notes);
        text
    }
}
