//! The side without Python of `python/benchmarks/overhead.py`: the same rays, columns and
//! threads. Each line that is read, `t` or `all`, makes it trace all rays into new columns
//! and print the seconds; `sum` prints the sum of their `t`.
//!
//! cargo run --release -p cyltrace-bench --example columns -- SCENE RAYS THREADS

use std::error::Error;
use std::io;
use std::sync::Arc;
use std::time::Instant;

use cyltrace::math::Ray;
use cyltrace::tracer::{HitFields, Options, PartialHit, Tracer, workers};
use glam::DVec3;
use rayon::prelude::*;

/// Rays that a thread traces at a time.
const BLOCK: usize = 1 << 14;

/// Answers column by column.
struct Columns {
    t: Vec<f64>,
    primitive: Vec<i64>,
    point: Vec<[f64; 3]>,
    normal: Vec<[f64; 3]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [scene, rays, threads] = words.as_slice() else {
        return Err("the arguments are SCENE RAYS THREADS".into());
    };
    let threads = Some(threads.parse()?);
    let numbers: Vec<f64> = std::fs::read(rays)?
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight bytes")))
        .collect();
    let workers = workers(threads)?;
    let scene = Arc::new(cyltrace::scene::load(scene.as_ref())?);
    let options = Options {
        threads,
        ..Options::default()
    };
    let tracer = workers.install(|| Tracer::new(scene, &options))?;
    println!("ready");
    let mut last = None;
    for line in io::stdin().lines() {
        let line = line?;
        if line == "sum" {
            let times = last.iter().flat_map(|columns: &Columns| &columns.t);
            println!("{}", times.filter(|t| t.is_finite()).sum::<f64>());
            continue;
        }
        let start = Instant::now();
        last = Some(workers.install(|| columns(&tracer, &numbers, line == "all")));
        println!("{}", start.elapsed().as_secs_f64());
    }
    // They are computed, though only `t` is read.
    drop(last.map(|columns| (columns.primitive, columns.point, columns.normal)));
    Ok(())
}

/// Traces the rays, six numbers each.
fn columns(tracer: &Tracer, numbers: &[f64], has_all: bool) -> Columns {
    let count = numbers.len() / 6;
    let others = if has_all { count } else { 0 };
    let mut columns = Columns {
        t: vec![f64::INFINITY; count],
        primitive: vec![-1; others],
        point: vec![[f64::NAN; 3]; others],
        normal: vec![[f64::NAN; 3]; others],
    };
    let rays = numbers.par_chunks(6 * BLOCK).map(|numbers| {
        let rays = numbers.chunks_exact(6).map(|ray| Ray {
            origin: DVec3::from_slice(ray),
            direction: DVec3::from_slice(&ray[3..]),
            t_min: 0.0,
            t_max: f64::INFINITY,
        });
        rays.collect::<Vec<_>>()
    });
    if !has_all {
        let blocks = rays.zip(columns.t.par_chunks_mut(BLOCK));
        blocks.for_each(|(rays, times)| {
            let mut hits = Vec::new();
            tracer.first_hits(&rays, &mut hits);
            for (hit, t) in hits.iter().zip(times) {
                *t = hit.as_ref().map_or(f64::INFINITY, |hit| hit.t);
            }
        });
        return columns;
    }
    let targets = columns
        .t
        .par_chunks_mut(BLOCK)
        .zip(columns.primitive.par_chunks_mut(BLOCK))
        .zip(columns.point.par_chunks_mut(BLOCK))
        .zip(columns.normal.par_chunks_mut(BLOCK));
    rays.zip(targets).for_each(|(rays, target)| {
        let (((times, primitives), points), normals) = target;
        let mut hits: Vec<Option<PartialHit>> = Vec::new();
        tracer.closest_batch_with(&rays, HitFields::POINT | HitFields::NORMAL, &mut hits);
        for (row, hit) in hits.iter().enumerate() {
            let Some(hit) = hit else { continue };
            times[row] = hit.t();
            primitives[row] = hit.primitive().into();
            points[row] = hit.point().expect("requested").to_array();
            normals[row] = hit.normal().expect("requested").to_array();
        }
    });
    columns
}
