//! What analytic cylinders are compared with: Embree's own curve, meshes of
//! any fineness, and the whole tracer on the same scene.
//!
//! They answer whole queries: Embree walks its tree to a primitive, and
//! intersects it by itself or calls back. So their times are not those of
//! solvers; [`tracer`](Traced) is the row to compare them with.
//!
//! *Errors* are found on a scene a problem, built for it alone, in which the
//! one cylinder, curve or mesh is at its stated place: nothing but the rival's
//! own f32 is to blame. What Embree cannot take (coordinates beyond its
//! limit, ends that coincide in f32) counts as a miss. *Times* are of one
//! scene of cylinders apart from one another ([`Spaced`]), the same for all.

mod native;
mod spaced;
mod traced;

use glam::DVec3;

use crate::solid::{Caps, Cylinder};

pub use native::{Native, SIDES, Shape};
pub use spaced::Spaced;
pub use traced::Traced;

/// Cylinders in the scene that is timed. The finest mesh has 4096 triangles a
/// cylinder, a million in all; fewer cylinders would leave too little of a
/// tree to walk.
const CYLINDERS_TIMED: usize = 256;

/// Cylinders whose memory is measured: with both discs, side by side.
fn measured_cylinders() -> Vec<Cylinder> {
    (0..CYLINDERS_TIMED)
        .map(|index| {
            let p0 = DVec3::X * (4 * index) as f64;
            Cylinder::new(p0, p0 + DVec3::Z * 3.0, 1.0, Caps::Both)
                .expect("a length and a radius of usual size")
        })
        .collect()
}
