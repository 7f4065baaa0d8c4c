//! Builds rivals, where there is room for them.

use std::sync::Arc;

use super::flat::Flat;
use super::native::Native;
use super::native_packets::by_packets;
use super::plan::Plan;
use super::representation::{Representation, Representative};
use crate::rivals::Shape;
use cyltrace::embree::DeviceOptions;
use cyltrace_output::readable;

/// Builds a rival, or says why not.
pub fn build(
    plan: &Plan,
    flat: &Arc<Flat>,
    representation: Representation,
) -> Result<Arc<dyn Representative>, String> {
    let device = DeviceOptions {
        threads: plan.options.threads,
        max_isa: plan.options.max_isa,
    };
    let shape = representation.shape();
    let shape = shape.expect("every rival is a shape");
    if let Some(reason) = refusal(plan, flat, shape) {
        return Err(reason);
    }
    let native = Native::new(flat, shape, &device).map_err(|error| error.to_string())?;
    Ok(if representation.is_by_packets() {
        Arc::from(by_packets(native)?)
    } else {
        Arc::new(native)
    })
}

/// Why a scene is not built of what Embree intersects by itself, if it is not.
fn refusal(plan: &Plan, flat: &Flat, shape: Shape) -> Option<String> {
    let kinds = flat.kinds();
    if let Some(&kind) = kinds.iter().find(|&&kind| !shape.represents(kind)) {
        return Some(shape.refusal(kind));
    }
    let estimate = shape_bytes(flat, shape);
    (estimate > plan.max_memory).then(|| {
        format!(
            "it would take about {}, more than the {} allowed",
            readable(estimate),
            readable(plan.max_memory)
        )
    })
}

/// Bytes that a rival takes while it is built, at most.
fn shape_bytes(flat: &Flat, shape: Shape) -> u64 {
    let used = flat.prototypes().into_iter();
    let solids = used.flat_map(|one| flat.solids(one));
    let primitives: u64 = solids.map(|solid| shape.primitives(&solid)).sum();
    primitives * BYTES_PER_PRIMITIVE
}

/// By how much the process grew, at its peak, for each triangle of 10^4 prisms
/// of 32 (121 bytes) and of 64 sides (124), rounded up: our buffers, Embree's
/// copies of them and its tree, with Embree 3.13.5. 75 to 82 bytes stay. Of 10^5 disks,
/// whose triangles share the fewest corners, it was 125, of cuboids 119 and of balls
/// 113; it is a little more than all. What is no mesh takes less.
pub const BYTES_PER_PRIMITIVE: u64 = 128;
