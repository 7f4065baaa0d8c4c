//! `cyltrace tessellate`.

use std::io::Write;
use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::anyhow;
use cyltrace::meshes::{Format, MeshFileError, Plan};
use cyltrace::solid::tessellation::Fit;
use serde_json::json;

use super::arguments::TessellateArguments;
use super::limit::{MemoryLimit, Need};
use super::output_sink::OutputSink;
use super::outputs::Files;
use super::{interrupt, json, memory, print, progress, scene, text};

/// Writes the scene as a mesh.
pub fn run(arguments: &TessellateArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    let files =
        Files::new(&arguments.scene, common.json.as_deref()).output("-o", &arguments.output);
    files.check()?;
    let format = Format::to_write(&arguments.output)?;
    OutputSink::check(&arguments.output)?;
    json::check(common)?;

    let start = Instant::now();
    let file = scene::read(&arguments.scene, MemoryLimit::available())?;
    files.check_with(&file)?;
    let file = file.without_environment();
    let scene = scene::load(common, file, Need::Records, MemoryLimit::available())?;
    let load = start.elapsed().as_secs_f64();

    let fit = if arguments.circumscribed {
        Fit::Circumscribed
    } else {
        Fit::Inscribed
    };
    let plan = Plan::new(&scene, arguments.segments, fit)?;
    let name = arguments.scene.to_string_lossy();
    let bytes = format.file_bytes(&plan, &name);
    format
        .check(&plan, &name, arguments.max_memory)
        .map_err(error_of)?;
    if common.prints() {
        print(&stated(arguments, &plan, format, bytes))?;
    }

    interrupt::end_in_order();
    let mut target = OutputSink::create(&arguments.output)?;
    let items = plan.vertices() + plan.triangles();
    let bar = progress::bar(
        common,
        u64::try_from(items).unwrap_or(u64::MAX),
        "vertices and triangles",
    );
    let start = Instant::now();
    let written = format.write(&scene, &plan, &name, &mut target, &mut |items| {
        bar.inc(items);
        match interrupt::check() {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    });
    bar.finish_and_clear();
    match written {
        Err(MeshFileError::Cancelled) => {
            return Err(interrupt::Interrupted::NothingWritten.into());
        }
        other => other?,
    }
    target.flush()?;
    target.finish()?;
    let write = start.elapsed().as_secs_f64();

    json::write(
        common,
        &json!({
            "scene": arguments.scene,
            "output": arguments.output,
            "load_s": load,
            "write_s": write,
            "segments": plan.segments(),
            "fit": plan.fit().name(),
            "deviation": plan.deviation(),
            "solids": json::count(plan.solids()),
            "vertices": json::count(plan.vertices()),
            "triangles": json::count(plan.triangles()),
            "skipped_rows": scene.skipped_rows,
            "notes": scene.notes,
        }),
    )?;
    if !common.prints() {
        return Ok(());
    }
    let mut text = text::skipped_rows(scene.skipped_rows);
    text += &text::notes(&scene.notes);
    text += &format!("time: load {load:.2} s, write {write:.2} s\n");
    print(&text)
}

/// The error in terms of the options.
fn error_of(error: MeshFileError) -> anyhow::Error {
    match error {
        MeshFileError::TooLarge { needed, allowed } => anyhow!(
            "the mesh needs up to {} and --max-memory allows {}: use fewer --segments or a greater --max-memory",
            readable(needed),
            memory::readable(allowed)
        ),
        other => other.into(),
    }
}

/// A size as text; one beyond 64 bits is given as the greatest of 64 bits.
fn readable(bytes: u128) -> String {
    memory::readable(u64::try_from(bytes).unwrap_or(u64::MAX))
}

/// The contents and the size of the mesh, in lines for people.
fn stated(arguments: &TessellateArguments, plan: &Plan, format: Format, bytes: u128) -> String {
    let most = if format.is_size_exact() {
        ""
    } else {
        "at most "
    };
    let mut text = format!(
        "{}: {} {} {} of {} sides, {} vertices, {} triangles, {most}{}\n",
        arguments.output.display(),
        plan.solids(),
        plan.fit().name(),
        if plan.are_prisms() {
            "prisms"
        } else {
            "meshes"
        },
        plan.segments(),
        plan.vertices(),
        plan.triangles(),
        readable(bytes),
    );
    text += "deviation: at most ";
    text::push_number(&mut text, plan.deviation());
    text + " scene units from the true surface\n"
}
