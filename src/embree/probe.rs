//! The start-up check: does the loaded library write hits in the layout of the headers?
//!
//! The layout depends on how a library was configured, not on its version alone. With headers
//! of 4.2 and a library of 4.4, every query wrote a word beyond the hit, without any error.

use super::device::{Device, DeviceOptions};
use super::error::Error;
use super::ray::Ray32;
use super::scene::SceneBuilder;
use super::sys;

/// A value that Embree never writes.
const SENTINEL: u32 = 0x5EA1_C0DE;
/// More words than any known layout exceeds another by.
const MARGIN_WORDS: usize = 16;

#[repr(C)]
struct Padded {
    query: sys::RTCRayHit,
    margin: [u32; MARGIN_WORDS],
}

impl Device {
    /// Sets up Embree.
    ///
    /// # Errors
    /// When Embree reports an error, its major or minor version differs from that of the
    /// headers, or it writes another hit layout.
    pub fn new(options: &DeviceOptions) -> Result<Self, Error> {
        let device = Self::open(options)?;
        check_hit_layout(&device)?;
        Ok(device)
    }
}

/// Traces one ray against one triangle, into a hit that is followed by a margin.
fn check_hit_layout(device: &Device) -> Result<(), Error> {
    let mut builder = SceneBuilder::<()>::new(device)?;
    let corners = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
    builder.attach_triangles(&corners, &[[0, 1, 2]])?;
    let scene = builder.commit()?;
    let ray = Ray32 {
        origin: [1.0, 1.0, 0.0],
        direction: [0.0, 0.0, 0.5],
        t_near: 0.0,
        t_far: f32::INFINITY,
    };
    let mut padded = Padded {
        query: ray.to_query(),
        margin: [SENTINEL; MARGIN_WORDS],
    };
    // SAFETY: invariants 1 and 5; the margin makes a layout longer than that of the headers
    // harmless, which is what this call detects.
    unsafe { scene.trace_into((&raw mut padded).cast(), &mut ()) };
    let Padded { query, margin } = padded;
    // Embree's reciprocals may be off by an ulp; a misplaced field is far off.
    let near = |found: f32, expected: f32| (found - expected).abs() < 1e-3;
    let found = if margin != [SENTINEL; MARGIN_WORDS] {
        "it writes behind the hit"
    } else if !near(query.ray.tfar, 2.0) || query.hit.geomID != 0 || query.hit.primID != 0 {
        "a triangle straight ahead is not found"
    } else if !near(query.hit.u, 0.25) || !near(query.hit.Ng_z.abs(), 16.0) {
        "the parts of a hit are not where they should be"
    } else {
        return Ok(());
    };
    Err(Error::HitLayout {
        loaded: device.version(),
        found,
    })
}
