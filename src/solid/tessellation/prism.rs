//! The prisms of cylinders by their own names, as benchmarks and checks use them.

use super::profile::turned_size;
use super::{Fit, Mesh, inner_factor, mesh_of};
use crate::solid::{Caps, Cylinder};

/// By how much the inscribed prism may fall short of the cylinder's wall, which is
/// [`deviation_of`](super::deviation_of) it.
#[must_use]
pub fn sagitta(cylinder: &Cylinder, segments: u32) -> f64 {
    cylinder.radius() * (1.0 - inner_factor(segments))
}

/// The prism with `segments` sides whose corners lie on the rims, which is
/// [`mesh_of`] a cylinder. It has the disks that the cylinder has.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn inscribed_prism(cylinder: &Cylinder, segments: u32) -> Mesh {
    mesh_of(&(*cylinder).into(), segments, Fit::Inscribed)
}

/// How many vertices and triangles the prism of a cylinder has: they depend on its
/// disks alone.
#[must_use]
pub fn prism_size(caps: Caps, segments: u32) -> (u64, u64) {
    let disks = u64::from(caps.at_p0()) + u64::from(caps.at_p1());
    turned_size(2, disks, segments)
}
