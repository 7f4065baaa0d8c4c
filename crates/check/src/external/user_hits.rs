//! Hits that another program found, against the exact ones.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::agreement::Agreement;
use super::deviation::Deviation;
use super::surfaces::Surfaces;
use super::tolerance::Tolerance;
use crate::{Progress, Witness};
use cyltrace::math::Ray;
use cyltrace::tracer::Tracer;

/// Rays that one task compares.
const BLOCK: u64 = 512;

/// Compares the answers `told` for `rays` with the exact ones, in the rayon pool
/// that this is called in. `None` when `progress` asked to stop.
///
/// `tolerance` is relative to the distances of a ray's origin from the scene's, of the hit
/// from the ray's origin, and of the farthest corner of the solid's box from the scene's origin,
/// added up; [`crate::F32_TOLERANCE`] suits a renderer in f32.
///
/// # Panics
/// When there is not one answer a ray.
#[must_use]
pub fn compare_hits(
    tracer: &Tracer,
    rays: &[Ray],
    told: &[Option<f64>],
    tolerance: f64,
    most_listed: usize,
    progress: &Progress,
) -> Option<Agreement> {
    assert_eq!(rays.len(), told.len(), "one answer a ray");
    let tolerance = Tolerance {
        deviation: Deviation::Everywhere(0.0),
        of_way: tolerance,
        of_extent: tolerance,
    };
    let surfaces = Surfaces::new(tracer.scene(), tolerance.deviation);
    in_blocks(
        Agreement::new("given", Witness::UserHits, tolerance, &surfaces),
        rays.len() as u64,
        most_listed,
        progress,
        |agreement, index| {
            let (ray, told) = (&rays[index as usize], told[index as usize]);
            agreement.add((tracer, &surfaces), index, ray, told, most_listed);
        },
    )
}

/// Runs `compare` for every number below `count`, on all threads, in an order that
/// the outcome does not show.
pub(crate) fn in_blocks(
    none: Agreement,
    count: u64,
    most_listed: usize,
    progress: &Progress,
    compare: impl Fn(&mut Agreement, u64) + Sync,
) -> Option<Agreement> {
    let done = std::sync::atomic::AtomicU64::new(0);
    let blocks: Option<Vec<Agreement>> = (0..count.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let mut found = none.clone();
            let indices = block * BLOCK..count.min((block + 1) * BLOCK);
            indices.for_each(|index| compare(&mut found, index));
            let before = done.fetch_add(found.rays, std::sync::atomic::Ordering::Relaxed);
            match progress(before + found.rays, count, "comparing hits") {
                ControlFlow::Continue(()) => Some(found),
                ControlFlow::Break(()) => None,
            }
        })
        .collect();
    let mut whole = none;
    for block in blocks? {
        whole.append(block, most_listed);
    }
    Some(whole)
}
