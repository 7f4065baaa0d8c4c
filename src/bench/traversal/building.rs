//! Builds rivals, where there is room for them.

use std::sync::Arc;

use super::c_callback::CCallback;
use super::flat::Flat;
use super::measure::Plan;
use super::native::{Native, Solids};
use super::native_packets::by_packets;
use super::representation::{Representation, Representative};
use crate::bench::rivals::Shape;
use crate::embree::{Device, DeviceOptions};
use crate::report::readable;

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
    let native = |solids| Native::new(flat, solids, &device).map_err(|error| error.to_string());
    if let Some(shape) = representation.shape() {
        let estimate = shape_bytes(flat, shape);
        if estimate > plan.max_memory {
            return Err(format!(
                "it would take about {}, more than the {} allowed",
                readable(estimate),
                readable(plan.max_memory)
            ));
        }
        let native = native(Solids::Shape(shape))?;
        return Ok(match representation {
            // Embree 3.13.5 does not come back from coherent packets of shadow rays
            // through instances of curves.
            Representation::EmbreeConePacket if flat.has_placements() => {
                return Err(String::from(
                    "Embree does not come back from coherent packets through instances of curves",
                ));
            }
            Representation::EmbreeConePacket => Arc::from(by_packets(native)?),
            _ => Arc::new(native),
        });
    }
    match representation {
        Representation::CCallback if flat.has_placements() => Err(String::from(
            "the callback in C is of cylinders; this scene places prototypes",
        )),
        Representation::CCallback => {
            let in_c = CCallback::new(flat, &device).map_err(|error| error.to_string())?;
            Ok(Arc::new(in_c))
        }
        _ if !flat.has_placements() => Err(String::from("the scene has no placements")),
        Representation::NativeInstances => Ok(Arc::new(native(Solids::Narrow)?)),
        _ => Err(instance_arrays(&device)),
    }
}

/// Why there are no arrays of instances.
fn instance_arrays(device: &DeviceOptions) -> String {
    let version = Device::new(device).map(|device| device.version().to_string());
    match version {
        Ok(version) if version.starts_with('3') => {
            String::from("Embree 3 has no arrays of instances")
        }
        _ => String::from("arrays of instances are not bound"),
    }
}

/// Bytes that a rival takes while it is built, at most.
fn shape_bytes(flat: &Flat, shape: Shape) -> u64 {
    let used = flat.prototypes();
    let records = used.iter().flat_map(|&one| flat.cylinders(one));
    let primitives: u64 = records
        .map(|record| shape.primitives(record.cylinder().caps()))
        .sum();
    primitives * BYTES_PER_PRIMITIVE
}

/// By how much the process grew, at its peak, for each triangle of 10^4 prisms
/// of 32 (121 bytes) and of 64 sides (124), rounded up: our buffers, Embree's
/// copies of them and its tree, with Embree 3.13.5. 75 to 82 bytes stay. A cone
/// takes less.
pub const BYTES_PER_PRIMITIVE: u64 = 125;
