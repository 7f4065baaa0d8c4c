//! Prisms of cylinders, for benchmarks and checks.

use super::profile::turned_size;
use super::{Fit, Mesh, inner_factor, mesh_of};
use crate::solid::{Caps, Cylinder};

/// The distance by which the inscribed prism falls short of the cylinder's wall: its
/// [`deviation_of`](super::deviation_of).
#[must_use]
pub fn sagitta(cylinder: &Cylinder, segments: u32) -> f64 {
    cylinder.radius() * (1.0 - inner_factor(segments))
}

/// The prism with `segments` sides whose corners lie on the rims: the [`mesh_of`] a cylinder.
/// It has the disks that the cylinder has.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn inscribed_prism(cylinder: &Cylinder, segments: u32) -> Mesh {
    mesh_of(&(*cylinder).into(), segments, Fit::Inscribed)
}

/// The numbers of vertices and triangles of a cylinder's prism, which depend on its disks
/// alone.
#[must_use]
pub fn prism_size(caps: Caps, segments: u32) -> (u64, u64) {
    let disks = u64::from(caps.at_p0()) + u64::from(caps.at_p1());
    turned_size(2, disks, segments)
}
