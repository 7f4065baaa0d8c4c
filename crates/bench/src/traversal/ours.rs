//! This library's modes.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use super::flat::Flat;
use super::rays::{Kind, Rays};
use super::representation::{Met, Mode, Representative, SolidId};
use cyltrace::tracer::counters::{self, Counts};
use cyltrace::tracer::{BuildTime, FirstHit, Layout, Options, Tracer, TracerError};

/// The scene as this library traces it in one mode.
pub struct Ours {
    tracer: Arc<Tracer>,
    flat: Arc<Flat>,
    /// Whether rays are traced in batches.
    in_batches: bool,
}

/// The modes, with the seconds that each took to build.
///
/// # Errors
/// If Embree rejects the scene.
pub fn modes(flat: &Arc<Flat>, options: &Options) -> Result<[(Mode, Ours, f64); 3], TracerError> {
    let built = |layout| -> Result<_, TracerError> {
        let start = Instant::now();
        let options = Options {
            layout,
            build: BuildTime::AtOnce,
            ..options.clone()
        };
        let tracer = Tracer::new(Arc::clone(&flat.scene), &options)?;
        Ok((Arc::new(tracer), start.elapsed().as_secs_f64()))
    };
    let ours = |mode, (tracer, build_s): &(Arc<Tracer>, f64)| {
        let ours = Ours {
            tracer: Arc::clone(tracer),
            flat: Arc::clone(flat),
            in_batches: mode != Mode::Single,
        };
        (mode, ours, *build_s)
    };
    let single = built(Layout::Single)?;
    let block = built(Layout::Block)?;
    Ok([
        ours(Mode::Single, &single),
        ours(Mode::Packet, &single),
        ours(Mode::Block, &block),
    ])
}

impl Ours {
    /// The tracer.
    pub fn tracer(&self) -> &Arc<Tracer> {
        &self.tracer
    }
}

/// Traces the rays by the query of their kind, one at a time or in batches. The queries
/// return what Embree's own return: where, and of which solid.
pub fn run(tracer: &Tracer, rays: &Rays, range: Range<usize>, in_batches: bool) -> u64 {
    let asked = &rays.wide[range];
    let bits = |hit: Option<FirstHit>| hit.map_or(0, |hit| hit.t.to_bits());
    match (rays.kind, in_batches) {
        (Kind::Shadow, false) => asked
            .iter()
            .map(|ray| u64::from(tracer.occluded(ray)))
            .sum(),
        (Kind::Shadow, true) => {
            let mut blocked = Vec::new();
            tracer.occluded_batch(asked, &mut blocked);
            blocked.into_iter().map(u64::from).sum()
        }
        (Kind::Coherent | Kind::Incoherent, false) => asked.iter().fold(0, |sum: u64, ray| {
            sum.wrapping_add(bits(tracer.first_hit(ray)))
        }),
        (Kind::Coherent | Kind::Incoherent, true) => {
            let mut hits = Vec::new();
            tracer.first_hits(asked, &mut hits);
            hits.into_iter()
                .fold(0, |sum: u64, hit| sum.wrapping_add(bits(hit)))
        }
    }
}

impl Representative for Ours {
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>> {
        let asked = &rays.wide[range];
        let mut hits = Vec::new();
        if self.in_batches {
            self.tracer.closest_batch(asked, &mut hits);
        } else {
            hits.extend(asked.iter().map(|ray| self.tracer.closest(ray)));
        }
        let met = |hit: Option<cyltrace::tracer::Hit>| {
            let hit = hit?;
            Some(Met {
                t: hit.t,
                solid: SolidId {
                    placed: self.flat.number(&hit.instance),
                    primitive: hit.primitive,
                },
            })
        };
        hits.into_iter().map(met).collect()
    }

    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool> {
        let asked = &rays.wide[range];
        let mut blocked = Vec::new();
        if self.in_batches {
            self.tracer.occluded_batch(asked, &mut blocked);
        } else {
            blocked.extend(asked.iter().map(|ray| self.tracer.occluded(ray)));
        }
        blocked
    }

    fn run(&self, rays: &Rays, range: Range<usize>) -> u64 {
        run(&self.tracer, rays, range, self.in_batches)
    }

    fn bytes(&self) -> usize {
        let statistics = self.tracer.statistics();
        statistics.embree_bytes + statistics.records_bytes
    }

    fn counts(&self, rays: &Rays) -> Option<Counts> {
        // Discards what was counted on this thread before.
        let _ = counters::take();
        self.run(rays, 0..rays.wide.len());
        counters::take()
    }
}
