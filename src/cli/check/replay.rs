//! `cyltrace check --replay`: one ray, and what everyone says of it.

use cyltrace::check::{Settings, oracle_t, ray_from_text};
use cyltrace::report::Table;
use cyltrace::tracer::{DEFAULT_BATCH, Tracer};

use crate::cli::GOOD;
use crate::cli::print::print;
use crate::cli::text;

/// Hits that are shown.
const MOST_HITS: usize = 40;

/// Prints the ray of a word and the answers to it.
pub fn run(tracer: &Tracer, word: &str, _settings: &Settings) -> anyhow::Result<u8> {
    let ray = ray_from_text(word)?;
    let mut shown = format!(
        "origin    {}\ndirection {}\nrange     {:?} to {:?}\n",
        text::point(ray.origin),
        text::point(ray.direction),
        ray.t_min,
        ray.t_max
    );
    let headings = [
        "instance",
        "primitive",
        "part",
        "crossing",
        "t",
        "oracle's first t",
    ];
    let mut table = Table::new(&headings, 4);
    for hit in tracer.all_hits(&ray, DEFAULT_BATCH).take(MOST_HITS) {
        let path: Vec<String> = hit.instance.iter().map(u32::to_string).collect();
        let exact = oracle_t(tracer.scene(), &ray, &hit);
        table.push(vec![
            path.join("/"),
            hit.primitive.to_string(),
            hit.part.name().to_owned(),
            hit.crossing.name().to_owned(),
            format!("{:?}", hit.t),
            exact.map_or_else(|| "a miss".to_owned(), |t| format!("{t:?}")),
        ]);
    }
    match tracer.closest(&ray) {
        Some(hit) => shown += &format!("closest   t {:?}\n", hit.t),
        None => shown += "closest   a miss\n",
    }
    print(&format!("{shown}{table}"))?;
    Ok(GOOD)
}
