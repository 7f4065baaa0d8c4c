//! A ray and one cylinder.

use cyltrace::math::Ray;
use cyltrace::solid::Cylinder;

/// A ray and the cylinder that it is intersected with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// The ray.
    pub ray: Ray,
}
