//! Builds the rivals that represent a scene and fit into memory.

use std::sync::Arc;

use super::flat::Flat;
use super::native::Native;
use super::native_packets::by_packets;
use super::plan::Plan;
use super::representation::Representative;
use crate::rivals::Shape;
use cyltrace::embree::DeviceOptions;
use cyltrace_output::readable;

/// Builds a rival; the error is the reason why it is not measured.
pub fn build(
    plan: &Plan,
    flat: &Arc<Flat>,
    shape: Shape,
    in_packets: bool,
) -> Result<Arc<dyn Representative>, String> {
    let device = DeviceOptions {
        threads: plan.options.threads,
        max_isa: plan.options.max_isa,
    };
    check(plan, flat, shape)?;
    let native = Native::new(flat, shape, &device).map_err(|error| error.to_string())?;
    Ok(match in_packets {
        true => Arc::from(by_packets(native)?),
        false => Arc::new(native),
    })
}

/// Rejects a geometry that does not represent the scene, or takes too much memory.
fn check(plan: &Plan, flat: &Flat, shape: Shape) -> Result<(), String> {
    let kinds = flat.kinds();
    if let Some(&kind) = kinds.iter().find(|&&kind| !shape.represents(kind)) {
        return Err(shape.refusal(kind));
    }
    let estimate = shape_bytes(flat, shape);
    if estimate > plan.max_memory {
        return Err(format!(
            "it needs about {} of memory, more than the {} that --max-memory allows",
            readable(estimate),
            readable(plan.max_memory)
        ));
    }
    Ok(())
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
