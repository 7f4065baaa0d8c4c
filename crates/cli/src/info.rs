//! `cyltrace info`.

use std::time::Instant;

use cyltrace::scene::Color;
use cyltrace::tracer::{self, MemoryEstimate};
use serde_json::json;

use super::arguments::InfoArguments;
use super::limit::{MemoryLimit, Need};
use super::outputs::Files;
use super::{json, memory, outliers, print, scene, text};

/// Prints what the scene contains.
pub fn run(arguments: &InfoArguments) -> anyhow::Result<()> {
    let common = &arguments.common;
    let files = Files::new(&arguments.scene, common.json.as_deref());
    files.check()?;
    json::check(common)?;
    let start = Instant::now();
    let limit = MemoryLimit::of(&arguments.memory);
    let file = scene::read(&arguments.scene, limit)?;
    files.check_with(&file)?;
    let read = file.files();
    let scene = scene::load(common, file, Need::Records, limit)?;
    let load = start.elapsed().as_secs_f64();
    let workers = scene::workers(common)?;
    let (scene_stats, found) = workers.install(|| (scene.scene_stats(), tracer::outliers(&scene)));
    let estimate = MemoryEstimate::of(
        &scene.contents(),
        arguments.memory.layout.into(),
        common.max_isa,
    );
    let (lower, upper) = (scene_stats.bounds.lower, scene_stats.bounds.upper);

    let materials: Vec<_> = scene
        .materials
        .iter()
        .map(|material| {
            json!({
                "name": material.name,
                "kind": material.kind.name(),
                "color": material.color.average().to_array(),
            })
        })
        .collect();
    let solids = json::Solids {
        unique: &scene_stats.unique,
        instanced: &scene_stats.instanced,
    };
    json::write(
        &arguments.common,
        &json!({
            "scene": arguments.scene,
            "files": read,
            "load_s": load,
            "prototypes": { "all": scene_stats.prototypes, "placed": scene_stats.prototypes_used },
            "placements": scene_stats.placements,
            "instances": json::count(scene_stats.instances),
            "depth": scene_stats.depth,
            "solids": solids.by_kind(),
            "cylinders": solids.cylinders(),
            "other_solids": solids.others(),
            "skipped_rows": scene.skipped_rows,
            "notes": scene.notes,
            "bounds": { "lower": lower.to_array(), "upper": upper.to_array() },
            "memory_estimate": {
                "records_bytes": estimate.records_bytes,
                "embree_bytes": estimate.embree_bytes,
                "copies_bytes": estimate.copies_bytes,
                "building_bytes": estimate.building_bytes,
                "peak_bytes": estimate.peak_bytes(),
            },
            "materials": materials,
            "records": json::records(&scene),
            "outliers": outliers::values(&scene, &found),
        }),
    )?;
    if !arguments.common.prints() {
        return Ok(());
    }
    let mut text = format!("{}\n", arguments.scene.display());
    if scene_stats.prototypes > 0 {
        text += &format!(
            "prototypes: {}, {} of them placed\n",
            scene_stats.prototypes, scene_stats.prototypes_used
        );
        text += &format!(
            "placements: {} stored, {} in total, nesting depth {}\n",
            scene_stats.placements,
            text::count(scene_stats.instances),
            scene_stats.depth
        );
    }
    for (kind, unique) in scene_stats.unique.iter() {
        text += &format!(
            "{}: {unique} unique, {} instanced\n",
            text::plural(kind),
            text::count(scene_stats.instanced[kind])
        );
    }
    text += &text::skipped_rows(scene.skipped_rows);
    text += &text::notes(&scene.notes);
    text += &outliers::lines(&scene, &found);
    text += &format!("bounds: {} to {}\n", text::point(lower), text::point(upper));
    text += &format!(
        "memory, estimated: {} of records, {} in Embree, {} at most while it builds\n",
        memory::readable(estimate.records_bytes),
        memory::readable(estimate.embree_bytes),
        memory::readable(estimate.peak_bytes())
    );
    text += &text::records(&scene);
    for material in &scene.materials {
        let name = if material.name.is_empty() {
            "(default)"
        } else {
            &material.name
        };
        let (kind, color) = (material.kind.name(), color_text(&material.color));
        text += &format!("material {name}: {kind} {color}\n");
    }
    print(&text)
}

/// The color of a material, for people.
fn color_text(color: &Color) -> String {
    let average = || text::point(color.average());
    match color {
        Color::Constant(color) => text::point(*color),
        Color::Checker(_) => format!("checker of mean {}", average()),
        Color::Stripes(_) => format!("stripes of mean {}", average()),
        Color::Image(_) => format!("image of mean {}", average()),
        Color::Data(data) if data.map.has_categories() => {
            format!("by column {}: {}", data.column, data.map.name())
        }
        Color::Data(data) => {
            let [first, last] = data.range;
            let map = data.map.name();
            format!("by column {}: {map} from {first} to {last}", data.column)
        }
    }
}
