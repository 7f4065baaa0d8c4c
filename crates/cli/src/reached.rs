//! What a picture with `--error` or `--time` has reached, as text and as JSON.

use cyltrace_parts::PartSet;
use cyltrace_render::{Reached, Settings, Tiles};
use serde_json::{Value, json};

/// The key of the figures.
pub const KEY: &str = "reached";

/// The value of [`KEY`].
pub fn figures(reached: &Reached) -> Value {
    json!({
        "error": reached.error,
        "tiles_above": reached.tiles_above,
        "samples": reached.samples,
    })
}

/// What the parts together have reached; `None` if a part says nothing of it.
pub fn of_parts(set: &PartSet) -> Option<Reached> {
    let parts = set.parts().iter().map(|part| {
        let stated = &part.summary()["figures"][KEY];
        Some(Reached {
            error: stated["error"].as_f64()? as f32,
            tiles_above: stated["tiles_above"].as_u64()?,
            samples: stated["samples"].as_u64()?,
        })
    });
    let parts: Option<Vec<Reached>> = parts.collect();
    parts?.into_iter().reduce(Reached::and)
}

/// A line for people.
pub fn text(reached: &Reached, settings: &Settings) -> String {
    let tiles = Tiles::of(settings.film).count();
    let pixels = u64::from(settings.film.width) * u64::from(settings.film.height);
    let above = match settings.target {
        Some(target) if target.error > 0.0 => format!(
            ", above {} in {} of {tiles} tiles",
            target.error, reached.tiles_above
        ),
        _ => String::new(),
    };
    format!(
        "error: {:.4} at most in a tile, as estimated{above}; {:.1} samples per pixel\n",
        reached.error,
        reached.samples as f64 / pixels as f64
    )
}
