//! Outliers, as `info` names them.

use cyltrace::scene::{Origin, PrototypeIndex, Scene};
use cyltrace::tracer::Outlier;
use serde_json::{Value, json};

use super::text;

/// The most outliers that the text names.
const MOST_NAMED: usize = 10;

/// What an outlier comes from, if that is a file.
fn origin<'a>(scene: &'a Scene, outlier: &Outlier) -> Option<Origin<'a>> {
    let prototype = &scene.prototypes[outlier.prototype.0 as usize];
    match outlier.kind {
        Some(_) => prototype.solid_origins.of(outlier.number),
        None => prototype.placement_origins.of(outlier.number),
    }
}

fn kind(outlier: &Outlier) -> &'static str {
    outlier.kind.map_or("placement", |kind| kind.name())
}

/// A line for each of the first outliers, and one for how many more there are.
pub fn lines(scene: &Scene, outliers: &[Outlier]) -> String {
    let mut lines = String::new();
    for outlier in outliers.iter().take(MOST_NAMED) {
        let place = match outlier.prototype {
            PrototypeIndex::ROOT => String::new(),
            index => format!(
                " of prototype \"{}\"",
                scene.prototypes[index.0 as usize].name
            ),
        };
        let origin = match origin(scene, outlier) {
            Some(Origin {
                file,
                row: Some(row),
            }) => format!(" (row {row} of {file})"),
            Some(Origin { file, row: None }) => format!(" (from {file})"),
            None => String::new(),
        };
        lines += &format!(
            "outlier: {} {}{place}{origin} is {} times as far away as the others reach, and {} times as large as all of them\n",
            kind(outlier),
            outlier.number,
            text::rounded(outlier.distance),
            text::rounded(outlier.size),
        );
    }
    if let Some(more @ 1..) = outliers.len().checked_sub(MOST_NAMED) {
        lines += &format!("outliers: {more} more\n");
    }
    lines
}

/// All outliers for programs.
pub fn values(scene: &Scene, outliers: &[Outlier]) -> Value {
    let value = |outlier: &Outlier| {
        let origin = origin(scene, outlier);
        json!({
            "prototype": scene.prototypes[outlier.prototype.0 as usize].name,
            "kind": kind(outlier),
            "number": outlier.number,
            "file": origin.map(|origin| origin.file),
            "row": origin.and_then(|origin| origin.row),
            "distance": outlier.distance,
            "size": outlier.size,
        })
    };
    outliers.iter().map(value).collect()
}
