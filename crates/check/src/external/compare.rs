//! Hits of another program, or of a mesh, compared with the exact ones.

use super::agreement::Comparison;
use super::deviation::Deviation;
use super::nearness::ROUNDING;
use super::tolerance::Tolerance;
use super::traced_mesh::TracedMesh;
use crate::outcome::{Outcome, Witness};
use crate::tally::Progress;
use cyltrace::math::Ray;
use cyltrace::tracer::Tracer;

/// Compares the `reported` hits of `rays` with the exact ones, in the rayon pool
/// that this is called in. `None` if `progress` breaks off.
///
/// `tolerance` is relative to the sum of three distances: of the ray's origin from the scene's,
/// of the hit from the ray's origin, and of the farthest corner of the solid's box from the
/// scene's origin. [`crate::F32_TOLERANCE`] suits a renderer in f32.
///
/// # Panics
/// If the number of answers is not the number of rays.
#[must_use]
pub fn compare_hits(
    tracer: &Tracer,
    rays: &[Ray],
    reported: &[Option<f64>],
    tolerance: f64,
    most_listed: usize,
    progress: &Progress,
) -> Option<Outcome> {
    assert_eq!(rays.len(), reported.len(), "one answer per ray");
    let tolerance = Tolerance {
        deviation: Deviation::Everywhere(0.0),
        of_way: tolerance,
        of_extent: tolerance,
    };
    let comparison = Comparison::new(tracer, tolerance, most_listed);
    let row = ("given", Witness::UserHits);
    comparison.run(row, rays, progress, |index| reported[index])
}

/// Compares the hits of a mesh with the exact ones, on the rays of a class of that name,
/// in the rayon pool that this is called in. The mesh may be off by
/// `deviation`, and by the share `rounding` of a solid's coordinates. `None` if `progress`
/// breaks off.
#[must_use]
pub fn compare_mesh(
    tracer: &Tracer,
    mesh: &TracedMesh,
    (class, rays): (&'static str, &[Ray]),
    (deviation, rounding): (Deviation, f64),
    most_listed: usize,
    progress: &Progress,
) -> Option<Outcome> {
    let of_placing = match deviation {
        Deviation::Everywhere(_) => 0.0,
        Deviation::Tessellated { .. } => ROUNDING,
    };
    let tolerance = Tolerance {
        deviation,
        of_way: ROUNDING,
        of_extent: rounding + of_placing,
    };
    let comparison = Comparison::new(tracer, tolerance, most_listed);
    let row = (class, Witness::UserMesh);
    let reported = |index: usize| mesh.closest(&rays[index]).map(|hit| hit.t);
    comparison.run(row, rays, progress, reported)
}
