//! `cyltrace bench image`.

mod measure;
mod outputs;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::anyhow;
use cyltrace::scene::{Integrator, Sampler};
use cyltrace::tracer::Options;
use cyltrace_bench::Environment;
use cyltrace_output::{Table, csv, write_text};
use cyltrace_render::{EnvironmentMap, Settings};
use serde_json::json;

use self::measure::{Group, Plan};
use self::outputs::{SLOPE_HEADINGS, SUMMARY_HEADINGS, figures, page, records, slopes, summaries};
use super::{print_summary, with_environment};
use crate::arguments::ImageArguments;
use crate::limit::{MemoryLimit, Need, PictureBytes};
use crate::output_sink::make_directory;
use crate::{interrupt, json, progress, scene};

/// The scenes without others.
const SCENES: [&str; 4] = ["minimal", "lattice", "set_operations", "forest"];

/// The errors without others.
const ERRORS: [f64; 2] = [0.2, 0.1];

/// The integrators, where they suit a scene.
const INTEGRATORS: [Integrator; 3] = [Integrator::Sun, Integrator::Path, Integrator::Ao];

/// Measures time and error of pictures.
pub fn run(arguments: &ImageArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    json::check(common)?;
    if let Some(directory) = &arguments.report {
        make_directory(directory)?;
    }
    interrupt::end_in_order();
    let plan = Plan {
        samplers: or_all(&arguments.sampler, &Sampler::ALL),
        spp: arguments.spp,
        errors: or_all(&arguments.error, &ERRORS),
        rounds: arguments.rounds.get(),
    };
    let default = SCENES.map(|name| Path::new("scenes").join(name).with_extension("toml"));
    let mut groups = Vec::new();
    for path in or_all(&arguments.scenes, &default) {
        measure(arguments, &plan, &path, &mut groups)?;
    }

    let film = arguments.size;
    let rounds = plan.rounds;
    let pixels = u64::from(film.width) * u64::from(film.height);
    let environment = Environment::here(common.max_isa, pixels, arguments.seed, rounds);
    let threads = scene::workers(common)?.current_num_threads();
    let sentence = format!(
        "{}x{} pixels, seed {}, {rounds} rounds, {threads} threads. {}",
        film.width,
        film.height,
        arguments.seed,
        environment.place()
    );
    if let Some(directory) = &arguments.report {
        for shown in figures(&groups) {
            write_text(&directory.join(shown.name + ".svg"), &shown.svg)?;
        }
        write_text(&directory.join("image.csv"), &csv(&records(&groups)))?;
        write_text(&directory.join("index.html"), &page(&groups, &sentence))?;
    }
    let all = json!({ "pictures": records(&groups), "threads": threads });
    json::write(common, &with_environment(all, &environment, "pixels"))?;
    let mut table = Table::new(&SUMMARY_HEADINGS, 4);
    let mut of_slopes = Table::new(&SLOPE_HEADINGS, 4);
    for group in &groups {
        summaries(group).for_each(|row| table.push(row));
        slopes(group)
            .into_iter()
            .for_each(|row| of_slopes.push(row));
    }
    let text = format!("{sentence}\n{table}\n{of_slopes}");
    print_summary(common, text, arguments.report.as_deref())
}

fn or_all<T: Clone>(some: &[T], all: &[T]) -> Vec<T> {
    match some {
        [] => all.to_vec(),
        some => some.to_vec(),
    }
}

/// Measures a scene with each integrator.
fn measure(
    arguments: &ImageArguments,
    plan: &Plan,
    path: &PathBuf,
    groups: &mut Vec<Group>,
) -> anyhow::Result<()> {
    let common = &arguments.common;
    let limit = MemoryLimit::of(&arguments.memory);
    let file = scene::read(path, limit)?;
    let film = arguments.size;
    let pixels = u64::from(film.width) * u64::from(film.height);
    let limit = limit.with_picture(PictureBytes {
        // A picture and its reference.
        pixels: 2 * pixels * size_of::<[f32; 3]>() as u64,
        environment: EnvironmentMap::bytes(file.environment_pixels()),
        ..PictureBytes::default()
    });
    let scene = Arc::new(scene::load(common, file, Need::Build, limit)?);
    let options = Options {
        layout: arguments.memory.layout.into(),
        ..Options::default()
    };
    let tracer = scene::build(common, &scene, options)?;
    let stated: Vec<Integrator> = arguments.integrator.iter().map(|&one| one.into()).collect();
    let mut integrators = or_all(&stated, &INTEGRATORS);
    if stated.is_empty() && scene.render.integrator == Integrator::Path {
        // Lights and materials that other integrators do not show.
        integrators.retain(|&one| one != Integrator::Sun);
    }
    let name = path
        .file_stem()
        .ok_or_else(|| anyhow!("{path:?} has no name"))?;
    let workers = scene::workers(common)?;
    let bar = progress::bar(common, plan.steps() * integrators.len() as u64, "pictures");
    for integrator in integrators {
        let settings = Settings {
            film: arguments.size,
            integrator,
            seed: arguments.seed,
            ..Settings::of(&scene)
        };
        let rows = plan.measure(&tracer, &settings, &workers, &|| bar.inc(1));
        interrupt::check()?;
        groups.push(Group {
            scene: name.to_string_lossy().into_owned(),
            integrator,
            rows: rows?,
        });
    }
    bar.finish_and_clear();
    Ok(())
}
